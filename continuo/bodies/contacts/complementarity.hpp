// Impulses, or forces, of contacts that act together: each at least 0, and 0 where its contact opens.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/minimum_norm.hpp>

namespace continuo {

/// See complementary_forces.
template <class Real>
class ActiveSet {
 public:
  ActiveSet(std::span<const Real> a, std::span<const Real> q) : a_(a), q_(q), f_(q.size()), acts_(q.size()) {}

  [[nodiscard]] std::vector<Real> find(const Real& least) {
    for (std::size_t round = 0, most = 10 * size() + 10; round < most; ++round) {
      const std::size_t worst = lowest_below(-least);
      if (worst == size()) return f_;
      acts_[worst] = true;
      if (!settle(worst)) break;
    }
    return {};
  }

 private:
  [[nodiscard]] std::size_t size() const { return q_.size(); }
  [[nodiscard]] std::size_t lowest_below(Real lowest) const {
    std::size_t worst = size();
    for (std::size_t i = 0; i < size(); ++i) {
      if (acts_[i]) continue;
      Real rate = q_[i];
      for (std::size_t j = 0; j < size(); ++j) rate += a_[j * size() + i] * f_[j];
      if (rate < lowest) lowest = rate, worst = i;
    }
    return worst;
  }
  /// Moves to the forces that hold the rates of the set at 0, without those that would pull.
  [[nodiscard]] bool settle(std::size_t newest) {
    for (;;) {
      if (!solve(newest)) return false;
      Real part(1);
      std::size_t first = set_.size();
      for (std::size_t k = 0; k < set_.size(); ++k)
        if (!(trial_[k] > Real(0)))
          if (const Real here = f_[set_[k]] / (f_[set_[k]] - trial_[k]); first == set_.size() || here < part)
            part = here, first = k;
      if (first == set_.size()) break;
      if (!(f_[set_[first]] - trial_[first] > Real(0))) part = Real(0);
      for (std::size_t k = 0; k < set_.size(); ++k) f_[set_[k]] += part * (trial_[k] - f_[set_[k]]);
      f_[set_[first]] = Real(0);
      acts_[set_[first]] = false;
      if (set_.size() == 1) return true;
    }
    for (std::size_t k = 0; k < set_.size(); ++k) f_[set_[k]] = trial_[k];
    return true;
  }
  /// Where the forces of the set are to go. False where the newest column depends on the others, and nothing holds its
  /// rate back.
  [[nodiscard]] bool solve(std::size_t newest) {
    set_.clear(), trial_.clear();
    for (std::size_t i = 0; i < size(); ++i)
      if (acts_[i]) set_.push_back(i), trial_.push_back(-q_[i]);
    factor();
    if (system_.rank() < set_.size() && acts_[newest]) return take_over(newest);
    system_.solve(trial_);
    return true;
  }
  void factor() {
    sub_.clear();
    for (const std::size_t j : set_)
      for (const std::size_t i : set_) sub_.push_back(a_[j * size() + i]);
    system_.factor(set_.size(), sub_);
  }
  /// Increases the force of a column that depends on the others, which change so that no rate does, until one of them
  /// is 0. False where none decreases.
  [[nodiscard]] bool take_over(std::size_t column) {
    std::erase(set_, column);
    factor();
    trial_.clear();
    for (const std::size_t i : set_) trial_.push_back(-a_[column * size() + i]);
    system_.solve(trial_);
    std::size_t first = set_.size();
    Real way(0);
    for (std::size_t k = 0; k < set_.size(); ++k)
      if (trial_[k] < Real(0))
        if (const Real here = f_[set_[k]] / -trial_[k]; first == set_.size() || here < way) way = here, first = k;
    if (first == set_.size()) return false;
    for (std::size_t k = 0; k < set_.size(); ++k) trial_[k] = k == first ? Real(0) : f_[set_[k]] + way * trial_[k];
    set_.push_back(column), trial_.push_back(f_[column] + way);
    return true;
  }

  std::span<const Real> a_, q_;
  std::vector<Real> f_, sub_, trial_;
  std::vector<bool> acts_;
  std::vector<std::size_t> set_;
  MinimumNorm<Real> system_;
};

/// Finds f with f >= 0, A f + q >= 0 and f . (A f + q) = 0, of a symmetric positive semidefinite A, column by column:
/// the least of f . A f / 2 + q . f. In finitely many steps, each with a set of columns that do not depend on each
/// other (C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23). A column that depends on the
/// set, as that of a contact that others make redundant, but which asks for more than they give, takes over from one of
/// them. Rates within `least` are 0. Empty where no f exists, or rounding keeps it from an end.
template <class Real>
[[nodiscard]] std::vector<Real> complementary_forces(std::span<const Real> a, std::span<const Real> q,
                                                     const Real& least) {
  return ActiveSet<Real>(a, q).find(least);
}
/// The greatest rate of a column that has a force: 0 but for errors.
template <class Real>
[[nodiscard]] Real greatest_error(std::span<const Real> a, std::span<const Real> q, std::span<const Real> f) {
  Real greatest(0);
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (!(f[i] > Real(0))) continue;
    Real rate = q[i];
    for (std::size_t j = 0; j < q.size(); ++j) rate += a[j * q.size() + i] * f[j];
    greatest = std::max(greatest, std::abs(rate));
  }
  return greatest;
}

}  // namespace continuo
