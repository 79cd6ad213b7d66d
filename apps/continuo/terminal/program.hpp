// apps/continuo/terminal/program.hpp
#pragma once
#include <string>
#include <vector>

namespace continuo::app {

/// Runs a program of the path, its output thrown away; its exit code, or -1 where it could not be started.
int run_program(const std::vector<std::string>& words);

}  // namespace continuo::app
