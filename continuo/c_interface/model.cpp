// Models of continuo.h: loading, names, parameters, whole runs.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/c_interface/handle/model_handle.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/native.hpp>

using namespace continuo;
using continuo::c::call;
using continuo::c::call_with_program;
using continuo::c::fail;

namespace {

constexpr const char* no_model = "there is no model: the pointer is NULL";

int take(continuo_model& m, model::Loaded loaded) {
  m.source_name = loaded.source.name();
  m.text = loaded.source.text();
  if (!loaded) return fail(m, CONTINUO_ERROR, loaded.diagnostics);
  loaded.model->native = std::make_shared<model::NativeCompiler>(model::NativeOptions{});
  m.program = model::compile(std::move(*loaded.model));
  return CONTINUO_OK;
}

template <class Load>
int load_into(continuo_model** model, Load&& load) noexcept {
  if (!model) return CONTINUO_MISUSE;
  *model = new (std::nothrow) continuo_model;
  return *model ? call(*model, load) : CONTINUO_MEMORY;
}

/// The name and the unit of number i of `what`; nulls where there is none.
std::pair<const char*, const char*> description(const continuo_model* m, int what, std::size_t i) {
  std::pair<const char*, const char*> none{"", ""};
  if (!m || !m->program || i >= continuo_count(m, what)) return none;
  const model::Model& model = m->program->model;
  if (what == CONTINUO_STATES) return {model.states[i].column.c_str(), model.states[i].unit.c_str()};
  if (what == CONTINUO_PARAMETERS) return {model.parameters[i].name.c_str(), model.parameters[i].unit.c_str()};
  if (what == CONTINUO_COLUMNS) return {m->run->motion.columns[i].name.c_str(), m->run->motion.columns[i].unit.c_str()};
  return none;
}

int no_parameter(continuo_model& m, const char* name) {
  return fail(m, CONTINUO_MISUSE, {model::no_parameter(m.program->model, name, {})});
}

/// The value that later runs, and the motion, begin with.
std::vector<double> variables_of(const continuo_model& m) {
  return model::start_values(m.program->model, m.experiment.parameters, m.experiment.from);
}

/// Those of the motion, with the parameters as they have been set; of the inputs, which may follow files, the one
/// named.
std::vector<double> variables_on_the_way(const continuo_model& m, std::string_view name) {
  const model::Model& model = m.program->model;
  const std::vector<double> at_start = variables_of(m);
  std::vector<double> variables = m.motion->variables();
  for (const model::Parameter& p : model.parameters) variables[p.variable] = at_start[p.variable];
  for (const model::Input& input : model.inputs) {
    if (input.name == name) variables[input.variable] = at_start[input.variable];
  }
  return variables;
}

int set_parameter(continuo_model& m, const char* name, double value) {
  if (!name) return fail(m, CONTINUO_MISUSE, "the name of the parameter is NULL");
  const model::Model& model = m.program->model;
  const std::size_t parameter = model::find_parameter(model, name);
  if (parameter == model::npos && model::find_input(model, name) == model::npos) return no_parameter(m, name);
  if (!std::isfinite(value)) return fail(m, CONTINUO_MISUSE, fmt::format("`{}` cannot be {}", name, value));
  if (parameter != model::npos && model.parameters[parameter].structural) {
    return fail(m, CONTINUO_ERROR, fmt::format("`{}` decides how many equations there are", name),
                "write its value into the text and load that");
  }
  m.experiment.parameters.insert_or_assign(name, value);
  if (m.motion) m.motion->go_on(m.motion->x(), variables_on_the_way(m, name));
  return CONTINUO_OK;
}

template <class Number>
int set_optional(continuo_model& m, std::optional<Number>& option, double value) {
  if (value == CONTINUO_DEFAULT) {
    option.reset();
  } else {
    option = static_cast<Number>(value);
  }
  static_cast<void>(m);
  return CONTINUO_OK;
}

int set_option(continuo_model& m, std::string_view option, double value) {
  model::Experiment& e = m.experiment;
  if (std::isnan(value)) return fail(m, CONTINUO_MISUSE, fmt::format("the option {} is no number", option));
  if (option == "rtol") return set_optional(m, e.rtol, value);
  if (option == "step") return set_optional(m, e.step, value);
  if (option == "max_step") return set_optional(m, e.max_step, value);
  if (option == "from") return set_optional(m, e.from, value);
  if (option == "atol") {
    e.atol.clear();
    if (value != CONTINUO_DEFAULT) e.atol = {value};
    return CONTINUO_OK;
  }
  if (option == "output") {
    e.output_steps = value == 0;
    e.output.reset();
    return value == 0 ? CONTINUO_OK : set_optional(m, e.output, value);
  }
  if (option == "max_steps") {
    if (value != CONTINUO_DEFAULT && !(value >= 1 && value <= 1e15))
      return fail(m, CONTINUO_MISUSE, fmt::format("max_steps is {}; it counts steps", value));
    return set_optional(m, e.max_steps, value);
  }
  return fail(m, CONTINUO_MISUSE, fmt::format("there is no option `{}`", option),
              "there are rtol, atol, step, max_step, max_steps, from, output");
}

int run(continuo_model& m, double to) {
  m.run.reset(), m.motion.reset(), m.events.clear(), m.outcome.clear();
  m.interrupt = false;
  model::Experiment experiment = m.experiment;
  experiment.interrupt = &m.interrupt;
  if (to != CONTINUO_DEFAULT) experiment.to = to;
  model::Simulated simulated = runs::run(m.program, experiment);
  if (!simulated.run) return fail(m, CONTINUO_ERROR, simulated.diagnostics);
  m.run = std::move(simulated.run);
  for (const model::RecordedEvent& event : m.run->events)
    m.events.push_back({event.t, event.mark.empty() ? event.name : event.mark});
  m.outcome = describe(m.run->outcome);
  if (succeeded(m.run->outcome.ending)) return CONTINUO_OK;
  if (!has_errors(simulated.diagnostics)) return fail(m, CONTINUO_FAILED, m.outcome);
  return fail(m, CONTINUO_FAILED, simulated.diagnostics);
}

int read_column(continuo_model& m, const char* name, double* buffer, std::size_t count) {
  if (!m.run) return fail(m, CONTINUO_MISUSE, "there is no run whose rows could be read", "continuo_run");
  if (!name) return fail(m, CONTINUO_MISUSE, "the name of the column is NULL");
  const model::Motion& motion = m.run->motion;
  const auto column = std::ranges::find(motion.columns, name, &model::Column::name);
  if (column == motion.columns.end()) return fail(m, CONTINUO_MISUSE, fmt::format("there is no column `{}`", name));
  std::vector<double> values(motion.rows());
  const auto place = static_cast<std::size_t>(column - motion.columns.begin());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = motion.row(i)[place];
  return c::copy(m, values, buffer, count, "the column");
}

}  // namespace

