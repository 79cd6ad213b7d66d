// A run of a world as a file: what the run noted, one thing after the other, and every so often the world itself with
// all it takes to go on from there to the same bits.
//
//   std::ofstream file("gas.run", std::ios::binary);
//   RunLog log(file, {.file = "gas.sim", .text = text});
//   simulate_world(program, experiment, &log);
//   const Result<RunRecording> recording = RunRecording::read(bytes_of_the_file);
//   if (!recording) std::cerr << describe(recording.status());
//   replay_world(program, *recording);                             // the same run, without moving a body
//   resume_world(program, *recording, recording->checkpoints.size() - 1, {.to = 20});
//
// A file that was cut off is read as far as its blocks are whole.
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
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/status/result.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

/// What was run: the model's text, and what was asked of it.
struct RunHead {
  std::string file{}, text{};  // the folder of the file is where tables are
  bool decides_size = false;   // the parameters are wanted when the text is read
  bool as_written = true;      // checks are meant for this run
  model::Experiment experiment{};
};

/// What a run tells its recorder.
struct Note {
  enum class Kind : std::uint8_t { begin, arrival, contact, happening, finish };
  Kind kind{};
  double t = 0;
  std::vector<double> x{}, before{};        // before: of a happening
  bool is_row = false, is_sampled = false;  // of an arrival,
  double until = 0;                         // samples up to here
  std::string name{};                       // of a contact
  double impulse = 0;                       //
  std::vector<model::EventName> names{};    // of a happening
};
void tell(model::RunRecorder& recorder, const Note& note);

/// Between two notes: the world, and how far its run is.
struct Checkpoint {
  Snapshot world;
  std::uint64_t next_output = 0, next_sample = 0, contacts = 0;
  std::vector<std::uint64_t> stops{};
  std::size_t notes = 0;  // so many came before
};

/// How it ended.
struct RunEnd {
  Outcome<double> outcome{};
  std::string stop_text{}, error{};
  double seconds = 0;
};

class RunLog {
 public:
  /// The stream must be binary and stay; whether writing went well is for the caller to ask of it.
  RunLog(std::ostream& out, const RunHead& head, std::size_t checkpoints = 20);

  void add(const Note& note);
  void add(const Checkpoint& checkpoint);
  void add(const RunEnd& end);
  /// So many checkpoints are wanted, evenly over the run, and more where that takes long; none for 0.
  [[nodiscard]] std::size_t checkpoints() const { return checkpoints_; }

 private:
  BlockWriter out_;
  std::size_t checkpoints_;
};

struct RunRecording {
  RunHead head{};
  std::vector<Note> notes{};
  std::vector<Checkpoint> checkpoints{};
  std::optional<RunEnd> end{};  // none where the file was cut off

  /// Unreadable where not one note of the run is there.
  static Result<RunRecording> read(std::span<const std::byte> bytes);
  /// The last checkpoint not after t; the first where all are.
  [[nodiscard]] std::size_t checkpoint_at(double t) const;
};

}  // namespace continuo::worlds
