// continuo/results/output_file.hpp
// Where result files go: a path, or "-" for standard output. Buffered; the first failure is kept and told at the end,
// so that a full disk or a read-only folder is one message and no exception in the middle of a run.
//
//   OutputFile out("ball.csv");
//   out.write("t,h\n");
//   if (auto failure = out.close()) fmt::print(stderr, "{}\n", *failure);
#pragma once
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace continuo::results {

class OutputFile {
 public:
  explicit OutputFile(std::string path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  void write(std::string_view bytes);
  /// What went wrong since the file was opened, if anything: "cannot write ball.csv: Permission denied".
  std::optional<std::string> close();
  const std::optional<std::string>& failure() const { return failure_; }

 private:
  void flush();
  void fail();

  std::string path_;
  std::string buffer_;
  std::FILE* file_;  // null after a failure to open
  std::optional<std::string> failure_;
};

/// The whole text at once.
std::optional<std::string> write_file(const std::string& path, std::string_view text);

}  // namespace continuo::results
