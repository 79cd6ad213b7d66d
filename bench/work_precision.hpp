// bench/work_precision.hpp
// Cost against true error, never against the tolerance asked. Each solver is swept over tolerances; every point that
// can matter is timed, all solvers in turn and many times over, so that noise of the machine meets all of them; the
// least time of a point counts.
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <bench/solver.hpp>

namespace continuo::bench {

struct Point {
  double tolerance, error, seconds;
  std::size_t evaluations;
};

struct Curve {
  std::string solver;
  bool ours;
  std::vector<Point> points;  // from loose to tight
};

/// The cost of a solver at one error.
struct Cost {
  double seconds, evaluations, tolerance;
};

/// Which tolerances are tried, and how long a run may take to be worth repeating.
struct Tolerances {
  double points_per_decade = 8, tightest_power = 15, slowest = std::numeric_limits<double>::infinity();
};

std::vector<Curve> sweep(const std::vector<Solver>& solvers, double loosest_error, double tightest_error,
                         double seconds_to_spend, const Tolerances& tolerances = {});

/// The cost at `error`. The end error as a function of the tolerance is rough (an accident of signs makes one point ten
/// times better than its neighbours), cost as a function of the tolerance is smooth; so log error and log cost are both
/// fitted by a straight line in log tolerance, over the points within a factor 30 of the error asked. Infinite where
/// fewer than four points are there, or where the solver does not get that far.
Cost cost_at(const Curve& curve, double error);

}  // namespace continuo::bench
