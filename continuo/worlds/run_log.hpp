// A run of a world as a file: the notes of the run one after the other, and from time to time a checkpoint of the
// world, from which the run can continue to the same bits.
//
//   std::ofstream file("gas.run", std::ios::binary);
//   RunLog log(file, {.file = "gas.sim", .text = text});
//   simulate_world(program, experiment, &log);
//   const Result<RunRecording> recording = RunRecording::read(bytes_of_the_file);
//   if (!recording) std::cerr << describe(recording.status());
//   replay_world(program, *recording);                             // the same run, without moving a body
//   resume_world(program, *recording, recording->checkpoints.size() - 1, {.to = 20});
//
// A file that was cut off is read up to its last complete block.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <continuo/bodies/support/blocks.hpp>
#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/recorded_run.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/status/result.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

using model::RunEnd;
using model::RunHead;

/// A message of a run to its recorder.
struct Note {
  /// What the recorder is told.
  enum class Kind : std::uint8_t { begin, arrival, contact, event, finish };
  Kind kind{};
  double t = 0;
  std::vector<double> x{}, before{};        // before: of an event
  bool is_row = false, is_sampled = false;  // of an arrival,
  double until = 0;                         // samples up to here
  std::string name{};                       // of a contact
  double impulse = 0;                       //
  std::vector<model::EventName> names{};    // of an event
};
/// Tells a recorder what a note contains, as the run itself does.
void tell(model::RunRecorder& recorder, const Note& note);

/// A checkpoint between two notes: the world, and the progress of its run.
struct Checkpoint {
  Snapshot world;
  std::uint64_t next_output = 0, next_sample = 0, contacts = 0;
  std::vector<std::uint64_t> stops{};
  std::size_t notes = 0;  // the number of notes before it
};

/// Writes a run to a stream while it advances.
class RunLog {
 public:
  /// The stream must be binary and outlive this object. The caller checks the stream for failed writes.
  RunLog(std::ostream& out, const RunHead& head, std::size_t checkpoints = 20);

  /// Writes a note, a checkpoint, or the end of the run as one block.
  /// @{
  void add(const Note& note);
  void add(const Checkpoint& checkpoint);
  void add(const RunEnd& end);
  /// @}
  /// The number of checkpoints, evenly over the run; there are more where the run takes long, and none for 0.
  [[nodiscard]] std::size_t checkpoints() const { return checkpoints_; }

 private:
  BlockWriter out_;
  std::size_t checkpoints_;
};

/// A run that was read from a file.
struct RunRecording {
  RunHead head{};
  std::vector<Note> notes{};
  std::vector<Checkpoint> checkpoints{};
  std::optional<RunEnd> end{};  // none where the file was cut off

  /// Fails as unreadable where the run has not one note.
  static Result<RunRecording> read(std::span<const std::byte> bytes);
  /// The last checkpoint not after t; the first one where all are after t.
  [[nodiscard]] std::size_t checkpoint_at(double t) const;
};

}  // namespace continuo::worlds
