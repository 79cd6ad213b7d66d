// How far forces of contacts that stick are within their cones, where other forces would have the same effect.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include <continuo/bodies/contacts/minimum_norm.hpp>

namespace continuo {

/// The room of forces (normal, across, across, of each contact) in their cones: the least of friction times normal
/// force, less the force across.
template <class Real>
[[nodiscard]] Real cone_room(std::span<const Real> friction, std::span<const Real> forces) {
  Real least = std::numeric_limits<Real>::infinity();
  for (std::size_t k = 0; k < friction.size(); ++k)
    least = std::min(least, Real(friction[k] * forces[3 * k] - std::hypot(forces[3 * k + 1], forces[3 * k + 2])));
  return least;
}

/// Bodies that touch at more points than they need, as a box on a floor, are held by many sets of forces: these are
/// moved, with the same effect, to where their room is the greatest. `matrix`: of the responses of all rows to each
/// other, column by column. By Newton's method along the central path of logarithmic barriers (S. Boyd, L.
/// Vandenberghe, "Convex Optimization", 2004, 11.3), to some roundings of the forces; where the room has turned out to
/// be far above 0, it ends there.
template <class Real>
class ConeRoom {
 public:
  ConeRoom(std::span<const Real> matrix, std::span<const Real> friction)
      : friction_(friction), n_(3 * friction.size()) {
    MinimumNorm<Real> system;
    system.factor(n_, matrix);
    if (system.rank() < n_) find_ways(system, matrix);
  }

  /// The greatest room, for which it moves the forces.
  [[nodiscard]] Real widen(std::vector<Real>& forces) const {
    Real room = cone_room<Real>(friction_, forces), size(0);
    for (const Real& force : forces) size = std::max(size, std::abs(force));
    if (ways_.empty() || !(size > Real(0)) || !(room < Real(0))) return room;
    std::vector<Real> unknowns(ways_.size() + 1), best = forces;
    unknowns.back() = room - size;
    for (Real weight = size; weight > least * size && room < Real(1e-3) * size; weight /= 8)
      for (int round = 0; round < 30 && room < Real(1e-3) * size; ++round) {
        const bool is_near = !(step(forces, unknowns, weight) > Real(0.01));
        const std::vector<Real> here = forces_at(forces, unknowns);
        if (const Real found = cone_room<Real>(friction_, here); found > room) room = found, best = here;
        if (is_near) break;
      }
    forces = best;
    return room;
  }

 private:
  static constexpr Real least = std::is_same_v<Real, float> ? Real(1e-6) : Real(1e-14);

  /// Forces without effect, perpendicular to each other, of length 1.
  void find_ways(MinimumNorm<Real>& system, std::span<const Real> matrix) {
    std::vector<std::vector<Real>> left;
    for (std::size_t j = 0; j < n_; ++j) {
      std::vector<Real> way(matrix.begin() + static_cast<std::ptrdiff_t>(j * n_),
                            matrix.begin() + static_cast<std::ptrdiff_t>((j + 1) * n_));
      system.solve(way);
      for (Real& part : way) part = -part;
      way[j] += Real(1);
      left.push_back(std::move(way));
    }
    const auto product = [](const std::vector<Real>& a, const std::vector<Real>& b) {
      Real sum(0);
      for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    while (ways_.size() < n_ - system.rank()) {
      const auto longest =
          std::ranges::max_element(left, {}, [&](const std::vector<Real>& way) { return product(way, way); });
      std::vector<Real> way = *longest;
      const Real size = std::sqrt(product(way, way));
      if (!(size > Real(1e-6))) return;
      for (Real& part : way) part /= size;
      for (int twice = 0; twice < 2; ++twice)
        for (std::vector<Real>& other : left) {
          const Real along = product(way, other);
          for (std::size_t i = 0; i < n_; ++i) other[i] -= along * way[i];
        }
      ways_.push_back(std::move(way));
    }
  }
  [[nodiscard]] std::vector<Real> forces_at(const std::vector<Real>& from, const std::vector<Real>& unknowns) const {
    std::vector<Real> forces = from;
    for (std::size_t w = 0; w < ways_.size(); ++w)
      for (std::size_t i = 0; i < n_; ++i) forces[i] += unknowns[w] * ways_[w][i];
    return forces;
  }
  /// The sum of the logarithms of h^2 - t^2, with h = friction * normal - room > |t|; nothing beyond.
  [[nodiscard]] Real barrier(const std::vector<Real>& forces, const Real& room) const {
    Real sum(0);
    for (std::size_t k = 0; k < friction_.size(); ++k) {
      const Real h = friction_[k] * forces[3 * k] - room, t = std::hypot(forces[3 * k + 1], forces[3 * k + 2]);
      if (!(h > t)) return -std::numeric_limits<Real>::infinity();
      sum += std::log(h - t) + std::log(h + t);
    }
    return sum;
  }
  /// One step of Newton's method for the greatest of room / weight + barrier. Returns how much of it is left, at first
  /// order; 0 where rounding ends it.
  [[nodiscard]] Real step(const std::vector<Real>& from, std::vector<Real>& unknowns, const Real& weight) const {
    const std::size_t d = unknowns.size();
    const std::vector<Real> forces = forces_at(from, unknowns);
    std::vector<Real> gradient(d), curvature(d * d);
    gradient.back() = 1 / weight;
    std::vector<Real> along_h(d), along_t(2 * d), along(d);
    for (std::size_t k = 0; k < friction_.size(); ++k) {
      const Real h = friction_[k] * forces[3 * k] - unknowns.back(), p = forces[3 * k + 1], q = forces[3 * k + 2];
      const Real inside = (h - std::hypot(p, q)) * (h + std::hypot(p, q));
      for (std::size_t w = 0; w < d; ++w) {
        const bool is_room = w + 1 == d;
        along_h[w] = is_room ? Real(-1) : friction_[k] * ways_[w][3 * k];
        along_t[w] = is_room ? Real(0) : ways_[w][3 * k + 1], along_t[d + w] = is_room ? Real(0) : ways_[w][3 * k + 2];
        along[w] = h * along_h[w] - p * along_t[w] - q * along_t[d + w];
        gradient[w] += 2 / inside * along[w];
      }
      for (std::size_t v = 0; v < d; ++v)
        for (std::size_t w = 0; w < d; ++w)
          curvature[v * d + w] +=
              4 / (inside * inside) * along[v] * along[w] -
              2 / inside * (along_h[v] * along_h[w] - along_t[v] * along_t[w] - along_t[d + v] * along_t[d + w]);
    }
    MinimumNorm<Real> system;
    system.factor(d, curvature);
    std::vector<Real> change = gradient;
    system.solve(change);
    Real gain(0);
    for (std::size_t w = 0; w < d; ++w) gain += gradient[w] * change[w];
    if (!(gain > Real(0))) return Real(0);
    const Real before = unknowns.back() / weight + barrier(forces, unknowns.back());
    for (Real part(1); part > Real(1e-6); part /= 2) {
      std::vector<Real> trial = unknowns;
      for (std::size_t w = 0; w < d; ++w) trial[w] += part * change[w];
      const Real after = trial.back() / weight + barrier(forces_at(from, trial), trial.back());
      if (!(after > before)) continue;
      unknowns = trial;
      return gain;
    }
    return Real(0);
  }

  std::span<const Real> friction_;
  std::size_t n_;
  std::vector<std::vector<Real>> ways_;
};

}  // namespace continuo
