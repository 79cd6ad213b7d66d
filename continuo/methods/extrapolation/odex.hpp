// The method of Gragg, Bulirsch and Stoer: the explicit midpoint rule, extrapolated, of variable order 4 to 18 and
// variable step. W. B. Gragg, "On extrapolation algorithms for ordinary initial value problems", SIAM J. Numer. Anal. 2
// (1965); R. Bulirsch, J. Stoer, Numer. Math. 8 (1966); E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary
// Differential Equations I", II.9, with the name of their program.
//
// With H = h / n, y_0 = x and y_1 = x + H f_0, the rule is y_(i+1) = y_(i-1) + 2 H f_i. For an even n the error of y_n
// is a series in H^2 (Gragg). His smoothing at the end is left out: it is not necessary (L. F. Shampine, L. S. Baca,
// "Smoothing the extrapolated midpoint rule", Numer. Math. 41 (1983)), and costs an evaluation in each row.
//
// Dense output (E. Hairer, A. Ostermann, "Dense output for extrapolation methods", Numer. Math. 58 (1990)): with
// n = 2, 6, 10, ... the middle of the step is y_(n/2), n / 2 odd. The central differences
//
//   (2 H)^-q delta^q f = (2 H)^-q sum_p (-1)^p (q over p) f_(n/2 + q - 2 p)
//
// of each row approximate x^(q+1) there. They are series in H^2 too, because all f of one difference have the same
// parity of i, and are extrapolated from all rows with enough values of f. After k rows the polynomial of degree 2 k -
// 1 with these derivatives of orders 0 to 2 k - 5 in the middle, and with the value and the slope at both ends, has
// order 2 k - 1.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <continuo/methods/extrapolation/extrapolation_method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>

namespace continuo {

/// For smooth problems and strict tolerances. Steps of a fixed size have order 8.
struct Odex : ExtrapolationMethod<Odex> {
  static constexpr std::array<int, 9> numbers{2, 6, 10, 14, 18, 22, 26, 30, 34};
  static constexpr int power = 2;
  static constexpr std::size_t starting_rows = 4;
  static constexpr std::string_view name = "odex";
  static constexpr int order = 18, error_order = 16, starting_order = 8, dense_degree = 17, dense_order = 17;
  static constexpr int order_of_fixed_steps = 8;
  static constexpr std::array safety{0.65, 0.94};
  static constexpr double patience = 1;
  static constexpr double dense_looseness = 5;  // tolerances of the error within a step

  template <State X>
  struct Workspace : ExtrapolationTable<X, numbers.size()> {
    using Real = Scalar<X>;
    std::array<X, 153> f;                   // f_1 to f_(n - 1) of each row, row after row
    std::array<X, numbers.size()> middles;  // y_(n / 2) - x of each row
    X slope, end_slope;                     // at the ends of the step
    X even, odd, argument;                  // y_i - x for even i, for odd i; y_i
    Tolerance<Real> tolerance{Real(1e-6), Real(1e-9)};
    bool has_slope = false, has_end_slope = false;

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      ExtrapolationTable<X, numbers.size()>::transfer(archive);
      archive(slope, end_slope, has_slope, has_end_slope);
    }

    explicit Workspace(const X& x)
        : ExtrapolationTable<X, numbers.size()>(x, starting_rows),
          slope(x),
          end_slope(x),
          even(x),
          odd(x),
          argument(x) {
      f.fill(x);
      middles.fill(x);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return Workspace<X>(x);
  }
  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    work.tolerance = tolerance;
  }
  /// Of T_jj - T_(j-1,j-1): T_jj - T_(j,j-1) is so much smaller, and too small if f jumps within the step.
  [[nodiscard]] static constexpr double caution(std::size_t j) {
    return static_cast<double>(numbers[j - 1] * numbers[j - 1] / (numbers[0] * numbers[0]));
  }
  [[nodiscard]] static constexpr double cost(std::size_t j) { return static_cast<double>(1 + first_of(j + 1)); }

  template <State X>
  [[nodiscard]] static std::size_t least_rows(const Workspace<X>&) {
    return 2;
  }

  template <class System, State X>
  static int begin(System& system, const Scalar<X>& t, const X& x, const Scalar<X>&, bool discontinuity,
                   Workspace<X>& work) {
    work.has_end_slope = false;
    if (work.has_slope && !discontinuity) return 0;
    evaluate(system, t, x, work.slope);
    work.has_slope = true;
    return 1;
  }

