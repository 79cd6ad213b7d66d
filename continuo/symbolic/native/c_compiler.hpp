// The C compiler of the system, called to make a shared object.
//
//   const CCompiler compiler = find_c_compiler();
//   const Status made = compiler.compile("f.c", "f.so", stop);
#pragma once
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include <continuo/status/result.hpp>

namespace continuo::model {

struct CCompiler {
  /// The program and its first arguments: "cc", or "ccache", "gcc".
  std::vector<std::string> command;
  /// What the machine code depends on besides the text: the program that is called, the flags, the processor.
  std::string identity;

  /// Blocks until the shared object is there, which takes 30 ms or more; gives up and kills the compiler once stop is
  /// requested. A failure is unreadable, with what the compiler said first.
  [[nodiscard]] Status compile(const std::filesystem::path& source, const std::filesystem::path& shared_object,
                               std::stop_token stop) const;
};

/// `$CC`, else the first of cc, gcc and clang in the path; the command is empty where there is none.
[[nodiscard]] CCompiler find_c_compiler();

}  // namespace continuo::model
