// One place after the other on a branch of equilibria: predicted along the tangent, corrected by Newton's iteration.
// Internal to continuation.
#pragma once
#include <optional>
#include <vector>

#include <continuo/studies/continuation.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

/// Of the largest eigenvalue: so small a sum of two may be what rounding leaves of zero.
inline constexpr double rounding_of_sum = 1e-10;

/// A place on the branch: x and, behind it, the constant; in units in which all are about 1.
struct EquilibriumPlace {
  std::vector<double> z;
  std::vector<double> tangent;  // of length 1
  double direction_sign = 0;    // of det (df/dz; tangent): changes where another branch crosses
  BranchPoint point;
  /// The product of the sums of all pairs of eigenvalues, which changes its sign where one pair passes the axis;
  /// without the sums that rounding alone may keep from zero, for what is conserved keeps a pair there all along.
  double hopf_test = 0;
};

class EquilibriumSteps {
 public:
  /// x: what is usual, for its units.
  EquilibriumSteps(const ParametricSystem& system, const std::vector<double>& x, const ContinuationOptions& options);

  [[nodiscard]] std::vector<double> scaled(const std::vector<double>& x, double constant) const;
  [[nodiscard]] double constant_of(const std::vector<double>& z) const { return z[n_] * units_[n_]; }
  [[nodiscard]] std::vector<double> state_of(const std::vector<double>& z) const;
  [[nodiscard]] double unit(std::size_t unknown) const { return units_[unknown]; }

  [[nodiscard]] std::vector<double> f(const std::vector<double>& z);
  /// df/dz, n rows of n + 1.
  [[nodiscard]] std::vector<double> jacobian(const std::vector<double>& z);
  /// Newton to f = 0 with (z - guess) . tangent = 0; at fixed constant where `at_constant`.
  [[nodiscard]] std::optional<std::vector<double>> corrected(const std::vector<double>& guess, std::vector<double> z,
                                                             const std::vector<double>& tangent, bool at_constant);
  /// The tangent nearest to `along`, eigenvalues and tests.
  [[nodiscard]] EquilibriumPlace described(std::vector<double> z, const std::vector<double>& along);
  /// The point and the tests alone.
  void describe(EquilibriumPlace& place);
  /// Forwards or, with a step below 0, back. Nothing where none is found, or only one that is farther off than the step
  /// is long.
  [[nodiscard]] std::optional<EquilibriumPlace> stepped(const EquilibriumPlace& from, double step);

 private:
  [[nodiscard]] std::vector<double> sizes_of_constants() const;
  [[nodiscard]] std::vector<double> solved(const std::vector<double>& rows, const std::vector<double>& last,
                                           std::vector<double> b) const;

  const ParametricSystem& system_;
  const ContinuationOptions& options_;
  std::size_t n_;
  std::vector<double> p_, units_;
};

}  // namespace continuo::studies::detail
