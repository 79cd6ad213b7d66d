// Newton's method on f(x, p) = 0, mu(x, p) = 0, mu being the real eigenvalue of df/dx that is nearest to zero.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/orbits/curves/saddle_node.hpp>
#include <continuo/studies/orbits/curves/saddle_spaces.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Index = Eigen::Index;

constexpr double leaves_by_at_most = 0.1;  // in sizes

class FoldEquations {
 public:
  FoldEquations(const ParametricSystem& system, std::size_t constant, const Values& p, const Values& sizes,
                double size_of_constant)
      : system_(system), constant_(constant), p_(p.begin(), p.end()), sizes_(sizes.begin(), sizes.end()) {
    sizes_.push_back(size_of_constant);
  }

  /// In rates; nothing where df/dx has no such eigenvalue. v: x and the constant, in sizes.
  std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& v) {
    const Eigen::MatrixXd a = matrix_at(v);
    if (!a.allFinite()) return std::nullopt;
    const double rate = a.norm();
    const auto spaces = saddle_node_spaces(a, stable_of(a));
    if (!spaces || !(rate > 0)) return std::nullopt;
    const std::size_t n = system_.size;
    Vector f(n);
    system_.derivative(0, state(v), constants(v), f);
    Eigen::VectorXd result(v.size());
    for (std::size_t i = 0; i < n; ++i) result(static_cast<Index>(i)) = f[i] / (sizes_[i] * rate);
    result(v.size() - 1) = spaces->centre->eigenvalue / rate;
    return result;
  }

  Vector state(const Eigen::VectorXd& v) const {
    Vector x(system_.size);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = v(static_cast<Index>(i)) * sizes_[i];
    return x;
  }
  Vector constants(const Eigen::VectorXd& v) const {
    Vector p(p_);
    p[constant_] = v(v.size() - 1) * sizes_.back();
    return p;
  }
  Eigen::MatrixXd matrix_at(const Eigen::VectorXd& v) const {
    const std::size_t n = system_.size;
    const Vector a = jacobian_of(system_, 0, state(v), constants(v), Values(sizes_).first(n));
    Eigen::MatrixXd matrix(static_cast<Index>(n), static_cast<Index>(n));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        matrix(static_cast<Index>(i), static_cast<Index>(j)) = a[i * n + j] * sizes_[j] / sizes_[i];
    return matrix;
  }
  /// How many eigenvalues lie to the left of the one nearest to zero.
  static std::size_t stable_of(const Eigen::MatrixXd& a) {
    const auto values = a.eigenvalues().eval();
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& value : values)
      if (std::abs(value) < std::abs(nearest)) nearest = value.real();
    return static_cast<std::size_t>(
        std::ranges::count_if(values, [&](const auto& value) { return value.real() < nearest; }));
  }

 private:
  const ParametricSystem& system_;
  std::size_t constant_;
  Vector p_, sizes_;
};

}  // namespace

std::optional<SaddleNode> saddle_node_near(const ParametricSystem& system, std::size_t constant, const Values& x,
                                           const Values& p, const Values& sizes, double size_of_constant) {
  FoldEquations equations(system, constant, p, sizes, size_of_constant);
  const auto n = static_cast<Index>(system.size);
  Eigen::VectorXd v(n + 1);
  for (Index i = 0; i < n; ++i) v(i) = x[static_cast<std::size_t>(i)] / sizes[static_cast<std::size_t>(i)];
  v(n) = p[constant] / size_of_constant;
  const Eigen::VectorXd begin(v);
  const auto correct = [&]() -> NewtonCorrection {
    const auto at = equations.residuals(v);
    if (!at) return NewtonEnding::not_finite;
    Eigen::MatrixXd matrix(n + 1, n + 1);
    for (Index j = 0; j <= n; ++j) {
      const double step = central_increment(0.0, 1.0);
      const auto [above, below] = on_both_sides(v(j), step, [&] { return equations.residuals(v); });
      if (!above || !below) return NewtonEnding::not_finite;
      matrix.col(j) = (*above - *below) / (2 * step);
    }
    const Eigen::VectorXd change = matrix.fullPivLu().solve(*at);
    v -= change;
    if ((v - begin).cwiseAbs().maxCoeff() > leaves_by_at_most) return NewtonEnding::diverged;
    return change.norm();
  };
  constexpr NewtonLimits limits{.most_iterations = 20, .solved_to = 1e-10, .rounding = 1e-6};
  if (!newton_iteration(limits, correct)) return std::nullopt;
  return SaddleNode{equations.state(v), equations.constants(v), FoldEquations::stable_of(equations.matrix_at(v))};
}

}  // namespace continuo::studies::detail
