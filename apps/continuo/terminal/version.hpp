// The version of the command, as --version shows it: other versions may compute other bits.
#pragma once
#include <string>

namespace continuo::app {

/// "1.2.0".
std::string version_of_program();

}  // namespace continuo::app
