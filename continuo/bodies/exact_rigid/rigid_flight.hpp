// The flight of bodies that move together: an integrator, its present step as polynomials in time, and bounds of the
// motion within that step.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/exact_options.hpp>
#include <continuo/bodies/exact_rigid/rigid_system.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo {

/// Bounds of the motion of a body within a step: of the speed of its points, and of their acceleration beyond a steady
/// one, which for a body that falls is gravity; `sway` is what the centre alone has of that.
template <class Real, int Dim>
struct MotionBounds {
  Real speed{};
  Vector<Real, Dim> steady{};
  Real acceleration{}, sway{};
  Real spin{}, turning_on{};      // of the spin and of its derivative
  Real jerk{}, turning_change{};  // of the second derivatives of velocity and spin, by differences
};

/// What accelerates a body at an instant.
template <class Real, int Dim>
struct Accelerations {
  Vector<Real, Dim> linear{};
  Spin<Real, Dim> angular{};
};

template <class Real, int Dim>
class RigidFlight {
 public:
  using System = RigidSystem<Real, Dim>;
  using X = std::vector<Real>;
  using Body = ExactBody<Real, Dim>;

  /// Begins at time t, where the system is. `reach` is that of all bodies of the world; `first_step` is tried first,
  /// unless it is 0.
  RigidFlight(System system, const Real& t, const Real& until, const ExactOptions<Real>& options,
              std::span<const Real> reach, const Real& first_step)
      : system_(std::make_unique<System>(std::move(system))), begin_(t), end_(t), reach_(reach) {
    const Real tolerance = std::max(options.tolerance, Real(64 * std::numeric_limits<Real>::epsilon()));
    system_->begin(tolerance);
    Options<X> how{.rtol = tolerance, .atol = tolerance};
    how.atol_each = tolerances(tolerance, system_->gravity());
    how.rtol_each.assign(how.atol_each.size(), tolerance);
    how.max_steps = options.most_events;
    how.interrupt = options.interrupt;
    how.first_step = std::min(first_step, Real(until - t));
    how.projection = [system = system_.get()](Real at, X& x) { return system->project(at, x); };
    integrator_.emplace(std::ref(*system_), system_->pack(), Interval<Real>{t, until}, Dop853{}, std::move(how));
  }

  /// Takes the next step. False where it cannot.
  [[nodiscard]] bool advance() {
    integrator_->advance();
    if (!succeeded(integrator_->outcome().ending)) return false;
    begin_ = integrator_->step_begin(), size_ = integrator_->step_size(), end_ = integrator_->t();
    polynomials_ = integrator_->dense_output();
    bound();
    return true;
  }
  [[nodiscard]] const Outcome<Real>& outcome() const { return integrator_->outcome(); }
  [[nodiscard]] Real begin() const { return begin_; }
  [[nodiscard]] Real end() const { return end_; }
  [[nodiscard]] Real step_size() const { return integrator_->step_size(); }
  [[nodiscard]] System& system() { return *system_; }
  [[nodiscard]] const System& system() const { return *system_; }
  [[nodiscard]] const MotionBounds<Real, Dim>& bounds(std::size_t k) const { return bounds_[k]; }

