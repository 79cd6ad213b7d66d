// continuo/simulation/program/model_system.cpp
// Evaluates a model's right-hand sides, guards, blocks and Jacobian at its present mode and values.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/finite.hpp>
#include <continuo/simulation/program/differences_of_model.hpp>
#include <continuo/simulation/program/model_system.hpp>

namespace continuo::model {

ModelSystem::ModelSystem(std::shared_ptr<const ModelProgram> program, std::span<const double> variables)
    : autonomous(program->autonomous),
      program_(std::move(program)),
      mode_(program_->model.start_mode),
      variables_(variables.begin(), variables.end()) {
  for (const auto& tape : program_->derivatives) derivatives_.emplace_back(tape, variables);
  for (const ProgramGuards& guards : program_->guards) {
    guards_.emplace_back(guards.tape, variables);
    truths_.emplace_back(guards.truths, variables);
  }
  for (const ProgramBlock& block : program_->event_blocks) event_blocks_.emplace_back(block.tape, variables);
  for (const ProgramBlock& block : program_->limit_blocks) limit_blocks_.emplace_back(block.tape, variables);
  for (const ProgramBlock& block : program_->schedule_blocks) {
    schedule_blocks_.emplace_back(block.tape, variables);
  }
  guard_values_.resize(program_->model.events.size());
  step_codes_.resize(derivatives_.size());
}
ModelSystem::ModelSystem(const ModelSystem&) = default;
ModelSystem::ModelSystem(ModelSystem&&) noexcept = default;
ModelSystem& ModelSystem::operator=(const ModelSystem&) = default;
ModelSystem& ModelSystem::operator=(ModelSystem&&) noexcept = default;
ModelSystem::~ModelSystem() = default;

NativeLaneEvaluation ModelSystem::step_code(StepFormula formula) {
  if (!held_.empty() || has_switches()) return nullptr;
  StepCode& step = step_codes_[mode_];
  if (step.formula != formula) {
    step = {formula, program_->step_code(mode_, formula), formula().b.size() * derivatives_[mode_].operations()};
  }
  if (!step.code) return nullptr;
  void* const code = step.code->code();
  if (code == nullptr) step.code->count(step.operations);
  return reinterpret_cast<NativeLaneEvaluation>(code);
}

template <class Visit>
void ModelSystem::for_each(Visit&& visit) {
  for (auto* list : {&derivatives_, &guards_, &truths_, &event_blocks_, &limit_blocks_, &schedule_blocks_})
    std::ranges::for_each(*list, visit);
}

void ModelSystem::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  if (derivatives_of_f_) derivatives_of_f_->set(variable, value);
  if (switched_) switched_->set(variable, value);
  if (series_) series_->set(variable, value);
  for_each([&](Evaluation& evaluation) { evaluation.set(variable, value); });
}

void ModelSystem::guards(double t, const X& x, std::span<double> values) {
  const std::vector<std::size_t>& events = program_->guards[mode_].events;
  if (events.empty()) return;
  guards_[mode_](t, x, std::span(guard_values_).first(events.size()));
  const std::vector<std::size_t>& conditions = program_->guards[mode_].conditions;
  const auto is_zero = [&](std::size_t k) { return guard_values_[k] == 0; };
  if (std::ranges::any_of(conditions, is_zero)) {
    const std::vector<double> truths = truths_[mode_](t, x);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      constexpr double least = std::numeric_limits<double>::denorm_min();
      if (is_zero(conditions[c])) guard_values_[conditions[c]] = truths[c] != 0 ? least : -least;
    }
  }
  for (std::size_t k = 0; k < events.size(); ++k) values[events[k]] = guard_values_[k];
}

ModelDerivatives& ModelSystem::derivatives_of_f() {
  if (!derivatives_of_f_) {
    derivatives_of_f_.emplace(*program_, variables_, switched_.has_value());
    place_switches();
  }
  return *derivatives_of_f_;
}

void ModelSystem::hold_switches(double t, const X& x) {
  const bool any = std::ranges::any_of(program_->switches, [](const SwitchedEquations& e) { return !e.empty(); });
  if (!any) return;
  switched_.emplace(*program_, variables_);
  derivatives_of_f_.reset();
  series_.reset();
  settle_switches(t, x, nullptr);
}

void ModelSystem::settle_switches(double t, const X& x, const X* before) {
  if (!switched_) return;
  switched_->settle(mode_, t, x, before);
  place_switches();
}

Passage ModelSystem::pass_switch(std::size_t k, double t, const X& x) {
  const Passage passage = switched_->pass(mode_, k, t, x);
  place_switches();
  return passage;
}

