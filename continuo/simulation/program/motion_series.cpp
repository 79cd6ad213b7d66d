// Taylor coefficients of a model's motion, with its unknowns, and of its guards along it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/simulation/program/motion_series.hpp>

namespace continuo::model {

namespace {

using Number = Rounded<double>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double units_of_state = 4, units_of_time = 1;
/// Covers the roundings of the bounds and their squares, which the bounds leave out: some epsilon per operation.
constexpr double margin = 1 + 0x1p-20;
/// Passes over the coefficients. One is enough where f is smooth; each further one lets the branches that a coefficient
/// has just decided bear on the next.
constexpr int sweeps = 5;

Number of_state(double x) {
  return {x, units_of_state * epsilon * std::abs(x)};
}

bool is_same(const Number& a, const Number& b) {
  return (a.value == b.value && a.rounding == b.rounding) || (!a.is_known() && !b.is_known());
}

}  // namespace

int carried(const GuardMotion& motion) {
  for (std::size_t k = 1; k < motion.c.size(); ++k) {
    if (std::abs(motion.c[k]) > motion.rounding[k]) return motion.c[k] > 0 ? 1 : -1;
    if (!std::isfinite(motion.rounding[k])) return 0;
  }
  return 0;
}

MotionSeries::MotionSeries(const ModelProgram& program, std::span<const double> variables)
    : first_state_(program.model.layout.states), variables_(variables.begin(), variables.end()) {
  const std::vector<State>& states = program.model.states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    (states[i].algebraic ? unknowns_ : differential_).push_back(i);
    in_world_.push_back(states[i].in_world);
  }
  for (std::size_t mode = 0; mode < program.derivatives.size(); ++mode) {
    modes_.push_back({.rates = {program.derivatives[mode]},
                      .guards = {program.guards[mode].tape},
                      .events = program.guards[mode].events});
  }
  x_.resize(states.size());
  rates_.resize(states.size());
  known_.resize(states.size());
  guards_.resize(program.model.events.size());
  slopes_.resize(unknowns_.size() * unknowns_.size());
  inverse_.resize(slopes_.size());
}

void MotionSeries::set(std::uint32_t variable, double value) {
  variables_[variable] = value;
  for (OfMode& mode : modes_) {
    mode.rates.registers.clear();
    mode.guards.registers.clear();
  }
}

void MotionSeries::evaluate(Evaluated& evaluated, const TapeSeries& time, std::span<const TapeSeries> x,
                            std::span<TapeSeries> outputs) {
  std::vector<TapeSeries>& registers = evaluated.registers;
  if (registers.empty()) {
    registers.resize(evaluated.tape->register_count());
    std::ranges::copy(variables_, registers.begin());
    evaluated.tape->prepare<TapeSeries>(registers);
  }
  registers[Layout::time] = time;
  std::ranges::copy(x, registers.begin() + first_state_);
  evaluated.tape->evaluate<TapeSeries>(registers, outputs);
}

void MotionSeries::evaluate_rates(const TapeSeries& time, std::span<const TapeSeries> x) {
  evaluate(modes_[mode_].rates, time, x, rates_);
  for (const std::size_t i : held_) rates_[i] = TapeSeries(0);
}

void MotionSeries::guards(std::size_t mode, double t, std::span<const double> x, double forward,
                          std::span<GuardMotion> motions) {
  const std::vector<std::size_t>& events = modes_[mode].events;
  if (events.empty()) return;
  (void)states(mode, t, x, forward);
  evaluate(modes_[mode].guards, time_, x_, std::span(guards_).first(events.size()));
  for (std::size_t k = 0; k < events.size(); ++k) {
    for (std::size_t j = 0; j <= TapeSeries::order; ++j) {
      motions[events[k]].c[j] = guards_[k].c[j].value;
      motions[events[k]].rounding[j] =
          guards_[k].c[j].is_known() ? margin * guards_[k].c[j].rounding : std::numeric_limits<double>::infinity();
    }
  }
}

std::span<const TapeSeries> MotionSeries::states(std::size_t mode, double t, std::span<const double> x,
                                                 double forward) {
  mode_ = mode;
  forward_ = forward;
  time_ = TapeSeries(Number(t, units_of_time * epsilon * std::abs(t)), Number(forward));
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = TapeSeries(of_state(x[i]));
    known_[i] = in_world_[i] ? 1 : TapeSeries::order + 1;
  }
  for (int pass = 1; pass <= sweeps; ++pass) {
    sweep();
    if (is_settled(pass == sweeps)) return x_;
  }
  sweep();  // once more, with what depends on the coefficients that have been given up
  return x_;
}

// x_(k+1) = f_k/(k + 1), and the unknowns of order k + 1 after that.
void MotionSeries::sweep() {
  if (!unknowns_.empty()) {
    invert_slopes_of_unknowns();
    round_unknowns();
  }
  for (std::size_t k = 0; k < TapeSeries::order; ++k) {
    evaluate_rates(time_, x_);
    for (const std::size_t i : differential_) {
      x_[i].c[k + 1] = k + 1 < known_[i] ? next_coefficient(i, k) : Number::anything();
    }
    if (!unknowns_.empty()) solve_unknowns(k + 1);
  }
}

