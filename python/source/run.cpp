// The class Run: how it begins, and how it goes on.
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <utility>

#include <continuo/solve/outcome.hpp>

namespace py = pybind11;

namespace continuo::python {
namespace {

using X = std::vector<double>;

// A run with as many components holds the GIL no longer than a callback: what it computes between them takes longer
// than the way there and back.
constexpr std::size_t most_held = 64;
constexpr double seconds_between_looks = 0.02, seconds_between_progress = 0.1;

/// The GIL for a callback, where the run does not have it.
class GilForCallback {
 public:
  explicit GilForCallback(bool held) : held_(held) {
    if (!held_) state_ = PyGILState_Ensure();
  }
  GilForCallback(const GilForCallback&) = delete;
  GilForCallback& operator=(const GilForCallback&) = delete;
  ~GilForCallback() {
    if (!held_) PyGILState_Release(state_);
  }

 private:
  bool held_;
  PyGILState_STATE state_{};
};

void fill_not_a_number(double* numbers, std::size_t n) {
  std::fill_n(numbers, n, std::numeric_limits<double>::quiet_NaN());
}

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
  const auto array = py::array_t < double, py::array::c_style | py::array::forcecast > ::ensure(given);
  if (!array) throw py::error_already_set();
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    each.push_back(array.data()[i]);
    if (complex) each.push_back(array.data()[i]);
  }
  if (!each.empty()) one = *std::ranges::min_element(each);
}

// A guard that is no number has no side, and its events would be missed.
[[nodiscard]] bool is_known(double value, const StateFunction& guard) {
  if (!std::isnan(value)) return true;
  PyErr_SetString(PyExc_ValueError,
                  (guard.name() + " is not a number here, so that its zeros cannot be found").c_str());
  return false;
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
}

