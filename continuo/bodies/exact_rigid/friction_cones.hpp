// Contacts in space with Coulomb friction that act together: which of them press, which stick, and in which directions
// the others slip, such that forces (or impulses) and accelerations (or velocities after an impact) belong together.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/minimum_norm.hpp>
#include <continuo/bodies/exact_rigid/cone_room.hpp>
#include <continuo/bodies/exact_rigid/lemke.hpp>
#include <continuo/bodies/exact_rigid/single_cone.hpp>

namespace continuo {

/// All contacts, each with a row along its normal and then two across it.
template <class Real>
struct ConeProblem {
  std::vector<ConeContact<Real>> contacts;
  std::vector<Real> matrix;  // column by column: the responses of the rows to their forces
  std::vector<Real> rates;   // without forces; along a normal, what must not be below 0
};
template <class Real>
struct ConeSolution {
  std::vector<Real> forces;  // in the order of the rates
  std::vector<ConeMode> modes;
  std::vector<std::array<Real, 2>> slips;  // directions, by the tangents, of contacts that slip
};

/// Coulomb's law in the form of J. J. Moreau: of a contact that presses, either there is no slip and the force is in
/// the cone of friction, or the force is at its rim, against the slip. A slip that there is already has its direction;
/// one that begins has that of its acceleration, which depends on the force: Newton's method finds the angles.
///
/// Which contacts do what is found first by sweeps, one contact after the other (M. Jean, "The non-smooth contact
/// dynamics method", 1999), and where these lead nowhere by pivots, with the cones as pyramids (D. E. Stewart, J. C.
/// Trinkle, 1996). Then the equations of that combination are solved, and what is not consistent is changed. Forces
/// that are not determined are the least that hold, moved where that leaves a cone (cone_room.hpp). Solutions that the
/// least give in a contact would drive away are none, as those of the plane (friction_modes.hpp).
template <class Real>
class FrictionCones {
 public:
  using Problem = ConeProblem<Real>;
  using Solution = ConeSolution<Real>;

  explicit FrictionCones(const Problem& problem)
      : of_(problem), points_(problem.contacts.size()), all_(3 * points_), a_(problem.matrix), b_(problem.rates) {
    Real compliance(0);
    for (const Real& rate : b_) rate_ = std::max(rate_, std::abs(rate));
    for (std::size_t i = 0; i < all_; ++i) compliance = std::max(compliance, a_[i * all_ + i]);
    if (!(rate_ > Real(0)) || !(compliance > Real(0))) return;
    force_ = rate_ / compliance;
    for (Real& entry : a_) entry /= compliance;
    for (Real& rate : b_) rate /= rate_;
  }

  /// A consistent combination; nothing where none was found.
  [[nodiscard]] std::optional<Solution> solve() {
    if (!(force_ > Real(0))) return {};
    constexpr int attempts = 8;
    if (auto found = settle(sweep(), false)) return found;
    if (auto found = settle(project(), false)) return found;
    if (auto found = settle(all_closed(), false)) return found;
    for (int attempt = 0; attempt < 3; ++attempt)
      if (auto guess = pivot(attempt > 0))
        if (auto found = settle(std::move(*guess), false)) return found;
    for (int attempt = 0; attempt < attempts; ++attempt)
      if (auto found = settle(attempt % 2 == 0 ? sweep() : all_closed(), true)) return found;
    return {};
  }

 private:
  /// By how much a condition may be violated, in units of forces and rates.
  static constexpr Real small = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-10);
  struct Trial {
    std::vector<ConeMode> modes;
    std::vector<Real> angles;  // of slips
    std::vector<Real> forces, rates;
    bool is_solved = false, is_stable = false;
  };

