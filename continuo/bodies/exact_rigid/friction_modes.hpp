// Contacts of the plane with Coulomb friction that act together: which of them press, and which slip, such that forces
// (or impulses) and accelerations (or velocities after an impact) belong together.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/minimum_norm.hpp>
#include <continuo/bodies/exact_rigid/lemke.hpp>
#include <continuo/bodies/exact_rigid/rigid_system.hpp>

namespace continuo {

/// The points of all contacts, and the pairs of parts that they belong to. All points of a pair have the same motion
/// across the normal, so that a pair has one direction across it, and friction limits the sum over its points.
template <class Real>
struct FrictionProblem {
  struct Pair {
    Real friction{};
    bool may_stick = true, may_go_forwards = true, may_go_backwards = true;
  };
  std::vector<std::uint32_t> pair_of_point;
  std::vector<Pair> pairs;
  std::vector<Real> matrix;  // column by column: the points along the normal, then the pairs across it
  std::vector<Real> rates;   // without forces, in this order; of a point, what must not be below 0
};
template <class Real>
struct FrictionSolution {
  std::vector<Real> forces;  // in the order of the rates
  std::vector<bool> presses;
  std::vector<Rubbing> rubbing;  // of pairs
  Real margin{};                 // of the inequality that holds least, in units of forces and rates
};

/// Friction can make a force that presses two parts together move them towards each other (Painleve's paradox). Forces
/// that belong together only so would not last: the least give in a contact makes them grow or vanish. The determinant
/// of their equations is then below 0, and they are no solution (F. Genot, B. Brogliato, "New results on Painleve
/// paradoxes", European Journal of Mechanics A 18, 1999).
///
/// Of few contacts all combinations are tried, 2^points times 3^pairs. Of many, first from all contacts closed and
/// sticking, one after the other is changed where it is not consistent; where that does not end, the linear
/// complementarity problem of all forces is solved. Nothing where no combination was found that is consistent.
template <class Real>
class FrictionModes {
 public:
  using Problem = FrictionProblem<Real>;
  using Solution = FrictionSolution<Real>;

  explicit FrictionModes(const Problem& problem)
      : of_(problem), points_(problem.pair_of_point.size()), all_(problem.rates.size()) {
    for (const Real& rate : of_.rates) rate_ = std::max(rate_, std::abs(rate));
    Real compliance(0);
    for (std::size_t k = 0; k < all_; ++k) compliance = std::max(compliance, entry(k, k));
    force_ = compliance > Real(0) ? rate_ / compliance : Real(0);
  }

  /// A consistent combination.
  [[nodiscard]] std::optional<Solution> solve() {
    std::optional<Solution> best;
    if (!(rate_ > Real(0))) return best;
    if (points_ + 2 * of_.pairs.size() > most_unknowns) return solve_by_changes();
    for (std::uint32_t pressed = 0; pressed < 1u << points_; ++pressed) {
      Solution trial;
      trial.presses.resize(points_);
      for (std::size_t k = 0; k < points_; ++k) trial.presses[k] = (pressed >> k & 1u) != 0;
      trial.rubbing.assign(of_.pairs.size(), Rubbing::none);
      choose_rubbing(trial, 0, best);
    }
    if (best && best->margin < least_margin) best.reset();
    return best;
  }

 private:
  /// A slip of what sticks that grows faster is no rounding, in units of rates.
  static constexpr Real least_unmet = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-8);
  static constexpr Real least_margin = std::is_same_v<Real, float> ? Real(-1e-3) : Real(-1e-9);

