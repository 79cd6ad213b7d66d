// continuo/language/sweep.hpp
// `sweep { ... }` of a checked model: what is varied in many runs, how the runs are chosen, and what is kept of each.
// Plain data; Model::sweep holds it, and studies/sweep_run.hpp runs it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::model {

/// How the runs are chosen: every combination of the values, or points of the unit cube that the distributions map to
/// values; of the last two, those for Sobol' indices, and those for the screening of Morris.
enum class SweepSampling { grid, sobol, latin_hypercube, monte_carlo, indices, morris };

/// The word of the language: "latin_hypercube".
[[nodiscard]] std::string_view to_string(SweepSampling sampling);

/// The values of an axis one by one, in the unit of what is varied.
struct SweepPoints {
  std::vector<double> values;
  std::string file{};  // that they were read from; axes of the same file take its rows together
};

/// What is varied has a probability distribution: uniform(low, high), normal(mean, deviation), lognormal(median,
/// deviation of the logarithm), triangular(low, mode, high).
struct SweepDistribution {
  /// The distributions.
  enum class Kind { uniform, normal, lognormal, triangular };
  Kind kind = Kind::uniform;
  std::vector<double> numbers;
};

/// The word of the language: "normal".
[[nodiscard]] std::string_view to_string(SweepDistribution::Kind kind);

/// What is varied, and its values.
struct SweepAxis {
  /// A parameter, the initial value of a state, of a body as well, or an input without a file.
  enum class Kind { parameter, initial, input };
  Kind kind = Kind::parameter;
  std::string name;  // "k", "x'", "ball.x"
  std::string unit;
  std::variant<SweepPoints, SweepDistribution> values;
  Span span;

  /// The name of its column: "k", "x'(0)".
  [[nodiscard]] std::string column() const { return kind == Kind::initial ? name + "(0)" : name; }
};

/// The times of a series: first, first + interval, ..., up to last.
struct SweepTimes {
  double first = 0, interval = 0;
  std::size_t count = 0;

  /// Time number k.
  [[nodiscard]] double at(std::size_t k) const { return first + static_cast<double>(k) * interval; }
};

/// One number that is kept of every run, or a series of them.
struct SweepKeep {
  /// What a check could read; the largest, the smallest and the mean value of an expression over the run, between its
  /// rows as well; or its values at times.
  enum class Kind { reading, maximum, minimum, mean, series };
  Kind kind = Kind::reading;
  std::string name;  // after `as`, else as written
  std::string unit;
  Check reading{};     // of Kind::reading; its relation and its value mean nothing
  NodeId node{};       // of the other kinds
  SweepTimes times{};  // of Kind::series
  Span span;

  /// How many numbers it is: of a series one for each time.
  [[nodiscard]] std::size_t width() const { return kind == Kind::series ? times.count : 1; }
};

/// The block as a whole.
struct SweepPlan {
  std::vector<SweepAxis> axes;
  std::size_t runs = 0;
  SweepSampling sampling = SweepSampling::grid;
  std::uint64_t seed = 0;
  std::vector<SweepKeep> keeps;
  Span span;
};

/// More runs than these are a mistake.
inline constexpr std::size_t most_sweep_runs = 1'000'000'000;

}  // namespace continuo::model
