// Runs a model without the interpreter's lock, so that Ctrl-C ends the run and keeps what there is of it.
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include "loaded_model.hpp"
#include "messages.hpp"
#include "watched_work.hpp"
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>

namespace continuo::python {
namespace {

namespace py = pybind11;

/// What Python asks for, by the names of Experiment.
model::Experiment experiment_of(const py::dict& asked) {
  model::Experiment experiment;
  for (const auto& [key, value] : asked) {
    const std::string name = py::cast<std::string>(key);
    if (name == "method")
      experiment.method = py::cast<std::string>(value);
    else if (name == "rtol")
      experiment.rtol = py::cast<double>(value);
    else if (name == "atol")
      experiment.atol = {py::cast<double>(value)};
    else if (name == "rtol_of")
      experiment.rtol_of = py::cast<model::Overrides>(value);
    else if (name == "atol_of")
      experiment.atol_of = py::cast<model::Overrides>(value);
    else if (name == "step")
      experiment.step = py::cast<double>(value);
    else if (name == "to")
      experiment.to = py::cast<double>(value);
    else if (name == "output")
      experiment.output = py::cast<double>(value);
    else if (name == "output_steps")
      experiment.output_steps = py::cast<bool>(value);
    else if (name == "max_step")
      experiment.max_step = py::cast<double>(value);
    else if (name == "max_steps")
      experiment.max_steps = py::cast<std::size_t>(value);
    else if (name == "parameters")
      experiment.parameters = py::cast<model::Overrides>(value);
    else if (name == "initial")
      experiment.initial = py::cast<model::Overrides>(value);
    else if (name == "estimate_error")
      experiment.estimate_error = py::cast<bool>(value);
    else
      throw py::key_error(name);
  }
  experiment.doubts = true;
  return experiment;
}

/// Makes a function of the place alone of one of the place and the part that is done.
class PartTeller {
 public:
  PartTeller(const LoadedModel& model, const model::Experiment& experiment, py::object tell) : tell_(std::move(tell)) {
    if (tell_.is_none() || !runs::kind_of(model.model()).has_start) return;
    std::vector<model::Diagnostic> problems;  // the run itself will tell of them
    const auto plan = runs::plan(model.model(), experiment, problems);
    if (!plan || !(plan->to > plan->from)) return;
    from_ = plan->from;
    to_ = plan->to;
  }

  /// What is to be called with a place.
  [[nodiscard]] py::object function() const {
    if (tell_.is_none()) return tell_;
    return py::cpp_function([tell = tell_, from = from_, to = to_](double place) {
      const double part = (place - from) / (to - from);
      tell(place, part < 0 ? 0 : part > 1 ? 1 : part);
    });
  }
  [[nodiscard]] double begin() const { return from_; }

 private:
  py::object tell_;
  double from_ = 0, to_ = 1;
};

/// Raises MemoryError where the rows that are asked for take more memory than the computer has: the interpreter would
/// be killed, with all that is in it.
void check_memory(const model::Model& model, const model::Experiment& experiment) {
  const model::RunSettings& run = model.run;
  const auto value = [](const std::optional<model::Setting>& setting) { return setting ? setting->value : 0; };
  const double interval = experiment.output ? *experiment.output : run.output ? value(run.output->interval) : 0;
  if (!(interval > 0) || experiment.output_steps) return;
  const double time = experiment.to.value_or(value(run.to)) - value(run.from);
  const double columns = static_cast<double>(1 + model.states.size() + model.outputs.size() + model.energies.size());
  const double bytes = time / interval * columns * sizeof(double);
  const double there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes < there / 2) return;
  const std::string text = fmt::format(
      "{:.3g} rows of {} columns take {:.0f} GB: ask for fewer by output=, or write them to a file by the command "
      "continuo run -o",
      time / interval, columns, bytes / 1e9);
  PyErr_SetString(PyExc_MemoryError, text.c_str());
  throw py::error_already_set();
}

/// The run, or None; its messages; and what a signal or `tell` has raised, or None.
py::tuple run(const LoadedModel& self, const py::dict& asked, const py::object& tell) {
  model::Experiment experiment = experiment_of(asked);
  check_memory(self.model(), experiment);
  const PartTeller parts(self, experiment, tell);
  Watched watched;
  watched.place = parts.begin();
  experiment.interrupt = &watched.interrupt;
  if (!tell.is_none()) experiment.progress = [&watched](double place) { watched.place.store(place); };
  model::Simulated simulated;
  const py::object raised =
      do_watched([&] { simulated = runs::run(self.program, experiment); }, watched, parts.function());
  py::object messages = messages_of(simulated.diagnostics, self.source);
  py::object result = py::none();
  if (simulated.run)
    result = py::cast(std::make_shared<ModelRun>(ModelRun{.program = self.program, .run = *std::move(simulated.run)}));
  return py::make_tuple(result, messages, raised ? raised : py::none());
}

}  // namespace

void add_run_of_model(py::class_<LoadedModel, std::shared_ptr<LoadedModel>>& model) {
  model.def("run", &run, py::arg("asked"), py::arg("tell"));
}

}  // namespace continuo::python
