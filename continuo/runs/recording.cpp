// Each recording to the module that has written it.
#include <algorithm>
#include <utility>

#include <continuo/runs/kind.hpp>
#include <continuo/runs/recording.hpp>
#include <continuo/worlds/simulate_world.hpp>

namespace continuo::runs {

namespace {

std::variant<model::IntegrationLog, worlds::RunLog> log_of(std::ostream& out, const model::Model& model,
                                                           const model::RunHead& head, std::size_t checkpoints) {
  if (kind_of(model).solver == Solver::world) return worlds::RunLog(out, head, checkpoints);
  return model::IntegrationLog(out, head, checkpoints);
}

}  // namespace

Log::Log(std::ostream& out, const model::Model& model, const model::RunHead& head, std::size_t checkpoints)
    : log_(log_of(out, model, head, checkpoints)) {}

Result<Recording> read_recording(std::span<const std::byte> bytes) {
  const auto held = [](auto read) -> Result<Recording> {
    if (!read) return read.status();
    return Recording(*std::move(read));
  };
  if (model::IntegrationRecording::is_one(bytes)) return held(model::IntegrationRecording::read(bytes));
  return held(worlds::RunRecording::read(bytes));
}

const model::RunHead& head_of(const Recording& recording) {
  return std::visit([](const auto& one) -> const model::RunHead& { return one.head; }, recording);
}

std::vector<double> checkpoints_of(const Recording& recording) {
  std::vector<double> times;
  if (const auto* one = std::get_if<model::IntegrationRecording>(&recording)) {
    for (const model::IntegrationCheckpoint& checkpoint : one->checkpoints) times.push_back(checkpoint.t);
  } else {
    for (const worlds::Checkpoint& checkpoint : std::get<worlds::RunRecording>(recording).checkpoints)
      times.push_back(checkpoint.world.time);
  }
  return times;
}

std::size_t checkpoint_at(const Recording& recording, double t) {
  return std::visit([t](const auto& one) { return one.checkpoint_at(t); }, recording);
}

double last_time(const Recording& recording) {
  if (const auto* one = std::get_if<model::IntegrationRecording>(&recording)) return one->last_time();
  return std::get<worlds::RunRecording>(recording).notes.back().t;
}

bool is_whole(const Recording& recording) {
  return std::visit([](const auto& one) { return one.end.has_value(); }, recording);
}

bool fits(const Recording& recording, const model::Model& model) {
  const Kind kind = kind_of(model);
  return kind.can_be_recorded &&
         (kind.solver == Solver::world) == std::holds_alternative<worlds::RunRecording>(recording);
}

model::Simulated replay(const std::shared_ptr<const model::ModelProgram>& program, const Recording& recording,
                        const model::RowsOfRecording& rows) {
  if (const auto* one = std::get_if<model::IntegrationRecording>(&recording))
    return replay_integration(program, *one, rows);
  return worlds::replay_world(program, std::get<worlds::RunRecording>(recording), rows);
}

model::Simulated resume(const std::shared_ptr<const model::ModelProgram>& program, const Recording& recording,
                        std::size_t checkpoint, const model::ResumeOptions& how, Log* log) {
  if (const auto* one = std::get_if<model::IntegrationRecording>(&recording))
    return resume_integration(program, *one, checkpoint, how, log ? log->integration() : nullptr);
  return worlds::resume_world(program, std::get<worlds::RunRecording>(recording), checkpoint,
                              {.to = how.to, .interrupt = how.interrupt, .progress = how.progress, .rows = how.rows},
                              log ? log->world() : nullptr);
}

}  // namespace continuo::runs
