// Bodies that many others touch which are much lighter, as a drum and what tumbles in it. Of contacts that share a body
// only one can be solved at a time, so that a hundred of them would be a hundred colours. Each contact of a heavy body
// acts on a copy of its own instead, and after each sweep the body gets the sum of their changes: momentum is the same,
// and what the contacts miss of each other within a sweep is as small as the masses of what touches against that of the
// body. (Splitting of bodies into copies: R. Tonge, F. Benevolenski, A. Voroshilov, "Mass splitting for jitter-free
// parallel rigid body simulation", ACM Transactions on Graphics 31 (2012), 105, there with parts of the mass.)
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/manifold_kernels/solver_states.hpp>
#include <continuo/bodies/rigid_stepping/rigid_body.hpp>

namespace continuo {

template <class Real, int Dim>
class HeavyBodies {
 public:
  static constexpr std::uint32_t least_contacts = 32;
  /// By how much of what an impulse changes there all contacts together may move a heavy body.
  static constexpr Real most_change = Real(0.1);

  /// Finds them among bodies, where heads(k) has the bodies a and b of contact k below `contacts`, and may_be(body)
  /// tells whether one may be heavy.
  template <class HeadOf, class MayBe>
  void find(std::span<const RigidBody<Real, Dim>> bodies, std::size_t contacts, HeadOf&& head, MayBe&& may_be) {
    count_.assign(bodies.size(), 0);
    copied_.clear(), copy_of_a_.clear(), copy_of_b_.clear();
    for (std::size_t k = 0; k < contacts; ++k) ++count_[head(k).a], ++count_[head(k).b];
    are_there_ = false;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      if (count_[i] < least_contacts || bodies[i].is_fixed() || !may_be(i)) {
        count_[i] = 0;
      } else
        are_there_ = true;
    }
    if (!are_there_) return;
    keep_heavy(bodies, contacts, head);
    copy_of_a_.assign(contacts, none), copy_of_b_.assign(contacts, none);
    for (std::size_t k = 0; k < contacts; ++k) {
      if (is_heavy(head(k).a)) copy_of_a_[k] = add_copy(head(k).a);
      if (is_heavy(head(k).b)) copy_of_b_[k] = add_copy(head(k).b);
    }
    are_there_ = !copied_.empty();
  }
  [[nodiscard]] bool is_heavy(std::size_t body) const { return are_there_ && count_[body] != 0; }
  /// The bodies of the copies. Those of a contact on a body: contact k has copy copy_of_a(k) of its body a, or none.
  /// @{
  static constexpr std::uint32_t none = 0xffffffff;
  [[nodiscard]] std::span<const std::uint32_t> copied() const { return copied_; }
  [[nodiscard]] std::uint32_t copy_of_a(std::size_t k) const { return are_there_ ? copy_of_a_[k] : none; }
  [[nodiscard]] std::uint32_t copy_of_b(std::size_t k) const { return are_there_ ? copy_of_b_[k] : none; }
  /// @}
  /// The copies get the states of their bodies.
  void spread(SolverState<Real, Dim>* states, SolverState<Real, Dim>* copies) const {
    for (std::size_t n = 0; n < copied_.size(); ++n) copies[n] = states[copied_[n]];
  }
  /// The bodies get what has changed since.
  void gather(SolverState<Real, Dim>* states, const SolverState<Real, Dim>* copies) {
    if (copied_.empty()) return;
    changes_.assign(copied_.size(), {});
    for (std::size_t n = 0; n < copied_.size(); ++n)
      changes_[n] = {copies[n].v() - states[copied_[n]].v(), copies[n].spin() - states[copied_[n]].spin()};
    for (std::size_t n = 0; n < copied_.size(); ++n) {
      SolverState<Real, Dim>& body = states[copied_[n]];
      body.set_v(body.v() + changes_[n].v), body.set_spin(body.spin() + changes_[n].spin);
    }
  }

 private:
  struct Change {
    Vector<Real, Dim> v{};
    Spin<Real, Dim> spin{};
  };
  /// Leaves those that nothing touches but bodies that are so much lighter.
  template <class HeadOf>
  void keep_heavy(std::span<const RigidBody<Real, Dim>> bodies, std::size_t contacts, HeadOf&& head) {
    const std::vector<std::uint32_t> count = count_;
    const auto check = [&](std::uint32_t heavy, std::uint32_t other) {
      if (count[heavy] == 0) return;
      const RigidBody<Real, Dim>& body = bodies[heavy];
      Real turns(0);
      for (std::size_t i = 0; i < Spin<Real, Dim>::size(); ++i) turns += body.inverse_inertia_now[i][i];
      const Real change = body.inverse_mass + turns * squared(bodies[other].x - body.x);
      const bool is_light = static_cast<Real>(count[heavy]) * change <= most_change * bodies[other].inverse_mass;
      if (!is_light || count[other] != 0) count_[heavy] = 0;
    };
    for (std::size_t k = 0; k < contacts; ++k) check(head(k).a, head(k).b), check(head(k).b, head(k).a);
  }
  [[nodiscard]] std::uint32_t add_copy(std::uint32_t body) {
    copied_.push_back(body);
    return static_cast<std::uint32_t>(copied_.size() - 1);
  }

  bool are_there_ = false;
  std::vector<std::uint32_t> count_;  // of the contacts of each body that may be heavy
  std::vector<std::uint32_t> copied_, copy_of_a_, copy_of_b_;
  std::vector<Change> changes_;
};

}  // namespace continuo
