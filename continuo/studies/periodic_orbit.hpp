// Closed orbits of systems that do not depend on time: found by running until the motion comes back to where it was,
// then solved for as a boundary-value problem with an unknown period; the multipliers say whether neighbours come
// nearer.
#pragma once
#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// For how long, and how exactly, an orbit is searched for.
struct PeriodicOrbitOptions {
  double settle = 100;       // time for the motion to come to the orbit, before it is looked for
  double duration = 1000;    // within which it must come back
  double tolerance = 1e-10;  // of the boundary-value problem
  double rtol = 1e-9;        // of the integrations
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // from 0 to 1
};

/// A closed orbit with its multipliers.
struct PeriodicOrbit {
  Outcome<double> outcome;  // its hint says why there is none
  double period = 0;
  boundary::BoundaryValueSolution orbit;          // over t / period from 0 to 1
  std::vector<std::complex<double>> multipliers;  // by descending size; one of them is 1
  bool stable = false;                            // all but that one inside the unit circle
  /// How far each component has gone on after a period, by whole turns of 2 pi after which f is the same again; empty
  /// where the orbit comes back to where it was.
  std::vector<double> advance{};
  bool wanders = false;  // there is none because the motion did not come back: a longer run may find one
};

/// Runs from x0 until the motion comes back, then solves for the orbit. Where there is none, the outcome has the
/// reason.
[[nodiscard]] PeriodicOrbit find_periodic_orbit(const ParametricSystem& system, std::vector<double> x0,
                                                const PeriodicOrbitOptions& options = {});

/// The least and the greatest value of each component on an orbit that was found.
struct OrbitExtents {
  std::vector<double> low, high;
};
/// The extents of the orbit's polynomial.
[[nodiscard]] OrbitExtents extents_of(const ParametricSystem& system, const PeriodicOrbit& found);

/// Whether f(t, x) differs from one t to another.
[[nodiscard]] bool depends_on_time(const ParametricSystem& system, const std::vector<double>& x);

/// Crossings of a plane x_i = level, in the direction of growth: a Poincare section.
struct SectionPoint {
  double t;
  std::vector<double> x;
};
/// The points of a section, in the order of time.
struct Section {
  Outcome<double> outcome;
  std::vector<SectionPoint> points;
};
/// The plane, and how long the motion is followed.
struct SectionOptions {
  double level = 0;
  double settle = 0, duration = 100;
  double rtol = 1e-9;
  bool every_turn = false;  // of an angle: wherever it passes the level and any number of turns, upwards
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double t)> progress{};
};
/// Runs from x0 and records the crossings after `settle`.
[[nodiscard]] Section poincare_section(const ParametricSystem& system, std::vector<double> x0, std::size_t component,
                                       const SectionOptions& options);

/// Of a model with all that happens in it: events, modes, jumps of the equations, the time. What an event carries over
/// the plane has passed it.
[[nodiscard]] Section poincare_section(const std::shared_ptr<const model::ModelProgram>& program,
                                       const model::Experiment& experiment, std::size_t component,
                                       const SectionOptions& options);

}  // namespace continuo::studies
