// Runs that are asked for one time after another: those of ode and odeint.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <utility>
#include <vector>

#include "gil.hpp"
#include "parts.hpp"
#include "run.hpp"

namespace py = pybind11;

namespace continuo::python {

void Run::derivative_at(double t, const std::vector<double>& x, std::vector<double>& dxdt) {
  ++checks_;
  dxdt.resize(x.size());
  functions_->derivative.call(t, x.data(), dxdt.data(), functions_->derivative.user);
}

void Run::state_at(double t, std::vector<double>& x) {
  x = run_ ? run_->x() : y0_;
  if (run_ && t != run_->t()) run_->at(t, x);
}

namespace {

/// How far a run has come.
enum class Reached { there, ended, too_many_steps };

/// Takes steps until the run is at t or beyond. `last_step` is the size of the last one, where there is one.
[[nodiscard]] Reached advance(Run& run, double t, double direction, std::size_t most_steps, double& last_step) {
  for (std::size_t steps = 0; direction * (t - run.t()) > 0; ++steps) {
    if (steps == most_steps) return Reached::too_many_steps;
    const double before = run.t();
    const bool goes_on = run.step();
    last_step = run.t() - before;
    if (!goes_on && direction * (t - run.t()) > 0) return Reached::ended;
  }
  return Reached::there;
}

/// A run that is continued call by call while its functions stay what they were. Whether f has is found by calling it
/// where the last call has led to: at the end of that call and at the beginning of the next one.
class ContinuedRun {
 public:
  /// From t to `end` at first. Where it `lands` it goes no further than it is asked to.
  ContinuedRun(py::object run, double t, double end, bool lands, py::tuple functions)
      : object_(std::move(run)),
        run_(object_.cast<Run&>()),
        t_(t),
        end_(end),
        direction_(end < t ? -1 : 1),
        lands_(lands),
        is_complex_(run_.y().dtype().kind() == 'c'),
        functions_(std::move(functions)) {}

  /// Whether the run leads from y, by these functions, to t: not where y, or f where the last call has led to, is
  /// different from what it was then.
  [[nodiscard]] bool leads_to(double t, const py::array& y, const py::tuple& functions) {
    if (!std::isfinite(t) || !(direction_ * (t - t_) > 0)) return false;
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (PyTuple_GET_ITEM(functions.ptr(), i) != PyTuple_GET_ITEM(functions_.ptr(), i)) return false;
    if (x_.empty()) return true;
    if (static_cast<std::size_t>(y.nbytes()) != x_.size() * sizeof(double)) return false;
    if (std::memcmp(y.data(), x_.data(), x_.size() * sizeof(double)) != 0) return false;
    run_.derivative_at(t_, x_, now_);
    return std::memcmp(now_.data(), slope_.data(), now_.size() * sizeof(double)) == 0;
  }
  /// Advances until t lies in the last step; 0 there, 1 the run has ended, 2 more steps would be needed.
  [[nodiscard]] int advance_to(double t, std::size_t most_steps) {
    if (direction_ * (end_ - t) < 0) {
      end_ = lands_ ? t : t + beyond * (t - t_);
      run_.extend_to(end_);
    }
    double last_step = 0;
    return static_cast<int>(advance(run_, t, direction_, most_steps, last_step));
  }
  /// y at t, in the last step, from where the next call continues.
  [[nodiscard]] py::array stop_at(double t) {
    t_ = t;
    run_.state_at(t, x_);
    run_.derivative_at(t_, x_, slope_);
    const auto count = static_cast<py::ssize_t>(x_.size());
    py::array y =
        is_complex_ ? py::array(py::array_t<std::complex<double>>(count / 2)) : py::array(py::array_t<double>(count));
    std::memcpy(y.mutable_data(), x_.data(), x_.size() * sizeof(double));
    return y;
  }
  /// All of this, where nothing is in the way; else None.
  [[nodiscard]] py::object go_on(double t, const py::array& y, const py::tuple& functions, std::size_t most_steps) {
    if (!leads_to(t, y, functions) || advance_to(t, most_steps) != 0 || run_.failed()) return py::none();
    return stop_at(t);
  }
  [[nodiscard]] bool goes_beyond(double t) const { return direction_ * (end_ - t) > 0; }

