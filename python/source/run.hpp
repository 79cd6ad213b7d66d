// A run of a Python or a compiled right-hand side: what solve_ivp and the solver classes drive.
#pragma once
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "callbacks.hpp"
#include "dense_solution.hpp"
#include "native.hpp"
#include <continuo/foreign/foreign_run.hpp>

namespace continuo::python {

/// What a run is made of, as the package gives it. Names are those of solve_ivp.
struct RunSettings {
  std::string method;  // by its name in the catalogue
  double t0 = 0, t1 = 0;
  pybind11::object rtol, atol;  // a float, or an array with one for each component
  double first_step = 0, max_step = 0, step = 0, min_step = 0;
  std::size_t max_steps = 0;
  pybind11::object arguments;  // a tuple, or None
  StateFunction::Form form;    // of the state; form.size is filled in
  ForeignRecord::Wanted wanted;
};

class Run {
 public:
  /// `extras`: what few runs have, by name: see read_extras.
  Run(const pybind11::object& fun, const pybind11::array& y0, RunSettings settings, const pybind11::dict& extras);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run() = default;

  /// Runs to the end. Returns what `take_error` does.
  [[nodiscard]] pybind11::object run();
  /// Takes one step. True while the run has not ended.
  bool step();
  /// Evaluates f once where the run begins, so that what is wrong with it shows.
  void check();

  /// The exception of a callback, which the run then has no more; None where there is none.
  [[nodiscard]] pybind11::object take_error();
  [[nodiscard]] pybind11::array times() const;
  [[nodiscard]] pybind11::array states() const;
  [[nodiscard]] pybind11::object dense();
  /// For each event of the events: its times, the states before and after it.
  [[nodiscard]] pybind11::tuple events() const;
  /// (status, message, outcome, nfev, njev, nlu)
  [[nodiscard]] pybind11::tuple summary() const;

  [[nodiscard]] double t() const { return run_ ? run_->t() : end_without_run_; }
  [[nodiscard]] pybind11::array y() const;
  [[nodiscard]] pybind11::array y_at(double t);
  /// The dense output of the last step alone, from t_old to t.
  [[nodiscard]] pybind11::object last_piece(double t_old);
  [[nodiscard]] const Outcome<double>& outcome() const;
  [[nodiscard]] Statistics statistics() const;
  [[nodiscard]] bool native() const { return native_.has_value(); }
  /// Whether a callback has failed, whose exception has not been taken yet.
  [[nodiscard]] bool failed() const { return control_.failed(); }
  /// f at (t, x), outside of the run; not numbers where it fails.
  void derivative_at(double t, const std::vector<double>& x, std::vector<double>& dxdt);
  /// The state at a time of the last step.
  void state_at(double t, std::vector<double>& x);
  /// Continues from this state.
  void set_state(const pybind11::array& y);
  /// f has changed: the method begins anew.
  void restart();
  void extend_to(double t1);

 private:
  class Busy;
  struct EventFunctions {
    std::unique_ptr<StateFunction> guard, action, at_limit;
  };

  void read_state(const pybind11::array& y0);
  void read_extras(const pybind11::dict& extras, Options<std::vector<double>>& options);
  void read_events(const pybind11::handle& events, Options<std::vector<double>>& options);
  void read_jacobian(const pybind11::dict& extras);
  void read_mass(const pybind11::handle& mass);
  void set_native_jacobian();
  void set_functions(const pybind11::object& fun);
  [[nodiscard]] std::unique_ptr<StateFunction> function(const pybind11::object& f, const std::string& name);
  void act(StateFunction& action, EventAction<std::vector<double>>& now);
  [[nodiscard]] std::string reason_of_matrix() const;
  void run_with_gil();
  void run_without_gil();
  template <class Advance>
  bool advance_by(Advance&& take_step);
  bool advance();
  void require_idle() const;
  void check_guards(double from);
  void report_progress(bool at_end);
  [[nodiscard]] bool is_below_min_step(double t_before) const;
  [[nodiscard]] pybind11::array numbers(const double* from, std::size_t rows, bool components_first) const;

  static void derivative(double t, const double* x, double* dxdt, void* run);
  static void native_derivative(double t, const double* x, double* dxdt, void* run);
  static void accelerations(double t, const double* x, double* dxdt, void* run);
  static void native_accelerations(double t, const double* x, double* dxdt, void* run);
  static void jacobian(double t, const double* x, double* rows, void* run);
  static void constant_jacobian(double t, const double* x, double* rows, void* run);
  static void jacobian_values(double t, const double* x, double* values, void* run);
  static void constant_values(double t, const double* x, double* values, void* run);

  RunControl control_;
  RunSettings settings_;
  std::vector<double> y0_;
  std::optional<Native> native_;
  std::unique_ptr<StateFunction> fun_, jac_;
  std::vector<double> constant_jacobian_;  // row by row, or of the pattern
  bool pattern_is_native_ = false;         // that of the compiled function's own Jacobian
  std::vector<EventFunctions> events_;
  std::vector<std::string> event_names_;
  std::shared_ptr<ForeignFunctions> functions_ = std::make_shared<ForeignFunctions>();
  ForeignRun::Pointer run_;  // null where there is nothing to integrate
  ForeignRecord record_;
  pybind11::object progress_;
  double last_progress_ = 0;
  double end_without_run_ = 0;
  std::size_t checks_ = 0;         // evaluations of f by check
  std::atomic<bool> busy_{false};  // taking steps: in another thread, or below in this one
  bool holds_gil_ = true, has_python_ = false, second_order_ = false, below_min_step_ = false, below_spacing_ = false,
       guards_unknown_ = false;
};

}  // namespace continuo::python
