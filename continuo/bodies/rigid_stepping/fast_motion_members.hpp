// The members of FastMotion, for the two sources that instantiate it: each takes half a minute to compile.
#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/manifold_kernels/chosen_kernels.hpp>
#include <continuo/bodies/rigid_stepping/rigid_steps.hpp>
#include <continuo/bodies/time_stepping/fast_stepper.hpp>

namespace continuo {

/// Balls without joints have a stepper of their own, which is many times as fast.
template <class Real, int Dim>
struct FastMotion<Real, Dim>::Steppers {
  Steppers(World<Real, Dim>& of, const FastOptions<Real>& chosen) : world(of), options(chosen) { choose(); }

  /// Makes the stepper that the world needs now, if it has the other one.
  void choose() {
    const bool needs_any = world.has_solids() || world.joint_count() > 0 || world.has_traits() || world.has_meshes() ||
                           world.may_collide || world.may_push;
    if (needs_any ? any.has_value() : balls.has_value()) return;
    const FastStatistics so_far = any ? any->statistics : balls ? balls->statistics : FastStatistics{};
    any.reset(), balls.reset();
    needs_any ? void(any.emplace(world, options)) : void(balls.emplace(world, options));
    with_stepper([&](auto& stepper) { stepper.statistics = so_far; });
  }
  /// Calls act(stepper).
  template <class Act>
  decltype(auto) with_stepper(Act&& act) {
    return any ? act(*any) : act(*balls);
  }
  /// Balls are solved in registers that every machine has, but a width that is wrong is wrong for them, too.
  [[nodiscard]] Status advance() {
    choose();
    if (balls && options.registers != 0)
      if (const auto kernels = chosen_kernels<Real, Dim>(options.registers); !kernels) return kernels.status();
    return with_stepper([](auto& stepper) { return stepper.advance(); });
  }
  void renew() {
    choose();
    with_stepper([](auto& stepper) { stepper.renew(); });
  }

  /// What a stepper has made for its steps, threads and records stays where these do.
  void set(const FastOptions<Real>& chosen) {
    FastOptions<Real> as_before = chosen;
    as_before.hertz = options.hertz, as_before.damping = options.damping;
    as_before.fastest_push = options.fastest_push, as_before.sleep_speed = options.sleep_speed;
    const bool goes_on = as_before == options;
    options = chosen;
    if (goes_on) return with_stepper([&](auto& stepper) { stepper.set_options(chosen); });
    const FastStatistics so_far = with_stepper([](auto& stepper) { return stepper.statistics; });
    any.reset(), balls.reset();
    choose();
    with_stepper([&](auto& stepper) { stepper.statistics = so_far; });
  }
  [[nodiscard]] Status advance_to(const Real& t) {
    if (!(t >= world.time) || !(t - t == Real(0)))
      return invalid_input("the time to advance to must be finite and not before the present");
    if (!(options.step > Real(0))) return advance();  // which says what is wrong
    // In double, as many steps of a single one have no number of their own.
    const double steps = std::ceil(static_cast<double>(t - world.time) / static_cast<double>(options.step) - 1e-9);
    constexpr double most = 1e15;
    if (!(steps <= most)) return invalid_input("the time to advance to is more than 1e15 steps away");
    for (double k = 0; k < steps; ++k)
      if (Status status = advance(); !status) return status;
    return {};
  }

  World<Real, Dim>& world;
  FastOptions<Real> options;
  std::optional<Stepper> balls;
  std::optional<RigidSteps<Real, Dim>> any;
};

template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(World<Real, Dim>& world, const FastOptions<Real>& options)
    : steppers_(std::make_unique<Steppers>(world, options)) {}
template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>& FastMotion<Real, Dim>::operator=(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>::~FastMotion() = default;
template <class Real, int Dim>
Status FastMotion<Real, Dim>::advance() {
  return steppers_->advance();
}
template <class Real, int Dim>
Status FastMotion<Real, Dim>::step(const Real& h) {
  FastOptions<Real> of_size = options();
  of_size.step = h;
  if (of_size != options()) set_options(of_size);
  return advance();
}
template <class Real, int Dim>
Status FastMotion<Real, Dim>::advance_to(const Real& t) {
  return steppers_->advance_to(t);
}
template <class Real, int Dim>
const FastOptions<Real>& FastMotion<Real, Dim>::options() const {
  return steppers_->options;
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::set_options(const FastOptions<Real>& options) {
  steppers_->set(options);
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::refresh() {
  steppers_->renew();
}
template <class Real, int Dim>
Real FastMotion<Real, Dim>::deepest_overlap() const {
  return steppers_->with_stepper([](const auto& stepper) { return stepper.deepest_overlap(); });
}
template <class Real, int Dim>
std::size_t FastMotion<Real, Dim>::memory() const {
  return steppers_->with_stepper([](const auto& stepper) { return stepper.memory(); });
}
template <class Real, int Dim>
const FastStatistics& FastMotion<Real, Dim>::statistics() const {
  return steppers_->with_stepper([](const auto& stepper) -> const FastStatistics& { return stepper.statistics; });
}

template <class Real, int Dim>
std::span<const ContactEvent<Real, Dim>> FastMotion<Real, Dim>::contact_events() const {
  return steppers_->with_stepper([](const auto& stepper) { return stepper.log.events(); });
}
template <class Real, int Dim>
std::size_t FastMotion<Real, Dim>::lost_contact_events() const {
  return steppers_->with_stepper([](const auto& stepper) { return stepper.log.lost(); });
}

template <class Real, int Dim>
void FastMotion<Real, Dim>::save(ByteWriter& writer) const {
  steppers_->with_stepper([&](const auto& stepper) { stepper.save(writer); });
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::load(ByteReader& reader) {
  steppers_->choose();
  steppers_->with_stepper([&](auto& stepper) { stepper.load(reader); });
}

}  // namespace continuo