  /// The state at a time of the present step; on the constraints at its end only.
  void at(const Real& t, X& x) {
    if (t == end_) {
      x = integrator_->x();
      return;
    }
    x.resize(integrator_->x().size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = component((t - begin_) / size_, i);
  }
  /// Body k at a time of the present step, and at its end.
  /// @{
  void body_at(std::size_t k, const Real& t, Body& body) const {
    if (polynomials_.empty()) return body_at_end(k, body);  // before the first step
    const Real theta = (t - begin_) / size_;
    take(body, [&, i = k * System::stride]() mutable { return component(theta, i++); });
  }
  void body_at_end(std::size_t k, Body& body) const {
    take(body, [&, i = k * System::stride]() mutable { return integrator_->x()[i++]; });
  }
  /// @}
  /// What accelerates body k at a time of the present step, at which it is `body`.
  [[nodiscard]] Accelerations<Real, Dim> accelerations_at(std::size_t k, const Real& t, const Body& body) const {
    Accelerations<Real, Dim> found;
    if (polynomials_.empty()) return found;
    const Real theta = (t - begin_) / size_;
    for (std::size_t i = 0; i < Dim; ++i) found.linear[i] = slope(theta, k * System::stride + Dim + i);
    Spin<Real, Dim> torque;
    for (std::size_t i = 0; i < torque.size(); ++i)
      torque[i] = slope(theta, (k + 1) * System::stride - torque.size() + i);
    found.angular = body.inverse_inertia_now * torque + free_turning(body);
    return found;
  }

 private:
  template <class Next>
  static void take(Body& body, Next&& next) {
    const auto fill = [&](auto& vector) {
      for (Real& value : vector.components) value = next();
    };
    fill(body.x), fill(body.v), fill(body.orientation), fill(body.momentum);
    body.orientation = turned(body.orientation, Spin<Real, Dim>{}, Real(0));
    body.turn_with_momentum();
  }
  [[nodiscard]] Real component(const Real& theta, std::size_t i) const {
    Real value = polynomials_.back()[i];
    for (std::size_t j = polynomials_.size() - 1; j-- > 0;) value = value * theta + polynomials_[j][i];
    return value;
  }
  [[nodiscard]] Real slope(const Real& theta, std::size_t i) const {
    Real value(0);
    for (std::size_t j = polynomials_.size() - 1; j > 0; --j)
      value = value * theta + static_cast<Real>(j) * polynomials_[j][i];
    return value / size_;
  }
  /// The tolerance in units of each body, but no less than the rounding of what joints and contacts do to it, which is
  /// that of the largest body that it flies with.
  [[nodiscard]] std::vector<Real> tolerances(const Real& tolerance, const Real& gravity) const {
    using V = Vector<Real, Dim>;
    constexpr Real rounding = 256 * std::numeric_limits<Real>::epsilon();
    const bool is_alone = system_->joints().empty() && system_->contacts().empty();
    Real way(0), speed(0), twist(0);
    for (std::size_t k = 0; k < system_->moving() && !is_alone; ++k) {
      const Body& body = std::as_const(*system_).bodies()[k];
      const Real r = reach_[system_->numbers()[k]];
      const Real fastest = length(body.v) + length(body.spin) * r + std::sqrt(gravity * r);
      way = std::max(way, Real(length(body.x) + r)), speed = std::max(speed, fastest);
      twist = std::max(twist, Real(r * fastest / body.inverse_mass));
    }
    std::vector<Real> each;
    for (std::size_t k = 0; k < system_->moving(); ++k) {
      const Real r = reach_[system_->numbers()[k]];
      Real inertia(0);
      for (std::size_t i = 0; i < Spin<Real, Dim>::size(); ++i)
        inertia = std::max(inertia, std::as_const(*system_).bodies()[k].inertia[i][i]);
      each.insert(each.end(), V::size(), std::max(Real(tolerance * r), Real(rounding * way)));
      each.insert(each.end(), V::size(), std::max(Real(tolerance * r), Real(rounding * speed)));
      each.insert(each.end(), Orientation<Real, Dim>::size(), std::max(tolerance, Real(rounding * way / r)));
      each.insert(each.end(), Spin<Real, Dim>::size(), std::max(Real(tolerance * inertia), Real(rounding * twist)));
    }
    each.insert(each.end(), system_->contacts().size(), Real(1e30));  // impulses need no error control
    return each;
  }
  /// Samples the step; what lies between the samples exceeds them by less than a quarter where the step is accurate.
  void bound() {
    constexpr int samples = 5;
    bounds_.assign(system_->moving(), {});
    Body body;
    for (std::size_t k = 0; k < system_->moving(); ++k) {
      body = system_->bodies()[k];
      const Real r = reach_[system_->numbers()[k]];
      MotionBounds<Real, Dim>& bounds = bounds_[k];
      for (std::size_t i = 0; i < Dim; ++i) {
        const std::size_t v = k * System::stride + Dim + i;
        bounds.steady[i] = (component(Real(1), v) - component(Real(0), v)) / size_;
      }
      Accelerations<Real, Dim> before;
      for (int sample = 0; sample < samples; ++sample) {
        const Real theta = static_cast<Real>(sample) / (samples - 1);
        body_at(k, begin_ + theta * size_, body);
        const Accelerations<Real, Dim> here = accelerations_at(k, begin_ + theta * size_, body);
        const Real spin = length(body.spin), pull = length(here.linear - bounds.steady);
        const Real turning_on = length(here.angular);
        bounds.spin = std::max(bounds.spin, Real(1.25) * spin);
        bounds.turning_on = std::max(bounds.turning_on, Real(1.25) * turning_on);
        if (sample > 0) {
          const Real rate = Real(1.5) * (samples - 1) / size_;
          bounds.jerk = std::max(bounds.jerk, Real(rate * length(here.linear - before.linear)));
          bounds.turning_change = std::max(bounds.turning_change, Real(rate * length(here.angular - before.angular)));
        }
        before = here;
        bounds.speed = std::max(bounds.speed, Real(1.25) * (length(body.v) + spin * r));
        bounds.sway = std::max(bounds.sway, Real(1.25) * pull);
        bounds.acceleration = std::max(bounds.acceleration, Real(1.25) * (pull + r * (turning_on + spin * spin)));
      }
    }
  }

  std::unique_ptr<System> system_;  // its place stays
  std::optional<Integrator<SystemReference<System>, X, Dop853>> integrator_;
  Real begin_, size_{}, end_;
  std::span<const X> polynomials_;
  std::vector<MotionBounds<Real, Dim>> bounds_;
  std::span<const Real> reach_;  // of all bodies of the world
};

}  // namespace continuo
