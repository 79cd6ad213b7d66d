// Collisions of one instant. Those that share bodies are solved together, not one after the other: a ball that hits two
// at once sends them away alike. Impulses that make others approach each other, as along a row of touching balls, leave
// that to the next round. So momentum goes through a row as if the balls were a hair apart, and what is symmetric stays
// so, with all its energy where restitution is 1. (B. Smith, D. M. Kaufman, E. Vouga, R. Tamstorf, E. Grinspun,
// "Reflections on simultaneous impact", ACM Trans. Graph. 31, 2012.)
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/direct_presses.hpp>
#include <continuo/bodies/contacts/impulse.hpp>
#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>

namespace continuo {

/// Two bodies that touch, or a body and a wall, with the normal from a to b.
template <class Real, int Dim>
struct Collision {
  static constexpr std::uint32_t wall = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t a = 0, b = wall;
  Vector<Real, Dim> normal{};
  Material<Real> material{};
  Real impulse{};  // along the normal, of the round
  bool acts = false;
};

template <class Real, int Dim>
class CollisionRound {
 public:
  using V = Vector<Real, Dim>;
  using One = Collision<Real, Dim>;

  /// Applies the impulses of those that act, and sets them. `mover_of(body)` is the motion of a body. False where the
  /// impulses of those that share bodies were not found, in `most_sweeps` sweeps or directly: then what is applied is
  /// only near to what they should be.
  template <class MoverOf>
  [[nodiscard]] bool collide(std::span<One> all, MoverOf&& mover_of, int most_sweeps = 1000) {
    const auto mover = [&](std::uint32_t body) -> Mover<Real, Dim> {
      if (body == One::wall) return {no_velocity_, no_spin_, Real(0), Real(0), Real(0)};
      return mover_of(body);
    };
    bodies_.clear(), shared_.clear();
    for (One& one : all) {
      one.impulse = Real(0);
      for (const std::uint32_t body : {one.a, one.b})
        if (one.acts && mover(body).inverse_mass > Real(0)) bodies_.push_back(body);
    }
    std::ranges::sort(bodies_);
    for (One& one : all) {
      if (!one.acts) continue;
      if (is_shared(one.a) || is_shared(one.b)) {
        shared_.push_back(&one);
      } else {
        one.impulse = continuo::collide(mover(one.a), mover(one.b), one.normal, one.material);
      }
    }
    if (shared_.empty()) return true;
    list(mover);
    const bool parts = part(most_sweeps), rubs = resist_slip(most_sweeps);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const Mover<Real, Dim> of = mover(bodies_[k]);
      of.velocity = sweeps_.mover(k + 1).v, of.spin = sweeps_.mover(k + 1).spin;
    }
    return parts && rubs;
  }

 private:
  static constexpr int patience = 20;  // as many sweeps where there is no other way
  static constexpr Real rounding = std::numeric_limits<Real>::epsilon();

  [[nodiscard]] bool is_shared(std::uint32_t body) const { return std::ranges::equal_range(bodies_, body).size() > 1; }
  /// The bodies of shared_, also those that no impulse moves, and their contacts.
  template <class MoverOf>
  void list(MoverOf&& mover) {
    bodies_.clear(), sweeps_.clear();
    for (const One* one : shared_)
      for (const std::uint32_t body : {one->a, one->b})
        if (body != One::wall) bodies_.push_back(body);
    std::ranges::sort(bodies_);
    bodies_.erase(std::ranges::unique(bodies_).begin(), bodies_.end());
    for (const std::uint32_t body : bodies_) {
      const Mover<Real, Dim> of = mover(body);
      sweeps_.add({of.velocity, of.spin, of.inverse_mass, of.radius * of.inverse_inertia, of.radius});
    }
    const auto place_of = [this](std::uint32_t body) {
      if (body == One::wall) return 0u;
      return static_cast<std::uint32_t>(std::ranges::lower_bound(bodies_, body) - bodies_.begin()) + 1;
    };
    for (const One* one : shared_) {
      const Real approach = -dot(V(mover(one->b).velocity - mover(one->a).velocity), one->normal);
      sweeps_.add(one->normal, Real(0), place_of(one->a), place_of(one->b)).least =
          one->material.restitution * approach;
    }
  }
  /// The impulses along the normals: each pair parts with its restitution at least, and with just that where it bears
  /// an impulse. So the energy changes by impulse (parting - approach) / 2 = -(1 - e) impulse approach / 2 of each.
  [[nodiscard]] bool part(int most_sweeps) {
    const std::vector<Moving> before = sweeps_.movers();
    Real fastest(0);
    for (const Moving& one : before) fastest = std::max(fastest, length(one.v));
    const auto sweep = [&](int sweeps) { sweeps_.sweep(rounding / 4 * fastest, sweeps); };
    const auto is_found = [&](const Real& share) {
      Real now = fastest;
      for (const Moving& one : sweeps_.movers()) now = std::max(now, length(one.v));
      return are_finite() && sweeps_.greatest_error() <= share * now;
    };
    sweep(most_sweeps);
    bool found = is_found(64 * rounding);
    if (!found && press_directly<Real, Dim>(sweeps_, before)) {
      found = is_found(std::sqrt(rounding));
    } else if (!found) {
      sweep(patience * most_sweeps);
      found = is_found(16384 * rounding);  // an error that falls slowly from sweep to sweep is many times as large
    }
    for (std::size_t k = 0; k < shared_.size(); ++k) shared_[k]->impulse = sweeps_.rows()[k].impulse.press;
    return found;
  }
  /// Friction by these impulses, which lowers the energy as far as it can. Normal impulses that would answer it at once
  /// could raise the energy: what it makes approach is for the next round.
  [[nodiscard]] bool resist_slip(int most_sweeps) {
    if (std::ranges::none_of(shared_, [](const One* one) { return one->material.friction > Real(0); })) return true;
    Real fastest(0);
    for (const Moving& one : sweeps_.movers())
      fastest = std::max(fastest, Real(length(one.v) + one.radius * length(one.spin)));
    for (std::size_t k = 0; k < shared_.size(); ++k) {
      auto& row = sweeps_.row(k);
      row.friction = shared_[k]->material.friction, row.has_known_press = true;
    }
    const Real least = rounding * fastest, most = std::sqrt(rounding) * fastest;
    return are_finite() &&
           (sweeps_.sweep(least, most_sweeps) <= most ||
            (are_finite() && sweeps_.sweep(least, patience * most_sweeps) <= most)) &&
           are_finite();
  }

  /// A greatest number is found without those that are none.
  [[nodiscard]] bool are_finite() const {
    return std::ranges::all_of(sweeps_.movers(),
                               [](const Moving& one) { return is_finite(one.v) && is_finite(one.spin); });
  }

  using Moving = typename ProjectedGaussSeidel<Real, Dim>::Moving;
  ProjectedGaussSeidel<Real, Dim> sweeps_;
  std::vector<std::uint32_t> bodies_;  // at first those that move, once for each collision
  std::vector<One*> shared_;           // those that share bodies
  V no_velocity_{};
  Spin<Real, Dim> no_spin_{};
};

}  // namespace continuo
