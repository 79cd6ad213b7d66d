// The recording of a run on disk, written as the run goes and read again.
#pragma once
#include <cstddef>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include <continuo/runs/recording.hpp>

namespace continuo::app {

struct RecordTo {
  std::string path{};  // empty: nowhere
  std::size_t checkpoints = 20;
};
/// --record and --snapshots.
void add_record(CLI::App& verb, RecordTo& record);
bool can_be_written(const RecordTo& record);

class RunFile {
 public:
  explicit RunFile(const RecordTo& to) : to_(to) {}
  bool is_wanted() const { return !to_.path.empty(); }
  /// Opens the file, for a run of this program. Null where it is not wanted, or cannot be opened.
  runs::Log* begin(const model::ModelProgram& program, model::RunHead head);
  /// False, and said, where not all of it could be written.
  bool close();

 private:
  RecordTo to_;
  std::ofstream file_;
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
