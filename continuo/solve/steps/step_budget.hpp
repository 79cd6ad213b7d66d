// continuo/solve/steps/step_budget.hpp
// The progress of a run whose step size stiffness limits: whether the run can end within its limit of steps.
#pragma once
#include <cmath>
#include <cstddef>

namespace continuo {

/// Compares the progress in two successive windows of a hundredth of the limit each. A run that is to end within the
/// limit and yet is so slow that it would need a hundred times the limit has to take steps a hundred times as long on
/// the average of what remains; steps that grow towards that evenly have grown by a factor 100^(1/100) > 1.04 from one
/// window to the next.
template <class Real>
class StepBudget {
 public:
  /// Notes the progress now and then, at the end of a step that stiffness limits: `steps` so far, of at most `most`.
  void mark(std::size_t steps, std::size_t most, const Real& t) {
    using std::abs;
    if (!begun_) {
      begun_ = true;
      steps_ = steps;
      t_ = t;
    } else if (steps - steps_ >= most / parts + 1) {
      const Real now = abs(t - t_) / Real(static_cast<double>(steps - steps_));
      steady_ = per_step_ > 0 && now <= Real(longest_growth) * per_step_;
      per_step_ = now;
      steps_ = steps;
      t_ = t;
    }
  }
  /// Starts again where stiffness does not limit the steps, or something has changed.
  void forget() { *this = {}; }

  /// For checkpoints.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(t_, per_step_, steps_, begun_, steady_);
  }

  [[nodiscard]] bool steady() const { return steady_; }
  /// The steps that the rest of the way needs.
  [[nodiscard]] Real steps_for(const Real& way) const {
    using std::abs;
    return abs(way) / per_step_;
  }

  static constexpr double far_beyond = 100;  // times the limit

 private:
  static constexpr std::size_t parts = 100;
  static constexpr double longest_growth = 1.01;  // the variation of steps at the limit of stability that do not grow

  Real t_{}, per_step_{};
  std::size_t steps_ = 0;
  bool begun_ = false, steady_ = false;
};

}  // namespace continuo
