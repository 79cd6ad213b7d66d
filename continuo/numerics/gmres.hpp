// A linear system whose matrix is known by what it does to a vector only: the generalised method of minimal residuals
// (GMRES), restarted. Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986).
//
//   Gmres<std::vector<double>> gmres(b, 30);
//   gmres.solve([&](const auto& v, auto& product) { ... }, b, 1e-8, 300);  // b becomes the solution
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <continuo/numerics/finite.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo {

/// Keeps its vectors from call to call: only the constructor allocates.
template <State X>
class Gmres {
 public:
  using Real = Scalar<X>;

  /// For vectors like x; `most_vectors` are orthogonalised before a restart.
  Gmres(const X& x, std::size_t most_vectors)
      : directions_(std::clamp(dimension(x), std::size_t{1}, most_vectors)),
        basis_(directions_ + 1, x),
        solution_(x),
        right_(x),
        triangle_(directions_ * directions_),
        cosine_(directions_),
        sine_(directions_),
        rest_(directions_ + 1) {}

  /// How a solution went.
  struct Result {
    std::size_t products = 0;  // of the matrix with a vector
    bool converged = false;    // else the solution is the best found
  };

  /// b becomes the solution of A y = b, up to a residual of the length `target`. apply(v, product) writes A v. Where
  /// something is not finite the solution is not either.
  template <class Apply>
  Result solve(Apply&& apply, X& b, const Real& target, std::size_t most_products) {
    Result result;
    right_ = b;
    fill(solution_, Real(0));
    basis_[0] = right_;
    for (;;) {
      Real length = euclidean_norm(basis_[0]);
      if (!detail::is_finite(length)) return give_up(b, result);
      if (length <= target) {
        result.converged = true;
        break;
      }
      if (result.products >= most_products) break;
      const std::size_t columns = cycle(apply, length, target, most_products, result);
      if (!detail::is_finite(length)) return give_up(b, result);
      add_to_solution(columns);
      if (length <= target) {
        result.converged = true;
        break;
      }
      apply(solution_, basis_[0]);
      ++result.products;
      for (std::size_t i = 0; i < dimension(right_); ++i) basis_[0].data()[i] = right_.data()[i] - basis_[0].data()[i];
    }
    b = solution_;
    return result;
  }

 private:
  // The basis grows from the residual in basis_[0] of the given length, which becomes that of the residual after.
  // Returns the number of directions.
  template <class Apply>
  [[nodiscard]] std::size_t cycle(Apply& apply, Real& length, const Real& target, std::size_t most_products,
                                  Result& result) {
    scale(basis_[0], Real(1) / length);
    rest_[0] = length;
    std::size_t k = 0;
    while (k < directions_ && result.products < most_products) {
      X& next = basis_[k + 1];
      apply(basis_[k], next);
      ++result.products;
      const Real below = orthogonalise(k, next);
      if (!rotate(k, below)) break;
      length = abs_of(rest_[k + 1]);
      ++k;
      if (!detail::is_finite(length) || length <= target || below == Real(0)) break;
      scale(next, Real(1) / below);
    }
    return k;
  }

  // Modified Gram-Schmidt; column k of the Hessenberg matrix goes into the triangle, what is left below the diagonal is
  // returned. Once more where so much was taken away that rounding is what remains.
  [[nodiscard]] Real orthogonalise(std::size_t k, X& next) {
    for (std::size_t j = 0; j <= k; ++j) entry(j, k) = Real(0);
    const Real before = euclidean_norm(next);
    Real after = before;
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t j = 0; j <= k; ++j) {
        const X& direction = basis_[j];
        Real part(0);
        for (std::size_t i = 0; i < dimension(next); ++i) part += direction.data()[i] * next.data()[i];
        for (std::size_t i = 0; i < dimension(next); ++i) next.data()[i] -= part * direction.data()[i];
        entry(j, k) += part;
      }
      after = euclidean_norm(next);
      if (after > Real(0.001) * before) break;
    }
    return after <= std::numeric_limits<Real>::epsilon() * before ? Real(0) : after;
  }

  // Givens rotations make the Hessenberg matrix a triangle, column by column; rest_ is the right-hand side with them.
  // False where the matrix maps the direction to nothing that the others do not give.
  [[nodiscard]] bool rotate(std::size_t k, const Real& below) {
    using std::max, std::sqrt;
    Real greatest = below;
    for (std::size_t j = 0; j <= k; ++j) greatest = max(greatest, abs_of(entry(j, k)));
    for (std::size_t j = 0; j < k; ++j) {
      const Real upper = entry(j, k), lower = entry(j + 1, k);
      entry(j, k) = cosine_[j] * upper + sine_[j] * lower;
      entry(j + 1, k) = cosine_[j] * lower - sine_[j] * upper;
    }
    const Real diagonal = entry(k, k), size = sqrt(diagonal * diagonal + below * below);
    if (size <= 10 * std::numeric_limits<Real>::epsilon() * greatest) return false;
    cosine_[k] = diagonal / size;
    sine_[k] = below / size;
    entry(k, k) = size;
    rest_[k + 1] = -sine_[k] * rest_[k];
    rest_[k] *= cosine_[k];
    return true;
  }

  void add_to_solution(std::size_t columns) {
    for (std::size_t k = columns; k-- > 0;) {
      Real sum = rest_[k];
      for (std::size_t j = k + 1; j < columns; ++j) sum -= entry(k, j) * rest_[j];
      rest_[k] = sum / entry(k, k);
      for (std::size_t i = 0; i < dimension(solution_); ++i) solution_.data()[i] += rest_[k] * basis_[k].data()[i];
    }
  }

  [[nodiscard]] Result give_up(X& b, Result result) {
    fill(b, std::numeric_limits<Real>::quiet_NaN());
    result.converged = false;
    return result;
  }

  [[nodiscard]] Real& entry(std::size_t row, std::size_t column) { return triangle_[column * directions_ + row]; }
  [[nodiscard]] static Real abs_of(const Real& value) { return value < Real(0) ? Real(-value) : value; }
  static void fill(X& x, const Real& value) { std::fill(x.data(), x.data() + dimension(x), value); }
  static void scale(X& x, const Real& factor) {
    for (std::size_t i = 0; i < dimension(x); ++i) x.data()[i] *= factor;
  }

  std::size_t directions_;
  std::vector<X> basis_;
  X solution_, right_;
  std::vector<Real> triangle_, cosine_, sine_, rest_;
};

}  // namespace continuo
