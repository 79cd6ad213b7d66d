// A compiled right-hand side at many points, as solve_bvp asks for it.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "native.hpp"

namespace continuo::python {

/// y' = f(x, (y, p)) of n components y and k constants p, which the compiled function takes for components n to
/// n + k - 1 with the derivative 0. Not for several threads at once.
class NativeAtPoints {
 public:
  /// Throws a ValueError where the function is one of another number of components.
  NativeAtPoints(Native native, std::size_t size, std::size_t parameters);

  /// Whether it knows its own derivatives.
  [[nodiscard]] bool has_jacobian() const { return native_.jacobian != nullptr; }
  /// f_i at the points x[q], at i * count + q, from y_i there. Throws a ValueError where a constant would change.
  void derivative(std::span<const double> x, std::span<const double> y, std::span<const double> p, std::span<double> f);
  /// df_i/dy_j at (i * n + j) * count + q and df_i/dp_l at (i * k + l) * count + q.
  void jacobian(std::span<const double> x, std::span<const double> y, std::span<const double> p, std::span<double> by_y,
                std::span<double> by_p);

 private:
  void gather(std::span<const double> y, std::size_t count, std::size_t point);

  Native native_;
  std::size_t n_, k_;
  std::vector<double> components_, slopes_, rows_;
};

}  // namespace continuo::python
