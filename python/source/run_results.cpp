// The results of a Run as arrays, and the class in Python.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include "gil.hpp"
#include "parts.hpp"
#include "run.hpp"
#include <continuo/solve/catalogue.hpp>
#include <continuo/solve/choice.hpp>
#include <continuo/solve/outcome.hpp>

namespace py = pybind11;

namespace continuo::python {

py::object Run::take_error() {
  return control_.failed() ? control_.release() : py::none();
}

// Rows of states as an array; with the components first it is the transposed view, as SciPy's is.
py::array Run::numbers(const double* from, std::size_t rows, bool components_first) const {
  const std::size_t size = y0_.size();
  const bool complex = settings_.form.numbers == Numbers::complex;
  const auto n = static_cast<py::ssize_t>(complex ? size / 2 : size), m = static_cast<py::ssize_t>(rows);
  const auto item = static_cast<py::ssize_t>(complex ? sizeof(std::complex<double>) : sizeof(double));
  std::vector<py::ssize_t> shape = {m, n}, strides = {n * item, item};
  if (components_first) shape = {n, m}, strides = {item, n * item};
  py::array result = complex ? py::array(py::array_t<std::complex<double>>(std::move(shape), std::move(strides)))
                             : py::array(py::array_t<double>(std::move(shape), std::move(strides)));
  if (rows * size > 0) std::memcpy(result.mutable_data(), from, rows * size * sizeof(double));
  return result;
}

py::array Run::times() const {
  require_idle();
  return py::array_t<double>(static_cast<py::ssize_t>(record_.t.size()), record_.t.data());
}

py::array Run::states() const {
  require_idle();
  return numbers(record_.x.data(), record_.t.size(), true);
}

py::object Run::dense() {
  require_idle();
  const bool complex = settings_.form.numbers == Numbers::complex;
  if (record_.dense.pieces.empty()) record_.dense.add_constant(settings_.t0, settings_.t0, y0_);
  return py::cast(DenseSolution(record_.dense, complex));
}

py::tuple Run::events() const {
  require_idle();
  py::list result;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    std::vector<double> t, before, after;
    for (const ForeignRecord::Event& event : record_.events) {
      if (event.number != i) continue;
      t.push_back(event.t);
      before.insert(before.end(), event.before.begin(), event.before.end());
      after.insert(after.end(), event.after.begin(), event.after.end());
    }
    result.append(py::make_tuple(py::array_t<double>(static_cast<py::ssize_t>(t.size()), t.data()),
                                 numbers(before.data(), t.size(), false), numbers(after.data(), t.size(), false)));
  }
  return py::tuple(result);
}

const Outcome<double>& Run::outcome() const {
  static const Outcome<double> reached{};
  return run_ ? run_->outcome() : reached;
}

Statistics Run::statistics() const {
  Statistics statistics = run_ ? run_->statistics() : Statistics{};
  statistics.evaluations += checks_;
  // As SciPy counts: without those for differences.
  const ForeignFunctions& f = *functions_;
  if (!f.jacobian.call && !f.jacobian_values.call) {
    const std::size_t each = f.pattern.size() == 0 ? f.size : ColumnGroups(f.pattern).count();
    statistics.evaluations -= std::min(statistics.evaluations, statistics.jacobians * each);
  }
  return statistics;
}

