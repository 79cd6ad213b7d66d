// The recording of a run on disk, written as the run goes and read again.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include <continuo/results/output_file.hpp>
#include <continuo/runs/recording.hpp>

namespace continuo::app {

/// An output file as a stream.
class OutputStream final : public std::ostream {
 public:
  explicit OutputStream(const std::string& path);
  results::OutputFile& file() { return buffer_.file; }

 private:
  /// Hands everything on: the file has a buffer.
  struct Buffer final : std::streambuf {
    explicit Buffer(const std::string& path) : file(path, results::Unfinished::kept) {}
    std::streamsize xsputn(const char* bytes, std::streamsize count) override;
    int_type overflow(int_type byte) override;
    int sync() override;
    results::OutputFile file;
  };
  Buffer buffer_;
};

struct RecordTo {
  std::string path{};  // empty: nowhere
  std::size_t checkpoints = 20;
};
/// --record and --snapshots.
void add_record(CLI::App& verb, RecordTo& record);
bool can_be_written(const RecordTo& record);

/// A file that is there as a whole or under the name of an unfinished one, as a table is.
class RunFile {
 public:
  explicit RunFile(const RecordTo& to) : to_(to) {}
  bool is_wanted() const { return !to_.path.empty(); }
  /// Begins the file, for a run of this program. Null where it is not wanted.
  runs::Log* begin(const model::ModelProgram& program, model::RunHead head);
  /// Ends it: with its name where the run came to an end, as an unfinished file where it was interrupted, and without a
  /// file where there was no run. False, and said, where not all of it could be written.
  bool finish(const model::Simulated& simulated);

 private:
  RecordTo to_;
  std::optional<OutputStream> out_;
  std::unique_ptr<runs::Log> log_;
};

/// What the model in a recording reads, which a replay reads again.
std::vector<std::string> files_of_recording(const std::string& path);

/// Whether the recorded run would go on to other bits than it was recorded with, as by another version of the program
/// or with other tables: said, and refused.
bool has_changed(const model::RunHead& head, const model::ModelProgram& program, const std::string& path);

/// Says why there is none.
std::optional<runs::Recording> read_run(const std::string& path);

}  // namespace continuo::app
