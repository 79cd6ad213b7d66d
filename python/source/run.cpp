// The class Run: how it begins, and how it goes on.
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "gil.hpp"
#include <continuo/solve/outcome.hpp>

namespace py = pybind11;

namespace continuo::python {
namespace {

using X = std::vector<double>;

// A run with as many components holds the GIL no longer than a callback: what it computes between them takes longer
// than the way there and back.
constexpr std::size_t most_held = 64;
constexpr double seconds_between_looks = 0.02, seconds_between_progress = 0.1;

[[nodiscard]] bool is_main_thread() {
  static const unsigned long main_thread =
      py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  return PyThread_get_thread_ident() == main_thread;
}

void read_tolerance(const py::object& given, bool complex, double& one, std::vector<double>& each) {
  if (PyFloat_Check(given.ptr()) || PyLong_Check(given.ptr())) {
    one = given.cast<double>();
    return;
  }
  const py::array_t<double, py::array::c_style | py::array::forcecast> array(given);
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    each.push_back(array.data()[i]);
    if (complex) each.push_back(array.data()[i]);
  }
  if (!each.empty()) one = *std::ranges::min_element(each);
}

[[nodiscard]] py::object extra(const py::dict& extras, const char* name) {
  PyObject* found = PyDict_GetItemString(extras.ptr(), name);
  return found ? py::reinterpret_borrow<py::object>(found) : py::none();
}

}  // namespace

Run::Run(const py::object& fun, const py::array& y0, RunSettings settings, const py::dict& extras)
    : settings_(std::move(settings)), record_(std::move(settings_.wanted)) {
  const bool complex = settings_.form.numbers == Numbers::complex;
  read_state(y0);
  functions_->size = y0_.size();
  settings_.form.size = y0_.size();
  Options<X> options;
  read_tolerance(settings_.rtol, complex, options.rtol, options.rtol_each);
  read_tolerance(settings_.atol, complex, options.atol, options.atol_each);
  options.first_step = settings_.first_step;
  options.max_step = settings_.max_step;
  options.step = settings_.step;
  if (settings_.max_steps > 0) options.max_steps = settings_.max_steps;
  options.interrupt = &control_.stop();
  if (extras.size() > 0) read_extras(extras, options);
  native_ = native_of(fun, settings_.arguments);
  set_functions(fun);
  end_without_run_ = settings_.t1;
  if (y0_.empty() || settings_.t0 == settings_.t1) {
    record_.begin(settings_.t0, y0_);
    record_.end_at(settings_.t1, y0_);
    return;
  }
  run_ = begin_foreign_run(functions_, y0_, {settings_.t0, settings_.t1}, settings_.method, std::move(options));
  if (!run_) throw py::value_error("`method`: there is no " + settings_.method + reason_of_matrix());
  record_.begin(settings_.t0, run_->x());  // with the unknowns of algebraic equations solved for
}

std::string Run::reason_of_matrix() const {
  if (functions_->mass_rows.empty()) return {};
  return " for a mass that is a full matrix: take 'Radau', 'BDF', 'radau', 'rodas5p' or None";
}

void Run::read_state(const py::array& y0) {
  const std::size_t numbers = settings_.form.numbers == Numbers::complex ? 2 : 1;
  y0_.resize(static_cast<std::size_t>(y0.size()) * numbers);
  std::memcpy(y0_.data(), y0.data(), y0_.size() * sizeof(double));
  for (std::size_t i = 0; i < y0_.size(); ++i)
    if (!std::isfinite(y0_[i]))
      throw py::value_error("All components of the initial state `y0` must be finite, and that of number " +
                            std::to_string(i / numbers) + " is not.");
}

std::unique_ptr<StateFunction> Run::function(const py::object& f, const std::string& name) {
  if (!PyCallable_Check(f.ptr()))
    throw py::type_error(name + " is a " + std::string(Py_TYPE(f.ptr())->tp_name) + " and cannot be called");
  StateFunction::Form form = settings_.form;
  form.vectorized = false;
  has_python_ = true;
  return std::make_unique<StateFunction>(f, settings_.arguments, form, name, control_);
}

void Run::set_native_jacobian() {
  if (functions_->jacobian.call || functions_->jacobian_values.call || second_order_) return;
  if (native_->jacobian) functions_->jacobian = {native_->jacobian, native_->user};
  if (native_->entries && pattern_is_native_) functions_->jacobian_values = {native_->entries, native_->user};
}