  /// So many times the way from call to call the run may go further than it is asked to, so that its steps need not be
  /// cut there; farther, the digits of times between would suffer in long steps.
  static constexpr double beyond = 8;

 private:
  py::object object_;
  Run& run_;
  double t_, end_, direction_;
  bool lands_, is_complex_;
  py::tuple functions_;
  std::vector<double> x_, slope_, now_;
};

/// What odeint tells of a run, for each time but the first.
struct Costs {
  std::vector<double> step_sizes, times;
  std::vector<int> steps, evaluations, jacobians;

  void add(const Run& run, double last_step) {
    const Statistics statistics = run.statistics();
    step_sizes.push_back(last_step);
    times.push_back(run.t());
    steps.push_back(static_cast<int>(statistics.steps));
    evaluations.push_back(static_cast<int>(statistics.evaluations));
    jacobians.push_back(static_cast<int>(statistics.jacobians));
  }
  [[nodiscard]] py::dict to_python() const {
    const auto array = [](const auto& numbers) {
      return py::array_t<typename std::decay_t<decltype(numbers)>::value_type>(static_cast<py::ssize_t>(numbers.size()),
                                                                               numbers.data());
    };
    py::dict result;
    result["hu"] = array(step_sizes);
    result["tcur"] = array(times);
    result["nst"] = array(steps);
    result["nfe"] = array(evaluations);
    result["nje"] = array(jacobians);
    return result;
  }
};

/// The states at these times, the first of which is that of the beginning, with at most so many steps between two of
/// them: (states, costs, how many times were reached, why no more).
[[nodiscard]] py::tuple through_times(Run& run, const py::array_t<double>& times, std::size_t most_steps) {
  const py::array first = run.y();
  const auto count = times.size();
  py::array_t<double> states({count, first.size()});
  std::fill_n(states.mutable_data(), states.size(), 0.0);
  std::memcpy(states.mutable_data(), first.data(), static_cast<std::size_t>(first.nbytes()));
  const double direction = times.at(count - 1) < times.at(0) ? -1 : 1;
  double last_step = 0;
  std::vector<double> x;
  Costs costs;
  Reached why = Reached::there;
  py::ssize_t reached = 1;
  for (; reached < count; ++reached) {
    const double t = times.at(reached);
    why = advance(run, t, direction, most_steps, last_step);
    if (why != Reached::there) break;
    run.state_at(t, x);
    std::memcpy(states.mutable_data(reached), x.data(), x.size() * sizeof(double));
    costs.add(run, last_step);
  }
  return py::make_tuple(states, costs.to_python(), reached, static_cast<int>(why));
}

}  // namespace
}  // namespace continuo::python

void add_continued_run(py::module_& module) {
  using continuo::python::ContinuedRun;
  const py::call_guard<continuo::python::Visit> guard;
  py::class_<ContinuedRun>(module, "ContinuedRun", "A run that is continued while its function stays what it was.")
      .def(py::init<py::object, double, double, bool, py::tuple>(), py::arg("run"), py::arg("t"), py::arg("end"),
           py::arg("lands"), py::arg("functions"))
      .def_property_readonly_static("beyond", [](const py::object&) { return ContinuedRun::beyond; })
      .def("leads_to", &ContinuedRun::leads_to, py::arg("t"), py::arg("y"), py::arg("functions"))
      .def("advance_to", &ContinuedRun::advance_to, py::arg("t"), py::arg("most_steps"), guard)
      .def("stop_at", &ContinuedRun::stop_at, py::arg("t"))
      .def("go_on", &ContinuedRun::go_on, py::arg("t"), py::arg("y"), py::arg("functions"), py::arg("most_steps"),
           guard)
      .def("goes_beyond", &ContinuedRun::goes_beyond, py::arg("t"));
  module.def(
      "is_native", [](const py::object& f) { return continuo::python::native_of(f, py::none()).has_value(); },
      py::arg("f"), "Whether this is a compiled function, which a run calls without the interpreter.");
  module.def("through_times", &continuo::python::through_times, py::arg("run"), py::arg("times"), py::arg("most_steps"),
             guard);
}
