// The version, which only this part of the command is compiled with.
#include <apps/continuo/terminal/version.hpp>

namespace continuo::app {

std::string version_of_program() {
  return CONTINUO_VERSION;
}

}  // namespace continuo::app
