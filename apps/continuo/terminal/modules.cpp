// Loads the shared libraries of rarely used parts.
#include <stdexcept>
#include <string>

#include <apps/continuo/terminal/modules.hpp>
#include <apps/continuo/terminal/parts.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <dlfcn.h>
#include <fmt/format.h>

namespace continuo::app {
namespace {

struct Module {
  const void* content = nullptr;  // the address of its `continuo_module`
  std::string problem{};          // why there is none
};

Module load(const std::string& name) {
  const Part part = find_part("continuo_" + name + ".so");
  if (!part.problem.empty()) return {.problem = "a part of the command is missing: " + part.problem};
  void* module = dlopen(part.file.c_str(), RTLD_NOW | RTLD_LOCAL);
  const void* content = module == nullptr ? nullptr : dlsym(module, "continuo_module");
  if (content == nullptr) return {.problem = fmt::format("cannot load a part of the command: {}", dlerror())};
  return {.content = content};
}

}  // namespace

bool loadable(const char* module) {
  const std::string problem = load(module).problem;
  if (!problem.empty()) say(problem);
  return problem.empty();
}

const void* content_of(const char* module) {
  const auto [content, problem] = load(module);
  if (content == nullptr) throw std::runtime_error(problem);
  return content;
}

}  // namespace continuo::app
