// df/dx and df/dt of a model by differences, where its equations give none: the slope of a root at 0, an input that
// follows a table.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/system/jacobian.hpp>

namespace continuo::model {

/// Row by row; `f(x, dxdt)`.
template <class F>
[[nodiscard]] std::vector<double> differences_of_model(const std::vector<double>& x, const F& f) {
  constexpr double least_size = 1e-3;  // of a component
  std::vector<double> rows(x.size() * x.size());
  difference_jacobian(x, [&](std::size_t j) { return central_increment(x[j], least_size); }, f, std::span(rows));
  return rows;
}

/// df/dt by a forward difference, for equations in which an input follows a table; `f(t, dxdt)`. Real is a number or
/// lanes of them, `now` is scratch.
template <class Real, class F>
void difference_by_time(const Real& t, std::vector<Real>& now, std::vector<Real>& dfdt, const F& f) {
  const Real increment = difference_increment(t, Real(std::sqrt(std::numeric_limits<double>::epsilon())));
  f(t, now);
  f(Real(t + increment), dfdt);
  for (std::size_t i = 0; i < dfdt.size(); ++i) dfdt[i] = (dfdt[i] - now[i]) / increment;
}

}  // namespace continuo::model
