// Any bytes as a recording: of bodies, played to its end, or of a run, replayed and resumed. The checksums are
// corrected first, or hardly any input would pass them. A run is always one of the models below, whatever its text:
// texts are tested by another target.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <span>
#include <sstream>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <tests/fuzz/recorded_models.hpp>
#include <tests/fuzz/right_sums.hpp>

#include <continuo/bodies/recording.hpp>
#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/parser.hpp>
#include <continuo/runs/recording.hpp>

namespace {

using namespace continuo;

void check_refusal(const Status& status) {
  if (status.ending != Ending::unreadable || !status.message.starts_with("byte ")) std::abort();
}

template <class Real, int Dim>
void play(std::span<const std::byte> bytes) {
  const auto recording = Recording<Real, Dim>::read(bytes);
  if (!recording) return check_refusal(recording.status());
  for (const auto& frame : recording->frames)
    if (recording->at(frame.time).position.size() != recording->scenes.at(frame.scene).size() &&
        frame.time == frame.time)
      std::abort();
}

std::shared_ptr<const model::ModelProgram> program_of(const char* text) {
  const model::Source source("scene.sim", text);
  model::Checked checked = check(model::parse(source).model, source);
  if (!checked.model) std::abort();
  return model::compile(std::move(*checked.model));
}

/// As somebody who waits for a second and interrupts: springs may be as stiff and bodies as fast as numbers can be.
class Timer {
 public:
  explicit Timer(std::atomic<bool>& enough)
      : thread_([&enough](const std::stop_token& stop) {
          std::mutex mutex;
          std::unique_lock lock(mutex);
          if (!std::condition_variable_any().wait_for(lock, stop, std::chrono::seconds(1),
                                                      [&] { return stop.stop_requested(); }))
            enough = true;
        }) {}

 private:
  std::jthread thread_;
};

/// Whether an experiment is short enough to be run, by the settings that determine its duration; the others may be
/// arbitrary.
bool is_short(const model::Experiment& e, double from) {
  return e.step.value_or(0.01) >= 1e-3 && e.rtol.value_or(1e-6) >= 1e-12 && e.output.value_or(1) >= 1e-3 &&
         e.to.value_or(1) - from < 2 && e.from.value_or(0) > -10;
}

/// The states of a run; none where nothing of them is there.
std::size_t states_of(const worlds::RunRecording& recording) {
  return recording.notes.front().x.size();
}
std::size_t states_of(const model::IntegrationRecording& recording) {
  return recording.checkpoints.empty() ? 0 : recording.checkpoints.front().part.x.size();
}

/// The model that it may be a run of: one of its kind, with as many states where there is such a one.
const std::shared_ptr<const model::ModelProgram>& program_for(const runs::Recording& recording) {
  static const std::array programs{program_of(recorded_models[0].text),    program_of(recorded_models[1].text),
                                   program_of(recorded_models[2].text),    program_of(recorded_equations[0].text),
                                   program_of(recorded_equations[1].text), program_of(recorded_equations[2].text)};
  const std::size_t states = std::visit([](const auto& one) { return states_of(one); }, recording);
  const auto is_of_its_kind = [&](const auto& program) { return runs::fits(recording, program->model); };
  const auto found = std::ranges::find_if(
      programs, [&](const auto& program) { return is_of_its_kind(program) && program->model.states.size() == states; });
  return found != programs.end() ? *found : *std::ranges::find_if(programs, is_of_its_kind);
}

void go_on(std::span<const std::byte> bytes) {
  const Result<runs::Recording> recording = runs::read_recording(bytes);
  if (!recording) return check_refusal(recording.status());
  const model::RunHead& head = runs::head_of(*recording);
  if (!is_short(head.experiment, 0)) return;
  const auto& program = program_for(*recording);
  const model::Simulated told = runs::replay(program, *recording);
  if (!told.run && told.diagnostics.empty()) std::abort();
  const std::vector<double> times = runs::checkpoints_of(*recording);
  if (times.empty()) return;
  std::atomic<bool> enough = false;
  const Timer timer(enough);
  std::ostringstream file;
  runs::Log log(file, program->model, head, 3);
  const model::Simulated on =
      runs::resume(program, *recording, times.size() - 1, {.to = times.back() + 0.05, .interrupt = &enough}, &log);
  if (!on.run && on.diagnostics.empty()) std::abort();
  if (!on.run) return;
  // The recording of the resumed run must be readable, whatever the input was.
  const std::string text = file.str();
  if (!runs::read_recording(std::as_bytes(std::span(text)))) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(data[i]);
  put_sums_right(bytes, 14, [](std::uint8_t kind, std::span<std::byte> block) {
    if (kind == 0) put_sum_right(block);  // a scene
  });
  play<double, 3>(bytes);
  play<float, 2>(bytes);
  put_sums_right(bytes, 12, [](std::uint8_t kind, std::span<std::byte> block) {
    if (kind != 2 || block.size() < 8) return;  // a checkpoint begins with its bodies
    std::uint64_t count = 0;
    ByteReader reader(block);
    reader(count);
    if (count <= block.size() - 8) put_sum_right(block.subspan(8, static_cast<std::size_t>(count)));
  });
  go_on(bytes);
  return 0;
}
