// continuo/results/output_file.hpp
// Where result files go: a path, or "-" for standard output. A file gets its name when it is whole; until then it
// stands beside as NAME.unfinished.ENDING, so that whatever ends the program leaves an older file as it was, and what
// was written marked as unfinished. Pipes and devices are written directly. The first failure is kept and told at the
// end, so that a full disk or a read-only folder is one message and no exception in the middle of a run.
//
//   OutputFile out("ball.csv");
//   out.write("t,h\n");
//   if (const Status status = out.close(); !status) fmt::print(stderr, "{}\n", status.message);
#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include <continuo/results/file_place.hpp>
#include <continuo/status/status.hpp>

namespace continuo::results {

/// What becomes of a file that is not closed as whole: of a table or a recording what is there is kept, other files are
/// none.
enum class Unfinished { kept, removed };

/// A file that is written from its beginning to its end, with a buffer of its own.
class OutputFile {
 public:
  /// Begins the file; "-" is standard output.
  /// `unfinished_ending`: that of its name until it is whole, where this is another one.
  explicit OutputFile(std::string path, Unfinished unfinished = Unfinished::removed,
                      std::string_view unfinished_ending = {});
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// A file that was not closed is not whole: it is kept under its other name, or removed.
  ~OutputFile();

  /// Appends bytes, whole rows of a table. They are on the disk after a second at most, or when many have come
  /// together. After a failure this does nothing.
  void write(std::string_view bytes);
  /// Stores what was written so far.
  void flush();
  /// Changes bytes that were written before. Pipes and devices cannot.
  void overwrite(std::uint64_t at, std::string_view bytes);
  /// How many bytes are on the disk. What the program has to lose is behind them.
  [[nodiscard]] std::uint64_t stored() const { return stored_; }
  /// Writes what is left, and gives the file its name. The first failure since it was begun: "cannot write ball.csv:
  /// Permission denied".
  Status close();
  /// Writes what is left, and keeps the file under its other name.
  Status leave();
  /// Removes what was written: there is nothing in it that anybody wants.
  void discard();
  /// Ends the writing for a reason of the caller's.
  void fail(const std::string& reason);
  /// The first failure so far, or a success.
  [[nodiscard]] const Status& status() const { return status_; }
  /// The name under which the bytes stand at present; empty for pipes, devices and files without a name yet.
  [[nodiscard]] std::string present_name() const;

 private:
  void open();
  bool open_beside();
  bool open_without_name();
  void store(std::string_view bytes, std::uint64_t at);
  void end(bool is_whole);
  bool name_beside();
  bool give_name();
  void fail();

  std::string path_, present_name_, unfinished_ending_;
  Unfinished unfinished_;
  FilePlace place_;
  bool is_file_ = false;  // not a pipe or a device
  int descriptor_ = -1;   // -1 after a failure to open, and at the end
  std::string buffer_;
  std::uint64_t stored_ = 0;
  std::chrono::steady_clock::time_point last_flush_;
  Status status_;
};

/// "ball.unfinished.csv", "ball.unfinished2.csv": the names of a file that is not whole. `ending`: another one.
[[nodiscard]] std::string unfinished_name(const std::string& path, int number = 1, std::string_view ending = {});

/// That of them which no file has yet.
[[nodiscard]] std::string free_unfinished_name(const std::string& path);

/// Whether a file can be written there, to be told before a long run and not after it.
Status check_writable(const std::string& path);

/// The whole text at once.
Status write_file(const std::string& path, std::string_view text);

}  // namespace continuo::results
