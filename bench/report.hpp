// bench/report.hpp
// What is read from measured curves and written for people: the best solver at an error, the curves as table and plot,
// the tables of a page in Markdown.
#pragma once
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <bench/work_precision.hpp>

namespace continuo::bench {

/// Which solvers are meant.
using Which = bool (*)(const Curve&);
/// Our methods by name on a model that is typed, not compiled: "model METHOD".
inline bool of_model(const Curve& curve) {
  return curve.ours && curve.solver.starts_with("model ");
}
/// Our methods by name.
inline bool of_ours(const Curve& curve) {
  return curve.ours && curve.solver != default_choice && !of_model(curve);
}
inline bool of_default(const Curve& curve) {
  return curve.solver == default_choice;
}
inline bool of_peers(const Curve& curve) {
  return !curve.ours;
}

/// All solvers on one problem.
struct Measured {
  std::string_view name, title;
  std::vector<Curve> curves;
};

struct Best {
  const Curve* curve = nullptr;
  Cost cost{};
};

/// The least time at an error; without a curve, or with infinite cost, where none gets there.
Best best(const Measured& measured, double error, Which which);

/// `wanted`, or the smallest error above it that both sides reach, but not above `loosest`; 0 where there is none.
double smallest_shared_error(const Measured& measured, double wanted, double loosest, Which one, Which other);

/// Our time as a part of a peer's at an error.
struct Wanted {
  double error, at_most;
  Which peer;
  Which ours = of_ours;
};

/// FOLDER/work_precision_NAME.csv and a script for gnuplot that makes the .svg beside it.
void write_curves(const std::string& folder, const Measured& measured);
/// How gnuplot draws the curve of this number.
std::string line_of(std::size_t number, bool dashed);
/// The same on the terminal, at a few errors.
void print_costs(const Measured& measured, std::span<const double> errors);

/// "|...|" and what else stands in tables.
template <class... Values>
std::string text(const char* format, Values... values) {
  char line[400];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}
/// Two digits, whatever the size; "-" where there is no number.
std::string number(double value);

/// Ours against a peer's, and what is wanted: the head, then a line for each.
void write_head_of_ratios(std::ostream& page);
void write_ratios(std::ostream& page, const Measured& measured, std::span<const Wanted> ratios);
/// Time of `solve` without a method in units of our best named one.
void write_head_of_defaults(std::ostream& page, std::span<const double> errors);
void write_default(std::ostream& page, const Measured& measured, std::span<const double> errors);
/// Time of every solver in units of our best at that error.
void write_times(std::ostream& page, const Measured& measured, std::span<const double> errors);

}  // namespace continuo::bench
