// The screening of Morris: which of many uncertain quantities matter at all, by few runs.
//
//   const MorrisDesign design{.factors = 20, .trajectories = 16, .seed = 7};
//   for (std::uint64_t run = 0; run < design.runs(); ++run)
//     for (std::size_t i = 0; i < 20; ++i) u[i] = coordinate(design, run, i);  // in (0, 1)
//   const MorrisScreening screening = morris_screening(design, outcomes);
//   screening.effects[0].mean_absolute;
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/status/status.hpp>
#include <continuo/studies/sweep/sobol_indices.hpp>

namespace continuo::studies {

/// Which runs are made: trajectories of factors + 1 runs, each changing one factor more, in an order of its own. A
/// coordinate is the middle of one of `levels` equal parts of (0, 1), and changes by half of them.
struct MorrisDesign {
  std::size_t factors = 1;
  std::uint64_t trajectories = 16;
  std::uint64_t seed = 0;
  std::uint32_t levels = 4;  // even

  /// How many runs it takes.
  [[nodiscard]] std::uint64_t runs() const { return trajectories * (factors + 1); }
};

/// What is wrong with a design, and how to mend it; a success where nothing is.
Status check(const MorrisDesign& design);

/// The coordinate of a run of a design that has passed `check`.
[[nodiscard]] double coordinate(const MorrisDesign& design, std::uint64_t run, std::size_t factor);

/// The elementary effects of one factor: the change of the outcome divided by the change of the coordinate.
struct ElementaryEffects {
  Estimate mean_absolute;     ///< mu*: how much the factor matters.
  double mean = 0;            ///< mu: its sign is the direction.
  double deviation = 0;       ///< sigma: large where the effect depends on the other factors, or is curved.
  std::uint64_t count = 0;    ///< Trajectories that were used.
  std::uint64_t missing = 0;  ///< Trajectories without a finite outcome on both sides of the change.
};

/// The effects of all factors on one outcome.
struct MorrisScreening {
  std::vector<ElementaryEffects> effects;
};

/// The effects from the outcomes of all runs of a design, in the order of the runs. Fewer outcomes than runs: the steps
/// that are there are used.
[[nodiscard]] MorrisScreening morris_screening(const MorrisDesign& design, std::span<const double> outcomes);

}  // namespace continuo::studies
