// The accelerations by forces other than gravity at each substep of the fast motion, by one of the integrators of
// integrator.hpp. Without such forces this costs nothing.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_solver/solver_body.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/time_stepping/integrator.hpp>

namespace continuo {

template <class Real, int Dim>
class ForceIntegration {
 public:
  using V = Vector<Real, Dim>;
  using Bodies = SolverBodies<Real, Dim>;

  [[nodiscard]] bool acts() const { return acts_; }

  /// Begins a step. order[k] is the number in the world of the body at place k.
  void begin(const World<Real, Dim>& world, const std::vector<std::uint32_t>& order) {
    acts_ = !only_gravity(world);
    world_ = &world;
    order_ = &order;
  }
  /// Finds the accelerations by all forces in a substep of h from t on. False where the implicit equations for those at
  /// its end could not be solved.
  [[nodiscard]] bool accelerate(Bodies& bodies, const IntegratorRule& rule, const Real& t, const Real& h) {
    if (!acts_) return true;
    return find(bodies, t, rule.solves_equations ? h : Real(0));
  }
  /// Corrects the velocities at the end t of a substep, as the rule says.
  void correct(Bodies& bodies, ThreadTeam& team, const IntegratorRule& rule, const Real& t, const Real& h) {
    const std::vector<V> before = bodies.accelerations;
    const bool anew = rule.correction == EndCorrection::anew;
    const auto add = [&](const auto& change) {
      team.for_each(0, bodies.size(), 1024, [&](std::size_t from, std::size_t to) {
        for (std::size_t k = from; k < to; ++k)
          if (!bodies.touched[k]) put(V(bodies.v(k) + change(k)), bodies.motion[k].linear);
      });
    };
    if (anew) add([&](std::size_t k) { return V(before[k] * -h); });
    find(bodies, t, Real(0));
    const std::vector<V>& after = bodies.accelerations;
    add([&](std::size_t k) { return anew ? V(after[k] * h) : V((after[k] - before[k]) * (h / 2)); });
  }
  /// Whether only gravity and the constant force act on the body at place k.
  [[nodiscard]] bool is_steady(const Bodies& bodies, std::size_t k) const {
    if (!acts_ || !bodies.moves(k)) return true;
    const std::size_t i = (*order_)[k];
    return bodies.acceleration(k) ==
           (world_->mass[i] * world_->gravity + world_->constant_force[i]) * bodies.inverse_mass(k);
  }

  [[nodiscard]] std::size_t memory() const {
    return (x_.capacity() + v_.capacity() + force_.capacity()) * sizeof(V) + inverse_mass_.capacity() * sizeof(Real);
  }

 private:
  /// Finds the accelerations at time t, or, with h > 0, at the end of an implicit step of h from t.
  bool find(Bodies& bodies, const Real& t, const Real& h) {
    const std::vector<std::uint32_t>& order = *order_;
    x_.resize(bodies.size()), v_.resize(bodies.size()), force_.resize(bodies.size());
    inverse_mass_.resize(bodies.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      x_[i] = bodies.x(k), v_[i] = bodies.v(k), inverse_mass_[i] = bodies.inverse_mass(k);
    }
    const bool is_solved = h == Real(0) || forces_at_end<Real, Dim>(*world_, t, h, x_, v_, inverse_mass_, force_);
    if (h == Real(0)) forces<Real, Dim>(*world_, t, x_, v_, force_);
    bodies.accelerations.resize(bodies.size());
    for (std::size_t k = 0; k < order.size(); ++k) bodies.accelerations[k] = force_[order[k]] * bodies.inverse_mass(k);
    return is_solved;
  }

  bool acts_ = false;
  const World<Real, Dim>* world_ = nullptr;
  const std::vector<std::uint32_t>* order_ = nullptr;
  std::vector<V> x_, v_, force_;  // by number of the body
  std::vector<Real> inverse_mass_;
};

}  // namespace continuo
