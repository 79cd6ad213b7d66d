// Loads the shared libraries of rarely used parts and forwards calls to them.
#include <filesystem>
#include <stdexcept>
#include <string>

#include <apps/continuo/terminal/modules.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <dlfcn.h>
#include <fmt/format.h>

#include <continuo/results/netcdf_file.hpp>
#include <continuo/studies/least_squares.hpp>

namespace continuo::app {
namespace {

namespace fs = std::filesystem;

struct Module {
  const void* content = nullptr;  // the address of its `continuo_module`
  std::string problem{};          // why there is none
};

/// Beside the command, where it was built, or in the folder of libraries that it was installed with. Links to
/// the command are followed.
Module load(const std::string& name) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  const std::string file = "continuo_" + name + ".so";
  const fs::path built = here / file, installed = (here / CONTINUO_INSTALLED_MODULES / file).lexically_normal();
  const fs::path& found = fs::exists(built, error) ? built : installed;
  if (!fs::exists(found, error))
    return {.problem = fmt::format("a part of the command is missing: there is neither {} nor {}", built.string(),
                                   installed.string())};
  void* module = dlopen(found.c_str(), RTLD_NOW | RTLD_LOCAL);
  const void* content = module == nullptr ? nullptr : dlsym(module, "continuo_module");
  if (content == nullptr) return {.problem = fmt::format("cannot load a part of the command: {}", dlerror())};
  return {.content = content};
}

/// What the module has, a pointer to a function.
template <class Function>
Function entry_of(const char* module) {
  const auto [content, problem] = load(module);
  if (content == nullptr) throw std::runtime_error(problem);
  return *static_cast<const Function*>(content);
}

}  // namespace

bool loadable(const char* module) {
  const std::string problem = load(module).problem;
  if (!problem.empty()) say(problem);
  return problem.empty();
}

}  // namespace continuo::app

namespace continuo {

Status results::write_netcdf_file(const NetcdfFile& file, const std::string& path) {
  return app::entry_of<decltype(&write_netcdf_file)>(app::netcdf_module)(file, path);
}

studies::LeastSquaresResult studies::least_squares(const LeastSquares& problem, const LeastSquaresOptions& options) {
  return app::entry_of<decltype(&least_squares)>(app::least_squares_module)(problem, options);
}

}  // namespace continuo