  [[nodiscard]] const Real& entry(std::size_t row, std::size_t column) const { return a_[column * all_ + row]; }
  [[nodiscard]] bool is_smooth(std::size_t k) const { return !(of_.contacts[k].friction > Real(0)); }
  /// Whether a contact, if it slips, slips in a direction that is to be found.
  [[nodiscard]] bool begins_to_slip(const Trial& trial, std::size_t k) const {
    return trial.modes[k] == ConeMode::slips && !of_.contacts[k].slip && !is_smooth(k);
  }
  [[nodiscard]] ConeMode closed_mode(std::size_t k) const {
    return of_.contacts[k].slip || is_smooth(k) ? ConeMode::slips : ConeMode::sticks;
  }
  [[nodiscard]] Trial empty_trial() const {
    Trial trial{.modes = std::vector<ConeMode>(points_, ConeMode::open),
                .angles = std::vector<Real>(points_, Real(0)),
                .forces = std::vector<Real>(all_, Real(0)),
                .rates = b_};
    for (std::size_t k = 0; k < points_; ++k)
      if (const auto& slip = of_.contacts[k].slip) trial.angles[k] = std::atan2((*slip)[1], (*slip)[0]);
    return trial;
  }
  void find_rates(Trial& trial) const {
    trial.rates = b_;
    for (std::size_t column = 0; column < all_; ++column)
      if (const Real force = trial.forces[column]; force != Real(0))
        for (std::size_t row = 0; row < all_; ++row) trial.rates[row] += entry(row, column) * force;
  }

  // First combinations.