py::tuple Run::summary() const {
  Outcome<double> outcome = this->outcome();
  if (outcome.ending == Ending::events_accumulate)
    outcome.hint = "give the event an `at_limit` for what happens there, or make it terminal";
  int status = -1;
  if (outcome.ending == Ending::reached_end) status = 0;
  if (outcome.ending == Ending::stopped_by_event) status = 1;
  std::string text = run_ ? describe(outcome) : "reached end at t = " + std::to_string(settings_.t1);
  std::string message = text;
  if (outcome.ending == Ending::step_too_small || outcome.ending == Ending::too_many_rejects)
    message = "Required step size is less than spacing between numbers: " + text;
  if (below_spacing_) {
    status = -1;
    text = "max_step is less than the spacing between numbers at t = " + std::to_string(run_->t());
    message = "Required step size is less than spacing between numbers: " + text;
  }
  if (below_min_step_) {
    status = -1;
    message = text = "the step that the tolerance needs is below min_step at t = " + std::to_string(run_->t());
  }
  if (status == 0) message = "The solver successfully reached the end of the integration interval.";
  if (status == 1) message = "A termination event occurred.";
  const Statistics cost = statistics();
  const bool constant = !constant_jacobian_.empty();
  return py::make_tuple(status, message, text, cost.evaluations, constant ? std::size_t{0} : cost.jacobians,
                        cost.factorizations, to_string(outcome.ending), cost.steps, cost.rejected);
}

py::array Run::y() const {
  require_idle();
  const std::vector<double>& x = run_ ? run_->x() : y0_;
  const bool complex = settings_.form.numbers == Numbers::complex;
  const auto n = static_cast<py::ssize_t>(complex ? x.size() / 2 : x.size());
  py::array result = complex ? py::array(py::array_t<std::complex<double>>(n)) : py::array(py::array_t<double>(n));
  if (!x.empty()) std::memcpy(result.mutable_data(), x.data(), x.size() * sizeof(double));
  return result;
}

py::array Run::y_at(double t) {
  require_idle();
  std::vector<double> x = run_ ? run_->x() : y0_;
  if (run_) run_->at(t, x);
  return py::array(numbers(x.data(), 1, false).attr("ravel")());
}

py::object Run::last_piece(double t_old) {
  require_idle();
  ForeignDense dense{.size = y0_.size(), .pieces = {}, .coefficients = {}, .ends = {}};
  if (!run_ || run_->t() == t_old) {
    dense.add_constant(t_old, t(), run_ ? run_->x() : y0_);
  } else {
    dense.add(t_old, run_->t(), run_->step_begin(), run_->step_size(), run_->dense_output(), run_->x());
  }
  return py::cast(DenseSolution(std::move(dense), settings_.form.numbers == Numbers::complex));
}

namespace {

[[nodiscard]] std::unique_ptr<Run> make_run(const py::object& fun, double t0, double t1, const py::array& y0,
                                            const std::string& method, const py::object& rtol, const py::object& atol,
                                            double max_step, const py::object& times, bool dense,
                                            const py::object& arguments, const py::dict& extras) {
  RunSettings settings;
  settings.method = method;
  settings.t0 = t0;
  settings.t1 = t1;
  settings.rtol = rtol;
  settings.atol = atol;
  settings.max_step = max_step;
  settings.arguments = arguments;
  const char kind = y0.dtype().kind();
  if ((kind != 'f' && kind != 'c') || y0.ndim() != 1 || !(y0.flags() & py::array::c_style))
    throw py::type_error("y0 must be an array of one dimension of float64 or complex128");
  settings.form.numbers = kind == 'c' ? Numbers::complex : Numbers::real;
  settings.wanted.dense = dense;
  settings.wanted.steps = times.is_none();
  if (!times.is_none()) {
    const auto array = times.cast<py::array_t<double, py::array::c_style | py::array::forcecast>>();
    settings.wanted.times.assign(array.data(), array.data() + array.size());
  }
  if (extras.size() > 0) {
    const auto number = [&](const char* name, double& value) {
      if (PyObject* found = PyDict_GetItemString(extras.ptr(), name)) value = py::handle(found).cast<double>();
    };
    number("first_step", settings.first_step);
    number("step", settings.step);
    number("min_step", settings.min_step);
    double most = 0;
    number("max_steps", most);
    settings.max_steps = static_cast<std::size_t>(most);
    settings.form.vectorized = extras.contains("vectorized");
    if (extras.contains("state")) {
      const std::string state = extras["state"].cast<std::string>();
      settings.form.handing = state == "array" ? Handing::array : state == "list" ? Handing::list : Handing::automatic;
    }
  }
  return std::make_unique<Run>(fun, y0, std::move(settings), extras);
}

// One call in place of five, and no object for a Run of which nothing more is asked: a fifth of a short run.
[[nodiscard]] py::tuple run_to_end(const py::object& fun, double t0, double t1, const py::array& y0,
                                   const std::string& method, const py::object& rtol, const py::object& atol,
                                   double max_step, const py::object& times, bool dense, const py::object& arguments,
                                   const py::dict& extras) {
  std::unique_ptr<Run> run = make_run(fun, t0, t1, y0, method, rtol, atol, max_step, times, dense, arguments, extras);
  Run* const running = run.release();  // a thread that the end of the interpreter unwinds here must not destroy it
  const py::object error = running->run();
  run.reset(running);
  const py::tuple summary = run->summary();
  const py::array reached = run->times(), states = run->states();
  const bool ends_here = error.is_none() && !dense && !extras.contains("events");
  return py::make_tuple(ends_here ? py::none() : py::cast(std::move(run)), error, summary, reached, states);
}

[[nodiscard]] py::list methods() {
  py::list list;
  for (const MethodInfo& info : method_catalogue())
    if (!info.needs_series)
      list.append(py::make_tuple(info.name, info.order, info.error_order, info.second_order, info.implicit));
  return list;
}

}  // namespace
}  // namespace continuo::python