void Run::set_functions(const py::object& fun) {
  const std::size_t n = functions_->size;
  if (second_order_ && n % 2 != 0)
    throw py::value_error("`second_order`: y0 has " + std::to_string(n) +
                          " components, and must have the positions and then as many velocities");
  if (native_) {
    const std::size_t needs = second_order_ ? n / 2 : n;
    if (native_->size != 0 && native_->size != needs)
      throw py::value_error("the compiled right-hand side is one of " + std::to_string(native_->size) +
                            " components, and y0 gives " + std::to_string(needs));
    if (!native_->has_arguments && !settings_.arguments.is_none() && py::len(settings_.arguments) > 0)
      throw py::type_error("`args` are not handed to a compiled right-hand side: give it user data instead");
    if (settings_.form.numbers == Numbers::complex)
      throw py::type_error("a compiled right-hand side computes with real numbers, and y0 is complex");
    functions_->derivative = {native_->derivative, native_->user};
    if (native_->may_write_nothing) functions_->derivative = {native_derivative, this};
    if (second_order_) functions_->derivative = {native_accelerations, this};
    set_native_jacobian();
    holds_gil_ = false;
    return;
  }
  if (!PyCallable_Check(fun.ptr()))
    throw py::type_error("`fun` is a " + std::string(Py_TYPE(fun.ptr())->tp_name) +
                         ": needed is a function fun(t, y), or a compiled one");
  StateFunction::Form form = settings_.form;
  if (second_order_) form.size = n / 2;
  fun_ = std::make_unique<StateFunction>(fun, settings_.arguments, form, "fun", control_);
  has_python_ = true;
  functions_->derivative = {second_order_ ? accelerations : derivative, this};
  holds_gil_ = n <= most_held;
}

/// Held while a run takes steps. A callback of the run, or another thread, that would have it take some more, or read
/// what is being written, gets an exception.
class Run::Busy {
 public:
  explicit Busy(Run& run) : run_(run) {
    run.require_idle();
    run.busy_ = true;
  }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;
  ~Busy() { run_.busy_ = false; }

 private:
  Run& run_;
};

void Run::require_idle() const {
  if (busy_)
    throw std::runtime_error(
        "the run is taking a step: it cannot be advanced, changed or read by one of its functions or by another "
        "thread meanwhile");
}

py::object Run::run() {
  if (!run_) return take_error();
  const Busy busy(*this);
  holds_gil_ ? run_with_gil() : run_without_gil();
  if (!progress_.is_none() && progress_) report_progress(true);
  return take_error();
}

template <class Advance>
bool Run::advance_by(Advance&& take_step) {
  const double before = run_->t();
  // SciPy asks for ten times the spacing.
  if (settings_.max_step <
      10 * (std::nextafter(std::abs(before), std::numeric_limits<double>::infinity()) - std::abs(before))) {
    below_spacing_ = true;
    return false;
  }
  guards_unknown_ = false;
  const bool goes_on = take_step();
  if (guards_unknown_ && !control_.failed()) check_guards(before);
  if (control_.failed()) return false;
  if (settings_.min_step > 0 && goes_on && is_below_min_step(before)) below_min_step_ = true;
  return goes_on && !below_min_step_;
}

// A guard that is no number has no side, and its events would be missed. Guards are also asked off the solution, to
// learn how they are rounded: so it is looked for along the step.
void Run::check_guards(double from) {
  constexpr int parts = 8;
  const GilForCallback gil(holds_gil_);
  X x = run_->x();
  for (int part = 1; part <= parts; ++part) {
    const double t = part == parts ? run_->t() : from + (run_->t() - from) * part / parts;
    run_->at(t, x);
    for (const EventFunctions& event : events_) {
      double value = 0;
      StateFunction& guard = *event.guard;
      const bool known = guard.call(t, x.data(), [&](PyObject* result) { return read_number(result, guard, &value); });
      if (!known || !std::isnan(value)) continue;
      PyErr_SetString(PyExc_ValueError,
                      (guard.name() + " is not a number here, so that its zeros cannot be found").c_str());
      return control_.take_error("continuo: at t = " + std::to_string(t));
    }
  }
}

bool Run::advance() {
  return advance_by([this] { return run_->advance(record_); });
}

void Run::run_with_gil() {
  while (advance()) {
    if (PyErr_CheckSignals() != 0) return control_.take_error("");
    if (progress_) report_progress(false);
    if (control_.failed()) return;
  }
}

// Signals are looked for at intervals of time, whatever a step takes.
void Run::run_without_gil() {
  const bool looks = is_main_thread();
  const WithoutGil released;
  double last = detail::seconds_of_steady_clock();
  std::size_t steps = 0, steps_between_looks = 16;
  while (advance()) {
    if (!(looks || progress_) || ++steps < steps_between_looks) continue;
    steps = 0;
    const double now = detail::seconds_of_steady_clock();
    if (now - last < seconds_between_looks) {
      steps_between_looks = std::min<std::size_t>(2 * steps_between_looks, 256);
      continue;
    }
    steps_between_looks = std::max<std::size_t>(steps_between_looks / 2, 1);
    last = now;
    const WithGil gil;
    control_.check_signals();
    if (progress_) report_progress(false);
    if (control_.failed()) return;
  }
}

