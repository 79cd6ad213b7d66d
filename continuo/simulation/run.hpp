// continuo/simulation/run.hpp
// What a run of a model leaves: rows, events, marks, energies, checks, outcome and cost. Plain data.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/solve/outcome.hpp>

namespace continuo::model {

/// The name of a column, and its unit.
struct Column {
  std::string name, unit;
};

/// Rows of t, the states, then the outputs and the energies; both sides of an event that changes the state.
struct Motion {
  std::vector<Column> columns;
  std::vector<double> values;  // row after row
  std::size_t states = 0;      // how many columns after t are states

  /// The number of rows.
  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  /// Row i: one number for each column.
  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    return {values.data() + i * columns.size(), columns.size()};
  }
  /// The time of row i, in the model's unit of time.
  [[nodiscard]] double time(std::size_t i) const { return row(i)[0]; }
  /// The states of row i, each in its unit.
  [[nodiscard]] std::span<const double> state(std::size_t i) const { return row(i).subspan(1, states); }
};

/// A row of a run, handed over while the run goes on.
struct RunRow {
  std::span<const Column> columns;
  std::size_t states;              // how many columns after t are states
  std::span<const double> values;  // one for each column; then the sum of the energies, if the model declares any
};
/// Gets every row of a run as it comes; returns whether the run is to go on.
using OnRow = std::function<bool(const RunRow&)>;

/// One event of the model that has occurred, as the recorder keeps it.
struct RecordedEvent {
  std::string name;
  std::string mark;  // the text of a `mark` among its actions; empty for none
  double t;
  std::vector<double> before, after;  // both empty for a contact
  std::optional<double> impulse{};    // of a contact of bodies: along the normal

  /// Whether it is a contact of bodies, not an event of the text.
  [[nodiscard]] bool is_contact() const { return impulse.has_value(); }
};

/// The sum of the energies; `drift` is the largest |E - first| of the run, relative to |first| where that is
/// more than rounding of its parts.
struct EnergyBalance {
  double first, last, drift;
  std::string unit;
  bool relative = true;  // whether `drift` is; else it is in `unit`
};

/// The verdict on one check of the model.
struct CheckResult {
  std::string text;
  bool passed = false;
  double value = 0, expected = 0, tolerance = 0;
  std::string unit;
  std::string message;    // why it was not evaluated, or when it failed; else empty
  bool evaluated = true;  // false: the run failed, or did not reach the time or the event
};

/// The true error of a run, as a second, stricter one shows it: |difference| per state.
struct ErrorEstimate {
  std::vector<double> at_end;
  std::vector<double> largest;  // of all rows; empty where the two runs have no rows in common
  std::string message;          // why there is no estimate; else empty
};

/// The result of a run.
struct Run {
  Plan plan;
  Motion motion;
  std::vector<double> total_energy;  // at each row that is kept, if the model declares energies
  std::vector<RecordedEvent> events;
  std::string stop_text;  // of the `stop` that ended the run
  Outcome<double> outcome;
  Statistics statistics;
  std::optional<EnergyBalance> energy;
  std::vector<CheckResult> checks;
  std::optional<ErrorEstimate> error;

  /// The time of the last row.
  [[nodiscard]] double final_time() const { return motion.time(motion.rows() - 1); }
  /// The states of the first row; none where there is no row.
  [[nodiscard]] std::span<const double> first_state() const {
    return motion.rows() > 0 ? motion.state(0) : std::span<const double>();
  }
  /// The states of the last row.
  [[nodiscard]] std::span<const double> final_state() const { return motion.state(motion.rows() - 1); }
  /// Whether all checks passed; true of a model without checks.
  [[nodiscard]] bool checks_passed() const {
    for (const CheckResult& check : checks) {
      if (!check.passed) return false;
    }
    return true;
  }
};

}  // namespace continuo::model
