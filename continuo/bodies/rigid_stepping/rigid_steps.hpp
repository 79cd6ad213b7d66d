// The stepper of rigid bodies behind a pointer, so that who uses it compiles none of it: that takes a minute.
#pragma once
#include <cstddef>
#include <memory>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo {

template <class Real, int Dim>
class RigidStepper;

/// What FastMotion asks of a RigidStepper, whose members have the same names.
template <class Real, int Dim>
class RigidSteps {
  std::unique_ptr<RigidStepper<Real, Dim>> stepper_;

 public:
  RigidSteps(World<Real, Dim>& world, const FastOptions<Real>& options);
  RigidSteps(const RigidSteps&) = delete;
  RigidSteps& operator=(const RigidSteps&) = delete;
  ~RigidSteps();

  void renew();
  void set_options(const FastOptions<Real>& options);
  [[nodiscard]] Status advance();
  [[nodiscard]] Real deepest_overlap() const;
  [[nodiscard]] std::size_t memory() const;
  void save(ByteWriter& writer) const;
  void load(ByteReader& reader);

  FastStatistics& statistics;
  const ContactLog<Real, Dim>& log;
};

}  // namespace continuo
