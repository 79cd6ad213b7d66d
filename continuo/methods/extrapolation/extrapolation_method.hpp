// The stepper of extrapolation methods: a step of size h is computed with n_1 < n_2 < ... substeps of a basic method,
// and the results, whose errors are series in powers of the substep, are extrapolated to a substep of 0. E. Hairer, S.
// P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", II.9; P. Deuflhard, "Order and stepsize control
// in extrapolation methods", Numer. Math. 41 (1983).
//
// Row j of the table begins with the result T_j1 of n_j substeps, and with series in powers of (h / n)^p
//
//   T_(j,k+1) = T_jk + (T_jk - T_(j-1,k)) / ((n_j / n_(j-k))^p - 1).
//
// T_jj is the solution, and T_jj - T_(j,j-1) times a factor the error estimate, of order p (j - 1) + 1 in h. The step
// computes rows until the estimate is below the tolerance, and is rejected as soon as the estimates show that no row
// will reach it. The table contains changes x_new - x, whose rounding errors are smaller than those of x_new.
//
// A method is a struct with these members besides those of method.hpp:
//   M::numbers                 n_1, n_2, ...
//   M::power                   p
//   M::starting_rows           rows of steps of a fixed size, of the first step, and after a jump
//   M::cost(j)                 of the rows 1 to j, in evaluations of f
//   M::safety                  see longest
//   M::patience                how far an estimate may exceed its expected value; see finished
//   M::begin(system, t, x, h, discontinuity, work), M::row(system, t, x, h, j, work) -> number of evaluations;
//       row writes the change by n_j substeps to work.table[j - 1]
//   M::caution(j)              the factor of the error estimate of row j
//   M::least_rows(work)        the least number of rows that a step aims at
//   M::finish(system, t, x, h, x_new, work) -> number of evaluations; may set work.least_error
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// The table of a step and the choice of the number of rows; a base of the workspace.
template <State X, std::size_t most>
struct ExtrapolationTable {
  using Real = Scalar<X>;

  std::array<X, most> table;            // after row j: table[l] is T_(j,j-l) - x
  std::array<Real, most + 1> errors{};  // of row j, from 2 on, in tolerances
  std::size_t rows;                     // number of rows chosen for this step
  std::size_t computed = 0;             // number of rows computed
  std::size_t next_rows = 0;            // number of rows for the next step; 0: not chosen
  Real planned{};                       // size of the step for which `rows` was chosen; 0: not chosen
  Real least_error{};                   // a lower bound of the error in tolerances, besides the estimate
  bool controlled = false;              // whether the step size is adaptive
  bool was_rejected = false;            // whether the last try of this step was rejected

  ExtrapolationTable(const X& x, std::size_t starting_rows) : rows(starting_rows) { table.fill(x); }

  /// For checkpoints: what the next step depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    for (std::size_t* count : {&rows, &computed, &next_rows}) archive.index(*count, most);
    archive(errors, planned, least_error, controlled, was_rejected);
  }
};

template <class Derived>
struct ExtrapolationMethod {
  static constexpr bool second_order = false;

  template <class Work>
  [[nodiscard]] static int error_order_of(const Work& work) {
    return Derived::power * (static_cast<int>(work.computed) - 1);
  }

