// Where a model's motion carries its guards from an instant on: their derivatives along it of orders 1, 2 and 3, exact
// but for rounding, with a bound of that.
//
//   MotionSeries series(*program, start_values(model));
//   std::vector<GuardMotion> motions(model.events.size());
//   series.guards(mode, t, x, 1, motions);   // -1: to the past
//   if (carried(motions[i]) < 0) ...         // the guard falls from here on
//
// The states are Taylor series in s, t + forward*s being the time: by x' = f(t, x) each evaluation of f gives one more
// coefficient (A. Griewank, A. Walther, "Evaluating Derivatives", 2nd ed., SIAM (2008), section 13.3). Everything is
// the limit just after the instant: abs, min, floor, `if` and the corners of tables take the branch that the motion is
// about to enter. A coefficient that is not determined, because f jumps where the motion stands and both sides lead
// back, or because the equations of the unknowns are singular, is NaN with an infinite rounding.
//
// A state counts as known to four units in the last place, the time to one, zero as exact. Values that are equal bit by
// bit are a tie, which the motion decides by the first order in which they part; what does not part up to the third
// counts as equal for good. Values within their rounding of each other may be either way round, and what depends on
// that is not known unless both ways agree in sign.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/tape/tape_taylor.hpp>

namespace continuo::model {

/// g(t + forward*s) = c[0] + c[1] s + c[2] s^2 + c[3] s^3 + ...; each coefficient may be off by its rounding.
struct GuardMotion {
  std::array<double, 4> c{}, rounding{};
};

/// The sign of the first coefficient after c[0] that is more than rounding: 0 if none is, or if one before it is not
/// known.
[[nodiscard]] int carried(const GuardMotion& motion);

/// A copy is a checkpoint.
class MotionSeries {
 public:
  /// `variables`: a whole register file as `start_values` gives it.
  MotionSeries(const ModelProgram& program, std::span<const double> variables);

  /// motions[i] for Model::events[i], of those that are watched in this mode; the others are left alone. `forward` is 1
  /// where time runs on and -1 where it runs backwards.
  void guards(std::size_t mode, double t, std::span<const double> x, double forward, std::span<GuardMotion> motions);
  /// The states' series, and those of the unknowns. Valid until the next call.
  [[nodiscard]] std::span<const TapeSeries> states(std::size_t mode, double t, std::span<const double> x,
                                                   double forward);

  /// A parameter or an input.
  void set(std::uint32_t variable, double value);
  /// These states stand still, whatever the equations say.
  void hold(std::vector<std::size_t> states) { held_ = std::move(states); }

 private:
  /// A tape and its registers, which are empty until it is used and after each change of a parameter.
  struct Evaluated {
    std::shared_ptr<const Tape> tape;
    std::vector<TapeSeries> registers{};
  };
  struct OfMode {
    Evaluated rates, guards;
    std::vector<std::size_t> events;
  };

  void evaluate(Evaluated& evaluated, const TapeSeries& time, std::span<const TapeSeries> x,
                std::span<TapeSeries> outputs);
  void evaluate_rates(const TapeSeries& time, std::span<const TapeSeries> x);
  void sweep();
  [[nodiscard]] Rounded<double> next_coefficient(std::size_t i, std::size_t k) const;
  [[nodiscard]] bool is_settled(bool give_up);
  void invert_slopes_of_unknowns();
  [[nodiscard]] double doubt_of_unknown(std::size_t row, std::span<const Rounded<double>> residuals) const;
  void round_unknowns();
  void solve_unknowns(std::size_t k);

  std::uint32_t first_state_;
  std::vector<std::size_t> differential_, unknowns_;  // states by x' = ..., those by 0 = ...
  std::vector<bool> in_world_;                        // by state: no equation is here
  std::vector<double> variables_;
  std::vector<OfMode> modes_;
  std::vector<std::size_t> held_;

  // Of the present instant.
  std::size_t mode_ = 0;
  double forward_ = 1;
  TapeSeries time_;
  std::vector<TapeSeries> x_, rates_, guards_;
  std::vector<std::size_t> known_;       // by state: how many of its coefficients can be known
  std::vector<Rounded<double>> slopes_;  // d residual / d unknown, row by row
  std::vector<double> inverse_;          // of those; NaN where they are singular
};

}  // namespace continuo::model
