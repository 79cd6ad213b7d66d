// The members of RigidSteps, for the two sources that compile the stepper.
#pragma once
#include <memory>

#include <continuo/bodies/rigid_stepping/rigid_stepper.hpp>
#include <continuo/bodies/rigid_stepping/rigid_steps.hpp>

namespace continuo {

template <class Real, int Dim>
RigidSteps<Real, Dim>::RigidSteps(World<Real, Dim>& world, const FastOptions<Real>& options)
    : stepper_(std::make_unique<RigidStepper<Real, Dim>>(world, options)),
      statistics(stepper_->statistics),
      log(stepper_->log) {}
template <class Real, int Dim>
RigidSteps<Real, Dim>::~RigidSteps() = default;
template <class Real, int Dim>
void RigidSteps<Real, Dim>::set_options(const FastOptions<Real>& options) {
  stepper_->set_options(options);
}
template <class Real, int Dim>
void RigidSteps<Real, Dim>::renew() {
  stepper_->renew();
}
template <class Real, int Dim>
Status RigidSteps<Real, Dim>::advance() {
  return stepper_->advance();
}
template <class Real, int Dim>
Real RigidSteps<Real, Dim>::deepest_overlap() const {
  return stepper_->deepest_overlap();
}
template <class Real, int Dim>
std::size_t RigidSteps<Real, Dim>::memory() const {
  return stepper_->memory();
}
template <class Real, int Dim>
void RigidSteps<Real, Dim>::save(ByteWriter& writer) const {
  stepper_->save(writer);
}
template <class Real, int Dim>
void RigidSteps<Real, Dim>::load(ByteReader& reader) {
  stepper_->load(reader);
}

}  // namespace continuo
