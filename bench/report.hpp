// bench/report.hpp
// What is read from measured curves and written for people: the best solver at an error, the curves as table and plot.
#pragma once
#include <string>

#include <bench/measure.hpp>

namespace continuo::bench {

/// Which solvers are meant.
using Which = bool (*)(const Curve&);
inline bool of_ours(const Curve& curve) {
  return curve.ours;
}
inline bool of_peers(const Curve& curve) {
  return !curve.ours;
}

struct Best {
  const Curve* curve = nullptr;
  Cost cost{};
};

/// The least time at an error; without a curve, or with infinite cost, where none gets there.
Best best(const Measured& measured, double error, Which which);

/// `wanted`, or the smallest error above it that both sides reach; 0 where there is none.
double smallest_shared_error(const Measured& measured, double wanted, Which one, Which other);

/// FOLDER/work_precision_NAME.csv and a script for gnuplot that makes the .svg beside it.
void write_curves(const std::string& folder, const Measured& measured);

}  // namespace continuo::bench
