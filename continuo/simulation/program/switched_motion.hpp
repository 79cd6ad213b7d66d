// The equations of a model with their jumps located: the present value of every switch, and the sliding of the motion
// along surfaces where both sides lead back to it.
//
// On a surface z(t, x) = 0 where z' > 0 below and z' < 0 above, the motion goes on along the surface, by the convex
// combination of the two right-hand sides for which z' = 0 (A. F. Filippov, "Differential Equations with Discontinuous
// Righthand Sides", Kluwer (1988)). With f0 = f below all surfaces it slides on and f_k = f above the k-th one alone,
//   f = f0 + sum of w_k (f_k - f0),   z_j' of that = 0 for each j,
// is a linear system for the weights w. It leaves surface k where w_k comes to 0 or to 1.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::model {

/// What became of a switch when the motion came to its surface.
enum class Passage : unsigned char { none, crosses, begins_to_slide, leaves };

/// A copy is a checkpoint.
class SwitchedMotion {
 public:
  using X = std::vector<double>;

  /// `variables`: a whole register file as `start_values` gives it.
  SwitchedMotion(const ModelProgram& program, std::span<const double> variables);

  /// Whether the equations of this mode have switches; without, the other members do nothing.
  [[nodiscard]] bool any(std::size_t mode) const { return !program_->switches[mode].empty(); }
  [[nodiscard]] bool slides() const { return !sliding_.empty(); }
  [[nodiscard]] bool slides_along(std::size_t k) const {
    return std::ranges::find(sliding_, k, &Sliding::k) != sliding_.end();
  }

  /// x' with every switch held.
  void rates(std::size_t mode, double t, const X& x, X& dxdt);
  /// For each switch of the mode a number that changes its sign where the motion comes to the surface, or leaves it.
  void guards(std::size_t mode, double t, const X& x, std::span<double> values);

  /// The motion begins anew in this mode: every switch gets the value that the state asks for; on a surface, that of
  /// the side to which the motion leads, or it slides. What was on a surface it slid along, and has not been moved off
  /// it since `before`, still is (null: nothing slid).
  void settle(std::size_t mode, double t, const X& x, const X* before);
  /// The motion has come to the surface of switch k, or to the end of its sliding.
  [[nodiscard]] Passage pass(std::size_t mode, std::size_t k, double t, const X& x);

  /// A parameter or an input.
  void set(std::uint32_t variable, double value);
  /// The values of the mode's switches; of one that slides that of its lower side.
  [[nodiscard]] std::span<const double> values() const { return values_; }

  /// For checkpoints: the switches of this mode, which is the present one.
  template <class Archive>
  void transfer(Archive& archive, std::size_t mode) {
    const std::size_t n = switches(mode).size();
    std::size_t count = values_.size(), sliding = sliding_.size();
    archive.index(count, n);
    archive.index(sliding, count);
    if constexpr (Archive::reads) {
      mode_ = mode;
      values_.assign(count, 0);
      sliding_.assign(sliding, Sliding{});
    }
    archive(values_);
    for (Sliding& one : sliding_) {
      archive.index(one.k, n - 1);
      archive(one.below, one.above);
    }
    if constexpr (Archive::reads) {
      for (std::size_t k = 0; k < count; ++k) place(mode, k, values_[k]);
    }
  }

  /// A surface the motion slides along: the values of the switch on its two sides.
  struct Sliding {
    std::size_t k;
    double below, above;
  };
  [[nodiscard]] std::span<const Sliding> sliding() const { return sliding_; }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct OfMode {
    Evaluation rates, surfaces, approach;
  };
  [[nodiscard]] const std::vector<Switch>& switches(std::size_t mode) const {
    return program_->switches[mode].switches;
  }
  void place(std::size_t mode, std::size_t k, double value);
  void approach(std::size_t mode, double t, const X& x, std::span<double> values, std::size_t asked = none);
  void side_rates(std::size_t mode, double t, const X& x, X& dxdt);
  void evaluate(std::size_t mode, Evaluation& equations, double t, const X& x, std::span<double> values,
                std::size_t asked);
  [[nodiscard]] std::vector<double> weights(std::size_t mode, double t, const X& x);
  [[nodiscard]] double approach_of(std::size_t mode, std::size_t k, double value, double t, const X& x);
  Passage choose(std::size_t mode, Sliding sides, double t, const X& x);
  [[nodiscard]] Sliding sides_of(std::size_t mode, std::size_t k, double surface) const;
  bool settle_one(std::size_t mode, std::size_t k, double t, const X& x, const X* before, std::span<const char> slid);
  [[nodiscard]] double rounding(std::size_t mode, std::size_t k, double t, const X& x);
  [[nodiscard]] double surface(std::size_t mode, std::size_t k, double t, const X& x);

  const ModelProgram* program_;
  std::vector<OfMode> modes_;
  std::vector<double> values_;  // of the switches of the present mode
  std::size_t mode_ = 0;        // that of `sliding_`
  std::vector<Sliding> sliding_;
  std::vector<double> surfaces_, approach_;
  X base_, other_, moved_;
};

}  // namespace continuo::model
