// Runs that are asked for one time after another: those of ode and odeint.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "parts.hpp"
#include "run.hpp"

namespace py = pybind11;

namespace continuo::python {

std::vector<double> Run::derivative_at(double t, const std::vector<double>& x) {
  ++checks_;
  std::vector<double> slope(x.size());
  functions_->derivative.call(t, x.data(), slope.data(), functions_->derivative.user);
  return slope;
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

/// A run that is continued call by call while its function stays what it was. Whether it has is found by calling it
/// where the last call has led to: at the end of that call and at the beginning of the next one.
class ContinuedRun {
 public:
  ContinuedRun(py::object run, double t, double direction)
      : object_(std::move(run)), run_(object_.cast<Run&>()), t_(t), direction_(direction) {}

  /// Whether y, or f where the last call has led to, is not what it was then.
  [[nodiscard]] bool has_changed(const py::array& y) {
    if (x_.empty()) return false;
    if (static_cast<std::size_t>(y.nbytes()) != x_.size() * sizeof(double)) return true;
    if (std::memcmp(y.data(), x_.data(), x_.size() * sizeof(double)) != 0) return true;
    const std::vector<double> slope = run_.derivative_at(t_, x_);
    return std::memcmp(slope.data(), slope_.data(), slope.size() * sizeof(double)) != 0;
  }
  /// Advances until t lies in the last step; 0 there, 1 the run has ended, 2 more steps would be needed.
  [[nodiscard]] int advance_to(double t, std::size_t most_steps) {
    double last_step = 0;
    return static_cast<int>(advance(run_, t, direction_, most_steps, last_step));
  }
  /// y at t, in the last step, from where the next call continues.
  [[nodiscard]] py::array stop_at(double t) {
    py::array y = t == run_.t() ? run_.y() : run_.y_at(t);
    t_ = t;
    const auto count = static_cast<std::size_t>(y.nbytes()) / sizeof(double);
    x_.resize(count);
    std::memcpy(x_.data(), y.data(), count * sizeof(double));
    slope_ = run_.derivative_at(t_, x_);
    return y;
  }

 private:
  py::object object_;
  Run& run_;
  double t_, direction_;
  std::vector<double> x_, slope_;
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
  Costs costs;
  Reached why = Reached::there;
  py::ssize_t reached = 1;
  for (; reached < count; ++reached) {
    const double t = times.at(reached);
    why = advance(run, t, direction, most_steps, last_step);
    if (why != Reached::there) break;
    const py::array y = t == run.t() ? run.y() : run.y_at(t);
    std::memcpy(states.mutable_data(reached), y.data(), static_cast<std::size_t>(y.nbytes()));
    costs.add(run, last_step);
  }
  return py::make_tuple(states, costs.to_python(), reached, static_cast<int>(why));
}

}  // namespace
}  // namespace continuo::python

void add_continued_run(py::module_& module) {
  using continuo::python::ContinuedRun;
  py::class_<ContinuedRun>(module, "ContinuedRun", "A run that is continued while its function stays what it was.")
      .def(py::init<py::object, double, double>(), py::arg("run"), py::arg("t"), py::arg("direction"))
      .def("has_changed", &ContinuedRun::has_changed, py::arg("y"))
      .def("advance_to", &ContinuedRun::advance_to, py::arg("t"), py::arg("most_steps"))
      .def("stop_at", &ContinuedRun::stop_at, py::arg("t"));
  module.def(
      "is_native", [](const py::object& f) { return continuo::python::native_of(f, py::none()).has_value(); },
      py::arg("f"), "Whether this is a compiled function, which a run calls without the interpreter.");
  module.def("through_times", &continuo::python::through_times, py::arg("run"), py::arg("times"),
             py::arg("most_steps"));
}