extern "C" {

int continuo_load(const char* path, continuo_model** model) {
  return load_into(model, [&](continuo_model& m) {
    if (!path) return fail(m, CONTINUO_MISUSE, "the path is NULL");
    return take(m, model::load(std::string(path)));
  });
}

int continuo_load_text(const char* text, const char* name, continuo_model** model) {
  return load_into(model, [&](continuo_model& m) {
    if (!text) return fail(m, CONTINUO_MISUSE, "the text is NULL");
    return take(m, model::load(model::Source(name ? name : "model", text)));
  });
}

void continuo_free(continuo_model* model) {
  delete model;
}

const char* continuo_error_message(const continuo_model* model) {
  return model ? model->error.message.c_str() : no_model;
}
const char* continuo_error_code(const continuo_model* model) {
  return model ? model->error.code.c_str() : "";
}
const char* continuo_error_hint(const continuo_model* model) {
  return model ? model->error.hint.c_str() : "";
}
int continuo_error_line(const continuo_model* model) {
  return model ? model->error.line : 0;
}
int continuo_error_column(const continuo_model* model) {
  return model ? model->error.column : 0;
}

size_t continuo_count(const continuo_model* model, int what) {
  if (!model || !model->program) return 0;
  switch (what) {
    case CONTINUO_STATES:
      return model->program->model.states.size();
    case CONTINUO_PARAMETERS:
      return model->program->model.parameters.size();
    case CONTINUO_COLUMNS:
      return model->run ? model->run->motion.columns.size() : 0;
    case CONTINUO_ROWS:
      return model->run ? model->run->motion.rows() : 0;
    case CONTINUO_EVENTS:
      return model->events.size();
    default:
      return 0;
  }
}
const char* continuo_name(const continuo_model* model, int what, size_t i) {
  return description(model, what, i).first;
}
const char* continuo_unit(const continuo_model* model, int what, size_t i) {
  return description(model, what, i).second;
}

int continuo_set_parameter(continuo_model* model, const char* name, double value) {
  return call_with_program(model, [&](continuo_model& m) { return set_parameter(m, name, value); });
}

int continuo_get_parameter(continuo_model* model, const char* name, double* value) {
  return call_with_program(model, [&](continuo_model& m) {
    if (!name || !value) return fail(m, CONTINUO_MISUSE, "the name or the place of the value is NULL");
    const std::size_t parameter = model::find_parameter(m.program->model, name);
    if (parameter == model::npos) return no_parameter(m, name);
    *value = variables_of(m)[m.program->model.parameters[parameter].variable];
    return static_cast<int>(CONTINUO_OK);
  });
}

int continuo_set_initial(continuo_model* model, const char* state, double value) {
  return call_with_program(model, [&](continuo_model& m) {
    if (!state) return fail(m, CONTINUO_MISUSE, "the name of the state is NULL");
    if (model::states_named(m.program->model, state).empty())
      return fail(m, CONTINUO_MISUSE, {model::no_state(m.program->model, state, {})});
    if (!std::isfinite(value)) return fail(m, CONTINUO_MISUSE, fmt::format("`{}` cannot begin with {}", state, value));
    m.experiment.initial.insert_or_assign(state, value);
    return static_cast<int>(CONTINUO_OK);
  });
}

int continuo_set_method(continuo_model* model, const char* name) {
  return call_with_program(model, [&](continuo_model& m) {
    m.experiment.method.reset();
    if (name) m.experiment.method = name;
    return static_cast<int>(CONTINUO_OK);
  });
}

int continuo_set_option(continuo_model* model, const char* option, double value) {
  return call_with_program(model, [&](continuo_model& m) {
    return option ? set_option(m, option, value) : fail(m, CONTINUO_MISUSE, "the name of the option is NULL");
  });
}

int continuo_run(continuo_model* model, double to) {
  return call_with_program(model, [&](continuo_model& m) { return run(m, to); });
}

int continuo_read_column(continuo_model* model, const char* name, double* buffer, size_t count) {
  return call_with_program(model, [&](continuo_model& m) { return read_column(m, name, buffer, count); });
}

int continuo_read_rows(continuo_model* model, double* buffer, size_t count) {
  return call_with_program(model, [&](continuo_model& m) {
    if (!m.run) return fail(m, CONTINUO_MISUSE, "there is no run whose rows could be read", "continuo_run");
    return c::copy(m, m.run->motion.values, buffer, count, "the run");
  });
}

const char* continuo_outcome(const continuo_model* model) {
  return model ? model->outcome.c_str() : no_model;
}

void continuo_interrupt(continuo_model* model) {
  if (model) model->interrupt = true;
}

int continuo_event(const continuo_model* model, size_t i, double* t, const char** name) {
  if (!model || i >= model->events.size()) return CONTINUO_MISUSE;
  if (t) *t = model->events[i].t;
  if (name) *name = model->events[i].name.c_str();
  return CONTINUO_OK;
}

}  // extern "C"
