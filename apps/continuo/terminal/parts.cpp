// Looks for the parts of the command by the place of the program that runs.
#include <apps/continuo/terminal/parts.hpp>
#include <fmt/format.h>

namespace continuo::app {

namespace fs = std::filesystem;

Part find_part(const std::string& name) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path built = here / name, installed = (here / CONTINUO_INSTALLED_MODULES / name).lexically_normal();
  const fs::path& found = fs::exists(built, error) ? built : installed;
  if (fs::exists(found, error)) return {.file = found};
  return {.file = {}, .problem = fmt::format("there is neither {} nor {}", built.string(), installed.string())};
}

}  // namespace continuo::app
