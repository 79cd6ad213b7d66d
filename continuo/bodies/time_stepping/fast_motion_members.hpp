// The members of FastMotion, for the two sources that instantiate it: each takes half a minute to compile.
#pragma once
#include <memory>
#include <utility>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/time_stepping/fast_stepper.hpp>

namespace continuo {

template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(World<Real, Dim>& world, const FastOptions<Real>& options)
    : stepper_(std::make_unique<Stepper>(world, options)) {}
template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>& FastMotion<Real, Dim>::operator=(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>::~FastMotion() = default;
template <class Real, int Dim>
Status FastMotion<Real, Dim>::advance() {
  return stepper_->advance();
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::refresh() {
  stepper_->renew();
}
template <class Real, int Dim>
Real FastMotion<Real, Dim>::deepest_overlap() const {
  return stepper_->deepest_overlap();
}
template <class Real, int Dim>
std::size_t FastMotion<Real, Dim>::memory() const {
  return stepper_->memory();
}
template <class Real, int Dim>
const FastStatistics& FastMotion<Real, Dim>::statistics() const {
  return stepper_->statistics;
}

template <class Real, int Dim>
std::span<const ContactEvent<Real, Dim>> FastMotion<Real, Dim>::contact_events() const {
  return stepper_->log.events();
}
template <class Real, int Dim>
std::size_t FastMotion<Real, Dim>::lost_contact_events() const {
  return stepper_->log.lost();
}

template <class Real, int Dim>
void FastMotion<Real, Dim>::save(ByteWriter& writer) const {
  stepper_->save(writer);
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::load(ByteReader& reader) {
  stepper_->load(reader);
}

}  // namespace continuo
