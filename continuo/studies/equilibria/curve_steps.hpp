// One place after the other on a curve of folds or Hopf points: predicted along the tangent, corrected by Newton's
// iteration. Internal to bifurcation_curve.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include <continuo/studies/bifurcation_curve.hpp>
#include <continuo/studies/equilibria/critical_space.hpp>

namespace continuo::studies::detail {

/// z: x and, behind it, both constants; in units in which all are about 1.
struct CurvePlace {
  std::vector<double> z{};
  std::vector<double> tangent{};  // of length 1
  CriticalSpace space{};
  CurvePoint point{};
  /// By Degeneracy; each changes its sign there. Not a number where it cannot be on this curve.
  std::array<double, 5> tests{};
  [[nodiscard]] double test(Degeneracy kind) const { return tests[static_cast<std::size_t>(kind)]; }
};

class CurveSteps {
 public:
  CurveSteps(const ParametricSystem& system, const CurveStart& start, const CurveOptions& options);

  [[nodiscard]] std::vector<double> scaled(const std::vector<double>& x, const std::array<double, 2>& constants) const;
  [[nodiscard]] std::vector<double> state_of(const std::vector<double>& z) const;
  [[nodiscard]] std::array<double, 2> constants_of(const std::vector<double>& z) const;
  [[nodiscard]] double unit(std::size_t unknown) const { return units_[unknown]; }
  [[nodiscard]] std::size_t size() const { return n_; }

  /// df/dx in units, without unknowns of algebraic equations; empty where these do not determine them.
  [[nodiscard]] std::vector<double> matrix(const std::vector<double>& z);
  [[nodiscard]] std::size_t matrix_size() const { return system_.differential(); }

  /// Newton to f = 0, test = 0 and (z - guess) . last = 0.
  struct Found {
    std::vector<double> z;
    CriticalSpace space;
  };
  [[nodiscard]] std::optional<Found> corrected(const std::vector<double>& guess, const CriticalSpace& near,
                                               const std::vector<double>& last);
  /// With the tangent nearest to `along`, eigenvalues and tests.
  [[nodiscard]] std::optional<CurvePlace> described(Found found, const std::vector<double>& along);
  /// Nothing where none is found, or only one that is farther off than the step is long.
  [[nodiscard]] std::optional<CurvePlace> stepped(const CurvePlace& from, double step);
  /// A direction along the curve, where none is known.
  [[nodiscard]] std::optional<CurvePlace> first(const std::vector<double>& z, const CriticalSpace& near);

 private:
  [[nodiscard]] std::vector<double> f(const std::vector<double>& z);
  [[nodiscard]] std::vector<double> jacobian(const std::vector<double>& z);
  void set(const std::vector<double>& z);
  [[nodiscard]] std::vector<double> sizes_of_constants() const;
  /// df/dz and, below it, that of the test; nothing where the matrix is not known nearby.
  [[nodiscard]] std::optional<std::vector<double>> rows_at(const std::vector<double>& z, const CriticalSpace& space);
  [[nodiscard]] double turning(const CurvePlace& place, const std::vector<double>& rows) const;
  void set_tests(CurvePlace& place, const std::vector<double>& rows);

  const ParametricSystem& system_;
  const CurveOptions& options_;
  std::size_t n_;
  std::vector<double> p_, units_;
};

}  // namespace continuo::studies::detail
