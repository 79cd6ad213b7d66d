// Where in the unit cube each run of a sweep has its point.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include <continuo/language/sweep.hpp>
#include <continuo/status/result.hpp>
#include <continuo/studies/sweep/morris.hpp>
#include <continuo/studies/sweep/sampling.hpp>
#include <continuo/studies/sweep/sobol_indices.hpp>

namespace continuo::studies {

/// The points of all runs, each by the number of the run.
class SweepDesign {
 public:
  /// Those of a sampling that is no grid, for so many runs, or as many fewer as the design allows; what is wrong with
  /// it where there are none.
  [[nodiscard]] static Result<SweepDesign> create(model::SweepSampling sampling, std::uint64_t runs,
                                                  std::size_t dimensions, std::uint64_t seed);

  /// How many runs there are.
  [[nodiscard]] std::uint64_t runs() const;
  /// The coordinate of a run: above 0 and below 1.
  [[nodiscard]] double at(std::uint64_t run, std::size_t dimension) const;
  /// What somebody who asked for so many runs should know, in a sentence; empty where there is nothing.
  [[nodiscard]] std::string advice(std::uint64_t asked) const;

  /// The design where the runs are those for Sobol' indices, else null.
  [[nodiscard]] const SobolDesign* indices() const;
  /// The design where the runs are those for the screening of Morris, else null.
  [[nodiscard]] const MorrisDesign* screening() const;

 private:
  using Points = std::variant<Sampler, SobolPoints, MorrisDesign>;
  explicit SweepDesign(Points points) : points_(std::move(points)) {}

  Points points_;
};

}  // namespace continuo::studies
