// GMRES for real and complex numbers, in components measured by the tolerance of each, where lengths are comparable.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/methods/linear_solver.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/numerics/gmres.hpp>
#include <continuo/status/status.hpp>

namespace continuo::detail {

/// A complex system is solved as the real one of twice its size.
template <class Number>
class WeightedGmres {
 public:
  using Parts = PartsOf<Number>;
  using Real = typename Parts::Real;

  /// b, preconditioned already, becomes the solution of A y = b; apply(v, image) writes A v, preconditioned, and
  /// scale(i) is the tolerance of component i. What is left of b is a millionth of the tolerance, or as small as
  /// rounding lets it be: methods that iterate would do with less, but those of Rosenbrock and extrapolation multiply
  /// an error of a stage by up to a thousand before it is seen.
  template <class Apply, class Scale>
  [[nodiscard]] Status solve(std::span<Number> b, Apply&& apply, Scale&& scale) {
    using std::max, std::sqrt;
    const std::size_t n = b.size(), count = Parts::count;
    if (!gmres_ || y_.size() != n * count) {
      y_.assign(n * count, Real(0));
      v_.assign(n, Number{});
      image_ = v_;
      gmres_.emplace(y_, most_vectors);
    }
    const auto weigh = [&](std::span<const Number> from, std::vector<Real>& to) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < count; ++k) to[i * count + k] = Parts::part(from[i], k) / scale(i);
    };
    const auto undo = [&](const std::vector<Real>& from, std::span<Number> to) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < count; ++k) Parts::part(to[i], k) = from[i * count + k] * scale(i);
    };
    weigh(b, y_);
    const Real rounding = 100 * std::numeric_limits<Real>::epsilon() * euclidean_norm(y_);
    const Real target = max(rounding, Real(Real(part_of_tolerance) * sqrt(static_cast<Real>(n * count))));
    const auto result = gmres_->solve(
        [&](const std::vector<Real>& v, std::vector<Real>& image) {
          undo(v, std::span<Number>(v_));
          apply(std::span<const Number>(v_), std::span<Number>(image_));
          weigh(std::span<const Number>(image_), image);
        },
        y_, target, most_products);
    const bool finite = is_finite_state(y_);
    undo(y_, b);
    if (result.converged) return {};
    if (!finite) return {Ending::not_finite, "a product with the Jacobian is not finite"};
    return {Ending::nonlinear_solve_failed,
            "GMRES does not converge within " + std::to_string(most_products) +
                " products with the Jacobian: give the system a preconditioner, or a better one"};
  }

 private:
  // Directions before a restart; products before the step is better made shorter.
  static constexpr std::size_t most_vectors = 50, most_products = 500;
  static constexpr double part_of_tolerance = 1e-6;

  std::optional<Gmres<std::vector<Real>>> gmres_;
  std::vector<Real> y_;
  std::vector<Number> v_, image_;
};

}  // namespace continuo::detail
