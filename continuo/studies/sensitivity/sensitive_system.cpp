// Evaluates the equations of a motion and its sensitivities, sliding included.
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/studies/sensitivity/sensitive_system.hpp>

namespace continuo::studies::detail {

WideEvaluation::WideEvaluation(std::shared_ptr<const model::Tape> tape, const SensitiveProgram& program,
                               std::span<const double> variables)
    : tape_(std::move(tape)),
      states_(program.program().model.layout.states),
      further_(program.registers_of_s()),
      n_(program.size()),
      registers_(tape_->register_count()) {
  std::ranges::copy(variables, registers_.begin());
  tape_->prepare<double>(registers_);
}

void WideEvaluation::operator()(double t, std::span<const double> wide, std::span<double> outputs) {
  registers_[model::Layout::time] = t;
  std::ranges::copy(wide.first(n_), registers_.begin() + states_);
  std::ranges::copy(wide.subspan(n_), registers_.begin() + further_);
  tape_->evaluate<double>(registers_, outputs);
}

std::vector<double> WideEvaluation::operator()(double t, std::span<const double> wide) {
  std::vector<double> outputs(tape_->output_count());
  if (!outputs.empty()) (*this)(t, wide, outputs);
  return outputs;
}

void WideEvaluation::set(std::uint32_t variable, double value) {
  registers_[variable] = value;
  tape_->prepare<double>(registers_);
}

SensitiveSystem::SensitiveSystem(std::shared_ptr<const SensitiveProgram> program, std::span<const double> variables)
    : program_(std::move(program)),
      plain_(program_->shared_program(), variables),
      variables_(variables.begin(), variables.end()) {
  for (std::size_t mode = 0; mode < program_->program().model.modes.size(); ++mode) add_mode(mode);
  for (const SensitiveEvent& event : program_->events()) events_.emplace_back(event.tape, *program_, variables);
}

void SensitiveSystem::add_mode(std::size_t mode) {
  rates_.emplace_back(program_->rates(mode), *program_, variables_);
  const SensitiveSurfaces& surfaces = program_->surfaces(mode);
  surfaces_.emplace_back(surfaces.tape, *program_, variables_);
  approach_.emplace_back(surfaces.approach, *program_, variables_);
}

void SensitiveSystem::hold_switches(double t, const X& x) {
  plain_.hold_switches(t, X(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(program_->size())));
  place_switches();
}

void SensitiveSystem::place_switches() {
  const std::span<const double> values = plain_.switch_values();
  for (std::size_t k = 0; k < values.size(); ++k) place(k, values[k]);
}

void SensitiveSystem::place(std::size_t k, double value) {
  const std::uint32_t variable = program_->program().switches[mode()].switches[k].variable;
  rates_[mode()].place(variable, value);
  surfaces_[mode()].place(variable, value);
  approach_[mode()].place(variable, value);
  if (jacobian_) jacobian_->by_state[mode()].place(variable, value), jacobian_->by_time[mode()].place(variable, value);
}

void SensitiveSystem::rates(double t, const X& x, X& dxdt) {
  if (plain_.slides()) {
    slide(t, x, dxdt);
  } else {
    rates_[mode()](t, x, dxdt);
  }
}

void SensitiveSystem::slide(double t, const X& x, X& dxdt) {
  const std::span<const model::SwitchedMotion::Sliding> sliding = plain_.sliding();
  const std::size_t n = sliding.size(), width = 1 + program_->count(), states = program_->size();
  for (const auto& one : sliding) place(one.k, one.below);
  X base(x.size());
  rates_[mode()](t, x, base);
  const std::vector<double> below = approach_[mode()](t, x);
  std::vector<X> beyond(n, X(x.size()));  // f and df above the i-th surface alone, less those below all
  std::vector<std::vector<double>> change(n);
  for (std::size_t i = 0; i < n; ++i) {
    place(sliding[i].k, sliding[i].above);
    rates_[mode()](t, x, beyond[i]);
    change[i] = approach_[mode()](t, x);
    place(sliding[i].k, sliding[i].below);
    for (std::size_t s = 0; s < x.size(); ++s) beyond[i][s] -= base[s];
    for (std::size_t a = 0; a < change[i].size(); ++a) change[i][a] -= below[a];
  }
  DenseLU<double> matrix(n);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) matrix.matrix()[j * n + i] = change[i][sliding[j].k * width];
  dxdt = base;
  if (!matrix.factor()) {
    std::ranges::fill(dxdt, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  std::vector<double> weight(n), moved(n);
  for (std::size_t j = 0; j < n; ++j) weight[j] = -below[sliding[j].k * width];
  matrix.solve(weight.data());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t s = 0; s < x.size(); ++s) dxdt[s] += weight[i] * beyond[i][s];
  for (std::size_t k = 0; k < program_->count(); ++k) {
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t place = sliding[j].k * width + 1 + k;
      moved[j] = -below[place];
      for (std::size_t i = 0; i < n; ++i) moved[j] -= weight[i] * change[i][place];
    }
    matrix.solve(moved.data());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t s = 0; s < states; ++s) dxdt[program_->place(s, k)] += moved[i] * beyond[i][s];
  }
}