std::unique_ptr<StateFunction> Run::function(const py::object& f, const std::string& name) {
  if (!PyCallable_Check(f.ptr()))
    throw py::type_error(name + " is a " + std::string(Py_TYPE(f.ptr())->tp_name) + " and cannot be called");
  StateFunction::Form form = settings_.form;
  form.vectorized = false;
  has_python_ = true;
  return std::make_unique<StateFunction>(f, settings_.arguments, form, name, control_);
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
    if (second_order_) functions_->derivative = {native_accelerations, this};
    if (native_->jacobian && !functions_->jacobian.call && !functions_->jacobian_values.call && !second_order_)
      functions_->jacobian = {native_->jacobian, native_->user};
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

void Run::run() {
  if (!run_) return;
  holds_gil_ ? run_with_gil() : run_without_gil();
  if (!progress_.is_none() && progress_) report_progress(true);
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
  const bool goes_on = take_step();
  if (control_.failed()) return false;
  if (settings_.min_step > 0 && goes_on && is_below_min_step(before)) below_min_step_ = true;
  return goes_on && !below_min_step_;
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
  const py::gil_scoped_release released;
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
    const py::gil_scoped_acquire gil;
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
  PyObject* result = PyObject_CallFunction(progress_.ptr(), "dd", run_->t(), part);
  if (!result) return control_.take_error("continuo: in progress");
  Py_DECREF(result);
}

bool Run::step() {
  if (!run_ || control_.failed()) return false;
  const auto advanced = [&] { return advance_by([this] { return run_->advance(); }); };
  bool goes_on = false;
  if (holds_gil_) {
    goes_on = advanced();
  } else {
    const py::gil_scoped_release released;
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
  if (!run_) return;
  read_state(y);
  run_->set_state(y0_);
}

void Run::restart() {
  if (run_) run_->restart();
}

void Run::extend_to(double t1) {
  settings_.t1 = t1;
  if (run_) run_->extend_to(t1);
}

void Run::derivative(double t, const double* x, double* dxdt, void* run) {
  auto& self = *static_cast<Run*>(run);
  const GilForCallback gil(self.holds_gil_);
  StateFunction& f = *self.fun_;
  const std::size_t n = f.form().numbers == Numbers::complex ? f.form().size / 2 : f.form().size;
  if (!f.call(t, x, [&](PyObject* result) { return read_vector(result, n, f, dxdt); }))
    fill_not_a_number(dxdt, f.form().size);
}

void Run::accelerations(double t, const double* x, double* dxdt, void* run) {
  const std::size_t n = static_cast<Run*>(run)->functions_->size / 2;
  std::copy_n(x + n, n, dxdt);
  derivative(t, x, dxdt + n, run);
}

void Run::native_accelerations(double t, const double* x, double* dxdt, void* run) {
  const auto& self = *static_cast<Run*>(run);
  const std::size_t n = self.functions_->size / 2;
  std::copy_n(x + n, n, dxdt);
  self.native_->derivative(t, x, dxdt + n, self.native_->user);
}

void Run::jacobian(double t, const double* x, double* rows, void* run) {
  auto& self = *static_cast<Run*>(run);
  const GilForCallback gil(self.holds_gil_);
  StateFunction& f = *self.jac_;
  const std::size_t n = f.form().numbers == Numbers::complex ? f.form().size / 2 : f.form().size;
  if (!f.call(t, x, [&](PyObject* result) { return read_matrix(result, n, f, rows); }))
    fill_not_a_number(rows, f.form().size * f.form().size);
}

void Run::jacobian_values(double t, const double* x, double* values, void* run) {
  auto& self = *static_cast<Run*>(run);
  const GilForCallback gil(self.holds_gil_);
  StateFunction& f = *self.jac_;
  const std::size_t entries = self.functions_->pattern.entries();
  if (!f.call(t, x, [&](PyObject* result) { return read_vector(result, entries, f, values); }))
    fill_not_a_number(values, entries);
}

void Run::constant_jacobian(double, const double*, double* rows, void* run) {
  std::ranges::copy(static_cast<Run*>(run)->constant_jacobian_, rows);
}
void Run::constant_values(double, const double*, double* values, void* run) {
  std::ranges::copy(static_cast<Run*>(run)->constant_jacobian_, values);
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

void Run::read_events(const py::handle& events, Options<X>& options) {
  for (const py::handle given : events) {
    const auto fields = given.cast<py::tuple>();  // guard, direction, stop_after, action, at_limit, name
    EventFunctions functions;
    const std::string name = fields[5].cast<std::string>();
    functions.guard = function(fields[0], "the event `" + name + "`");
    if (!fields[3].is_none()) functions.action = function(fields[3], "the action of the event `" + name + "`");
    if (!fields[4].is_none()) functions.at_limit = function(fields[4], "the action at the limit of `" + name + "`");
    Event<X> event{.name = name};
    StateFunction* const guard = functions.guard.get();
    event.guard = [this, guard](double t, const X& x) {
      const GilForCallback gil(holds_gil_);
      double value = 1;
      const auto read = [&](PyObject* result) {
        return read_number(result, *guard, &value) && is_known(value, *guard);
      };
      if (!guard->call(t, x.data(), read)) return 1.0;
      return value;
    };
    const double direction = fields[1].cast<double>();
    event.direction = direction > 0 ? Direction::rises : direction < 0 ? Direction::falls : Direction::crosses;
    event.stop_after = fields[2].cast<std::size_t>();
    if (StateFunction* const action = functions.action.get())
      event.action = [this, action](EventAction<X>& now) { act(*action, now); };
    if (StateFunction* const action = functions.at_limit.get())
      event.at_limit = [this, action](EventAction<X>& now) { act(*action, now); };
    options.events.push_back(std::move(event));
    events_.push_back(std::move(functions));
    event_names_.push_back(name);
  }
}

// The state that an action returns is the new one; None leaves it.
void Run::act(StateFunction& action, EventAction<X>& now) {
  const GilForCallback gil(holds_gil_);
  const std::size_t n = settings_.form.numbers == Numbers::complex ? now.x.size() / 2 : now.x.size();
  X after = now.x;
  const bool acted = action.call(now.t, now.before.data(), [&](PyObject* result) {
    return result == Py_None || read_vector(result, n, action, after.data());
  });
  if (acted && !std::ranges::all_of(after, [](double number) { return std::isfinite(number); })) {
    PyErr_SetString(PyExc_ValueError, (action.name() + " gave a state that is not finite").c_str());
    control_.take_error("");
  }
  if (!acted || control_.failed()) {
    now.stop = true;
    return;
  }
  now.x = after;
}

}  // namespace continuo::python
