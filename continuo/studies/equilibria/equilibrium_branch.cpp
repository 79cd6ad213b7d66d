// continuo/studies/equilibria/equilibrium_branch.cpp
// Predictor and corrector on a branch of equilibria.
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/equilibria/equilibrium_branch.hpp>
#include <continuo/studies/support/arclength.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

}  // namespace

EquilibriumSteps::EquilibriumSteps(const ParametricSystem& system, const Vector& x, const ContinuationOptions& options)
    : system_(system), options_(options), n_(system.size), p_(system.constants), units_(n_ + 1) {
  for (std::size_t i = 0; i < n_; ++i) units_[i] = std::max(std::abs(x[i]), 1.0);
  units_[n_] = options.high - options.low;
}

Vector EquilibriumSteps::f(const Vector& z) {
  Vector result(n_);
  p_[options_.constant] = constant_of(z);
  system_.derivative(options_.t, state_of(z), p_, result);
  return result;
}

Vector EquilibriumSteps::scaled(const Vector& x, double constant) const {
  Vector z(x);
  z.push_back(constant);
  for (std::size_t i = 0; i <= n_; ++i) z[i] /= units_[i];
  return z;
}

Vector EquilibriumSteps::state_of(const Vector& z) const {
  Vector x(n_);
  for (std::size_t i = 0; i < n_; ++i) x[i] = z[i] * units_[i];
  return x;
}

/// What is small of each constant: of that which moves a part of its range, for its value may be zero on the way.
Vector EquilibriumSteps::sizes_of_constants() const {
  Vector sizes(p_);
  for (double& size : sizes) size = size == 0 ? 1 : std::abs(size);
  sizes[options_.constant] = units_[n_] / 100;
  return sizes;
}

/// df/dz, n rows of n + 1.
Vector EquilibriumSteps::jacobian(const Vector& z) {
  p_[options_.constant] = constant_of(z);
  const Vector x = state_of(z), by_x = jacobian_of(system_, options_.t, x, p_),
               by_p = constant_jacobian_of(system_, options_.t, x, p_, sizes_of_constants());
  Vector rows(n_ * (n_ + 1));
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) rows[i * (n_ + 1) + j] = by_x[i * n_ + j] * units_[j];
    rows[i * (n_ + 1) + n_] = by_p[i * p_.size() + options_.constant] * units_[n_];
  }
  return rows;
}

/// (df/dz; last row) y = b. Empty where it is singular.
Vector EquilibriumSteps::solved(const Vector& rows, const Vector& last, Vector b) const {
  DenseLU<double, run_time_size> lu(n_ + 1);
  auto&& matrix = lu.matrix();
  std::ranges::copy(rows, matrix.begin());
  std::ranges::copy(last, matrix.begin() + static_cast<std::ptrdiff_t>(n_ * (n_ + 1)));
  if (!lu.factor()) return {};
  lu.solve(b.data());
  return b;
}

/// Newton to f = 0 with (z - guess) . tangent = 0; at fixed constant where `at_constant`.
std::optional<Vector> EquilibriumSteps::corrected(const Vector& guess, Vector z, const Vector& tangent,
                                                  bool at_constant) {
  Vector last(tangent);
  if (at_constant) {
    last.assign(n_ + 1, 0.0);
    last[n_] = 1;
  }
  const auto correct = [&]() -> NewtonCorrection {
    Vector b(n_ + 1);
    p_[options_.constant] = constant_of(z);
    system_.derivative(options_.t, state_of(z), p_, std::span(b).first(n_));
    for (std::size_t i = 0; i <= n_; ++i) b[n_] += (z[i] - guess[i]) * last[i];
    const Vector step = solved(jacobian(z), last, b);
    if (step.empty()) return NewtonEnding::singular;
    double size = 0;
    for (std::size_t i = 0; i <= n_; ++i) {
      z[i] -= step[i];
      size = std::max(size, std::abs(step[i]) / std::max(1.0, std::abs(z[i])));
    }
    return size;
  };
  constexpr NewtonLimits limits{.most_iterations = 12, .solved_to = 1e-13, .rounding = 1e-9, .farthest = 1e6};
  return newton_iteration(limits, correct) ? std::optional(z) : std::nullopt;
}

/// The tangent nearest to `along`, eigenvalues and tests.
EquilibriumPlace EquilibriumSteps::described(Vector z, const Vector& along) {
  EquilibriumPlace place{.z = std::move(z), .tangent = {}, .point = {}};
  const Vector rows = jacobian(place.z);
  Vector last(along), b(n_ + 1);
  b[n_] = 1;
  if (last.empty()) {
    last.assign(n_ + 1, 0.0);
    last[n_] = 1;
  }
  place.tangent = solved(rows, last, b);
  if (place.tangent.empty()) {  // a fold just here: any other row will do
    for (std::size_t i = 0; i < n_ && place.tangent.empty(); ++i) {
      last.assign(n_ + 1, 0.0);
      last[i] = 1;
      place.tangent = solved(rows, last, b);
    }
  }
  normalize(place.tangent);
  Vector square(rows);
  square.insert(square.end(), place.tangent.begin(), place.tangent.end());
  double sign = 1;
  for (const auto& value : eigenvalues(square, n_ + 1).values)
    if (value.imag() == 0 && value.real() < 0) sign = -sign;
  place.direction_sign = sign;
  describe(place);
  return place;
}

void EquilibriumSteps::describe(EquilibriumPlace& place) {
  place.point.constant = constant_of(place.z);
  place.point.x = state_of(place.z);
  p_[options_.constant] = place.point.constant;
  const Equilibrium equilibrium = describe_equilibrium(system_, place.point.x, p_, options_.t);
  place.point.eigenvalues = equilibrium.eigenvalues;
  place.point.stability = equilibrium.stability;
  place.hopf_test = 1;
  const auto& values = place.point.eigenvalues;
  double size = 0;
  for (const auto& value : values) size = std::max(size, std::abs(value));
  std::complex<double> product = 1;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t j = i + 1; j < values.size(); ++j)
      if (std::abs(values[i] + values[j]) > rounding_of_sum * size) product *= (values[i] + values[j]) / size;
  place.hopf_test = product.real();
}

std::optional<EquilibriumPlace> EquilibriumSteps::stepped(const EquilibriumPlace& from, double step) {
  auto z = arclength_step(from.z, from.tangent, step, {},
                          [&](const Vector& guess) { return corrected(guess, guess, from.tangent, false); });
  return z ? std::optional(described(std::move(*z), from.tangent)) : std::nullopt;
}

}  // namespace continuo::studies::detail