void ModelSystem::place_switches() {
  if (!derivatives_of_f_ || !has_switches()) return;
  const std::vector<Switch>& switches = program_->switches[mode_].switches;
  for (std::size_t k = 0; k < switches.size(); ++k)
    derivatives_of_f_->set(switches[k].variable, switched_->values()[k]);
}

/// Central differences in place of what the equations do not give: of all entries where the motion slides, since its
/// weights depend on x, too; else of those that are not finite, as the slope of a root at 0. Entry (i, j) is
/// values[place(i, j)]; a place behind them is that of no entry.
template <class Place>
void ModelSystem::take_differences(double t, const X& x, std::span<double> values, Place place) {
  const std::vector<double> rows = differences_of_model(x, [&](const X& moved, X& dxdt) { (*this)(t, moved, dxdt); });
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      const std::size_t entry = place(i, j);
      if (entry < values.size() && (slides() || !std::isfinite(values[entry]))) values[entry] = rows[i * x.size() + j];
    }
  }
}

void ModelSystem::set_all(std::span<const double> variables) {
  const Layout& layout = program_->model.layout;
  for (std::uint32_t i = layout.parameters; i < layout.samples; ++i) {
    if (variables_[i] != variables[i]) set(i, variables[i]);
  }
}

void ModelSystem::jacobian(double t, const X& x, std::span<double> rows) {
  if (!slides()) derivatives_of_f().jacobian(mode_, t, x, rows);
  if (slides() || !all_finite(rows))
    take_differences(t, x, rows, [&](std::size_t i, std::size_t j) { return i * x.size() + j; });
  for (const std::size_t i : held_) std::ranges::fill(rows.subspan(i * x.size(), x.size()), 0.0);
}

void ModelSystem::jacobian_values(double t, const X& x, std::span<double> values) {
  derivatives_of_f().jacobian_values(mode_, t, x, values);
  const SparsePattern& pattern = jacobian_pattern();
  const bool slides_in_full = slides() && pattern.entries() == x.size() * x.size();
  if (slides_in_full || !all_finite(values))
    take_differences(t, x, values, [&](std::size_t i, std::size_t j) { return pattern.find(i, j); });
  for (const std::size_t i : held_) {
    for (std::size_t column = 0; column < x.size(); ++column) {
      const std::size_t entry = pattern.find(i, column);
      if (entry < pattern.entries()) values[entry] = 0;
    }
  }
}

void ModelSystem::jacobian_band(double t, const X& x, std::span<double> band) {
  derivatives_of_f().jacobian_band(mode_, t, x, band);
  const SparsePattern& pattern = jacobian_pattern();
  const BandLayout layout = pattern.band();
  const auto place = [&](std::size_t i, std::size_t j) {
    return pattern.find(i, j) < pattern.entries() ? layout.place(i, j) : band.size();
  };
  const bool slides_in_full = slides() && pattern.entries() == x.size() * x.size();
  if (slides_in_full || !all_finite(band)) take_differences(t, x, band, place);
  for (const std::size_t i : held_) {
    for (std::size_t column = 0; column < x.size(); ++column)
      if (place(i, column) < band.size()) band[place(i, column)] = 0;
  }
}

// An input that follows a table over time is a variable to the graph, so its change is measured: by a difference.
void ModelSystem::time_derivative(double t, const X& x, X& dfdt) {
  if (program_->linear_inputs.empty() && !slides()) {
    derivatives_of_f().time_derivative(mode_, t, x, dfdt);
    for (const std::size_t i : held_) dfdt[i] = 0;
    if (all_finite(dfdt)) return;
  }
  X now(x.size());
  difference_by_time(t, now, dfdt, [&](double when, X& dxdt) { (*this)(when, x, dxdt); });
}

std::string_view ModelSystem::taylor_coefficients(double t, double scale, std::span<double> c) {
  if (slides())
    return "the motion slides along a surface where the equations jump, and has no Taylor series there: take dop853";
  if (!series_ || series_mode_ != mode_) {
    std::vector<NodeId> guards;
    if (!has_switches())
      for (const std::size_t event : program_->guards[mode_].events) guards.push_back(model().events[event].guard);
    series_.emplace(*program_, equations(), variables_, guards);
    series_mode_ = mode_;
  }
  const std::span<const double> values = switch_values();
  for (std::size_t k = 0; k < values.size(); ++k)
    series_->set(program_->switches[mode_].switches[k].variable, values[k]);
  series_->expand(t, scale, c, held_);
  return {};
}

std::size_t ModelSystem::take_series_steps(SeriesSteps<double>& steps) {
  if (!series_ || series_mode_ != mode_ || !held_.empty() || has_switches()) return 0;
  return series_->take_steps(steps);
}

}  // namespace continuo::model
