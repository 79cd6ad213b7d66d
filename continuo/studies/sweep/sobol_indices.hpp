// How much of the variance of an outcome each uncertain quantity causes: Sobol' indices of first order and total.
//
//   const SobolDesign design{.factors = 3, .rows = 4096, .sampling = Sampling::sobol, .seed = 7};
//   const Result<SobolPoints> points = SobolPoints::create(design);
//   for (std::uint64_t run = 0; run < design.runs(); ++run) outcomes[run] = f(points->point(run));  // u in (0, 1)
//   const SobolIndices indices = sobol_indices(design, outcomes);
//   indices.first[0].value, indices.first[0].low, indices.first[0].high;
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <continuo/studies/sweep/sampling.hpp>

namespace continuo::studies {

/// Which runs are made: rows of factors + 2 runs each, row after row. Of two independent points A and B, a row has A,
/// B, and for each factor A with this factor's coordinate from B.
struct SobolDesign {
  std::size_t factors = 1;
  std::uint64_t rows = 1024;
  Sampling sampling = Sampling::sobol;
  std::uint64_t seed = 0;

  /// How many runs it takes.
  [[nodiscard]] std::uint64_t runs() const { return rows * (factors + 2); }
  /// Into how many independent samples the rows are divided: each row for monte_carlo, else 16.
  [[nodiscard]] std::uint64_t replicates() const;
};

/// The rows that a number of runs allows; for `sobol` such that each independent sample has a power of two of them.
[[nodiscard]] std::uint64_t sobol_rows(Sampling sampling, std::size_t factors, std::uint64_t runs);

/// What is wrong with a design, and how to mend it; a success where nothing is.
Status check(const SobolDesign& design);

/// The points of a design, each found by the number of its run.
class SobolPoints {
 public:
  /// The points of this design, or what is wrong with it.
  [[nodiscard]] static Result<SobolPoints> create(const SobolDesign& design);
  /// The coordinate of a run.
  [[nodiscard]] double at(std::uint64_t run, std::size_t factor) const;
  /// What they are of.
  [[nodiscard]] const SobolDesign& design() const { return design_; }

 private:
  SobolPoints(const SobolDesign& design, Sampler sampler) : design_(design), sampler_(std::move(sampler)) {}
  SobolDesign design_;
  Sampler sampler_;
};

/// An estimate, and the interval that has the true value with a probability of 95 per cent. NaN where there is none.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// The indices of one outcome.
struct SobolIndices {
  std::vector<Estimate> first;  ///< Of each factor: the part of the variance that is gone when it is known.
  std::vector<Estimate> total;  ///< Of each factor: the part that remains when all others are known.
  double mean = 0, variance = 0;
  std::uint64_t rows = 0;     ///< That were used.
  std::uint64_t missing = 0;  ///< Rows that were left out, because a run of theirs has no finite outcome.
};

/// The indices from the outcomes of all runs of a design, in the order of the runs. Outcomes that all are equal have
/// no variance, and indices that are NaN. Fewer outcomes than runs: the rows that are complete are used.
[[nodiscard]] SobolIndices sobol_indices(const SobolDesign& design, std::span<const double> outcomes);

}  // namespace continuo::studies