  /// Changes of what is least consistent can go round in circles: then by pivots, and last by changes of anything that
  /// is not consistent, by chance.
  [[nodiscard]] std::optional<Solution> solve_by_changes() {
    constexpr int attempts = 12;
    if (auto found = try_changes(false)) return found;
    for (int attempt = 0; attempt < attempts / 4; ++attempt)
      if (auto found = try_pivots(attempt > 0)) return found;
    for (int attempt = 1; attempt < attempts; ++attempt)
      if (auto found = try_changes(true)) return found;
    return {};
  }
  /// The pairs that may stick have two forces across, one each way, and a slip (D. E. Stewart, "Rigid-body dynamics
  /// with friction and impact", 2000): of each point the normal force, then of each such pair these three. The forces
  /// of friction of the others are those of their slip. Other covering vectors take other ways to a solution.
  [[nodiscard]] std::optional<Solution> try_pivots(bool by_chance) {
    Solution trial = first_trial();
    std::vector<std::size_t> sticking;
    for (std::size_t p = 0; p < of_.pairs.size(); ++p)
      if (trial.rubbing[p] == Rubbing::sticks) sticking.push_back(p);
    const std::size_t n = points_ + 3 * sticking.size();
    std::vector<Real> m(n * n), q(n), cover(n, Real(1));
    const Real per_force = force_ / rate_;
    for (std::size_t k = 0; k < points_; ++k) {
      q[k] = of_.rates[k] / rate_;
      for (std::size_t row = 0; row < points_; ++row) m[k * n + row] = change(trial, row, k) * per_force;
    }
    for (std::size_t s = 0; s < sticking.size(); ++s) {
      const std::size_t across = points_ + sticking[s], plus = points_ + 3 * s, minus = plus + 1, slip = plus + 2;
      q[plus] = of_.rates[across] / rate_, q[minus] = -q[plus];
      for (std::size_t k = 0; k < points_; ++k) {
        m[k * n + plus] = change(trial, across, k) * per_force, m[k * n + minus] = -m[k * n + plus];
        if (of_.pair_of_point[k] == sticking[s]) m[k * n + slip] = of_.pairs[sticking[s]].friction;
        m[plus * n + k] = entry(k, across) * per_force, m[minus * n + k] = -m[plus * n + k];
      }
      for (std::size_t t = 0; t < sticking.size(); ++t) {
        const std::size_t other = points_ + 3 * t;
        const Real change_across = entry(points_ + sticking[t], across) * per_force;
        m[plus * n + other] = m[minus * n + other + 1] = change_across;
        m[plus * n + other + 1] = m[minus * n + other] = -change_across;
      }
      m[slip * n + plus] = m[slip * n + minus] = Real(1);
      m[plus * n + slip] = m[minus * n + slip] = Real(-1);
    }
    if (by_chance)
      for (Real& part : cover) part += static_cast<Real>(chance_()) / static_cast<Real>(std::minstd_rand::max());
    const auto z = Lemke<Real>(m, q, cover).solve();
    if (!z) return {};
    return modes_of(*z, sticking, std::move(trial));
  }
  /// The combination that these unknowns of the complementarity problem have, with its forces.
  [[nodiscard]] std::optional<Solution> modes_of(const std::vector<Real>& z, const std::vector<std::size_t>& sticking,
                                                 Solution trial) {
    std::vector<bool> is_pressed(of_.pairs.size(), false);
    for (std::size_t k = 0; k < points_; ++k) {
      trial.presses[k] = z[k] > Real(0);
      if (trial.presses[k]) is_pressed[of_.pair_of_point[k]] = true;
    }
    for (std::size_t s = 0; s < sticking.size(); ++s) {
      const std::size_t plus = points_ + 3 * s;
      if (z[plus + 2] > Real(0))
        trial.rubbing[sticking[s]] = z[plus] > z[plus + 1] ? Rubbing::backwards : Rubbing::forwards;
    }
    for (std::size_t p = 0; p < of_.pairs.size(); ++p)
      if (!is_pressed[p]) trial.rubbing[p] = Rubbing::none;
    find_forces(trial);
    find_margin(trial);
    if (!(trial.margin >= least_margin)) return {};
    return trial;
  }
  /// All points pressed, and all pairs sticking that may.
  [[nodiscard]] Solution first_trial() const {
    Solution trial;
    trial.presses.assign(points_, true);
    for (const auto& pair : of_.pairs)
      trial.rubbing.push_back(!(pair.friction > Real(0)) ? Rubbing::none
                              : pair.may_stick           ? Rubbing::sticks
                              : pair.may_go_forwards     ? Rubbing::forwards
                                                         : Rubbing::backwards);
    return trial;
  }
  [[nodiscard]] std::optional<Solution> try_changes(bool by_chance) {
    Solution trial = first_trial();
    for (std::size_t round = 0; round < 20 * (points_ + of_.pairs.size()); ++round) {
      find_forces(trial);
      const std::vector<Real> forces = trial.forces;
      find_margin(trial);
      if (trial.margin >= least_margin) return trial;
      if (!change_one(trial, forces, by_chance)) return {};
    }
    return {};
  }
  /// Opens a point that pulls, or closes one that sinks in, or lets a pair slip or stick. False where there is
  /// nothing to change.
  [[nodiscard]] bool change_one(Solution& trial, const std::vector<Real>& forces, bool by_chance) {
    std::vector<Real> most(of_.pairs.size());
    std::size_t worst = all_;
    Real lowest = least_margin;
    std::uint32_t found = 0;
    const auto consider = [&](std::size_t k, const Real& margin) {
      if (!(margin < least_margin)) return;
      const bool is_taken = by_chance ? chance_() % ++found == 0 : margin < lowest;
      if (is_taken) lowest = margin, worst = k;
    };
    for (std::size_t k = 0; k < points_; ++k) {
      consider(k, trial.presses[k] ? forces[k] / force_ : rate_with(trial, forces, k) / rate_);
      most[of_.pair_of_point[k]] += of_.pairs[of_.pair_of_point[k]].friction * forces[k];
    }
    for (std::size_t p = 0; p < of_.pairs.size(); ++p) {
      if (trial.rubbing[p] == Rubbing::sticks) {
        consider(points_ + p, (most[p] - std::abs(forces[points_ + p])) / force_);
      } else if (trial.rubbing[p] != Rubbing::none && of_.pairs[p].may_stick) {
        const Real slip = rate_with(trial, forces, points_ + p) / rate_;
        consider(points_ + p, trial.rubbing[p] == Rubbing::forwards ? slip : -slip);
      }
    }
    if (worst == all_) return false;
    if (worst < points_) {
      trial.presses[worst] = !trial.presses[worst];
    } else {
      Rubbing& rubbing = trial.rubbing[worst - points_];
      rubbing = rubbing != Rubbing::sticks ? Rubbing::sticks
                : forces[worst] < Real(0)  ? Rubbing::forwards  // friction is against the slip
                                           : Rubbing::backwards;
    }
    return true;
  }
  /// The rate of a row with these forces, those of friction that slips aside.
  [[nodiscard]] Real rate_with(const Solution& trial, const std::vector<Real>& forces, std::size_t row) const {
    Real sum = of_.rates[row];
    for (std::size_t k = 0; k < all_; ++k)
      if (forces[k] != Real(0)) sum += change(trial, row, k) * forces[k];
    return sum;
  }
  static constexpr std::size_t most_unknowns = 16;

