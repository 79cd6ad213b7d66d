// Integrates torques in the fast motion by the integrator of forces. The exception is implicit Euler, which treats
// torques as semi-implicit Euler does. Without a torque law this costs nothing.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_solver/solver_body.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/time_stepping/integrator.hpp>

namespace continuo {

template <class Real, int Dim>
class TorqueIntegration {
 public:
  using S = Spin<Real, Dim>;
  using Bodies = SolverBodies<Real, Dim>;

  [[nodiscard]] bool acts() const { return acts_; }

  /// Begins a step. order[k] is the number in the world of the body at place k.
  void begin(const World<Real, Dim>& world, const std::vector<std::uint32_t>& order) {
    acts_ = !world.torque_laws.empty();
    if (!acts_) return;
    world_ = &world;
    order_ = &order;
    orientation_ = world.orientation;
  }
  /// Changes the spins by the torques at the start of a substep.
  void push(Bodies& bodies, const Real& t, const Real& h) {
    if (!acts_) return;
    find_rates(bodies, t, rate_);
    for (std::size_t k = 0; k < bodies.size(); ++k) add(bodies, k, rate_[k] * h);
  }
  /// Finds the orientations at the end of the substep.
  void turn(const Bodies& bodies, const IntegratorRule& rule, const Real& h) {
    if (!acts_) return;
    const Real lag = static_cast<Real>(rule.lag) * h;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (!bodies.moves(k)) continue;
      S spin = spin_of(bodies, k);
      if (!bodies.touched[k]) spin -= rate_[k] * lag;
      auto& orientation = orientation_[(*order_)[k]];
      orientation = turned(orientation, spin, h);
    }
  }
  /// Corrects the spins at the end t of the substep, as the rule says.
  void correct(Bodies& bodies, const IntegratorRule& rule, const Real& t, const Real& h) {
    if (!acts_) return;
    const bool anew = rule.correction == EndCorrection::anew;
    const auto add_to_all = [&](const auto& change) {
      for (std::size_t k = 0; k < bodies.size(); ++k)
        if (!bodies.touched[k]) add(bodies, k, change(k));
    };
    if (anew) add_to_all([&](std::size_t k) { return S(rate_[k] * -h); });
    find_rates(bodies, t, rate_after_);
    add_to_all([&](std::size_t k) { return anew ? S(rate_after_[k] * h) : S((rate_after_[k] - rate_[k]) * (h / 2)); });
  }
  [[nodiscard]] const Orientation<Real, Dim>& orientation(std::size_t body) const { return orientation_[body]; }

 private:
  [[nodiscard]] static S spin_of(const Bodies& bodies, std::size_t k) {
    return vector_of<S::size()>(bodies.motion[k].rim) * (1 / bodies.radius(k));
  }
  static void add(Bodies& bodies, std::size_t k, const S& change) {
    Quad<Real>& rim = bodies.motion[k].rim;
    for (std::size_t axis = 0; axis < S::size(); ++axis) rim[axis] += change[axis] * bodies.radius(k);
  }
  void find_rates(const Bodies& bodies, const Real& t, std::vector<S>& rates) {
    const std::size_t n = bodies.size();
    x_.resize(n), v_.resize(n), spin_.resize(n), torque_.resize(n), rates.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (*order_)[k];
      x_[i] = bodies.x(k), v_[i] = bodies.v(k), spin_[i] = spin_of(bodies, k);
    }
    torques<Real, Dim>(*world_, t, {x_, v_, orientation_, spin_}, torque_);
    for (std::size_t k = 0; k < n; ++k) {
      const Real radius = bodies.radius(k);
      rates[k] = torque_[(*order_)[k]] * (bodies.motion[k].rim[3] / (radius * radius));
    }
  }

  bool acts_ = false;
  const World<Real, Dim>* world_ = nullptr;
  const std::vector<std::uint32_t>* order_ = nullptr;
  std::vector<Orientation<Real, Dim>> orientation_;  // by number of the body, as spin and torque
  std::vector<Vector<Real, Dim>> x_, v_;
  std::vector<S> spin_, torque_;
  std::vector<S> rate_, rate_after_;  // by place
};

}  // namespace continuo
