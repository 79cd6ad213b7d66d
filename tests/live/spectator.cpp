// Models of the tests' own as files, which a session opens.
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <tests/live/spectator.hpp>
#include <unistd.h>

namespace continuo::live {

namespace {

/// A folder of this process, gone when it ends.
struct Folder {
  std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) / ("continuo-live-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

std::string Stage::file_of(const std::string& text_or_name) {
  if (text_or_name.find('\n') == std::string::npos)
    return std::string(CONTINUO_SOURCE_DIR) + "/models/" + text_or_name + ".sim";
  static const Folder folder;
  static int count = 0;
  const auto path = folder.path / ("live_" + std::to_string(count++) + ".sim");
  std::ofstream(path) << text_or_name;
  return path.string();
}

}  // namespace continuo::live
