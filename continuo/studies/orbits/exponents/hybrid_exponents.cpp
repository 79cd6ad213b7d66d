// Lyapunov exponents of a model with all that happens in it, by neighbours that are run beside its motion.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <continuo/studies/lyapunov.hpp>
#include <continuo/studies/orbits/exponents/orthonormal_columns.hpp>
#include <continuo/studies/support/hybrid_run.hpp>
#include <continuo/studies/support/state_roles.hpp>

namespace continuo::studies {

namespace {

using X = HybridRun::X;

// Differences of two runs have an error of the tolerance, and one of the second order of the distance: both are a
// millionth of it.
constexpr double distance_part = 1e-6, error_of_runs = 1e-12;
// What a column may grow or shrink by between two orthogonalisations, as a logarithm; and where it is nothing but
// error.
constexpr double most_parting = 4, least_length = 1e-7;

/// The motion, its neighbours, and a scout that runs ahead of them: they are put back only where nothing happens
/// nearby, since what has just been passed by one must not be still before another.
class Neighbourhood {
 public:
  Neighbourhood(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
                const model::Experiment& experiment)
      : directions_(directions_of(*program)), motion_(program, plan, experiment), scout_(program, plan, experiment) {
    for (std::size_t k = 0; k < directions_.size(); ++k)
      neighbours_.push_back(std::make_unique<HybridRun>(program, plan, experiment));
    columns_ = reflection(size());
  }

  std::size_t size() const { return directions_.size(); }
  double t() const { return motion_.t(); }
  const Outcome<double>& outcome() const {
    return motion_.outcome().ending == Ending::reached_end ? scout_.outcome() : motion_.outcome();
  }

  /// The motion to about t, with neighbours around it from there on.
  bool begin(double t) {
    if (!go_to_quiet(t)) return false;
    distance_ = distance_part * size_of(motion_.x());
    place();
    return true;
  }

  /// The logarithms of what the distances in each direction have become until about t; nothing where a run ends. They
  /// are looked at in between where neighbours part by too much.
  std::optional<std::vector<double>> advance(double t) {
    const model::Instant begin = motion_.instant();
    const std::vector<double> columns = columns_;
    for (int tries = 0; tries < 4; ++tries, distance_ /= 10) {
      if (tries > 0) {
        motion_.go_on(begin);
        columns_ = columns;
        place();
      }
      if (tries == 0 ? !go_to_quiet(t) : !motion_.advance_to(scouted_)) return std::nullopt;
      const std::optional<bool> alike = measure();
      if (!alike) return std::nullopt;
      if (*alike || tries == 3) break;
    }
    std::vector<double> logarithms = orthonormalise(columns_, size());
    for (std::size_t k = 0; k < size(); ++k) logarithms[k] = std::max(logarithms[k], std::log(least_length));
    distance_ = distance_part * size_of(motion_.x());
    place();
    return logarithms;
  }

 private:
  /// Orthonormal directions along none of the axes, which may be ways of their own: Householder's matrix of 1, 1/2, 1/3
  /// ...
  static std::vector<double> reflection(std::size_t n) {
    std::vector<double> matrix(n * n);
    const auto entry = [](std::size_t i) { return 1 / (static_cast<double>(i) + 1); };
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) square += entry(i) * entry(i);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) matrix[i * n + k] = (i == k ? 1 : 0) - 2 * entry(i) * entry(k) / square;
    return matrix;
  }
  static double size_of(const X& x) {
    double size = 1e-3;
    for (const double value : x) size = std::max(size, std::abs(value));
    return size;
  }

  // The motion to t, or to a little later, where nothing happens for a while before and after.
  bool go_to_quiet(double t) {
    double margin = 1e-3 * (t - motion_.t());
    for (int tries = 0;; ++tries) {
      if (!scout_.advance_to(std::max(t + margin, scout_.t()))) return false;
      if (scout_.last_discontinuity() < t - margin || tries == 60) break;
      if (tries % 10 == 9) margin /= 8;
      t = scout_.last_discontinuity() + 2 * margin;
    }
    scouted_ = t;
    return motion_.advance_to(t);
  }

  void place() {
    model::Instant instant = motion_.instant();
    const X x = instant.x;
    for (std::size_t k = 0; k < size(); ++k) {
      for (std::size_t i = 0; i < size(); ++i)
        instant.x[directions_[i]] = x[directions_[i]] + distance_ * columns_[k * size() + i];
      neighbours_[k]->go_on(instant);
    }
  }

  // Brings the neighbours to where the motion is. Whether they have come the same way; nothing where one ends.
  std::optional<bool> measure() {
    bool alike = true;
    const std::size_t mode = motion_.instant().mode;
    for (std::size_t k = 0; k < size(); ++k) {
      if (!neighbours_[k]->advance_to(motion_.t())) return std::nullopt;
      double length = 0;
      for (std::size_t i = 0; i < size(); ++i) {
        double& entry = columns_[k * size() + i];
        entry = (neighbours_[k]->x()[directions_[i]] - motion_.x()[directions_[i]]) / distance_;
        length = std::max(length, std::abs(entry));
      }
      alike = alike && neighbours_[k]->instant().mode == mode && length < 1e-3 / distance_part;
    }
    return alike;
  }

  std::vector<std::size_t> directions_;
  HybridRun motion_, scout_;
  std::vector<std::unique_ptr<HybridRun>> neighbours_;
  std::vector<double> columns_;  // of unit length after each step, one after the other
  double distance_ = distance_part, scouted_ = 0;
};

}  // namespace

LyapunovExponents lyapunov_exponents(const std::shared_ptr<const model::ModelProgram>& program,
                                     const model::Experiment& experiment, const LyapunovOptions& options) {
  LyapunovExponents result;
  model::Experiment exact = exactly(*program, experiment, error_of_runs);
  exact.interrupt = options.interrupt;
  std::optional<model::Plan> plan = plan_of(*program, exact, result.outcome);
  if (!plan) return result;
  const double from = plan->from, end = from + options.settle + options.duration;
  plan->to = end + options.duration;  // the scout runs ahead
  Neighbourhood neighbourhood(program, *plan, exact);
  std::vector<Stretch> stretches;
  double interval = options.interval;
  bool goes_on = neighbourhood.begin(from + 1e-3 * options.interval);
  while (goes_on && neighbourhood.t() < end) {
    const double begin = neighbourhood.t();
    const bool settled = begin >= from + options.settle - 1e-3 * options.interval;
    // What is averaged begins when it is said to: over whole periods of an orbit only rounding is left of the way.
    const double next = std::min(begin + interval, settled ? end : from + options.settle);
    std::optional<std::vector<double>> logarithms = neighbourhood.advance(next);
    goes_on = logarithms.has_value();
    if (!goes_on) break;
    const auto [least, most] = std::ranges::minmax(*logarithms);
    if (most - least > most_parting) interval = std::max(interval / 2, 1e-3 * options.interval);
    if (most - least < most_parting / 2) interval = std::min(1.5 * interval, options.interval);
    if (settled) stretches.push_back({neighbourhood.t() - begin, std::move(*logarithms)});
    if (options.progress) options.progress(neighbourhood.t() - from);
  }
  result.outcome = neighbourhood.outcome();
  average(result, stretches);
  return result;
}

}  // namespace continuo::studies
