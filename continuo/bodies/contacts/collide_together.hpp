// Collisions of one instant. Those that share bodies are solved together, not one after the other: a ball that hits two
// at once sends them away alike. Impulses that make others approach each other, as along a row of touching balls, leave
// that to the next round. So momentum goes through a row as if the balls were a hair apart, and what is symmetric stays
// so, with all its energy where restitution is 1. (B. Smith, D. M. Kaufman, E. Vouga, R. Tamstorf, E. Grinspun,
// "Reflections on simultaneous impact", ACM Trans. Graph. 31, 2012.)
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

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

  /// Applies the impulses of those that act, and sets them. `mover_of(body)` is the motion of a body.
  template <class MoverOf>
  void collide(std::span<One> all, MoverOf&& mover_of) {
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
    if (shared_.empty()) return;
    part(mover);
    resist_slip(mover);
  }

 private:
  static constexpr int most_sweeps = 1000;

  [[nodiscard]] bool is_shared(std::uint32_t body) const { return std::ranges::equal_range(bodies_, body).size() > 1; }
  /// The impulses along the normals: each pair parts with its restitution at least, and with just that where it bears
  /// an impulse. So the energy changes by impulse (parting - approach) / 2 = -(1 - e) impulse approach / 2 of each.
  template <class MoverOf>
  void part(MoverOf&& mover) {
    bodies_.erase(std::ranges::unique(bodies_).begin(), bodies_.end());
    sweeps_.clear();
    fastest_ = Real(0);
    for (const std::uint32_t body : bodies_) {
      const Mover<Real, Dim> of = mover(body);
      fastest_ = std::max(fastest_, length(of.velocity));
      sweeps_.add({of.velocity, of.spin, of.inverse_mass, of.radius * of.inverse_inertia, of.radius});
    }
    const auto place_of = [this](std::uint32_t body) {
      const auto at = std::ranges::lower_bound(bodies_, body);
      return at == bodies_.end() || *at != body ? 0u : static_cast<std::uint32_t>(at - bodies_.begin()) + 1;
    };
    for (const One* one : shared_) {
      const Real approach = -dot(V(mover(one->b).velocity - mover(one->a).velocity), one->normal);
      sweeps_.add(one->normal, Real(0), place_of(one->a), place_of(one->b)).least =
          one->material.restitution * approach;
    }
    sweeps_.sweep(least(), most_sweeps);
    for (std::size_t k = 0; k < bodies_.size(); ++k) mover(bodies_[k]).velocity = sweeps_.mover(k + 1).v;
    for (std::size_t k = 0; k < shared_.size(); ++k) shared_[k]->impulse = sweeps_.rows()[k].impulse.press;
  }
  /// Friction by these impulses, which lowers the energy as far as it can. Normal impulses that would answer it at once
  /// could raise the energy: what it makes approach is for the next round.
  template <class MoverOf>
  void resist_slip(MoverOf&& mover) {
    rubs_.assign(shared_.size(), {});
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      Real greatest(0);
      for (std::size_t n = 0; n < shared_.size(); ++n) {
        const std::size_t k = sweep % 2 == 0 ? n : shared_.size() - 1 - n;
        const One& one = *shared_[k];
        const Real most = one.material.friction * one.impulse;
        if (!(most > Real(0))) continue;
        const Mover<Real, Dim> a = mover(one.a), b = mover(one.b);
        const Real compliance = compliance_of_slip(a, b);
        V total = rubs_[k] + slip_of(a, b, one.normal) * (1 / compliance);
        if (const Real size = length(total); size > most) total *= most / size;
        const V change = total - rubs_[k];
        rub(a, b, one.normal, change);
        rubs_[k] = total;
        greatest = std::max(greatest, Real(length(change) * compliance));
      }
      if (!(greatest > least())) return;
    }
  }
  [[nodiscard]] Real least() const { return std::numeric_limits<Real>::epsilon() / 4 * fastest_; }

  ProjectedGaussSeidel<Real, Dim> sweeps_;
  std::vector<std::uint32_t> bodies_;  // those that move: at first once for each collision
  std::vector<One*> shared_;           // those that share bodies
  std::vector<V> rubs_;                // the impulses of their friction, on a
  Real fastest_{};
  V no_velocity_{};
  Spin<Real, Dim> no_spin_{};
};

}  // namespace continuo