void add_run(py::module_& module) {
  using continuo::python::Run;
  const py::call_guard<continuo::python::Visit> guard;
  py::class_<Run>(module, "Run", "A run of one right-hand side.")
      .def(py::init(&continuo::python::make_run), py::arg("fun"), py::arg("t0"), py::arg("t1"), py::arg("y0"),
           py::arg("method"), py::arg("rtol"), py::arg("atol"), py::arg("max_step"), py::arg("times"), py::arg("dense"),
           py::arg("args"), py::arg("extras"), guard)
      .def("run", &Run::run, guard)
      .def("check", &Run::check, guard)
      .def("step", &Run::step, guard)
      .def("take_error", &Run::take_error)
      .def("times", &Run::times, guard)
      .def("states", &Run::states, guard)
      .def("dense", &Run::dense, guard)
      .def("events", &Run::events, guard)
      .def("summary", &Run::summary, guard)
      .def("y_at", &Run::y_at, py::arg("t"), guard)
      .def("last_piece", &Run::last_piece, py::arg("t_old"))
      .def("set_state", &Run::set_state, py::arg("y"))
      .def("restart", &Run::restart)
      .def("extend_to", &Run::extend_to, py::arg("t1"), guard)
      .def_property_readonly("t", &Run::t)
      .def_property_readonly("y", &Run::y)
      .def_property_readonly("native", &Run::native);
  module.def("run_to_end", &continuo::python::run_to_end, py::arg("fun"), py::arg("t0"), py::arg("t1"), py::arg("y0"),
             py::arg("method"), py::arg("rtol"), py::arg("atol"), py::arg("max_step"), py::arg("times"),
             py::arg("dense"), py::arg("args"), py::arg("extras"), guard,
             "A Run to its end: (the Run where it has more to tell, or None, its error, summary, times, states).");
  module.def("methods", &continuo::python::methods,
             "The methods by name: (name, order, order of the error estimate, for x'' = a alone, implicit).");
  module.def(
      "canonical_name", [](const std::string& name) { return std::string(continuo::canonical_name(name)); },
      py::arg("name"));
  module.def(
      "choose_method",
      [](std::size_t size, double rtol, bool algebraic, bool accelerations, bool sparse, bool banded) {
        return std::string(continuo::choose_method({size, rtol, algebraic, accelerations, sparse, banded}).method);
      },
      py::arg("size"), py::arg("rtol"), py::arg("algebraic") = false, py::arg("accelerations") = false,
      py::arg("sparse") = false, py::arg("banded") = false, "The method that is taken where none is named.");
}
