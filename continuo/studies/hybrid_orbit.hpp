// Closed orbits of models with all that happens in them: events with jumps, modes, jumps of the equations, and what
// hangs periodically on the time. They are fixed points of the flow over one period, found by running until the motion
// comes back and solved for by Newton's method with the exact derivative through all events; its eigenvalues are the
// multipliers. Neighbours that are run on both sides confirm them.
//
//   const HybridOrbit found = find_hybrid_orbit(program, {}, {.settle = 100, .duration = 100});
//   if (found.outcome) fmt::print("period {}\n", found.period);
#pragma once
#include <atomic>
#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/stepping.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::studies {

/// For how long, and how exactly, an orbit is searched for.
struct HybridOrbitOptions {
  double settle = 100;     // time for the motion to come to the orbit, before it is looked for
  double duration = 1000;  // within which it must come back
  double tolerance = 1e-9;
  /// What depends on the time has this period; nothing where no time matters.
  std::optional<double> forcing{};
  /// As many of these are one period of the orbit; 0: as the motion comes back.
  std::size_t turns = 0;
  /// By which of the model's parameters the period is differentiated.
  std::vector<std::size_t> parameters{};
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // from 0 to 1
};

/// A closed orbit with its events and multipliers.
struct HybridOrbit {
  Outcome<double> outcome;  // its hint says why there is none
  double period = 0;
  std::size_t turns = 0;  // periods of the forcing, where there is one
  model::Instant start;   // on the orbit, where nothing happens
  std::vector<double> t;  // from the start over one period, both sides of an event
  std::vector<std::vector<double>> x;
  std::vector<double> low, high;  // of each state on the way
  std::vector<SensitivityEvent> events;
  /// By descending size; without a forcing one of them is 1, that of the shift along the orbit. States that conditions
  /// ask for and only events change, and sums that nothing reads, have none.
  std::vector<std::complex<double>> multipliers;
  /// What motions beside the orbit do, as runs show.
  enum class Neighbours { come_nearer, go_away, undecided };
  Neighbours neighbours = Neighbours::undecided;
  bool family = false;             // one of many: something is conserved, and there is one for each value of it
  bool found_nearby = false;       // the motion did not come back by itself; Newton's method found one near its way
  std::vector<std::size_t> aside;  // states that nothing reads and that do not come back
  std::vector<double> period_by;   // of options.parameters; empty with a forcing, or of a family
  bool wanders = false;            // there is none because the motion did not come back: a longer run may find one
};

/// Runs until the motion comes back, then solves for the orbit. Where there is none, the outcome has the reason.
[[nodiscard]] HybridOrbit find_hybrid_orbit(const std::shared_ptr<const model::ModelProgram>& program,
                                            const model::Experiment& experiment,
                                            const HybridOrbitOptions& options = {});

}  // namespace continuo::studies
