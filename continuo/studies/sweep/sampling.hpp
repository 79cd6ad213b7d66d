// Points of the unit cube at which a sweep runs a model: each run finds its own by its number, and needs to know of no
// other. The same bits on every machine, in every order.
//
//   const Result<Sampler> sampler = Sampler::create({.sampling = Sampling::sobol, .runs = 4096, .dimensions = 3, .seed
//   = 7}); const double u = sampler->at(4711, 2);  // of run 4711, in (0, 1)
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/status/result.hpp>

namespace continuo::studies {

/// How points are spread.
enum class Sampling {
  monte_carlo,      ///< Each independently of all others.
  latin_hypercube,  ///< In each dimension one point in every one of as many equal parts as there are runs.
  sobol,            ///< Sobol' sequence, scrambled: the first 2^m points are evenly spread in all dimensions together.
};

/// The names of the kinds of sampling, in their order.
inline constexpr std::array<std::string_view, 3> sampling_names{"monte_carlo", "latin_hypercube", "sobol"};
/// The name of a kind.
[[nodiscard]] std::string_view to_string(Sampling sampling);
/// The kind of this name; none for another.
[[nodiscard]] std::optional<Sampling> sampling_of(std::string_view name);

/// What is to be sampled.
struct SamplingPlan {
  Sampling sampling = Sampling::monte_carlo;
  std::uint64_t runs = 1;
  std::size_t dimensions = 1;
  std::uint64_t seed = 0;
  /// Samples that are independent of each other, each of runs / replicates points: run n is point n / replicates of
  /// sample n % replicates. Their spread tells the error of what is estimated (`sobol_indices.hpp`).
  std::uint64_t replicates = 1;
};

/// What is wrong with a plan, and how to mend it; a success where nothing is.
Status check(const SamplingPlan& plan);

/// What somebody who made this plan should know, in a sentence; empty where there is nothing.
[[nodiscard]] std::string advice(const SamplingPlan& plan);

/// The points of a plan. A value; all functions may be called by many threads at once.
class Sampler {
 public:
  /// The points of this plan, or what is wrong with it.
  [[nodiscard]] static Result<Sampler> create(const SamplingPlan& plan);

  /// The coordinate of the point of a run: above 0 and below 1. `run` < runs, `dimension` < dimensions.
  [[nodiscard]] double at(std::uint64_t run, std::size_t dimension) const;
  /// All coordinates of the point of a run; `point` has one number for each dimension.
  void point(std::uint64_t run, std::span<double> point) const;
  /// What it samples.
  [[nodiscard]] const SamplingPlan& plan() const { return plan_; }

 private:
  explicit Sampler(const SamplingPlan& plan);

  SamplingPlan plan_;
  std::vector<std::uint64_t> directions_;  // of the Sobol' sequence: 52 for each dimension, as integers of 52 bits
};

}  // namespace continuo::studies
