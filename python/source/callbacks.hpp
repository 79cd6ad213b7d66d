// Calls of Python functions in a run: of t and the state, with further arguments, each result checked. A call that
// fails ends the run; its exception is kept and raised when the run has ended.
#pragma once
#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "gil.hpp"

namespace continuo::python {

/// What ends a run from the outside: a callback that has failed, or a signal.
class RunControl {
 public:
  RunControl() = default;
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;
  ~RunControl();

  /// For Options::interrupt.
  [[nodiscard]] const std::atomic<bool>& stop() const { return stop_; }
  [[nodiscard]] bool failed() const { return type_ != nullptr; }
  /// Takes the exception of the interpreter, the first one alone, and ends the run. `where` says in a note where it was
  /// raised: "in the event `floor` at t = 3".
  void take_error(const std::string& where);
  /// Asks the interpreter for signals, such as that of Ctrl-C. The calling thread has the GIL.
  void check_signals();
  /// Raises what has been taken.
  [[noreturn]] void raise();
  /// The exception itself; the control then has none any more.
  [[nodiscard]] pybind11::object release();

 private:
  std::atomic<bool> stop_{false};
  PyObject *type_ = nullptr, *value_ = nullptr, *traceback_ = nullptr;
};

/// The GIL for a callback, where the run does not have it.
class GilForCallback {
 public:
  explicit GilForCallback(bool held) {
    if (!held) taken_.emplace();
  }

 private:
  std::optional<WithGil> taken_;
};

/// In what form a function gets the state.
enum class Handing { automatic, array, list };

/// How the components of the state are numbers of Python.
enum class Numbers { real, complex };

/// A Python function of t, the state and further arguments.
class StateFunction {
 public:
  struct Form {
    std::size_t size = 0;  // of the state of the run: two numbers for a complex component
    Numbers numbers = Numbers::real;
    Handing handing = Handing::automatic;
    bool vectorized = false;  // the state is handed over as a column
  };

  /// `name` in messages: "fun", "jac".
  StateFunction(pybind11::object f, const pybind11::object& arguments, Form form, std::string name,
                RunControl& control);
  StateFunction(const StateFunction&) = delete;
  StateFunction& operator=(const StateFunction&) = delete;
  ~StateFunction();

  /// Calls f at (t, x) and has take(result) read it, which returns false with an exception set where it cannot. Where
  /// either fails with a light state, the same is tried once with an array. False where it has failed: the control has
  /// the exception. The calling thread has the GIL.
  template <class Take>
  bool call(double t, const double* x, Take&& take) {
    return or_stay([&] { return try_call(t, x, std::forward<Take>(take)); });
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Form& form() const { return form_; }
  [[nodiscard]] pybind11::object function() const { return f_; }

 private:
  enum class Light { used, not_used, failed };

  [[nodiscard]] Light hand_over(double t, const double* x);
  [[nodiscard]] bool set_array(const double* x);
  [[nodiscard]] bool set_list(const double* x);
  [[nodiscard]] PyObject* invoke();
  void look_at_use();
  bool fail(double t);
  template <class Take>
  bool try_call(double t, const double* x, Take&& take) {
    stay_where_python_ends();
    if (control_->failed()) return false;
    const Light light = hand_over(t, x);
    if (light == Light::failed) return fail(t);
    if (PyObject* result = invoke()) {
      const bool taken = take(result);
      Py_DECREF(result);
      if (taken) {
        if (light == Light::used) look_at_use();
        return true;
      }
    }
    if (light != Light::used || !PyErr_ExceptionMatches(PyExc_Exception)) return fail(t);
    return call_with_array(t, x, [&](PyObject* result) { return take(result); });
  }
  template <class Take>
  bool call_with_array(double t, const double* x, Take&& take) {
    PyErr_Clear();
    if (!set_array(x)) return fail(t);
    PyObject* result = invoke();
    if (!result) return fail(t);
    const bool taken = take(result);
    Py_DECREF(result);
    if (!taken) return fail(t);
    uses_array_ = true;
    return true;
  }

  pybind11::object f_;
  Form form_;
  std::string name_;
  RunControl* control_;
  std::vector<PyObject*> call_;  // a free place, t, the state, the further arguments
  bool uses_array_;
};

/// Reads numbers that form a vector of n, into `numbers`. `name` says in messages whose result it is. False with an
/// exception set where they are no such.
[[nodiscard]] bool read_vector(PyObject* result, std::size_t n, const StateFunction& f, double* numbers);
/// The same for a matrix of n rows and columns, row by row; of complex numbers in the form of one of 2n real ones.
[[nodiscard]] bool read_matrix(PyObject* result, std::size_t n, const StateFunction& f, double* rows);
/// One real number: a float, or an array of one element.
[[nodiscard]] bool read_number(PyObject* result, const StateFunction& f, double* number);

}  // namespace continuo::python
