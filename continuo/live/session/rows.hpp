// continuo/live/session/rows.hpp
// The plotted rows of a run: one for each instant that is shown, and more where a curve bends between two.
//
//   Rows rows(pending);
//   rows.show(shown, variables);
//   rows.add(t, x, nullptr);
//   rows.consider(t + h/2, ...);                  // gets a row where the line to the next one would miss it
//   rows.add(t + h, ...);
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/bends.hpp>
#include <continuo/live/session/live_evaluation.hpp>
#include <continuo/live/session/pending_slice.hpp>

namespace continuo::live {

class Rows {
 public:
  using X = std::vector<double>;

  explicit Rows(PendingSlice& pending) : pending_(pending) {}

  /// For another run, or for the same one with its program made anew.
  void show(std::shared_ptr<const LiveModel> shown, const Variables& variables);
  /// Rows from here on are computed with these parameters and inputs.
  void use(const Variables& variables);

  /// Puts a row. `ghost` is the state of the ghost, null without one, here and below.
  void add(double t, const X& x, const X* ghost);
  /// Puts a row only where a line past it would be seen to miss it. There must be a row before: has_last().
  void consider(double t, const X& x, const X* ghost);
  /// Whether there is a row that others may follow.
  bool has_last() const { return last_.has_value(); }
  /// How far apart instants are to be considered, at least, over so much time; infinite where a row is too wide for
  /// more of them than pictures.
  double finest_spacing(double length) const;
  /// Rows at t and later are void.
  void rewind_to(double t);

  /// The drift of the energy is measured from its value in the state x at t.
  void measure_drift_from(double t, const X& x);
  /// The drift of the energy is measured from this value.
  void set_first_energy(double energy) { first_energy_ = energy; }
  double first_energy() const { return first_energy_; }

 private:
  Row row_at(double t, const X& x, const X* ghost);
  void append_values(double t, const X& x, double apart, std::vector<float>& row);
  void put(Row row);
  void put_unless_straight(const Row& next);

  PendingSlice& pending_;
  std::shared_ptr<const LiveModel> shown_;
  LiveEvaluation quantities_, paths_;
  std::vector<double> values_;  // of the quantities
  double first_energy_ = 0;
  std::optional<Row> last_;   // that was put
  std::vector<Row> between_;  // after it, that may be left out
  Bends bends_;
};

}  // namespace continuo::live
