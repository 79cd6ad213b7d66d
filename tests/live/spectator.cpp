#include <filesystem>
#include <fstream>

#include <tests/live/spectator.hpp>
#include <unistd.h>

namespace continuo::live {

std::string Stage::file_of(const std::string& text_or_name) {
  if (text_or_name.find('\n') == std::string::npos)
    return std::string(CONTINUO_SOURCE_DIR) + "/models/" + text_or_name + ".sim";
  static int count = 0;
  const auto path = std::filesystem::path(::testing::TempDir()) /
                    ("live_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".sim");
  std::ofstream(path) << text_or_name;
  return path.string();
}

}  // namespace continuo::live