  template <class System, State X>
  static int row(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, std::size_t j,
                 Workspace<X>& work) {
    using Real = Scalar<X>;
    const std::size_t n = static_cast<std::size_t>(numbers[j - 1]), size = dimension(x);
    const Real substep = h / Real(static_cast<double>(n)), twice = 2 * substep;
    for (std::size_t i = 0; i < size; ++i) {
      work.even.data()[i] = Real(0);
      work.odd.data()[i] = substep * work.slope.data()[i];
    }
    X* f = &work.f[first_of(j)];
    for (std::size_t k = 1; k < n; ++k, ++f) {
      X& here = k % 2 == 0 ? work.even : work.odd;
      X& next = k % 2 == 0 ? work.odd : work.even;
      if (2 * k == n) work.middles[j - 1] = here;
      for (std::size_t i = 0; i < size; ++i) work.argument.data()[i] = x.data()[i] + here.data()[i];
      evaluate(system, Real(t + Real(static_cast<double>(k)) * substep), work.argument, *f);
      for (std::size_t i = 0; i < size; ++i) next.data()[i] += twice * f->data()[i];
    }
    work.table[j - 1] = work.even;
    return static_cast<int>(n) - 1;
  }

  /// Evaluates f at the end of the step, where the next step begins, and estimates the error of the dense output: a
  /// step may exceed the radius of convergence of the series in the middle, where the polynomial does not converge.
  template <class System, State X>
  static int finish(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                    Workspace<X>& work) {
    using Real = Scalar<X>;
    if (work.computed < 2) return 0;
    evaluate(system, Real(t + h), x_new, work.end_slope);
    work.has_end_slope = true;
    const std::size_t degree = 2 * work.computed - 1;
    const Differences<Real>& differences = differences_of<Real>(work.computed);
    const Real factor = nodes_of<Real>(work.computed) / Real(dense_looseness);
    const Real dense = root_mean_square<Real>(dimension(x), [&](std::size_t i) {
      const Real last = coefficients(work, h, differences, i)[degree];
      return Real(factor * last / work.tolerance.scale(i, x.data()[i], x_new.data()[i]));
    });
    work.least_error = detail::greater(work.least_error, dense);
    return 1;
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>& h, const X&, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    const Differences<Real>& differences = differences_of<Real>(work.computed);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      std::array<Real, dense_degree + 1> c = coefficients(work, h, differences, i);
      move_origin(c, 2 * work.computed - 1, Real(0.5));
      interpolant.c[0].data()[i] = x.data()[i];
      for (std::size_t m = 1; m < c.size(); ++m) interpolant.c[m].data()[i] = c[m];
    }
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    accept_rows(work);
    std::swap(work.slope, work.end_slope);
    work.has_slope = work.has_end_slope;
    work.has_end_slope = false;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.has_slope = false;
  }

  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.slope;
  }

 private:
  /// The place of f_1 of row j.
  [[nodiscard]] static constexpr std::size_t first_of(std::size_t j) { return (j - 1) * (2 * j - 3); }

  /// The factors of all f in h^q x^(q+1) / (q + 1)! in the middle of a step of k rows.
  template <class Real>
  class Differences {
   public:
    Differences() = default;
    explicit Differences(std::size_t k) : rows_(k) {
      for (std::size_t j = 1; j <= k; ++j) middle_[j - 1] = weight<Real>(j, 1, k);
      Real factorial(1);  // (q + 1)!
      for (std::size_t q = 0; q + 5 < 2 * k; ++q) {
        factorial *= Real(static_cast<double>(q) + 1);
        for (std::size_t j = first_row(q); j <= k; ++j) {
          // (h / 2 H)^q = (n / 2)^q.
          Real factor = weight<Real>(j, first_row(q), k) / factorial;
          for (std::size_t m = 0; m < q; ++m) factor *= Real(numbers[j - 1] / 2);
          factors_[q][j - 1] = factor;
        }
        binomials_[q][0] = Real(1);
        for (std::size_t p = 1; p <= q; ++p)
          binomials_[q][p] = binomials_[q - 1][p - 1] * Real(-1) + (p < q ? binomials_[q - 1][p] : Real(0));
      }
    }

    /// The weight of y_(n/2) of row j.
    [[nodiscard]] const Real& middle(std::size_t j) const { return middle_[j - 1]; }
    /// f(p) is a component of Workspace::f[p].
    template <class Component>
    [[nodiscard]] Real sum(std::size_t q, const Component& f) const {
      Real sum(0);
      for (std::size_t j = first_row(q); j <= rows_; ++j) {
        // f_(n/2 + q), and down from there.
        const std::size_t highest = first_of(j) + static_cast<std::size_t>(numbers[j - 1] / 2) + q - 1;
        Real difference(0);
        for (std::size_t p = 0; p <= q; ++p) difference += binomials_[q][p] * f(highest - 2 * p);
        sum += factors_[q][j - 1] * difference;
      }
      return sum;
    }

   private:
    static constexpr std::size_t most_differences = 2 * numbers.size() - 5;

    /// The first row with f_(n/2 - q) to f_(n/2 + q).
    [[nodiscard]] static constexpr std::size_t first_row(std::size_t q) { return (q + 1) / 2 + 1; }

    std::size_t rows_ = 0;
    std::array<Real, numbers.size()> middle_{};
    std::array<std::array<Real, numbers.size()>, most_differences> factors_{};
    std::array<std::array<Real, most_differences>, most_differences> binomials_{};  // with their signs
  };

  /// Of component i of the dense output: of the powers of theta - 1/2, of the change since x.
  template <State X>
  [[nodiscard]] static std::array<Scalar<X>, dense_degree + 1> coefficients(const Workspace<X>& work,
                                                                            const Scalar<X>& h,
                                                                            const Differences<Scalar<X>>& differences,
                                                                            std::size_t i) {
    using Real = Scalar<X>;
    const std::size_t k = work.computed, derivatives = 2 * k - 4;  // in the middle, of orders 0, 1, ...
    std::array<Real, dense_degree + 1> c{};
    if (derivatives > 0) {
      for (std::size_t j = 1; j <= k; ++j) c[0] += differences.middle(j) * work.middles[j - 1].data()[i];
      for (std::size_t q = 0; q + 1 < derivatives; ++q)
        c[q + 1] = h * differences.sum(q, [&](std::size_t p) { return work.f[p].data()[i]; });
    }
    fit_ends(derivatives, Real(h * work.slope.data()[i]), work.table[0].data()[i], Real(h * work.end_slope.data()[i]),
             c);
    return c;
  }

  /// The greatest value of (s^2)^(k-2) (1/4 - s^2)^2 for |s| < 1/2, at s^2 = (k - 2) / 4 k: times the next divided
  /// difference, the error of the dense output of k rows. The last coefficient, a divided difference too, replaces it.
  template <class Real>
  [[nodiscard]] static Real nodes_of(std::size_t k) {
    const auto rows = static_cast<Real>(static_cast<double>(k)), square = static_cast<Real>((rows - 2) / (4 * rows));
    Real product = (Real(0.25) - square) * (Real(0.25) - square);
    for (std::size_t i = 2; i < k; ++i) product *= square;
    return product;
  }

  template <class Real>
  [[nodiscard]] static const Differences<Real>& differences_of(std::size_t rows) {
    static const std::array<Differences<Real>, numbers.size() + 1> all = [] {
      std::array<Differences<Real>, numbers.size() + 1> result;
      for (std::size_t k = 2; k < result.size(); ++k) result[k] = Differences<Real>(k);
      return result;
    }();
    return all[rows];
  }

  /// With s = theta - 1/2 and m coefficients known, m even: adds s^m times the cubic g that gives the value 0 and the
  /// slope `first` where the step begins, `change` and `last` where it ends.
  template <class Real>
  static void fit_ends(std::size_t m, const Real& first, const Real& change, const Real& last,
                       std::array<Real, dense_degree + 1>& c) {
    // Value and slope of s^m g at the start and at the end.
    std::array<Real, 2> value{Real(0), change}, slope{first, last};
    Real half(1);  // 2^-j
    for (std::size_t j = 0; j < m; ++j, half /= 2) {
      const Real sign(j % 2 == 0 ? 1 : -1);
      const auto times = static_cast<Real>(static_cast<double>(j));
      value[0] -= sign * half * c[j];
      value[1] -= half * c[j];
      slope[0] += sign * times * 2 * half * c[j];
      slope[1] -= times * 2 * half * c[j];
    }
    // Those of g, at s = -1/2 and 1/2.
    const auto twice_m = static_cast<Real>(2 * static_cast<double>(m));
    for (std::size_t end = 0; end < 2; ++end) value[end] /= half, slope[end] /= half;
    slope[0] += twice_m * value[0];
    slope[1] -= twice_m * value[1];
    const Real difference = value[1] - value[0], square = (slope[1] - slope[0]) / 2;
    const Real cube = slope[0] + slope[1] - 2 * difference;
    c[m] = (value[0] + value[1]) / 2 - square / 4;
    c[m + 1] = difference - cube / 4;
    c[m + 2] = square;
    c[m + 3] = cube;
  }
};

}  // namespace continuo
