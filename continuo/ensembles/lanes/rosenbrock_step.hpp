// The last step of one lane by a Rosenbrock method, taken once more to end at an event: with f, J and df/dt at its
// start as the lane has them, and so with the bits that one run alone gets.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/steps/correct.hpp>

namespace continuo::detail {

/// A Rosenbrock method whose steps depend on nothing of those before: not one of order 2, which carries rounding errors
/// on, nor one that begins with f of its last stage.
template <class M>
concept RosenbrockForLanes =
    is_implicit<M>() && requires { M::tableau.gamma_sum; } && (M::order > 2) && !M::tableau.first_same_as_last();

/// Writes J to a linearization, which gives it to nobody but a checkpoint.
template <class Real>
class EntriesForLinearization {
 public:
  static constexpr bool reads = false;
  explicit EntriesForLinearization(const std::vector<Real>& entries) : entries_(entries) {}
  void operator()(bool&) {}
  template <class Rows>
  void operator()(Rows& rows) {
    std::ranges::copy(entries_, rows.data());
  }

 private:
  const std::vector<Real>& entries_;
};

template <RosenbrockForLanes M, State X>
class RosenbrockStep {
 public:
  RosenbrockStep(const X& x, const Options<X>& options) : x_(x), work_(M::workspace(x)) {
    work_.tolerance = tolerance_of(options);
    entries_.resize(dimension(x) * dimension(x));
  }

  /// The step of a lane from x; `begins`: the motion begins with it.
  template <class WideWork>
  void set(const X& x, const WideWork& work, std::size_t lane, bool begins) {
    x_ = x;
    begins_ = begins;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      work_.slope.data()[i] = work.slope.data()[i][lane];
      work_.time_slope.data()[i] = work.time_slope.data()[i][lane];
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) entries_[i] = work.linear.entries()[i][lane];
  }

  /// Takes the step with another size. False where its equations cannot be solved.
  template <class System>
  [[nodiscard]] bool retake(System& system, double t, double h, X& x_new) {
    if (!work_.linear.prepared()) work_.linear.prepare(system, x_);
    EntriesForLinearization<double> entries(entries_);
    work_.linear.transfer(entries);
    work_.start_fresh = work_.linear_fresh = true;
    static_cast<void>(M::step(system, t, x_, h, begins_, work_, x_new));
    return work_.status == StepStatus::done;
  }
  /// The polynomial of a step that was taken so.
  template <class System, class Polynomial>
  void interpolate(System& system, double t, double h, const X& x_new, Polynomial& polynomial) {
    static_cast<void>(M::interpolate(system, t, x_, h, x_new, work_, polynomial));
  }

 private:
  X x_;
  bool begins_ = true;
  std::vector<double> entries_;  // of J
  typename M::template Workspace<X> work_;
};

}  // namespace continuo::detail
