// Impulses, or forces, of contacts that act together: each at least 0, and 0 where its contact opens.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/exact_rigid/minimum_norm.hpp>

namespace continuo {

/// Finds f with f >= 0, A f + q >= 0 and f . (A f + q) = 0, of a symmetric positive semidefinite A, column by column:
/// the least of f . A f / 2 + q . f. In finitely many steps, each with a set of columns that do not depend on each
/// other (C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23). Rates within `least` are 0.
/// Empty where rounding keeps it from an end.
template <class Real>
[[nodiscard]] std::vector<Real> complementary_forces(std::span<const Real> a, std::span<const Real> q,
                                                     const Real& least) {
  const std::size_t n = q.size();
  std::vector<Real> f(n), sub, trial;
  std::vector<bool> acts(n, false);
  std::vector<std::size_t> set;
  MinimumNorm<Real> system;
  const auto rate = [&](std::size_t i) {
    Real sum = q[i];
    for (std::size_t j = 0; j < n; ++j) sum += a[j * n + i] * f[j];
    return sum;
  };
  const auto solve = [&] {
    set.clear(), sub.clear(), trial.clear();
    for (std::size_t i = 0; i < n; ++i)
      if (acts[i]) set.push_back(i), trial.push_back(-q[i]);
    for (const std::size_t j : set)
      for (const std::size_t i : set) sub.push_back(a[j * n + i]);
    system.factor(set.size(), sub);
    system.solve(trial);
  };
  for (std::size_t round = 0, most = 10 * n + 10; round < most; ++round) {
    std::size_t worst = n;
    Real lowest = -least;
    for (std::size_t i = 0; i < n; ++i)
      if (!acts[i])
        if (const Real here = rate(i); here < lowest) lowest = here, worst = i;
    if (worst == n) return f;
    acts[worst] = true;
    for (solve();; solve()) {
      Real part(1);
      std::size_t first = set.size();
      for (std::size_t k = 0; k < set.size(); ++k)
        if (!(trial[k] > Real(0)))
          if (const Real here = f[set[k]] / (f[set[k]] - trial[k]); first == set.size() || here < part)
            part = here, first = k;
      if (first == set.size()) break;
      if (!(f[set[first]] - trial[first] > Real(0))) part = Real(0);
      for (std::size_t k = 0; k < set.size(); ++k) f[set[k]] += part * (trial[k] - f[set[k]]);
      f[set[first]] = Real(0);
      acts[set[first]] = false;
      if (set.size() == 1) {
        set.clear(), trial.clear();
        break;
      }
    }
    for (std::size_t k = 0; k < set.size(); ++k) f[set[k]] = trial[k];
  }
  return {};
}

}  // namespace continuo
