// What the explicit method of a pair (methods/switching.hpp) needs besides its steps, for one run of an ensemble: how
// strict the pair is with its errors, and whether it would go over to the stiff method, with which no lane goes on.
//
// A method in lanes that is such a part of a pair says so by a type `Pair`.
#pragma once
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/simd_state.hpp>
#include <continuo/solve/options.hpp>

namespace continuo::detail {

template <class M>
concept PartOfPair = requires { typename M::Pair; };

/// Of a method on its own: nothing. Its steps end at no event.
template <class M, State X>
class PairOfLane {
 public:
  template <class System>
  [[nodiscard]] bool retake(System&, double, double, X&) {
    return true;
  }
  template <class System, class Polynomial>
  void interpolate(System&, double, double, const X&, Polynomial&) {}
};

template <PartOfPair M, State X>
class PairOfLane<M, X> {
  using Pair = typename M::Pair;

 public:
  PairOfLane(const X& x, const Options<X>& options) : x_(x), slope_(x), work_(Pair::workspace(x)) {
    work_.tolerance = {.rtol = options.rtol, .atol = options.atol};
    if (!options.rtol_each.empty()) work_.tolerance.rtol_each = options.rtol_each.data();
    if (!options.atol_each.empty()) work_.tolerance.atol_each = options.atol_each.data();
  }

  /// A run begins at x.
  void begin(const X& x) {
    Pair::forget(work_, x);
    begins_ = true;
  }
  /// The motion begins anew after an event: what was learnt of the system stays.
  void begin_anew() { begins_ = true; }

  /// Whether `look` reads the state and the slope at the start of the step, which are to be put here before.
  [[nodiscard]] bool is_probe_due() const { return Pair::is_probe_due(work_); }
  [[nodiscard]] X& x() { return x_; }
  [[nodiscard]] X& slope() { return slope_; }
  /// After every step, accepted or not.
  template <class System>
  void look(System& system, double t, double h) {
    if (begins_) work_.in_favour = 0;
    if (is_probe_due()) work_.nonstiff.k[0] = keep(slope_);
    static_cast<void>(Pair::watch_step(system, t, x_, h, work_));
  }

  /// Takes the step once more, to end at an event, as the pair does: from `x()`, with the slope there in `slope()`.
  template <class System>
  [[nodiscard]] bool retake(System& system, double t, double h, X& x_new) {
    Pair::retaken(work_);
    work_.nonstiff.k[0] = keep(slope_);
    work_.nonstiff.start_fresh = true;
    static_cast<void>(Pair::step(system, t, x_, h, begins_, work_, x_new));
    return true;
  }
  /// The polynomial of a step that was taken so.
  template <class System, class Polynomial>
  void interpolate(System& system, double t, double h, const X& x_new, Polynomial& polynomial) {
    static_cast<void>(Pair::interpolate(system, t, x_, h, x_new, work_, polynomial));
  }

  /// The factor of the norm of the step's error.
  [[nodiscard]] double strictness() const { return Pair::strictness_of_turns(work_); }

  /// The step is accepted. False where the next one would be of the stiff method.
  [[nodiscard]] bool accept() {
    begins_ = false;
    Pair::accept(work_);
    return !work_.is_stiff;
  }

 private:
  X x_, slope_;
  bool begins_ = true;  // no step has been accepted since
  typename Pair::template Workspace<X> work_;
};

}  // namespace continuo::detail