/// The motion slides, and the pattern has a place for all that its weights depend on.
bool SensitiveSystem::slides_in_full() const {
  const std::size_t width = program_->size() * (1 + program_->count());
  return plain_.slides() && program_->jacobians().pattern.entries() == width * width;
}

/// As in ModelSystem.
void SensitiveSystem::difference_rows(double t, const X& x, std::span<double> rows) {
  difference_jacobian(
      x, [&](std::size_t j) { return central_increment(x[j], 1e-3); },
      [&](const X& moved, X& dxdt) { slide(t, moved, dxdt); }, rows);
}

void SensitiveSystem::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  for (auto* of_modes : {&rates_, &surfaces_, &approach_})
    for (WideEvaluation& evaluation : *of_modes) evaluation.set(variable, value);
  for (WideEvaluation& event : events_) event.set(variable, value);
  if (!jacobian_) return;
  for (WideEvaluation& entries : jacobian_->by_state) entries.set(variable, value);
  for (WideEvaluation& entries : jacobian_->by_time) entries.set(variable, value);
}

SensitiveSystem::Jacobian& SensitiveSystem::derivatives() {
  if (jacobian_) return *jacobian_;
  const SensitiveProgram::Jacobians& shared = program_->jacobians();
  jacobian_.emplace();
  for (const auto& entries : shared.by_state) {
    jacobian_->by_state.emplace_back(entries.tape, *program_, variables_);
    std::vector<std::size_t>& entry = jacobian_->entry.emplace_back();
    for (const MatrixPlace& place : entries.places) entry.push_back(shared.pattern.find(place.row, place.column));
  }
  for (const auto& entries : shared.by_time) jacobian_->by_time.emplace_back(entries.tape, *program_, variables_);
  place_switches();
  return *jacobian_;
}

void SensitiveSystem::jacobian_values(double t, const X& x, std::span<double> values) {
  if (slides_in_full()) {
    std::vector<double> rows(x.size() * x.size());
    difference_rows(t, x, rows);
    const SparsePattern& pattern = program_->jacobians().pattern;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < x.size(); ++j) values[pattern.find(i, j)] = rows[i * x.size() + j];
    return;
  }
  Jacobian& mine = derivatives();
  const std::vector<double> entries = mine.by_state[mode()](t, x);
  std::ranges::fill(values, 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e) values[mine.entry[mode()][e]] = entries[e];
}

void SensitiveSystem::jacobian(double t, const X& x, std::span<double> rows) {
  if (plain_.slides()) return difference_rows(t, x, rows);
  const std::vector<double> entries = derivatives().by_state[mode()](t, x);
  const auto& places = program_->jacobians().by_state[mode()].places;
  std::ranges::fill(rows, 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e) rows[places[e].row * x.size() + places[e].column] = entries[e];
}

void SensitiveSystem::time_derivative(double t, const X& x, X& dfdt) {
  if (plain_.slides()) {
    const double moved = t + std::sqrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(t));
    X now(x.size());
    slide(t, x, now);
    slide(moved, x, dfdt);
    for (std::size_t i = 0; i < x.size(); ++i) dfdt[i] = (dfdt[i] - now[i]) / (moved - t);
    return;
  }
  const std::vector<double> entries = derivatives().by_time[mode()](t, x);
  const auto& places = program_->jacobians().by_time[mode()].places;
  std::ranges::fill(dfdt, 0.0);
  for (std::size_t e = 0; e < entries.size(); ++e) dfdt[places[e].row] = entries[e];
}

}  // namespace continuo::studies::detail
