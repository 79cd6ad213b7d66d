// continuo/results/output_file.hpp
// Where result files go: a path, or "-" for standard output. Buffered; the first failure is kept and told at the end,
// so that a full disk or a read-only folder is one message and no exception in the middle of a run.
//
//   OutputFile out("ball.csv");
//   out.write("t,h\n");
//   if (const Status status = out.close(); !status) fmt::print(stderr, "{}\n", status.message);
#pragma once
#include <cstdio>
#include <string>
#include <string_view>

#include <continuo/status/status.hpp>

namespace continuo::results {

/// A file that is written from its beginning to its end, with a buffer of its own.
class OutputFile {
 public:
  /// Opens the file, and empties it where it exists; "-" is standard output.
  explicit OutputFile(std::string path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// Writes what is left, without a message. `close` says whether that succeeds.
  ~OutputFile();

  /// Appends bytes. After a failure this does nothing.
  void write(std::string_view bytes);
  /// Writes what is left. The first failure since the file was opened: "cannot write ball.csv: Permission denied".
  Status close();
  /// The first failure so far, or a success.
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  void flush();
  void fail();

  std::string path_;
  std::string buffer_;
  std::FILE* file_;  // null after a failure to open
  Status status_;
};

/// The whole text at once.
Status write_file(const std::string& path, std::string_view text);

}  // namespace continuo::results