void Run::report_progress(bool at_end) {
  const double now = detail::seconds_of_steady_clock();
  if (control_.failed() || (!at_end && now - last_progress_ < seconds_between_progress)) return;
  last_progress_ = now;
  const double part = (run_->t() - settings_.t0) / (settings_.t1 - settings_.t0);
  PyObject* result = or_stay([&] { return PyObject_CallFunction(progress_.ptr(), "dd", run_->t(), part); });
  if (!result) return control_.take_error("continuo: in progress");
  Py_DECREF(result);
}

bool Run::step() {
  if (!run_ || control_.failed()) return false;
  const Busy busy(*this);
  const auto advanced = [&] { return advance_by([this] { return run_->advance(); }); };
  bool goes_on = false;
  if (holds_gil_) {
    goes_on = advanced();
  } else {
    const WithoutGil released;
    goes_on = advanced();
  }
  if (PyErr_CheckSignals() != 0) control_.take_error("");
  return goes_on && !control_.failed();
}

void Run::check() {
  if (y0_.empty() || control_.failed()) return;
  ++checks_;
  std::vector<double> slope(y0_.size());
  functions_->derivative.call(settings_.t0, y0_.data(), slope.data(), functions_->derivative.user);
}

bool Run::is_below_min_step(double t_before) const {
  return run_->t() != settings_.t1 && std::abs(run_->t() - t_before) < settings_.min_step;
}

void Run::set_state(const py::array& y) {
  require_idle();
  if (!run_) return;
  read_state(y);
  run_->set_state(y0_);
}

void Run::restart() {
  require_idle();
  if (run_) run_->restart();
}

void Run::extend_to(double t1) {
  require_idle();
  settings_.t1 = t1;
  if (run_) run_->extend_to(t1);
}

void Run::read_extras(const py::dict& extras, Options<X>& options) {
  second_order_ = !extra(extras, "second_order").is_none();
  progress_ = extra(extras, "progress");
  if (progress_.is_none()) progress_ = py::object();
  if (progress_) has_python_ = true;
  if (const py::object names = extra(extras, "names"); !names.is_none())
    for (const py::handle name : names) functions_->names.push_back(name.cast<std::string>());
  if (second_order_) {
    functions_->ignores_velocity = true;
    for (std::size_t i = 0; i < y0_.size() / 2; ++i) functions_->pairs.push_back({i, i + y0_.size() / 2});
  }
  if (const py::object pairs = extra(extras, "pairs"); !pairs.is_none())
    for (const py::handle pair : pairs) {
      const auto numbers = pair.cast<py::sequence>();
      functions_->pairs.push_back({numbers[0].cast<std::size_t>(), numbers[1].cast<std::size_t>()});
    }
  if (const py::object mass = extra(extras, "mass"); !mass.is_none()) read_mass(mass);
  read_jacobian(extras);
  if (const py::object events = extra(extras, "events"); !events.is_none()) read_events(events, options);
}

void Run::read_mass(const py::handle& mass) {
  const auto array = mass.cast<py::array_t<double, py::array::c_style | py::array::forcecast>>();
  std::vector<double>& to = array.ndim() == 1 ? functions_->mass : functions_->mass_rows;
  to.assign(array.data(), array.data() + array.size());
}

void Run::read_jacobian(const py::dict& extras) {
  if (const py::object pattern = extra(extras, "pattern"); !pattern.is_none()) {
    const auto rows = pattern.cast<py::tuple>()[0].cast<py::array_t<std::uint32_t>>();
    const auto columns = pattern.cast<py::tuple>()[1].cast<py::array_t<std::uint32_t>>();
    std::vector<MatrixPlace> places;
    for (py::ssize_t k = 0; k < rows.size(); ++k) places.push_back({rows.at(k), columns.at(k)});
    functions_->pattern = SparsePattern(y0_.size(), places);
    pattern_is_native_ = !extra(extras, "pattern_is_native").is_none();
  }
  const py::object jac = extra(extras, "jac"), constant = extra(extras, "jac_constant");
  const bool values = !extra(extras, "jac_is_values").is_none();
  if (!constant.is_none()) {
    const auto array = constant.cast<py::array_t<double, py::array::c_style | py::array::forcecast>>();
    constant_jacobian_.assign(array.data(), array.data() + array.size());
    const std::size_t needed = values ? functions_->pattern.entries() : y0_.size() * y0_.size();
    if (constant_jacobian_.size() != needed) throw py::value_error("`jac` has another number of entries than needed");
    (values ? functions_->jacobian_values : functions_->jacobian) = {values ? constant_values : constant_jacobian,
                                                                     this};
  } else if (!jac.is_none()) {
    jac_ = function(jac, "jac");
    (values ? functions_->jacobian_values : functions_->jacobian) = {values ? jacobian_values : jacobian, this};
  }
}

}  // namespace continuo::python
