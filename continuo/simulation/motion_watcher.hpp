// Who looks at a motion while it is computed, also between its rows: on the method's own dense output.
//
//   struct Highest : model::MotionWatcher { ... } highest;
//   simulate(program, {.rtol = 1e-9}, {.watcher = &highest});
#pragma once
#include <functional>
#include <vector>

#include <continuo/simulation/simulate.hpp>

namespace continuo::model {

/// Sees every piece of a motion, in the order of time. It changes nothing: a run that is watched has the same bits.
class MotionWatcher {
 public:
  /// A state of the model.
  using X = std::vector<double>;
  /// x(t) within the piece of the motion that has just become final, both of its ends included.
  using At = std::function<void(double t, X& x)>;

  virtual ~MotionWatcher() = default;
  /// The motion begins at plan.from, in the state x. It may be made twice, and then it begins anew.
  virtual void begin(const Plan& plan, const X& x) = 0;
  /// The motion is known from where it was known before up to `to`.
  virtual void on_piece(double to, const At& at) = 0;
  /// At t an event, or a step of an input, has put `after` in the place of `before`, which may be equal.
  virtual void on_jump(double t, const X& before, const X& after) = 0;
};

}  // namespace continuo::model
