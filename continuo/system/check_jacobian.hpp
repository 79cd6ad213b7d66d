// Is what a system says of the derivatives of its f true? Each entry of df/dx and df/dt that it gives, and each that
// its pattern leaves out, against differences of f that know how far they can be trusted:
//
//   const JacobianCheck<double> check = check_jacobian(system, t, x);
//   for (const auto& entry : check.wrong) fmt::print("{}: {}, is {}\n", entry_name(system, entry), entry.given,
//                                                    entry.measured);
//
// It takes some dozens of evaluations of f for each component: for tests and on demand, not within runs.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/system/differences.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// d f[row] / d x[column]; for df/dt the column is the number of components.
template <class Real>
struct JacobianEntry {
  std::size_t row{};       // of f
  std::size_t column{};    // of x; the number of components for df/dt
  Real given{};            // 0 where the pattern leaves it out
  Real measured{};         // by differences
  Real doubt{};            // how far they may be off
  Real below{};            // the slope to the smaller side
  Real above{};            // and to the greater
  Real apart{};            // |given - measured| in parts of the row's greatest, each column times its component
  bool in_pattern = true;  // false: the pattern says that it is 0
};

/// The entries of df/dx and df/dt, sorted by the verdict on each.
template <class Real>
struct JacobianCheck {
  using Entry = JacobianEntry<Real>;
  std::vector<Entry> wrong;      // the worst first
  std::vector<Entry> kinks;      // f has no derivative here: its slopes to either side differ, given is between them
  std::vector<Entry> undecided;  // f is not finite nearby, or too rough for any difference
  std::vector<Entry> right;      // at most one: the one furthest apart
  std::size_t compared = 0;      // entries of all kinds

  /// Whether no entry is wrong.
  [[nodiscard]] bool agrees() const { return wrong.empty(); }
};

/// What a comparison may know of the run in which the derivatives are used.
template <class Real>
struct JacobianCheckOptions {
  std::vector<Real> sizes{};  // how large the components become; without, as large as they are (or 1)
  std::vector<Real> rates{};  // how large the components of f become: rounding is a part of it, even where f is 0
  Real time = 0;              // how long the run takes; without, as large as t is (or 1)
  bool by_time = true;        // look at df/dt too
};

namespace detail {

/// What the system says, by every way it says it: matrices of n rows, row by row.
template <class F, State X>
[[nodiscard]] std::vector<std::vector<Scalar<X>>> given_jacobians(F& f, const Scalar<X>& t, const X& x) {
  using Real = Scalar<X>;
  const std::size_t n = dimension(x);
  std::vector<std::vector<Real>> all;
  if constexpr (HasJacobian<F, X>) f.jacobian(t, x, std::span<Real>(all.emplace_back(n * n, Real(0))));
  if constexpr (HasSparseJacobian<F, X>) {
    const SparsePattern& pattern = f.jacobian_pattern();
    std::vector<Real> values(pattern.entries(), Real(0)), rows(n * n, Real(0));
    f.jacobian_values(t, x, std::span<Real>(values));
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) rows[pattern.row(p) * n + j] = values[p];
    all.push_back(std::move(rows));
  }
  if constexpr (HasJacobianAction<F, X>) {
    std::vector<Real> rows(n * n, Real(0));
    X direction = x, column = x;
    std::fill_n(direction.data(), n, Real(0));
    for (std::size_t j = 0; j < n; ++j) {
      direction.data()[j] = Real(1);
      f.jacobian_action(t, x, direction, column);
      direction.data()[j] = Real(0);
      for (std::size_t i = 0; i < n; ++i) rows[i * n + j] = column.data()[i];
    }
    all.push_back(std::move(rows));
  }
  return all;
}

/// The verdicts on entries whose differences have been measured.
template <class Real>
class EntryJudge {
 public:
  EntryJudge(const std::vector<Real>& row_sizes, JacobianCheck<Real>& check) : row_sizes_(row_sizes), check_(check) {}

  void operator()(JacobianEntry<Real> entry, const Difference<Real>& difference, Real size) {
    using std::abs, std::max, std::min;
    entry.measured = difference.slope, entry.doubt = difference.doubt;
    entry.below = difference.below, entry.above = difference.above;
    const Real row = max(row_sizes_[entry.row], abs(entry.given) * size);
    entry.apart = row > 0 ? abs(entry.given - entry.measured) * size / row : Real(0);
    ++check_.compared;
    const bool agrees = abs(entry.given - entry.measured) <= entry.doubt;  // also false where either is NaN
    if (difference.kinked) {
      const Real room = entry.doubt;
      const bool between =
          entry.given >= min(entry.below, entry.above) - room && entry.given <= max(entry.below, entry.above) + room;
      (between ? check_.kinks : check_.wrong).push_back(entry);
    } else if (!difference.found || (agrees && entry.doubt * size > Real(rough) * row)) {
      // Nothing can be said against a finite entry; one that is not finite is wrong where f is smooth around it.
      check_.undecided.push_back(entry);
    } else if (!agrees) {
      check_.wrong.push_back(entry);
    } else if (check_.right.empty() || check_.right.front().apart < entry.apart) {
      check_.right.assign(1, entry);
    }
  }

 private:
  static constexpr double rough = 1e-3;  // of the row: a difference that may be further off says nothing
  const std::vector<Real>& row_sizes_;
  JacobianCheck<Real>& check_;
};

