// A run of equations as a file: its rows and events as they come, and from time to time a checkpoint of the
// integration, from which the run goes on to the same bits.
//
//   std::ofstream file("orbit.run", std::ios::binary);
//   IntegrationLog log(file, {.file = "orbit.sim", .text = text});
//   simulate(program, experiment, {.log = &log});
//   const Result<IntegrationRecording> recording = IntegrationRecording::read(bytes_of_the_file);
//   if (!recording) std::cerr << describe(recording.status());
//   replay_integration(program, *recording);                            // the same run, without a step
//   resume_integration(program, *recording, recording->checkpoints.size() - 1, {.to = 20});
//
// A file that was cut off is read up to its last complete block. The bits are those of the run without a break as long
// as program and machine are the same; a run to another end may have had other steps from its beginning where the
// equations depend on the time, since its longest step is a part of its length.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <vector>

#include <continuo/bodies/support/blocks.hpp>
#include <continuo/simulation/drive/run_recorder.hpp>
#include <continuo/simulation/recorded_run.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/status/result.hpp>

namespace continuo::model {

/// A checkpoint between two steps, with what has been recorded since the one before.
struct IntegrationCheckpoint {
  double t = 0;
  RecordedPart part{};
  Bytes state{};               // of the integration: Stepping::save
  std::size_t marks_seen = 0;  // EventNames
};
/// The last part of a run, and how it ended.
struct IntegrationEnd {
  RecordedPart part{};
  RunEnd end{};
};

/// Writes a run to a stream while it advances.
class IntegrationLog {
 public:
  /// The stream must be binary and outlive this object. The caller checks the stream for failed writes.
  IntegrationLog(std::ostream& out, const RunHead& head, std::size_t checkpoints = 20);

  /// Writes a checkpoint, or the end of the run as one block, and flushes the stream: a run that is killed keeps
  /// everything up to its last checkpoint.
  /// @{
  void add(const IntegrationCheckpoint& checkpoint);
  void add(const IntegrationEnd& end);
  /// @}
  /// The number of checkpoints, evenly over the run; there are more where the run takes long, and none for 0.
  [[nodiscard]] std::size_t checkpoints() const { return checkpoints_; }

 private:
  BlockWriter out_;
  std::size_t checkpoints_;
};

/// A run that was read from a file.
struct IntegrationRecording {
  RunHead head{};
  std::vector<IntegrationCheckpoint> checkpoints{};
  std::optional<IntegrationEnd> end{};  // none where the file was cut off

  /// Whether the bytes begin as a recording of equations does.
  [[nodiscard]] static bool is_one(std::span<const std::byte> bytes);
  /// Fails as unreadable where nothing of the run is there.
  [[nodiscard]] static Result<IntegrationRecording> read(std::span<const std::byte> bytes);
  /// The last checkpoint not after t; the first one where all are after t.
  [[nodiscard]] std::size_t checkpoint_at(double t) const;
  /// How far the run has come.
  [[nodiscard]] double last_time() const { return end ? end->end.outcome.t : checkpoints.back().t; }
};

/// Replays a recorded run. The program must be that of its text; a recording that does not fit the program is reported
/// (E325).
[[nodiscard]] Simulated replay_integration(const std::shared_ptr<const ModelProgram>& program,
                                           const IntegrationRecording& recording, const RowsOfRecording& rows = {});

/// Those options of a resumed run that may differ from the recorded ones.
struct ResumeOptions {
  std::optional<double> to{};
  std::optional<std::size_t> max_steps{};
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double t)> progress{};
  RowsOfRecording rows{};
};
/// Replays a recorded run up to one of its checkpoints, and integrates from there to its planned end, or to another.
/// The results have the same bits as those without a break.
[[nodiscard]] Simulated resume_integration(const std::shared_ptr<const ModelProgram>& program,
                                           const IntegrationRecording& recording, std::size_t checkpoint,
                                           const ResumeOptions& how = {}, IntegrationLog* log = nullptr);

}  // namespace continuo::model
