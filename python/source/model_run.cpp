// The run of a model as Python reads it: its table without a copy, all else as plain values.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "gil.hpp"
#include "loaded_model.hpp"
#include "messages.hpp"
#include <continuo/results/json.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::python {
namespace {

namespace py = pybind11;
using Array = py::array_t<double>;

py::ssize_t size_of(std::size_t size) {
  return static_cast<py::ssize_t>(size);
}

/// Numbers that are nobody else's, without a copy.
Array array_of(std::vector<double> numbers) {
  auto kept = std::make_unique<std::vector<double>>(std::move(numbers));
  const double* data = kept->data();
  const py::ssize_t size = size_of(kept->size());
  const py::capsule owner(kept.get(), [](void* vector) { delete static_cast<std::vector<double>*>(vector); });
  kept.release();
  return Array(size, data, owner);
}

/// The rows of the run, which live as long as it does and cannot be written into.
Array table(const py::object& self) {
  const model::Motion& motion = py::cast<const ModelRun&>(self).run.motion;
  Array view({size_of(motion.rows()), size_of(motion.columns.size())}, motion.values.data(), self);
  py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

py::list columns(const ModelRun& self) {
  py::list all;
  for (const model::Column& column : self.run.motion.columns)
    all.append(py::make_tuple(text_of(column.name), text_of(column.unit)));
  return all;
}

/// Names, marks, times and impulses (NaN for none) of the events; which of them have states before and after; these.
py::tuple events_of(const ModelRun& self) {
  py::list names, marks;
  std::vector<double> times, impulses, before, after;
  std::vector<std::size_t> with_states;
  for (std::size_t i = 0; i < self.run.events.size(); ++i) {
    const model::RecordedEvent& event = self.run.events[i];
    names.append(text_of(event.name));
    marks.append(text_of(event.mark));
    times.push_back(event.t);
    impulses.push_back(event.impulse.value_or(NAN));
    if (event.before.empty()) continue;
    with_states.push_back(i);
    before.insert(before.end(), event.before.begin(), event.before.end());
    after.insert(after.end(), event.after.begin(), event.after.end());
  }
  return py::make_tuple(names, marks, array_of(std::move(times)), array_of(std::move(impulses)), with_states,
                        array_of(std::move(before)), array_of(std::move(after)));
}

py::dict outcome(const ModelRun& self) {
  const Outcome<double>& outcome = self.run.outcome;
  py::dict all;
  all["ending"] = text_of(to_string(outcome.ending));
  all["success"] = succeeded(outcome.ending);
  all["message"] = text_of(describe(outcome));
  all["t"] = outcome.t;
  all["h"] = outcome.h;
  all["error"] = outcome.error;
  all["component"] = text_of(outcome.component);
  all["event"] = text_of(self.run.stop_text.empty() ? outcome.event : self.run.stop_text);
  all["limit_time"] = outcome.limit_time;
  all["hint"] = text_of(outcome.hint);
  return all;
}

py::dict statistics(const ModelRun& self) {
  const Statistics& statistics = self.run.statistics;
  py::dict all;
  all["steps"] = statistics.steps;
  all["rejected"] = statistics.rejected;
  all["evaluations"] = statistics.evaluations;
  all["jacobians"] = statistics.jacobians;
  all["factorizations"] = statistics.factorizations;
  all["linear_solves"] = statistics.linear_solves;
  all["events"] = statistics.events;
  all["seconds"] = statistics.seconds;
  return all;
}

py::list checks(const ModelRun& self) {
  py::list all;
  for (const model::CheckResult& check : self.run.checks) {
    py::dict one;
    one["text"] = text_of(check.text);
    one["passed"] = check.passed;
    one["evaluated"] = check.evaluated;
    one["value"] = check.value;
    one["expected"] = check.expected;
    one["tolerance"] = check.tolerance;
    one["unit"] = text_of(check.unit);
    one["message"] = text_of(check.passed ? std::string() : results::failed_check(check));
    all.append(one);
  }
  return all;
}

py::object energy(const ModelRun& self) {
  if (!self.run.energy) return py::none();
  py::dict all;
  all["first"] = self.run.energy->first;
  all["last"] = self.run.energy->last;
  all["drift"] = self.run.energy->drift;
  all["unit"] = text_of(self.run.energy->unit);
  all["relative"] = self.run.energy->relative;
  return all;
}

py::dict plan(const ModelRun& self) {
  const model::Plan& plan = self.run.plan;
  py::dict all;
  all["method"] = text_of(plan.method);
  all["reason"] = text_of(plan.reason);
  all["rtol"] = plan.rtol;
  all["atol"] = plan.atol;
  all["step"] = plan.step;
  all["from"] = plan.from;
  all["to"] = plan.to;
  return all;
}

/// Expressions of the model that are no columns of the table, each at every row.
py::dict values_of_lets(const ModelRun& self) {
  const std::vector<model::Quantity>& lets = self.program->model.lets;
  std::vector<model::NodeId> nodes;
  for (const model::Quantity& let : lets) nodes.push_back(let.node);
  std::vector<std::vector<double>> values;
  {
    const WithoutGil unlocked;
    values = model::values_along(*self.program, self.run, nodes);
  }
  py::dict all;
  for (std::size_t i = 0; i < lets.size(); ++i) all[text_of(lets[i].name)] = array_of(std::move(values[i]));
  return all;
}

py::tuple series_of(const model::Column& column, std::vector<double> values) {
  return py::make_tuple(text_of(column.name), text_of(column.unit), array_of(std::move(values)));
}

/// The model's plots: (against, [curve, ...]), each of them (label, unit, values).
py::list plots(const ModelRun& self) {
  std::vector<results::PlotData> plots;
  {
    const WithoutGil unlocked;
    plots = results::plots_of(*self.program, self.run);
  }
  py::list all;
  for (results::PlotData& plot : plots) {
    py::list curves;
    for (std::size_t i = 0; i < plot.curves.size(); ++i) curves.append(series_of(plot.curves[i], std::move(plot.y[i])));
    all.append(py::make_tuple(series_of(plot.against, std::move(plot.x)), curves));
  }
  return all;
}

py::dict attributes_of(const std::vector<results::NetcdfAttribute>& attributes) {
  py::dict all;
  for (const results::NetcdfAttribute& attribute : attributes)
    if (!attribute.text.empty()) all[text_of(attribute.name)] = text_of(attribute.text);
  return all;
}

/// The values of a variable: (columns of the rows, None), or (None, the values).
py::tuple values_of(const results::NetcdfVariable& variable) {
  if (const auto* columns = std::get_if<results::NetcdfVariable::Columns>(&variable.values))
    return py::make_tuple(*columns, py::none());
  if (const auto* numbers = std::get_if<results::NetcdfVariable::Numbers>(&variable.values))
    return py::make_tuple(py::none(), *numbers);
  if (const auto* integers = std::get_if<results::NetcdfVariable::Integers>(&variable.values))
    return py::make_tuple(py::none(), *integers);
  py::list texts;
  for (const std::string& text : std::get<results::NetcdfVariable::Texts>(variable.values)) texts.append(text_of(text));
  return py::make_tuple(py::none(), texts);
}

/// The variables of a netCDF file of the run: attributes, sizes of dimensions (0: of the rows), and for each variable
/// its name, dimensions, attributes and values.
py::tuple layout(const ModelRun& self) {
  const model::Model& model = self.program->model;
  const model::Run& run = self.run;
  const results::NetcdfLayout layout =
      results::netcdf_layout(model, run.plan, run.motion.columns,
                             results::manifest_hash(model, run.plan, run.first_state(), CONTINUO_VERSION));
  py::dict sizes;
  for (const results::NetcdfDimension& dimension : layout.dimensions) sizes[text_of(dimension.name)] = dimension.size;
  py::list variables;
  for (const results::NetcdfVariable& variable : layout.variables) {
    py::list dimensions;
    for (const std::size_t place : variable.dimensions) dimensions.append(text_of(layout.dimensions[place].name));
    variables.append(
        py::make_tuple(text_of(variable.name), dimensions, attributes_of(variable.attributes), values_of(variable)));
  }
  return py::make_tuple(attributes_of(layout.attributes), sizes, variables);
}

py::object error_estimate(const ModelRun& self) {
  if (!self.run.error) return py::none();
  py::dict all;
  all["at_end"] = array_of(self.run.error->at_end);
  all["largest"] = array_of(self.run.error->largest);
  all["message"] = text_of(self.run.error->message);
  return all;
}

}  // namespace

void add_model_run(py::module_& module) {
  py::class_<ModelRun, std::shared_ptr<ModelRun>>(module, "ModelRun")
      .def("table", &table)
      .def("columns", &columns)
      .def("states", [](const ModelRun& self) { return self.run.motion.states; })
      .def("total_energy", [](const ModelRun& self) { return array_of(self.run.total_energy); })
      .def("energy_unit", [](const ModelRun& self) { return text_of(self.program->model.total_energy_unit); })
      .def("events", &events_of)
      .def("outcome", &outcome)
      .def("statistics", &statistics)
      .def("checks", &checks)
      .def("energy", &energy)
      .def("plan", &plan)
      .def("lets", &values_of_lets)
      .def("plots", &plots)
      .def("layout", &layout)
      .def("error_estimate", &error_estimate)
      .def("manifest",
           [](const ModelRun& self) {
             return text_of(results::manifest(self.program->model, self.run, CONTINUO_VERSION));
           })
      .def(
          "summary",
          [](const ModelRun& self, bool as_written) {
            return text_of(results::summary(self.program->model, self.run, as_written));
          },
          py::arg("as_written"));
}

}  // namespace continuo::python
