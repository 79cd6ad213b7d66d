// Evaluates the equations of a model and their Jacobian, with a workspace for each thread.
#include "right_hand_side.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <continuo/language/load.hpp>

namespace continuo::python {

using namespace continuo::model;

namespace {

/// Why the equations of this model are not the whole of its motion; empty where they are.
std::string obstacle(const Model& model) {
  if (model.has_world()) return "it has bodies";
  if (model.needs_boundary_solver()) return "it has conditions at several times";
  if (model.needs_dae_solver()) return "it has algebraic equations, `0 = ...`";
  if (model.modes.size() > 1) return "it has modes";
  if (!model.events.empty() || !model.schedule.empty()) return "it has events";
  for (const Input& input : model.inputs) {
    if (!input.file.empty()) return fmt::format("its input `{}` comes from a file", input.name);
  }
  return {};
}

/// A child of fork has no thread that compiles, and must not wait for it: what was made before the fork stays.
std::shared_ptr<const ModelProgram> kept_in_forks(std::shared_ptr<const ModelProgram> program) {
  const ModelProgram* const plain = program.get();
  return {plain, [program = std::move(program), process = getpid()](const ModelProgram*) mutable {
            if (getpid() != process) static_cast<void>(new std::shared_ptr(std::move(program)));
          }};
}

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> number = 0;
  return ++number;
}

/// The initial values that the text lacks, if it lacks nothing else: "x(0) = ...;  x'(0) = ..." behind "add ".
std::vector<std::string> missing_initial_values(const Loaded& loaded) {
  std::vector<std::string> missing;
  for (const Diagnostic& diagnostic : loaded.diagnostics) {
    if (diagnostic.severity != Severity::error) continue;
    if (diagnostic.code != "E240" || !diagnostic.help.starts_with("add ")) return {};
    for (std::size_t begin = 4, end = 0; end != std::string::npos; begin = end + 1) {
      end = diagnostic.help.find(';', begin);
      const std::string value = diagnostic.help.substr(begin, end - begin);
      missing.push_back(value.substr(0, value.find(" = ")));
    }
  }
  return missing;
}

}  // namespace

std::shared_ptr<const ModelProgram> load_equations(const std::string& text, const std::string& path, NativeUse use) {
  Loaded loaded = load(Source(path, text));
  std::string completed = text;
  while (!loaded) {
    // A solver is handed its start: those that are not stated are zero. Of a family one member is reported at a time.
    const std::vector<std::string> missing = missing_initial_values(loaded);
    if (missing.empty()) break;
    completed += fmt::format("\n{} = 0", fmt::join(missing, " = 0\n"));
    loaded = load(Source(path, completed + "\n"));
  }
  if (!loaded) throw std::invalid_argument(loaded.text());
  Model& model = *loaded.model;
  const std::string reason = obstacle(model);
  if (!reason.empty()) {
    throw std::invalid_argument(
        fmt::format("the model {} is no plain system y' = f(t, y): {}; run it as a Model, which has all of it",
                    model.name, reason));
  }
  model.native = std::make_shared<NativeCompiler>(NativeOptions{.use = use});
  std::shared_ptr<const ModelProgram> program = compile(std::move(model));
  if (const std::string missing = program->model.native->missing(); !missing.empty())
    throw std::invalid_argument("native: " + missing);
  return kept_in_forks(std::move(program));
}

RightHandSide::RightHandSide(std::shared_ptr<const ModelProgram> program, const Overrides& parameters)
    : program_(std::move(program)), number_(next_number()) {
  const Model& model = program_->model;
  for (const auto& [name, value] : parameters) {
    const std::size_t parameter = find_parameter(model, name);
    if (parameter == npos && find_input(model, name) == npos) {
      throw std::invalid_argument(fmt::format("there is no parameter `{}`", name));
    }
    if (parameter != npos && model.parameters[parameter].structural) {
      throw std::invalid_argument(
          fmt::format("the parameter `{}` decides how many equations there are: it cannot be changed", name));
    }
  }
  variables_ = start_values(model, parameters);
}

RightHandSide::Workspace& RightHandSide::workspace_of_thread() const {
  const std::scoped_lock lock(mutex_);
  std::unique_ptr<Workspace>& mine = workspaces_[std::this_thread::get_id()];
  if (!mine) mine = std::make_unique<Workspace>(Evaluation(program_->derivatives.front(), variables_));
  return *mine;
}

RightHandSide::Workspace& RightHandSide::workspace() const {
  // Numbers are never used again, so that what belonged to a right-hand side that is gone is never found.
  thread_local std::uint64_t number = 0;
  thread_local Workspace* last = nullptr;
  if (number != number_) {
    last = &workspace_of_thread();
    number = number_;
  }
  return *last;
}

void RightHandSide::evaluate(double t, const double* x, double* dxdt) const {
  workspace().derivatives(t, {x, size()}, {dxdt, size()});
}

model::ModelSystem& RightHandSide::differentiated(Workspace& mine) const {
  if (!mine.system) {
    const std::scoped_lock lock(mutex_);
    if (!differentiated_) {
      differentiated_ = std::make_unique<ModelSystem>(program_, variables_);
      static_cast<void>(differentiated_->jacobian_pattern());
    }
    mine.system = std::make_unique<ModelSystem>(*differentiated_);
  }
  return *mine.system;
}

void RightHandSide::jacobian(double t, const double* x, double* rows) const {
  Workspace& mine = workspace();
  mine.x.assign(x, x + size());
  differentiated(mine).jacobian(t, mine.x, {rows, size() * size()});
}

SparsePattern RightHandSide::jacobian_pattern() const {
  return differentiated(workspace()).jacobian_pattern();
}

void RightHandSide::jacobian_values(double t, const double* x, double* values) const {
  Workspace& mine = workspace();
  mine.x.assign(x, x + size());
  ModelSystem& system = differentiated(mine);
  system.jacobian_values(t, mine.x, {values, system.jacobian_pattern().entries()});
}

void RightHandSide::derivative(double t, const double* x, double* dxdt, void* user) noexcept {
  const RightHandSide& f = *static_cast<const RightHandSide*>(user);
  try {
    f.evaluate(t, x, dxdt);
  } catch (...) {
    std::fill_n(dxdt, f.size(), std::numeric_limits<double>::quiet_NaN());
  }
}

void RightHandSide::jacobian_rows(double t, const double* x, double* rows, void* user) noexcept {
  const RightHandSide& f = *static_cast<const RightHandSide*>(user);
  try {
    f.jacobian(t, x, rows);
  } catch (...) {
    std::fill_n(rows, f.size() * f.size(), std::numeric_limits<double>::quiet_NaN());
  }
}

void RightHandSide::jacobian_entries(double t, const double* x, double* values, void* user) noexcept {
  const RightHandSide& f = *static_cast<const RightHandSide*>(user);
  try {
    f.jacobian_values(t, x, values);
  } catch (...) {
    values[0] = std::numeric_limits<double>::quiet_NaN();  // its diagonal entry: there is a component
  }
}

}  // namespace continuo::python