Number MotionSeries::next_coefficient(std::size_t i, std::size_t k) const {
  return Number(forward_) * rates_[i].c[k] / Number(static_cast<double>(k + 1));
}

/// Whether the series satisfy the equations with the branches that they themselves decide. `give_up`: those that do not
/// are unknown from there on.
bool MotionSeries::is_settled(bool give_up) {
  evaluate_rates(time_, x_);
  bool settled = true;
  const auto differs = [&](std::size_t i, std::size_t k) {
    settled = false;
    if (give_up) known_[i] = std::min(known_[i], k);
  };
  for (std::size_t k = 1; k <= TapeSeries::order; ++k) {
    for (const std::size_t i : differential_) {
      if (k < known_[i] && !is_same(next_coefficient(i, k - 1), x_[i].c[k])) differs(i, k);
    }
    const auto is_no_root = [&](std::size_t i) {
      const Number& residual = rates_[i].c[k];
      return (residual == Number(0)) == Truth::no;
    };
    if (std::ranges::none_of(unknowns_, is_no_root)) continue;
    for (const std::size_t i : unknowns_) differs(i, k);
  }
  return settled;
}

// Each unknown in turn leaves its value with slope 1, or -1 where that is the way it goes: what the residuals do then
// are their slopes, on the branches that the motion takes.
void MotionSeries::invert_slopes_of_unknowns() {
  const std::size_t n = unknowns_.size();
  std::vector<TapeSeries> still;
  for (const TapeSeries& x : x_) still.push_back(TapeSeries(x.c[0]));
  DenseLU<double> lu(n);
  for (std::size_t column = 0; column < n; ++column) {
    const std::size_t j = unknowns_[column];
    const Number way(x_[j].c[1].value < 0 ? -1 : 1);
    still[j].c[1] = way;
    evaluate_rates(TapeSeries(time_.c[0]), still);
    still[j].c[1] = 0;
    for (std::size_t row = 0; row < n; ++row) {
      slopes_[row * n + column] = way * rates_[unknowns_[row]].c[1];
      lu.matrix()[row * n + column] = slopes_[row * n + column].value;
    }
  }
  std::ranges::fill(inverse_, std::numeric_limits<double>::quiet_NaN());
  if (!lu.factor()) return;
  std::vector<double> unit(n);
  for (std::size_t column = 0; column < n; ++column) {
    std::ranges::fill(unit, 0.0);
    unit[column] = 1;
    lu.solve(unit.data());
    for (std::size_t row = 0; row < n; ++row) inverse_[row * n + column] = unit[row];
  }
}

/// What an unknown may be off by where its residual is off by as much.
double MotionSeries::doubt_of_unknown(std::size_t row, std::span<const Number> residuals) const {
  double doubt = 0;
  for (std::size_t j = 0; j < residuals.size(); ++j) {
    const double slope = std::abs(inverse_[row * residuals.size() + j]);
    if (!residuals[j].is_exactly_zero()) doubt += slope * (std::abs(residuals[j].value) + residuals[j].rounding);
  }
  return doubt;
}

// The values are the caller's: no better than the residuals that they leave.
void MotionSeries::round_unknowns() {
  const std::size_t n = unknowns_.size();
  for (const std::size_t i : unknowns_) x_[i].c[0].rounding = 0;
  evaluate_rates(time_, x_);
  std::vector<Number> residuals;
  for (const std::size_t i : unknowns_) residuals.push_back(rates_[i].c[0]);
  for (std::size_t row = 0; row < n; ++row) {
    Number& z = x_[unknowns_[row]].c[0];
    const double doubt = doubt_of_unknown(row, residuals);
    z.rounding = of_state(z.value).rounding;
    if (std::isfinite(doubt)) z.rounding = std::max(z.rounding, doubt);
  }
}

// The residuals of order k are r + J z_k, r being those with z_k = 0. Solved and corrected once; what is left of them,
// with its rounding, bounds that of z_k.
void MotionSeries::solve_unknowns(std::size_t k) {
  const std::size_t n = unknowns_.size();
  for (const std::size_t i : unknowns_) x_[i].c[k] = 0;
  evaluate_rates(time_, x_);
  std::vector<Number> residuals(n);
  std::vector<double> z(n);
  for (int pass = 0; pass < 3; ++pass) {
    for (std::size_t row = 0; row < n; ++row) {
      residuals[row] = rates_[unknowns_[row]].c[k];
      for (std::size_t j = 0; j < n; ++j) residuals[row] = residuals[row] + slopes_[row * n + j] * Number(z[j]);
    }
    for (std::size_t row = 0; row < n && pass < 2; ++row) {
      for (std::size_t j = 0; j < n; ++j) z[row] -= inverse_[row * n + j] * residuals[j].value;
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    const std::size_t i = unknowns_[row];
    const double doubt = doubt_of_unknown(row, residuals);
    x_[i].c[k] = k < known_[i] && std::isfinite(doubt) ? Number(z[row], doubt) : Number::anything();
  }
}

}  // namespace continuo::model
