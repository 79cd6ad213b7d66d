// The members of FastMotion, for the two sources that instantiate it: each takes half a minute to compile.
#pragma once
#include <memory>
#include <optional>
#include <utility>

#include <continuo/bodies/fast_motion.hpp>
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
  [[nodiscard]] Status advance() {
    choose();
    return with_stepper([](auto& stepper) { return stepper.advance(); });
  }
  void renew() {
    choose();
    with_stepper([](auto& stepper) { stepper.renew(); });
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