  template <class System, State X, class Work>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity, Work& work,
                  X& x_new) {
    using std::abs;
    if (discontinuity && !work.was_rejected) {
      work.rows = Derived::starting_rows;
      work.controlled = false;
      work.planned = Scalar<X>(0);
    }
    work.least_error = Scalar<X>(0);
    // A step that ends at a limit of the run is shorter than planned and may need fewer rows.
    const bool shortened = abs(h) < Scalar<X>(0.7) * work.planned;
    int evaluations = Derived::begin(system, t, x, h, discontinuity, work);
    for (std::size_t j = 1;; ++j) {
      work.computed = j;
      evaluations += Derived::row(system, t, x, h, j, work);
      if (detail::status_of<Derived>(work) != StepStatus::done) break;
      extrapolate(j, work);
      if (j > 1) work.errors[j] = norm_of_error(x, work, work.tolerance);
      if (finished(j, shortened, work)) break;
    }
    for (std::size_t i = 0; i < dimension(x); ++i) x_new.data()[i] = x.data()[i] + work.table[0].data()[i];
    if (detail::status_of<Derived>(work) != StepStatus::done) return evaluations;
    return evaluations + Derived::finish(system, t, x, h, x_new, work);
  }

  template <State X, class Work>
  [[nodiscard]] static Scalar<X> error_norm(const Work& work, const Scalar<X>&, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return detail::greater(norm_of_error(x, work, tolerance), work.least_error) + detail::zero_if_all_finite(x_new);
  }
  template <class Work, class Real>
  [[nodiscard]] static Real error_of(const Work& work, const Real&, std::size_t i) {
    if (work.computed < 2) return Real(0);
    return (work.table[0].data()[i] - work.table[1].data()[i]) * Real(Derived::caution(work.computed));
  }

  /// The number of rows with the least cost for a unit of time, and a step for it (Hairer, Norsett & Wanner, II.9).
  template <State X, class Work>
  [[nodiscard]] static Scalar<X> next_factor(Work& work, const Scalar<X>&, const Scalar<X>& h, const X&, const X&,
                                             const Tolerance<Scalar<X>>&) {
    using Real = Scalar<X>;
    using std::abs, std::max, std::min;
    const std::size_t last = work.computed;
    const bool was_shortened = abs(h) < Real(0.7) * work.planned;
    work.controlled = true;
    if (was_shortened) {  // its errors tell little about the next step
      work.next_rows = work.rows;
      work.planned = Real(0);
      return Real(1);
    }
    std::size_t rows = last;
    if (last == 2) {
      rows = 3;
    } else if (last <= work.rows) {
      if (work_of(last - 1, work) < Real(fewer) * work_of(last, work)) {
        rows = last - 1;
      } else if (work_of(last, work) < Real(more) * work_of(last - 1, work)) {
        rows = last + 1;
      }
    } else {
      rows = last - 1;
      if (last > 3 && work_of(last - 2, work) < Real(fewer) * work_of(last - 1, work)) rows = last - 2;
      if (work_of(last, work) < Real(more) * work_of(rows, work)) rows = last;
    }
    rows =
        min(max(rows, min(Derived::least_rows(work), last + 1)), work.was_rejected ? min(last, most_rows) : most_rows);
    const Real allowed = rows <= last ? longest(rows, work)
                                      : Real(longest(last, work) * Real(Derived::cost(rows) / Derived::cost(last)));
    const Real greatest(work.was_rejected ? 1 : greatest_factor);
    const Real factor = min(allowed, longest_for(work.least_error, last, greatest));
    work.next_rows = rows;
    work.planned = abs(h * factor);
    return factor;
  }

  template <class Work, class Real>
  static void rejected(Work& work, const Real& h_next) {
    using std::abs;
    work.controlled = work.was_rejected = true;
    work.planned = abs(h_next);
    const std::size_t last = std::min(work.computed, work.rows);
    if (last < 2) return;  // no estimate: f was not finite, or the equations were not solved
    work.rows = last > Derived::least_rows(work) && work_of(last - 1, work) < Real(fewer) * work_of(last, work)
                    ? last - 1
                    : last;
  }

 protected:
  static constexpr std::size_t most = Derived::numbers.size();
  static constexpr std::size_t most_rows = most - 1;  // chosen for a step, which may compute one more

  /// The part of M::accept for the number of rows.
  template <class Work>
  static void accept_rows(Work& work) {
    if (work.next_rows != 0) work.rows = work.next_rows;
    work.next_rows = 0;
    work.was_rejected = false;
  }

  /// p(theta) is the polynomial with these coefficients in theta - origin; coefficients in theta take their place.
  template <class Real, std::size_t size>
  static void move_origin(std::array<Real, size>& c, std::size_t degree, const Real& origin) {
    for (std::size_t i = 0; i < degree; ++i)
      for (std::size_t j = degree; j-- > i;) c[j] -= origin * c[j + 1];
  }

  /// The weight of row j where the rows `first` to `last` are extrapolated: the product of n_j^p / (n_j^p - n_l^p).
  template <class Real>
  [[nodiscard]] static Real weight(std::size_t j, std::size_t first, std::size_t last) {
    Real product(1);
    for (std::size_t l = first; l <= last; ++l)
      if (l != j) product *= number<Real>(j) / (number<Real>(j) - number<Real>(l));
    return product;
  }

 private:
  // The ratio of costs at which the number of rows changes: Hairer, Norsett & Wanner, II.9.
  static constexpr double fewer = 0.8, more = 0.9;
  // Bounds of a change of the step size; a further row may add to the second.
  static constexpr double least_factor = 0.1, greatest_of_row = 4, greatest_factor = 10;

  /// n_j^p.
  template <class Real>
  [[nodiscard]] static Real number(std::size_t j) {
    const auto n = static_cast<Real>(static_cast<double>(Derived::numbers[j - 1]));
    return Derived::power == 2 ? Real(n * n) : n;
  }

  template <class Work>
  static void extrapolate(std::size_t j, Work& work) {
    using Real = typename Work::Real;
    const std::size_t n = dimension(work.table[0]);
    for (std::size_t l = j - 1; l-- > 0;) {
      const Real divisor = number<Real>(j) / number<Real>(l + 1) - Real(1);
      const Real* upper = work.table[l + 1].data();
      Real* lower = work.table[l].data();
      for (std::size_t i = 0; i < n; ++i) lower[i] = upper[i] + (upper[i] - lower[i]) / divisor;
    }
  }

  template <State X, class Work>
  [[nodiscard]] static Scalar<X> norm_of_error(const X& x, const Work& work, const Tolerance<Scalar<X>>& tolerance) {
    if (work.computed < 2) return Scalar<X>(0);
    return root_mean_square<Scalar<X>>(dimension(x), [&](std::size_t i) {
      const Scalar<X>&here = x.data()[i], &change = work.table[0].data()[i];
      return Scalar<X>(error_of(work, here, i) / tolerance.scale_of_step(i, here, Scalar<X>(here + change)));
    });
  }

  /// Whether row j is the last one.
  template <class Work>
  [[nodiscard]] static bool finished(std::size_t j, bool shortened, Work& work) {
    using Real = typename Work::Real;
    using std::max, std::pow;
    if (!work.controlled) return j == work.rows;
    if (j == 1) return !detail::is_finite_state(work.table[0]);
    const Real error = work.errors[j];
    if (!(error < std::numeric_limits<Real>::infinity())) return true;
    if (j > 2 && error >= max(Real(1), Real(4 * work.errors[j - 1]))) {  // the table diverges: half the step
      work.least_error = pow(Real(1.5), Real(static_cast<double>(Derived::power * (static_cast<int>(j) - 1) + 1)));
      return true;
    }
    if (error <= Real(1)) return shortened || j + 1 >= work.rows;
    if (j + 1 < work.rows) return false;
    if (j == most || j > work.rows) return true;
    // A further row l divides T_jj - T_(j,j-1) by about (n_l / n_1)^p.
    const std::size_t last = work.rows + 1;
    auto hope = static_cast<Real>(Derived::caution(j) / Derived::caution(last));
    for (std::size_t l = j + 1; l <= last; ++l) hope *= Real(Derived::patience) * number<Real>(l) / number<Real>(1);
    return error > hope;
  }

  /// The longest step, in sizes of the last, that row j allows.
  template <class Work>
  [[nodiscard]] static auto longest(std::size_t j, const Work& work) {
    using Real = typename Work::Real;
    return longest_for(work.errors[j], j, Real(greatest_of_row));
  }
  /// For such an error of row j.
  template <class Real>
  [[nodiscard]] static Real longest_for(const Real& error, std::size_t j, const Real& greatest) {
    using std::clamp, std::max, std::pow;
    const Real exponent = Real(1) / Real(static_cast<double>(Derived::power * (static_cast<int>(j) - 1) + 1));
    const Real part = Real(Derived::safety[0]) / max(error, Real(1e-30));
    return clamp(Real(Real(Derived::safety[1]) * pow(part, exponent)), Real(least_factor), greatest);
  }
  /// For a unit of time.
  template <class Work>
  [[nodiscard]] static auto work_of(std::size_t j, const Work& work) {
    using Real = typename Work::Real;
    return Real(Real(Derived::cost(j)) / longest(j, work));
  }
};

}  // namespace continuo
