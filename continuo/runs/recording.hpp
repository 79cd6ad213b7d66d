// Recordings of runs, whatever the model needs to be run: of equations (simulation/integration_recording.hpp) and of
// worlds (worlds/run_log.hpp).
//
//   std::ofstream file("orbit.run", std::ios::binary);
//   runs::Log log(file, model, {.file = "orbit.sim", .text = text}, 20);
//   runs::run(program, experiment, {.log = &log});
//   const Result<runs::Recording> recording = runs::read_recording(bytes_of_the_file);
//   if (recording) runs::resume(program, *recording, runs::checkpoints_of(*recording).size() - 1, {.to = 20});
#pragma once
#include <cstddef>
#include <memory>
#include <ostream>
#include <span>
#include <variant>
#include <vector>

#include <continuo/simulation/integration_recording.hpp>
#include <continuo/status/result.hpp>
#include <continuo/worlds/run_log.hpp>

namespace continuo::runs {

/// Writes a run to a stream while it advances.
class Log {
 public:
  /// The stream must be binary and outlive this object. The model's kind must be one that can be recorded.
  Log(std::ostream& out, const model::Model& model, const model::RunHead& head, std::size_t checkpoints);

  /// The one of the two that there is.
  /// @{
  [[nodiscard]] model::IntegrationLog* integration() { return std::get_if<model::IntegrationLog>(&log_); }
  [[nodiscard]] worlds::RunLog* world() { return std::get_if<worlds::RunLog>(&log_); }
  /// @}

 private:
  std::variant<model::IntegrationLog, worlds::RunLog> log_;
};

/// A run that was read from a file.
using Recording = std::variant<model::IntegrationRecording, worlds::RunRecording>;

/// Fails as unreadable where it is none, or none of this version, and where it was changed.
[[nodiscard]] Result<Recording> read_recording(std::span<const std::byte> bytes);
/// Its head.
[[nodiscard]] const model::RunHead& head_of(const Recording& recording);
/// The times at which it can be resumed, ascending.
[[nodiscard]] std::vector<double> checkpoints_of(const Recording& recording);
/// The last of these not after t; the first one where all are after t. There must be one.
[[nodiscard]] std::size_t checkpoint_at(const Recording& recording, double t);
/// How far the run has come.
[[nodiscard]] double last_time(const Recording& recording);
/// Whether its end is there: else it was cut off.
[[nodiscard]] bool is_whole(const Recording& recording);
/// Whether it is a recording of what the model is: of equations, or of a world.
[[nodiscard]] bool fits(const Recording& recording, const model::Model& model);

/// Replays a recorded run. The program must be that of its text.
[[nodiscard]] model::Simulated replay(const std::shared_ptr<const model::ModelProgram>& program,
                                      const Recording& recording, const model::RowsOfRecording& rows = {});
/// Goes on from a checkpoint to the planned end, or to another, to the same bits as without a break.
[[nodiscard]] model::Simulated resume(const std::shared_ptr<const model::ModelProgram>& program,
                                      const Recording& recording, std::size_t checkpoint,
                                      const model::ResumeOptions& how = {}, Log* log = nullptr);

}  // namespace continuo::runs