  [[nodiscard]] const Real& entry(std::size_t row, std::size_t column) const { return of_.matrix[column * all_ + row]; }

  void choose_rubbing(Solution& trial, std::size_t pair, std::optional<Solution>& best) {
    if (pair == of_.pairs.size()) {
      find_forces(trial);
      find_margin(trial);
      if (!best || trial.margin > best->margin) best = trial;
      return;
    }
    const auto& one = of_.pairs[pair];
    bool is_closed = false;
    for (std::size_t k = 0; k < points_; ++k)
      is_closed = is_closed || (trial.presses[k] && of_.pair_of_point[k] == pair);
    const auto go_on = [&](Rubbing rubbing) {
      trial.rubbing[pair] = rubbing;
      choose_rubbing(trial, pair + 1, best);
    };
    if (!is_closed || !(one.friction > Real(0))) return go_on(Rubbing::none);
    if (one.may_stick) go_on(Rubbing::sticks);
    if (one.may_go_forwards) go_on(Rubbing::forwards);
    if (one.may_go_backwards) go_on(Rubbing::backwards);
  }
  /// The change of rate `row` by a normal force of point k, with the friction that it makes.
  [[nodiscard]] Real change(const Solution& trial, std::size_t row, std::size_t k) const {
    if (k >= points_) return entry(row, k);
    const std::size_t pair = of_.pair_of_point[k];
    return entry(row, k) + rubbing_share(trial, k) * entry(row, points_ + pair);
  }
  [[nodiscard]] Real rubbing_share(const Solution& trial, std::size_t k) const {
    const std::size_t pair = of_.pair_of_point[k];
    if (trial.rubbing[pair] == Rubbing::forwards) return -of_.pairs[pair].friction;
    return trial.rubbing[pair] == Rubbing::backwards ? of_.pairs[pair].friction : Real(0);
  }
  void find_forces(Solution& trial) {
    set_.clear(), sub_.clear(), wanted_.clear();
    for (std::size_t k = 0; k < points_; ++k)
      if (trial.presses[k]) set_.push_back(k);
    for (std::size_t p = 0; p < of_.pairs.size(); ++p)
      if (trial.rubbing[p] == Rubbing::sticks) set_.push_back(points_ + p);
    for (const std::size_t column : set_)
      for (const std::size_t row : set_) sub_.push_back(change(trial, row, column));
    for (const std::size_t row : set_) wanted_.push_back(-of_.rates[row]);
    system_.factor(set_.size(), sub_);
    system_.solve(wanted_);
    trial.forces.assign(all_, Real(0));
    for (std::size_t k = 0; k < set_.size(); ++k) trial.forces[set_[k]] = wanted_[k];
    is_stable_ = system_.determinant_sign() >= 0;
  }
  void find_margin(Solution& trial) const {
    Real margin = is_stable_ ? std::numeric_limits<Real>::infinity() : -std::numeric_limits<Real>::infinity();
    const auto rate = [&](std::size_t row) { return rate_with(trial, trial.forces, row) / rate_; };
    std::vector<Real> most(of_.pairs.size());
    for (std::size_t k = 0; k < points_; ++k) {
      margin = std::min(margin, trial.presses[k] ? trial.forces[k] / force_ : rate(k));
      // A dependent equation that is not met.
      if (trial.presses[k] && std::abs(rate(k)) > Real(1e-6)) margin = -std::numeric_limits<Real>::infinity();
      most[of_.pair_of_point[k]] += of_.pairs[of_.pair_of_point[k]].friction * trial.forces[k];
    }
    for (std::size_t p = 0; p < of_.pairs.size(); ++p) {
      if (trial.rubbing[p] == Rubbing::sticks) {
        margin = std::min(margin, (most[p] - std::abs(trial.forces[points_ + p])) / force_);
        // Likewise: joints can drive apart what would have to stick together.
        if (std::abs(rate(points_ + p)) > least_unmet) margin = -std::numeric_limits<Real>::infinity();
      } else if (trial.rubbing[p] != Rubbing::none) {
        const auto& pair = of_.pairs[p];
        const bool is_open = pair.may_go_forwards && pair.may_go_backwards;  // else it slips already
        const Real slip = rate(points_ + p);
        if (is_open || pair.may_stick) margin = std::min(margin, trial.rubbing[p] == Rubbing::forwards ? slip : -slip);
      }
    }
    trial.margin = margin;
    for (std::size_t p = 0; p < of_.pairs.size(); ++p)
      if (trial.rubbing[p] == Rubbing::forwards || trial.rubbing[p] == Rubbing::backwards)
        for (std::size_t k = 0; k < points_; ++k)
          if (of_.pair_of_point[k] == p) trial.forces[points_ + p] += rubbing_share(trial, k) * trial.forces[k];
  }

  const Problem& of_;
  std::size_t points_, all_;
  bool is_stable_ = true;  // the combination whose forces were found last
  Real rate_{}, force_{};
  std::minstd_rand chance_;  // the same numbers each time
  std::vector<std::size_t> set_;
  std::vector<Real> sub_, wanted_;
  MinimumNorm<Real> system_;
};

}  // namespace continuo
