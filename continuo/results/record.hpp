// continuo/results/record.hpp
// A run as its results are written: named columns, rows, events, what it cost and how it ended. Plain data; every
// writer of this room reads it and none changes it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/solve/outcome.hpp>

namespace continuo::results {

/// A column of a table: "h'" in "m/s"; the unit may be empty.
struct Column {
  std::string name, unit;
};

/// Rows of equal length, one behind the other.
struct Table {
  std::vector<Column> columns;
  std::vector<double> values;

  std::size_t width() const { return columns.size(); }
  std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  std::span<const double> row(std::size_t i) const { return {values.data() + i * width(), width()}; }
  double at(std::size_t row, std::size_t column) const { return values[row * width() + column]; }
};

/// An event with the states on both sides of it.
struct EventRow {
  std::string name;
  double t;
  std::vector<double> before, after;
};

/// Sum of the declared energies. `drift` is the largest |E(t) - E(first)| of the run over |E(first)|, or itself where
/// E(first) is 0.
struct EnergyBalance {
  double first, last, drift;
  std::string unit;
};

struct CheckRow {
  std::string text;
  bool passed;
  double value, expected, tolerance;  // tolerance 0: an exact comparison
  std::string unit;
  std::string message;  // why it could not be evaluated; else empty
};

/// What was asked of the run.
struct Setup {
  std::string model, path, text;  // name, file and content of the model
  std::map<std::string, double> parameters;
  std::string method;
  double rtol = 0, step = 0;  // step > 0: fixed, and rtol says nothing
  std::vector<double> atol;
  double from = 0, to = 0;
  std::string time_unit;
  std::optional<std::uint64_t> seed;
};

struct Record {
  Setup setup;
  Table motion;            // t, the states, then outputs and energies
  std::size_t states = 0;  // how many columns after t are states
  std::vector<EventRow> events;
  Outcome<double> outcome;
  Statistics statistics;
  std::optional<EnergyBalance> energy;
  std::vector<CheckRow> checks;

  std::span<const Column> state_columns() const { return std::span(motion.columns).subspan(1, states); }
  /// The last time and the last states; of the last row, which a run that failed keeps too.
  double final_time() const { return motion.rows() == 0 ? setup.from : motion.at(motion.rows() - 1, 0); }
  std::span<const double> final_state() const {
    return motion.rows() == 0 ? std::span<const double>{} : motion.row(motion.rows() - 1).subspan(1, states);
  }
};

}  // namespace continuo::results
