// continuo/bodies/exact_engine.hpp
// What the exact motion hands its work to: one engine for parabolas, one for whatever paths other forces make.
#pragma once
#include <memory>
#include <string>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/exact_motion.hpp>

namespace continuo {

template <class Real, int Dim>
class ExactEngine {
 public:
  explicit ExactEngine(const ExactOptions<Real>& options) : contacts(options.contact_events) {}
  virtual ~ExactEngine() = default;
  virtual std::string advance_to(const Real& t) = 0;
  virtual void save(ByteWriter& writer) = 0;
  virtual void load(ByteReader& reader) = 0;
  /// Of contacts that last, that they end.
  virtual void let_go() = 0;

  ExactStatistics statistics{};
  ContactLog<Real, Dim> contacts;
  /// Whether the other engine is to go on from here, where gravity is the only force: bodies have come to lie on each
  /// other, and move on no parabolas, or none does any more.
  bool hands_over = false;
};

/// From event to event on parabolas: event_driven.cpp.
template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> event_driven(World<Real, Dim>& world, const ExactOptions<Real>& options);

/// From contact to contact on whatever paths forces make, by an error-controlled method: forced_flight.cpp.
template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> forced_flight(World<Real, Dim>& world, const ExactOptions<Real>& options,
                                                      Companions<Real, Dim>* companions);

}  // namespace continuo