  [[nodiscard]] Trial all_closed() const {
    Trial trial = empty_trial();
    for (std::size_t k = 0; k < points_; ++k) trial.modes[k] = closed_mode(k);
    return trial;
  }
  /// What the forces of some sweeps over the contacts do.
  [[nodiscard]] Trial sweep() const {
    constexpr int most_sweeps = 2000;
    Trial trial = empty_trial();
    for (int round = 0; round < most_sweeps; ++round) {
      Real greatest(0);
      for (std::size_t k = 0; k < points_; ++k) greatest = std::max(greatest, sweep_one(trial, k));
      if (!(greatest > small / 10)) break;
    }
    find_rates(trial);
    for (std::size_t k = 0; k < points_; ++k) read_mode(trial, k);
    return trial;
  }
  /// Finds the force of contact k anew. Returns its change.
  [[nodiscard]] Real sweep_one(Trial& trial, std::size_t k) const {
    std::array<std::array<Real, 3>, 3> response;
    std::array<Real, 3> rate;
    for (std::size_t i = 0; i < 3; ++i) {
      rate[i] = trial.rates[3 * k + i];
      for (std::size_t j = 0; j < 3; ++j) {
        response[i][j] = entry(3 * k + i, 3 * k + j);
        rate[i] -= response[i][j] * trial.forces[3 * k + j];
      }
    }
    const auto found = single_cone<Real>(response, rate, of_.contacts[k]);
    if (!found) return Real(0);
    trial.modes[k] = found->mode;
    Real change(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Real by = found->force[i] - trial.forces[3 * k + i];
      if (by == Real(0)) continue;
      change = std::max(change, std::abs(by));
      trial.forces[3 * k + i] = found->force[i];
      for (std::size_t row = 0; row < all_; ++row) trial.rates[row] += entry(row, 3 * k + i) * by;
    }
    return change;
  }
  /// What the fixed point of projections onto the cones does (G. de Saxce, Z.-Q. Feng, "The bipotential method", 1998),
  /// which asks no contact alone for an answer.
  [[nodiscard]] Trial project() const {
    Trial trial = empty_trial();
    Real trace(0);
    for (std::size_t i = 0; i < all_; ++i) trace += entry(i, i);
    const auto most_rounds = static_cast<std::size_t>(100'000'000 / (all_ * all_) + 1);
    for (std::size_t round = 0; round < most_rounds; ++round) {
      Real greatest(0);
      find_rates(trial);
      for (std::size_t k = 0; k < points_; ++k) greatest = std::max(greatest, project_one(trial, k, 1 / trace));
      if (!(greatest > small / 1000)) break;
    }
    find_rates(trial);
    for (std::size_t k = 0; k < points_; ++k) read_mode(trial, k);
    return trial;
  }
  [[nodiscard]] Real project_one(Trial& trial, std::size_t k, const Real& part) const {
    const ConeContact<Real>& contact = of_.contacts[k];
    const auto rate = std::span(trial.rates).subspan(3 * k, 3);
    const std::array<Real, 3> before{trial.forces[3 * k], trial.forces[3 * k + 1], trial.forces[3 * k + 2]};
    std::array<Real, 3> force{before[0] - part * rate[0], before[1] - part * rate[1], before[2] - part * rate[2]};
    if (closed_mode(k) == ConeMode::sticks) {
      force[0] -= part * contact.friction * std::hypot(rate[1], rate[2]);
      const Real across = std::hypot(force[1], force[2]), mu = contact.friction;
      if (mu * across <= -force[0]) {
        force = {};
      } else if (across > mu * force[0]) {
        const Real normal = (force[0] + mu * across) / (1 + mu * mu);
        force = {normal, force[1] / across * mu * normal, force[2] / across * mu * normal};
      }
    } else {
      const Real normal = std::max(Real(0), force[0]);
      const Real across = is_smooth(k) ? Real(0) : -contact.friction * normal;
      force = {normal, across * std::cos(trial.angles[k]), across * std::sin(trial.angles[k])};
    }
    Real change(0);
    for (std::size_t i = 0; i < 3; ++i) {
      change = std::max(change, std::abs(force[i] - before[i]));
      trial.forces[3 * k + i] = force[i];
    }
    return change;
  }
  /// All that does not part presses first: forces that are not determined are shared.
  void read_mode(Trial& trial, std::size_t k) const {
    constexpr Real near = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-7);
    const std::array<Real, 2> across{trial.rates[3 * k + 1], trial.rates[3 * k + 2]};
    if (trial.rates[3 * k] > near) {
      trial.modes[k] = ConeMode::open;
      return;
    }
    trial.modes[k] = closed_mode(k);
    if (trial.modes[k] == ConeMode::sticks && std::hypot(across[0], across[1]) > near)
      trial.modes[k] = ConeMode::slips, trial.angles[k] = std::atan2(across[1], across[0]);
  }
  /// With pyramids of eight sides as cones: of each contact a normal force, and of each that may stick eight forces
  /// across and a slip (see FrictionModes::try_pivots).
  [[nodiscard]] std::optional<Trial> pivot(bool by_chance) {
    constexpr std::size_t most_unknowns = 600;
    const Trial trial = empty_trial();
    std::vector<std::size_t> first;
    std::size_t n = 0;
    for (std::size_t k = 0; k < points_; ++k)
      first.push_back(n), n += closed_mode(k) == ConeMode::sticks ? sides + 2 : 1;
    if (n > most_unknowns) return {};
    std::vector<Real> m(n * n), q(n), cover(n, Real(1)), changes(all_);
    for (std::size_t k = 0; k < points_; ++k) {
      const bool is_whole = closed_mode(k) == ConeMode::sticks;
      for (std::size_t u = 0; u < (is_whole ? sides + 1 : 1); ++u) {
        for (std::size_t row = 0; row < all_; ++row)
          changes[row] = u > 0      ? along_side(u - 1, entry(row, 3 * k + 1), entry(row, 3 * k + 2))
                         : is_whole ? entry(row, 3 * k)
                                    : entry(row, 3 * k) + sliding_change(trial, row, k);
        put_on_sides(changes, first, std::span(m).subspan((first[k] + u) * n, n));
      }
      if (!is_whole) continue;
      const std::size_t slip = first[k] + sides + 1;
      m[first[k] * n + slip] = of_.contacts[k].friction;
      for (std::size_t u = first[k] + 1; u < slip; ++u) m[u * n + slip] = Real(-1), m[slip * n + u] = Real(1);
    }
    put_on_sides(b_, first, q);
    if (by_chance)
      for (Real& part : cover) part += static_cast<Real>(chance_()) / static_cast<Real>(std::minstd_rand::max());
    const auto z = Lemke<Real>(m, q, cover).solve();
    return z ? std::optional(trial_of_pivots(trial, first, *z)) : std::nullopt;
  }
  static constexpr std::size_t sides = 8;
  /// The part of a vector across the normal that is along a side of the pyramid.
  [[nodiscard]] static Real along_side(std::size_t side, const Real& p, const Real& q) {
    const Real angle = 2 * std::numbers::pi_v<Real> * (static_cast<Real>(side) + Real(0.1)) / sides;
    return std::cos(angle) * p + std::sin(angle) * q;
  }
  /// The rates of all rows as those along normals and sides.
  void put_on_sides(std::span<const Real> rates, const std::vector<std::size_t>& first, std::span<Real> to) const {
    for (std::size_t k = 0; k < points_; ++k) {
      to[first[k]] = rates[3 * k];
      if (closed_mode(k) != ConeMode::sticks) continue;
      for (std::size_t s = 0; s < sides; ++s) to[first[k] + 1 + s] = along_side(s, rates[3 * k + 1], rates[3 * k + 2]);
    }
  }
  [[nodiscard]] Trial trial_of_pivots(Trial trial, const std::vector<std::size_t>& first,
                                      const std::vector<Real>& z) const {
    for (std::size_t k = 0; k < points_; ++k) {
      trial.modes[k] = z[first[k]] > Real(0) ? closed_mode(k) : ConeMode::open;
      if (trial.modes[k] != ConeMode::sticks || !(z[first[k] + sides + 1] > Real(0))) continue;
      std::array<Real, 2> force{};
      for (std::size_t s = 0; s < sides; ++s) {
        force[0] += z[first[k] + 1 + s] * along_side(s, Real(1), Real(0));
        force[1] += z[first[k] + 1 + s] * along_side(s, Real(0), Real(1));
      }
      trial.modes[k] = ConeMode::slips;
      trial.angles[k] = std::atan2(-force[1], -force[0]);
    }
    return trial;
  }

  // The equations of a combination.

  /// What a unit of the normal force of a contact that slips does by its friction.
  [[nodiscard]] Real sliding_change(const Trial& trial, std::size_t row, std::size_t k) const {
    if (is_smooth(k)) return Real(0);
    return -of_.contacts[k].friction *
           (std::cos(trial.angles[k]) * entry(row, 3 * k + 1) + std::sin(trial.angles[k]) * entry(row, 3 * k + 2));
  }
  /// What a turn of the slip of a contact by a unit does.
  [[nodiscard]] Real turning_change(const Trial& trial, std::size_t row, std::size_t k) const {
    return of_.contacts[k].friction * trial.forces[3 * k] *
           (std::sin(trial.angles[k]) * entry(row, 3 * k + 1) - std::cos(trial.angles[k]) * entry(row, 3 * k + 2));
  }
  /// The forces for the present angles.
  void find_forces(Trial& trial) {
    rows_.clear(), sub_.clear(), wanted_.clear();
    for (std::size_t k = 0; k < points_; ++k) {
      if (trial.modes[k] == ConeMode::open) continue;
      for (std::size_t i = 0; i < (trial.modes[k] == ConeMode::sticks ? 3u : 1u); ++i) rows_.push_back(3 * k + i);
    }
    for (const std::size_t column : rows_)
      for (const std::size_t row : rows_) {
        const bool slips = trial.modes[column / 3] == ConeMode::slips;
        sub_.push_back(entry(row, column) + (slips ? sliding_change(trial, row, column / 3) : Real(0)));
      }
    for (const std::size_t row : rows_) wanted_.push_back(-b_[row]);
    system_.factor(rows_.size(), sub_);
    system_.solve(wanted_);
    trial.forces.assign(all_, Real(0));
    for (std::size_t i = 0; i < rows_.size(); ++i) trial.forces[rows_[i]] = wanted_[i];
    for (std::size_t k = 0; k < points_; ++k) {
      if (trial.modes[k] != ConeMode::slips || is_smooth(k)) continue;
      const Real across = -of_.contacts[k].friction * trial.forces[3 * k];
      trial.forces[3 * k + 1] = across * std::cos(trial.angles[k]);
      trial.forces[3 * k + 2] = across * std::sin(trial.angles[k]);
    }
    find_rates(trial);
  }
  /// The rate across the slip of a contact, and along it.
  [[nodiscard]] std::array<Real, 2> slip_rates(const Trial& trial, std::size_t k) const {
    const Real c = std::cos(trial.angles[k]), s = std::sin(trial.angles[k]);
    const Real p = trial.rates[3 * k + 1], q = trial.rates[3 * k + 2];
    return {c * q - s * p, c * p + s * q};
  }
  /// Newton's method for the angles of slips that begin; with each its forces.
  void find_angles(Trial& trial) {
    constexpr int most_rounds = 60;
    constexpr auto most_turn = Real(0.6);
    std::vector<std::size_t> turning;
    for (std::size_t k = 0; k < points_; ++k)
      if (begins_to_slip(trial, k)) turning.push_back(k);
    const std::size_t n = turning.size();
    std::vector<Real> matrix, change(n);
    MinimumNorm<Real> angles;
    Real before = std::numeric_limits<Real>::infinity();
    find_forces(trial);
    for (int round = 0; n > 0 && round < most_rounds; ++round) {
      Real greatest(0), most(0);
      for (std::size_t i = 0; i < n; ++i) {
        change[i] = slip_rates(trial, turning[i])[0];
        greatest = std::max(greatest, std::abs(change[i]));
      }
      matrix = turning_matrix(trial, turning);
      if (greatest < small / 1000 && !(greatest < before / 2)) break;
      before = greatest;
      angles.factor(n, matrix);
      angles.solve(change);
      for (const Real& turn : change) most = std::max(most, std::abs(turn));
      if (most == Real(0)) break;
      for (std::size_t i = 0; i < n; ++i)
        trial.angles[turning[i]] += change[i] * std::min(Real(1), Real(most_turn / most));
      find_forces(trial);
    }
    trial.is_solved = meets_equations(trial);
    trial.is_stable = is_positive(rows_.size(), sub_) && is_positive(n, matrix);
  }
  /// How fast the rate across a slip falls (rows) where a slip turns (columns), with the forces that follow.
  [[nodiscard]] std::vector<Real> turning_matrix(const Trial& trial, const std::vector<std::size_t>& turning) {
    const std::size_t n = turning.size();
    std::vector<Real> matrix(n * n), forces(rows_.size()), rates(all_);
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t row = 0; row < all_; ++row) rates[row] = turning_change(trial, row, turning[j]);
      for (std::size_t r = 0; r < rows_.size(); ++r) forces[r] = -rates[rows_[r]];
      system_.solve(forces);
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const bool slips = trial.modes[rows_[r] / 3] == ConeMode::slips;
        for (std::size_t row = 0; row < all_; ++row)
          rates[row] +=
              forces[r] * (entry(row, rows_[r]) + (slips ? sliding_change(trial, row, rows_[r] / 3) : Real(0)));
      }
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = turning[i];
        const Real along = i == j ? slip_rates(trial, k)[1] : Real(0);
        matrix[j * n + i] =
            along + std::sin(trial.angles[k]) * rates[3 * k + 1] - std::cos(trial.angles[k]) * rates[3 * k + 2];
      }
    }
    return matrix;
  }
  /// Equations that depend on each other can contradict each other.
  [[nodiscard]] bool meets_equations(const Trial& trial) const {
    for (std::size_t k = 0; k < points_; ++k) {
      if (trial.modes[k] == ConeMode::open) continue;
      for (std::size_t i = 0; i < (trial.modes[k] == ConeMode::sticks ? 3u : 1u); ++i)
        if (!(std::abs(trial.rates[3 * k + i]) < 10 * small)) return false;
      if (begins_to_slip(trial, k) && !(std::abs(slip_rates(trial, k)[0]) < 10 * small)) return false;
    }
    return true;
  }
  /// Whether the determinant is above 0, but for what of it is 0.
  [[nodiscard]] static bool is_positive(std::size_t n, std::vector<Real> matrix) {
    MinimumNorm<Real> lifted;
    for (std::size_t i = 0; i < n; ++i) matrix[i * n + i] += lift;
    lifted.factor(n, matrix);
    return lifted.determinant_sign() >= 0;
  }
  static constexpr Real lift = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-6);

  // Changes of a combination.

  /// Solves a combination, changes what is least consistent, or by chance any of it, and so on. Nothing where that does
  /// not end.
  [[nodiscard]] std::optional<Solution> settle(Trial trial, bool by_chance) {
    for (std::size_t round = 0; round < 10 + 10 * points_; ++round) {
      find_angles(trial);
      widen(trial);
      const std::size_t worst = least_consistent(trial, by_chance);
      if (worst == points_) return trial.is_solved && trial.is_stable ? solution_of(trial) : std::nullopt;
      change_mode(trial, worst);
    }
    return {};
  }
  /// Moves the forces of contacts that stick into their cones.
  void widen(Trial& trial) const {
    std::vector<std::size_t> rows;
    std::vector<Real> friction, matrix, forces;
    for (std::size_t k = 0; k < points_; ++k) {
      if (trial.modes[k] != ConeMode::sticks) continue;
      friction.push_back(of_.contacts[k].friction);
      for (std::size_t i = 0; i < 3; ++i) rows.push_back(3 * k + i), forces.push_back(trial.forces[3 * k + i]);
    }
    if (friction.size() < 2 || !(cone_room<Real>(friction, forces) < Real(0))) return;
    for (const std::size_t column : rows)
      for (const std::size_t row : rows) matrix.push_back(entry(row, column));
    static_cast<void>(ConeRoom<Real>(matrix, friction).widen(forces));
    for (std::size_t i = 0; i < rows.size(); ++i) trial.forces[rows[i]] = forces[i];
    find_rates(trial);
  }
  /// By how much contact k violates a condition: below 0 where it does.
  [[nodiscard]] Real margin(const Trial& trial, std::size_t k) const {
    if (trial.modes[k] == ConeMode::open) return trial.rates[3 * k];
    const Real normal = trial.forces[3 * k];
    if (trial.modes[k] == ConeMode::sticks)
      return of_.contacts[k].friction * normal - std::hypot(trial.forces[3 * k + 1], trial.forces[3 * k + 2]);
    if (!begins_to_slip(trial, k)) return normal;
    return std::min(normal, slip_rates(trial, k)[1]);
  }
  [[nodiscard]] std::size_t least_consistent(const Trial& trial, bool by_chance) {
    std::size_t worst = points_;
    Real lowest = -small;
    std::uint32_t found = 0;
    for (std::size_t k = 0; k < points_; ++k) {
      const Real here = margin(trial, k);
      if (!(here < -small)) continue;
      if (by_chance ? chance_() % ++found == 0 : here < lowest) lowest = here, worst = k;
    }
    return worst;
  }
  void change_mode(Trial& trial, std::size_t k) const {
    const bool presses = trial.forces[3 * k] > -small;
    ConeMode& mode = trial.modes[k];
    if (mode == ConeMode::open) {
      read_mode(trial, k);
    } else if (!presses) {
      mode = ConeMode::open;
    } else if (mode == ConeMode::sticks) {
      mode = ConeMode::slips;
      trial.angles[k] = std::atan2(-trial.forces[3 * k + 2], -trial.forces[3 * k + 1]);
    } else {
      mode = ConeMode::sticks;
    }
  }
  [[nodiscard]] std::optional<Solution> solution_of(const Trial& trial) const {
    Solution found{trial.forces, trial.modes, {}};
    for (Real& force : found.forces) force *= force_;
    for (const Real& angle : trial.angles) found.slips.push_back({std::cos(angle), std::sin(angle)});
    return found;
  }

  const Problem& of_;
  std::size_t points_, all_;
  std::vector<Real> a_, b_;  // in units of force_ and rate_
  Real rate_{}, force_{};
  std::minstd_rand chance_;  // the same numbers each time
  std::vector<std::size_t> rows_;
  std::vector<Real> sub_, wanted_;
  MinimumNorm<Real> system_;
};

}  // namespace continuo
