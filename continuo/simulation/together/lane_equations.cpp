// The right-hand sides of a model and their derivatives in lanes. A lane whose derivatives are not finite gets those of
// its run alone.
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/numerics/finite.hpp>
#include <continuo/simulation/program/differences_of_model.hpp>
#include <continuo/simulation/together/lane_equations.hpp>

namespace continuo::model {

LaneEquations::LaneEquations(const ModelProgram& program, std::shared_ptr<NativeFunction> code, std::size_t mode,
                             std::optional<LaneDerivatives> derivatives)
    : autonomous(program.autonomous),
      rates_(program.derivatives[mode], std::move(code)),
      derivatives_(std::move(derivatives)),
      follows_tables_(!program.linear_inputs.empty()) {}

std::vector<double> LaneEquations::parameters(std::size_t number, std::span<const double> variables) {
  std::vector<double> p(variables.begin(), variables.end());
  p[Layout::time] = static_cast<double>(number);  // the time itself is no parameter
  return p;
}

void LaneEquations::operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt,
                               const std::vector<double>& p) {
  rates_(t, x, dxdt, p);
}

void LaneEquations::operator()(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dxdt,
                               const std::vector<Wide>& p) {
  rates_(t, x, dxdt, p);
}

void LaneEquations::jacobian(double t, const std::vector<double>& x, std::span<double> rows,
                             const std::vector<double>& p) {
  derivatives_->jacobian<double>(t, x, rows, p);
  if (!all_finite(rows)) replace_not_finite(t, x, rows, p);
}

void LaneEquations::jacobian(const Wide& t, const std::vector<Wide>& x, std::span<Wide> rows,
                             const std::vector<Wide>& p) {
  derivatives_->jacobian<Wide>(t, x, rows, p);
  for_each_not_finite(rows, t, x, p, [&](std::size_t lane, double t_one) {
    entries_.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) entries_[i] = rows[i][lane];
    replace_not_finite(t_one, x_, entries_, p_);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].set(lane, entries_[i]);
  });
}

void LaneEquations::replace_not_finite(double t, const std::vector<double>& x, std::span<double> rows,
                                       const std::vector<double>& p) {
  const std::vector<double> differences = differences_of_model(
      x, [&](const std::vector<double>& moved, std::vector<double>& dxdt) { (*this)(t, moved, dxdt, p); });
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!std::isfinite(rows[i])) rows[i] = differences[i];
}

void LaneEquations::time_derivative(double t, const std::vector<double>& x, std::vector<double>& dfdt,
                                    const std::vector<double>& p) {
  if (!follows_tables_) {
    derivatives_->time_derivative<double>(t, x, dfdt, p);
    if (all_finite(dfdt)) return;
  }
  now_.resize(x.size());
  difference_by_time(t, now_, dfdt, [&](double when, std::vector<double>& dxdt) { (*this)(when, x, dxdt, p); });
}

void LaneEquations::time_derivative(const Wide& t, const std::vector<Wide>& x, std::vector<Wide>& dfdt,
                                    const std::vector<Wide>& p) {
  if (follows_tables_) {
    wide_now_.resize(x.size());
    return difference_by_time(t, wide_now_, dfdt,
                              [&](const Wide& when, std::vector<Wide>& dxdt) { (*this)(when, x, dxdt, p); });
  }
  derivatives_->time_derivative<Wide>(t, x, dfdt, p);
  for_each_not_finite(dfdt, t, x, p, [&](std::size_t lane, double t_one) {
    entries_.resize(x.size());
    time_derivative(t_one, x_, entries_, p_);
    for (std::size_t i = 0; i < x.size(); ++i) dfdt[i].set(lane, entries_[i]);
  });
}

template <class Act>
void LaneEquations::for_each_not_finite(std::span<const Wide> numbers, const Wide& t, const std::vector<Wide>& x,
                                        const std::vector<Wide>& p, const Act& act) {
  Wide sum(0.0);
  for (const Wide& number : numbers) sum += detail::zero_if_finite(number);
  const auto finite = sum == Wide(0.0);
  if (all(finite)) [[likely]]
    return;
  const auto take = [](const std::vector<Wide>& from, std::size_t lane, std::vector<double>& to) {
    to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i][lane];
  };
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (finite[lane]) continue;
    take(x, lane, x_);
    take(p, lane, p_);
    act(lane, t[lane]);
  }
}

}  // namespace continuo::model