/// What the terms of f[i] may amount to: rounding is a part of it.
template <State X>
[[nodiscard]] std::vector<Scalar<X>> sizes_of_terms(const X& x, const X& fx,
                                                    const std::vector<std::vector<Scalar<X>>>& given) {
  using Real = Scalar<X>;
  using std::abs, std::max;
  const std::size_t n = dimension(x);
  std::vector<Real> terms(n, Real(0));
  for (std::size_t i = 0; i < n; ++i) {
    terms[i] = abs(fx.data()[i]);
    for (const auto& rows : given) {
      Real sum(0);
      for (std::size_t j = 0; j < n; ++j) sum += abs(rows[i * n + j] * x.data()[j]);
      if (sum < std::numeric_limits<Real>::infinity()) terms[i] = max(terms[i], sum);
    }
  }
  return terms;
}

/// What the system says of one place: of several ways of saying it the one that is furthest off.
template <class F, class Real>
[[nodiscard]] JacobianEntry<Real> given_entry(F& f, std::size_t i, std::size_t j, std::size_t n,
                                              const std::vector<std::vector<Real>>& given, const Real& measured) {
  using std::abs;
  JacobianEntry<Real> entry{.row = i, .column = j};
  if constexpr (HasJacobianPattern<F>) {
    const SparsePattern& pattern = f.jacobian_pattern();
    entry.in_pattern = pattern.find(i, j) < pattern.entries();
  }
  if (given.empty()) entry.given = entry.in_pattern ? measured : Real(0);
  for (const auto& rows : given) {
    const Real other = rows[i * n + j];
    if (&rows == &given.front() || !(abs(other - measured) <= abs(entry.given - measured))) entry.given = other;
  }
  return entry;
}

}  // namespace detail

/// Compares at one (t, x). A system that gives no derivatives can still have a wrong pattern, or say wrongly that it is
/// autonomous.
template <class F, State X>
[[nodiscard]] JacobianCheck<Scalar<X>> check_jacobian(F& f, const Scalar<X>& t, const X& x,
                                                      const JacobianCheckOptions<Scalar<X>>& options = {}) {
  using Real = Scalar<X>;
  using std::abs, std::max;
  const std::size_t n = dimension(x);
  const auto given = detail::given_jacobians(f, t, x);
  X fx = x;
  evaluate(f, t, x, fx);
  auto terms = detail::sizes_of_terms(x, fx, given);
  for (std::size_t i = 0; i < std::min(n, options.rates.size()); ++i) terms[i] = max(terms[i], abs(options.rates[i]));
  const auto size = [&](std::size_t j) {
    const Real here = abs(x.data()[j]), most = j < options.sizes.size() ? max(here, options.sizes[j]) : here;
    return most > 0 ? most : Real(1);
  };

  Differences<X> differences(x);
  std::vector<Difference<Real>> measured(n * n);  // column by column
  std::vector<Real> row_sizes(n, Real(0));
  for (std::size_t j = 0; j < n; ++j) {
    auto column = differences.by_component(f, t, x, fx, j, size(j), terms);
    if (const Real here = abs(x.data()[j]); here > 0 && here < size(j) / Real(16)) {
      // f may go by what x[j] is now (a square root of it) as well as by what it becomes.
      const auto closer = differences.by_component(f, t, x, fx, j, here, terms);
      for (std::size_t i = 0; i < n; ++i)
        if (closer[i].doubt < column[i].doubt) column[i] = closer[i];
    }
    for (std::size_t i = 0; i < n; ++i)
      if (column[i].found) row_sizes[i] = max(row_sizes[i], abs(column[i].slope) * size(j));
    std::ranges::copy(column, measured.begin() + static_cast<std::ptrdiff_t>(j * n));
  }

  JacobianCheck<Real> check;
  for (std::size_t i = 0; i < n; ++i) row_sizes[i] = max(row_sizes[i], terms[i]);
  detail::EntryJudge<Real> judge(row_sizes, check);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const Difference<Real>& difference = measured[j * n + i];
      judge(detail::given_entry(f, i, j, n, given, difference.slope), difference, size(j));
    }
  }
  if (options.by_time && (HasTimeDerivative<F, X> || is_autonomous(f))) {
    X dfdt = x;
    std::fill_n(dfdt.data(), n, Real(0));
    if constexpr (HasTimeDerivative<F, X>) f.time_derivative(t, x, dfdt);
    const Real most = max(options.time, abs(t)), span = most > 0 ? most : Real(1);
    const auto column = differences.by_time(f, t, x, fx, span, terms);
    for (std::size_t i = 0; i < n; ++i) {
      if (column[i].found) row_sizes[i] = max(row_sizes[i], abs(column[i].slope) * span);
      judge({.row = i, .column = n, .given = dfdt.data()[i]}, column[i], span);
    }
  }
  std::ranges::sort(check.wrong, [](const auto& a, const auto& b) { return a.apart > b.apart; });
  return check;
}

/// "d(x')/d(y)": what a message calls an entry. Rows of algebraic equations are "0" of their number; rows of M x' = f
/// with a full M are "f[i]".
template <class F, class Real>
[[nodiscard]] std::string entry_name(const F& f, const JacobianEntry<Real>& entry, std::size_t size) {
  std::string row = component_name(f, entry.row) + "'";
  if constexpr (requires {
                  { f.mass(entry.row) } -> std::convertible_to<Real>;
                }) {
    if (f.mass(entry.row) == Real(0)) row = "f[" + std::to_string(entry.row) + "]";
  } else if constexpr (requires(std::span<Real> rows) { f.mass_matrix(rows); }) {
    row = "f[" + std::to_string(entry.row) + "]";
  }
  return "d(" + row + ")/d(" + (entry.column < size ? component_name(f, entry.column) : "t") + ")";
}

}  // namespace continuo
