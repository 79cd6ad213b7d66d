// Models in the language: loading, and what is in them.
#include <cmath>
#include <memory>
#include <utility>

#include <pybind11/stl.h>
#include <unistd.h>

#include "gil.hpp"
#include "loaded_model.hpp"
#include "messages.hpp"
#include "parts.hpp"
#include <continuo/language/load.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::python {
namespace {

namespace py = pybind11;
using Class = py::class_<LoadedModel, std::shared_ptr<LoadedModel>>;

/// A forked process has the memory of the thread that compiles, and not the thread: it would wait for it for ever. So
/// it leaves alone what it has from its parent, and loads its models anew (model.py).
std::shared_ptr<const model::ModelProgram> left_alone_in_forks(std::shared_ptr<const model::ModelProgram> program) {
  const model::ModelProgram* const place = program.get();
  auto owner = std::make_unique<std::shared_ptr<const model::ModelProgram>>(std::move(program));
  return {place, [kept = owner.release(), process = getpid()](const model::ModelProgram*) {
            if (getpid() == process) delete kept;
          }};
}

/// The model, or None; then its messages.
py::tuple ready(model::Loaded loaded, model::NativeUse native) {
  py::object messages = messages_of(loaded.diagnostics, loaded.source);
  if (!loaded.model) return py::make_tuple(py::none(), messages);
  std::shared_ptr<const model::ModelProgram> program;
  {
    const WithoutGil unlocked;
    if (native != model::NativeUse::never)
      loaded.model->native = std::make_shared<model::NativeCompiler>(model::NativeOptions{.use = native});
    program = left_alone_in_forks(model::compile(*std::move(loaded.model)));
  }
  if (const std::string missing = program->model.native ? program->model.native->missing() : std::string();
      !missing.empty())
    throw py::value_error("native: " + missing);
  return py::make_tuple(std::make_shared<LoadedModel>(LoadedModel{
                            .source = std::move(loaded.source), .program = std::move(program), .native = native}),
                        messages);
}

model::NativeUse use_named(const std::string& name) {
  const auto use = model::native_use_named(name);
  if (!use) throw py::value_error("native is \"auto\", \"always\", \"fused\" or \"never\", not \"" + name + "\"");
  if (const std::string why = model::why_not(*use); !why.empty()) throw py::value_error("native: " + why);
  return *use;
}

py::tuple load_text(const std::string& name, const std::string& text, const std::string& native,
                    const model::Overrides& values) {
  const model::NativeUse use = use_named(native);
  model::Loaded loaded = [&] {
    const WithoutGil unlocked;
    return model::load(model::Source(name, text), {.overrides = values});
  }();
  return ready(std::move(loaded), use);
}

py::tuple with_values(const LoadedModel& self, const model::Overrides& values) {
  model::Loaded loaded = [&] {
    const WithoutGil unlocked;
    return model::load(self.source, {.overrides = values});
  }();
  return ready(std::move(loaded), self.native);
}

py::object range_of(const std::optional<model::Range>& range) {
  if (!range) return py::none();
  return py::make_tuple(range->low, range->high);
}

/// (name, unit, comment, range, whether it decides a size) of each.
py::list parameters(const LoadedModel& self) {
  py::list all;
  for (const model::Parameter& parameter : self.model().parameters)
    all.append(py::make_tuple(text_of(parameter.name), text_of(parameter.unit), text_of(parameter.comment),
                              range_of(parameter.range), parameter.structural));
  return all;
}

/// (name, unit, comment, range, whether a file gives its values) of each.
py::list inputs(const LoadedModel& self) {
  py::list all;
  for (const model::Input& input : self.model().inputs)
    all.append(py::make_tuple(text_of(input.name), text_of(input.unit), text_of(input.comment), range_of(input.range),
                              input.points.has_value()));
  return all;
}

/// (column, unit, whether it is algebraic, whether it is of a world) of each.
py::list states(const LoadedModel& self) {
  py::list all;
  for (const model::State& state : self.model().states)
    all.append(py::make_tuple(text_of(state.column), text_of(state.unit), state.algebraic, state.in_world));
  return all;
}

/// (name, unit) of each.
py::list quantities(const std::vector<model::Quantity>& quantities) {
  py::list all;
  for (const model::Quantity& quantity : quantities)
    all.append(py::make_tuple(text_of(quantity.name), text_of(quantity.unit)));
  return all;
}

/// The values of parameters, inputs and states at the start, in their orders.
py::tuple values(const LoadedModel& self, const model::Overrides& given) {
  const model::Model& model = self.model();
  const std::vector<double> variables = model::start_values(model, given);
  const auto of = [&](const auto& all) {
    py::list list;
    for (const auto& one : all) list.append(variables[one.variable]);
    return list;
  };
  return py::make_tuple(of(model.parameters), of(model.inputs), of(model.states));
}

/// The files that the text reads, as it names them.
std::vector<std::string> files(const LoadedModel& self) {
  std::vector<std::string> all;
  for (const model::TableFile& table : self.model().tables) all.push_back(table.file);
  for (const model::Input& input : self.model().inputs)
    if (!input.file.empty()) all.push_back(input.file);
  return all;
}

/// The texts of the events, those at given times included.
py::list events(const LoadedModel& self) {
  py::list all;
  for (const model::EventOrder& event : self.model().event_order)
    all.append(
        text_of(event.scheduled ? self.model().schedule[event.index].name : self.model().events[event.index].name));
  return all;
}

/// A parameter's value by its text, and the messages: None without a value.
py::tuple read_parameter(const LoadedModel& self, const std::string& text) {
  std::vector<model::Diagnostic> problems;
  const auto setting = model::parse_setting(self.model(), text, problems);
  return py::make_tuple(setting ? py::cast(setting->value) : py::none(),
                        messages_of(problems, model::Source("set", text)));
}

/// The initial value of a state by its text, as above.
py::tuple read_initial(const LoadedModel& self, const std::string& text) {
  std::vector<model::Diagnostic> problems;
  const auto setting = model::parse_initial(self.model(), text, problems);
  return py::make_tuple(setting ? py::cast(setting->value) : py::none(),
                        messages_of(problems, model::Source("initial", text)));
}

/// The start and the end of the run as the text has them; None where it has not.
py::tuple span(const LoadedModel& self) {
  const model::RunSettings& run = self.model().run;
  const auto value = [](const std::optional<model::Setting>& setting) {
    return setting ? py::object(py::float_(setting->value)) : py::none();
  };
  return py::make_tuple(value(run.from), value(run.to));
}

void add_parts(Class& model) {
  model.def("parameters", &parameters)
      .def("inputs", &inputs)
      .def("states", &states)
      .def("outputs", [](const LoadedModel& self) { return quantities(self.model().outputs); })
      .def("lets", [](const LoadedModel& self) { return quantities(self.model().lets); })
      .def("energies", [](const LoadedModel& self) { return quantities(self.model().energies); })
      .def("events", &events)
      .def("files", &files)
      .def("values", &values, py::arg("given"))
      .def("with_values", &with_values, py::arg("values"))
      .def("read_parameter", &read_parameter, py::arg("text"))
      .def("read_initial", &read_initial, py::arg("text"))
      .def("states_named",
           [](const LoadedModel& self, const std::string& name) { return model::states_named(self.model(), name); })
      .def_property_readonly("name", [](const LoadedModel& self) { return text_of(self.model().name); })
      .def_property_readonly("heading", [](const LoadedModel& self) { return text_of(self.model().heading); })
      .def_property_readonly("text", [](const LoadedModel& self) { return py::bytes(self.source.text()); })
      .def_property_readonly("time_unit", [](const LoadedModel& self) { return text_of(self.model().time_unit); })
      .def_property_readonly("span", &span)
      .def_property_readonly("solver",
                             [](const LoadedModel& self) { return runs::name_of(runs::kind_of(self.model()).solver); });
}

}  // namespace

void add_model(py::module_& module) {
  add_model_run(module);
  Class model(module, "Model");
  add_parts(model);
  add_run_of_model(model);
  module.def("load_model", &load_text, py::arg("name"), py::arg("text"), py::arg("native") = "auto",
             py::arg("values") = model::Overrides());
}

}  // namespace continuo::python
