// The functions of a Run as its system and its events call them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "run.hpp"

namespace py = pybind11;

namespace continuo::python {
namespace {

using X = std::vector<double>;

void fill_not_a_number(double* numbers, std::size_t n) {
  std::fill_n(numbers, n, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

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

void Run::native_derivative(double t, const double* x, double* dxdt, void* run) {
  const auto& self = *static_cast<Run*>(run);
  fill_not_a_number(dxdt, self.functions_->size);
  self.native_->derivative(t, x, dxdt, self.native_->user);
}

void Run::native_accelerations(double t, const double* x, double* dxdt, void* run) {
  const auto& self = *static_cast<Run*>(run);
  const std::size_t n = self.functions_->size / 2;
  std::copy_n(x + n, n, dxdt);
  fill_not_a_number(dxdt + n, n);
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
      if (!guard->call(t, x.data(), [&](PyObject* result) { return read_number(result, *guard, &value); })) return 1.0;
      guards_unknown_ = guards_unknown_ || std::isnan(value);
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
