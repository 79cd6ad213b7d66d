// The options of an ensemble, each with a good default.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include <continuo/ensembles/run_result.hpp>
#include <continuo/solve/options.hpp>

namespace continuo {

/// Who looks at the motions of an ensemble between the ends of their steps.
template <State X>
class RunWatcher {
 public:
  virtual ~RunWatcher() = default;
  /// Whether the piece of this run that ends at `to` is to be shown. Threads ask at the same time.
  [[nodiscard]] virtual bool wants(std::size_t run, double to) = 0;
  /// Shows it: `at(t, x)` gives the state at a time of the piece, its ends included. Of one run one after the other.
  virtual void on_piece(std::size_t run, double to, const std::function<void(double t, X& x)>& at) = 0;
};

/// The options of an ensemble: those of each run, as in `Options`, and what happens to the results.
template <State X, State P>
struct EnsembleOptions {
  double rtol = 1e-6;                                         // the error allowed in a step, relative to each component
  double atol = 1e-9;                                         // and its absolute part, in the unit of the components
  std::vector<double> rtol_each{};                            // one per component, instead of rtol
  std::vector<double> atol_each{};                            // one per component, instead of atol
  double step = 0;                                            // > 0: fixed steps of this size, no error control
  double first_step = 0;                                      // the size that is tried first; 0: Hairer's estimate
  double max_step = std::numeric_limits<double>::infinity();  // no step is longer
  Controller controller = PI;                                 // how the next step follows from the error
  std::size_t max_steps = 10'000'000;                         // of each run, accepted and rejected together
  std::size_t max_rejects_in_a_row = 60;                      // at more a run ends as `too_many_rejects`
  std::vector<double> save_at{};                              // times, in the direction of time: RunResult::rows
  RunWatcher<X>* watcher = nullptr;                           // sees the motions between the ends of their steps
  bool keep_events = true;                                    // whether results list the events
  int threads = 0;                                            // 0: as many as the machine runs at once, and never more
  /// Gets each result, in the order of the numbers of the runs and never two at once, whichever thread has computed it;
  /// then Ensemble::runs stays empty, and memory does not grow with the number of runs. `false` ends the ensemble.
  Callback<const RunResult<X, P>&> finished{};
  const std::atomic<bool>* interrupt = nullptr;  // the ensemble ends once it is true

  /// The part that is one run's.
  [[nodiscard]] Options<X> of_one_run() const {
    Options<X> one;
    one.rtol = rtol;
    one.atol = atol;
    one.rtol_each = rtol_each;
    one.atol_each = atol_each;
    one.step = step;
    one.first_step = first_step;
    one.max_step = max_step;
    one.controller = controller;
    one.max_steps = max_steps;
    one.max_rejects_in_a_row = max_rejects_in_a_row;
    if (!save_at.empty()) one.save = Save<X>::at(save_at);
    return one;
  }
};

}  // namespace continuo
