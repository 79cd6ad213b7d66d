// Calls of Python functions in a run, and the reading of their results.
#include "callbacks.hpp"

#include <algorithm>
#include <complex>
#include <cstring>
#include <utility>

#include "light_state.hpp"

namespace py = pybind11;

namespace continuo::python {
namespace {

constexpr std::size_t most_light = 32;  // components; for more an array is no dearer

[[nodiscard]] const char* type_name(PyObject* object) {
  return Py_TYPE(object)->tp_name;
}

[[nodiscard]] std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

void set_error(PyObject* type, const std::string& text) {
  PyErr_SetString(type, text.c_str());
}

[[nodiscard]] std::string short_text(PyObject* object) {
  return py::repr(py::handle(object)).cast<std::string>().substr(0, 80);
}

[[nodiscard]] bool is_number(PyObject* object, bool complex_wanted) {
  if (object == Py_None || PyUnicode_Check(object) || PyBytes_Check(object)) return false;
  if (PyComplex_Check(object)) return complex_wanted;
  PyFloat_AsDouble(object);
  if (!PyErr_Occurred()) return true;
  PyErr_Clear();
  return false;
}

// An array of double or complex numbers of what a function has given; empty with an exception set.
[[nodiscard]] py::object numeric_array(PyObject* result, const StateFunction& f, bool complex_wanted) {
  try {
    static const py::handle asarray = py::object(py::module_::import("numpy").attr("asarray")).release();
    py::object array;
    if (!py::isinstance<py::array>(result) && py::hasattr(result, "toarray") && py::hasattr(result, "nnz"))
      array = py::handle(result).attr("toarray")();  // a sparse matrix of SciPy
    else
      array = asarray(py::handle(result));
    const char kind = array.attr("dtype").attr("kind").cast<char>();
    if (kind == 'c' && !complex_wanted) {
      set_error(PyExc_TypeError, f.name() +
                                     " gave complex numbers where real ones are needed: give a complex y0 if "
                                     "the solution is meant to be complex");
      return {};
    }
    if (kind == 'O') {
      // Numbers of other types, as those of fractions and decimal: each must be convertible by itself.
      const py::object flat = array.attr("ravel")();
      for (const py::handle element : flat)
        if (!is_number(element.ptr(), complex_wanted)) {
          set_error(PyExc_TypeError, f.name() + " gave a " + type_name(element.ptr()) + " where a number is needed");
          return {};
        }
    } else if (kind != 'b' && kind != 'i' && kind != 'u' && kind != 'f' && kind != 'c') {
      set_error(PyExc_TypeError,
                f.name() + " gave " + short_text(result) + ", a " + type_name(result) + " without numbers");
      return {};
    }
    return array.attr("astype")(complex_wanted ? "complex128" : "float64", py::arg("order") = "C",
                                py::arg("copy") = false);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) {
      error.restore();
      return {};
    }
    set_error(PyExc_ValueError, f.name() + " gave " + short_text(result) +
                                    ", which is no array of numbers: " + py::str(error.value()).cast<std::string>());
    return {};
  }
}

[[nodiscard]] bool wrong_shape(const StateFunction& f, const std::string& given, const std::string& needed) {
  set_error(PyExc_ValueError, f.name() + " gave " + given + ", and must give " + needed);
  return false;
}

[[nodiscard]] bool read_vector_slowly(PyObject* result, std::size_t n, const StateFunction& f, double* numbers) {
  const bool complex = f.form().numbers == Numbers::complex;
  if (result == Py_None)
    return set_error(PyExc_TypeError,
                     f.name() + " gave None: it must return " + std::to_string(n) + (n == 1 ? " number" : " numbers")),
           false;
  const py::object object = numeric_array(result, f, complex);
  if (!object) return false;
  const auto array = py::reinterpret_borrow<py::array>(object);
  const bool column = f.form().vectorized && array.ndim() == 2 && array.shape(1) == 1;
  const bool fits = static_cast<std::size_t>(array.size()) == n && (array.ndim() == 1 || column || n == 1);
  if (!fits)
    return wrong_shape(f, "an array of shape " + shape_text(array),
                       "(" + std::to_string(n) + ",): a number for each component of y0");
  std::memcpy(numbers, array.data(), n * (complex ? 2 : 1) * sizeof(double));
  return true;
}

[[nodiscard]] bool read_sequence(PyObject* const* items, std::size_t n, double* numbers) {
  for (std::size_t i = 0; i < n; ++i) {
    PyObject* one = items[i];
    if (PyFloat_Check(one)) {
      numbers[i] = PyFloat_AS_DOUBLE(one);
    } else if (PyLong_Check(one)) {
      numbers[i] = PyLong_AsDouble(one);
      if (numbers[i] == -1 && PyErr_Occurred()) return false;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace

RunControl::~RunControl() {
  if (!type_) return;
  const WithGil gil;
  Py_XDECREF(type_);
  Py_XDECREF(value_);
  Py_XDECREF(traceback_);
}

void RunControl::take_error(const std::string& where) {
  if (type_) return PyErr_Clear();
  PyErr_Fetch(&type_, &value_, &traceback_);
  PyErr_NormalizeException(&type_, &value_, &traceback_);
  if (traceback_) PyException_SetTraceback(value_, traceback_);
  if (!where.empty()) {
    if (PyObject* note = PyObject_CallMethod(value_, "add_note", "s", where.c_str()))
      Py_DECREF(note);
    else
      PyErr_Clear();  // Python before 3.11 has no notes
  }
  stop_.store(true, std::memory_order_relaxed);
}

void RunControl::check_signals() {
  if (PyErr_CheckSignals() != 0) take_error("");
}

void RunControl::raise() {
  PyErr_Restore(std::exchange(type_, nullptr), std::exchange(value_, nullptr), std::exchange(traceback_, nullptr));
  throw py::error_already_set();
}

py::object RunControl::release() {
  Py_XDECREF(std::exchange(type_, nullptr));
  Py_XDECREF(std::exchange(traceback_, nullptr));
  stop_.store(false, std::memory_order_relaxed);
  return py::reinterpret_steal<py::object>(std::exchange(value_, nullptr));
}

StateFunction::StateFunction(py::object f, const py::object& arguments, Form form, std::string name,
                             RunControl& control)
    : f_(std::move(f)), form_(form), name_(std::move(name)), control_(&control), call_(3, nullptr) {
  if (!arguments.is_none())
    for (const py::handle one : arguments) call_.push_back(one.inc_ref().ptr());
  uses_array_ =
      form.handing != Handing::list && (form.handing == Handing::array || form.vectorized ||
                                        form.numbers == Numbers::complex || form.size > most_light || form.size == 0);
}

StateFunction::~StateFunction() {
  const WithGil gil;
  for (PyObject* one : call_) Py_XDECREF(one);
  f_ = py::object();
}

StateFunction::Light StateFunction::hand_over(double t, const double* x) {
  Py_XDECREF(call_[1]);
  call_[1] = PyFloat_FromDouble(t);
  if (!call_[1]) return Light::failed;
  if (uses_array_) return set_array(x) ? Light::not_used : Light::failed;
  if (form_.handing == Handing::list) return set_list(x) ? Light::not_used : Light::failed;
  if (call_[2] && is_light_state(call_[2]) && refill_light_state(call_[2], x)) return Light::used;
  Py_XDECREF(call_[2]);
  call_[2] = new_light_state(x, form_.size);
  return call_[2] ? Light::used : Light::failed;
}

bool StateFunction::set_array(const double* x) {
  const bool complex = form_.numbers == Numbers::complex;
  const auto n = static_cast<Py_ssize_t>(complex ? form_.size / 2 : form_.size);
  const std::size_t bytes = form_.size * sizeof(double);
  if (call_[2] && !form_.vectorized && Py_REFCNT(call_[2]) == 1 && py::isinstance<py::array>(call_[2])) {
    const auto array = py::reinterpret_borrow<py::array>(call_[2]);
    // One more reference is held here. f may have given it another shape or made it unwritable.
    if (array.ndim() == 1 && array.shape(0) == n && array.writeable() && array.strides(0) == (complex ? 16 : 8)) {
      std::memcpy(const_cast<void*>(array.data()), x, bytes);
      return true;
    }
  }
  try {
    std::vector<Py_ssize_t> shape = {n};
    if (form_.vectorized) shape.push_back(1);
    py::array array =
        complex ? py::array(py::array_t<std::complex<double>>(shape)) : py::array(py::array_t<double>(shape));
    std::memcpy(array.mutable_data(), x, bytes);
    Py_XDECREF(call_[2]);
    call_[2] = array.release().ptr();
    return true;
  } catch (py::error_already_set& error) {
    error.restore();
    return false;
  }
}

bool StateFunction::set_list(const double* x) {
  const bool complex = form_.numbers == Numbers::complex;
  const auto n = static_cast<Py_ssize_t>(complex ? form_.size / 2 : form_.size);
  PyObject* list = PyList_New(n);
  for (Py_ssize_t i = 0; list && i < n; ++i) {
    PyObject* one = complex ? PyComplex_FromDoubles(x[2 * i], x[2 * i + 1]) : PyFloat_FromDouble(x[i]);
    if (!one) Py_CLEAR(list);
    if (one && list) PyList_SET_ITEM(list, i, one);
  }
  if (!list) return false;
  Py_XDECREF(call_[2]);
  call_[2] = list;
  return true;
}

PyObject* StateFunction::invoke() {
  return PyObject_Vectorcall(f_.ptr(), call_.data() + 1, (call_.size() - 1) | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
}

// A function that computes with arrays gets one the next time.
void StateFunction::look_at_use() {
  if (was_used_as_array(call_[2])) uses_array_ = true;
}

bool StateFunction::fail(double t) {
  char where[160];
  PyOS_snprintf(where, sizeof where, "continuo: in %.100s at t = %.15g", name_.c_str(), t);
  control_->take_error(where);
  return false;
}

bool read_vector(PyObject* result, std::size_t n, const StateFunction& f, double* numbers) {
  if (f.form().numbers == Numbers::real) {
    if (PyList_CheckExact(result) || PyTuple_CheckExact(result)) {
      if (static_cast<std::size_t>(PySequence_Fast_GET_SIZE(result)) == n &&
          read_sequence(PySequence_Fast_ITEMS(result), n, numbers))
        return true;
      if (PyErr_Occurred()) return false;
    } else if (py::isinstance<py::array>(result)) {
      const py::detail::PyArray_Proxy* array = py::detail::array_proxy(result);
      constexpr int number_of_double = 12;  // NPY_DOUBLE
      if (array->nd == 1 && static_cast<std::size_t>(array->dimensions[0]) == n &&
          py::detail::array_descriptor_proxy(array->descr)->type_num == number_of_double &&
          py::detail::array_descriptor_proxy(array->descr)->byteorder == '=') {
        const char* at = array->data;
        for (std::size_t i = 0; i < n; ++i, at += array->strides[0]) std::memcpy(numbers + i, at, sizeof(double));
        return true;
      }
    } else if (n == 1 && PyFloat_Check(result)) {
      numbers[0] = PyFloat_AS_DOUBLE(result);
      return true;
    }
  }
  return read_vector_slowly(result, n, f, numbers);
}

bool read_matrix(PyObject* result, std::size_t n, const StateFunction& f, double* rows) {
  const bool complex = f.form().numbers == Numbers::complex;
  const py::object object = numeric_array(result, f, complex);
  if (!object) return false;
  const auto array = py::reinterpret_borrow<py::array>(object);
  const bool fits = static_cast<std::size_t>(array.size()) == n * n && (array.ndim() == 2 || n == 1) &&
                    (n == 1 || static_cast<std::size_t>(array.shape(0)) == n);
  if (!fits)
    return wrong_shape(f, "an array of shape " + shape_text(array),
                       "(" + std::to_string(n) + ", " + std::to_string(n) + "): df/dy row by row");
  if (!complex) {
    std::memcpy(rows, array.data(), n * n * sizeof(double));
    return true;
  }
  const auto* entries = static_cast<const std::complex<double>*>(array.data());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const std::complex<double> entry = entries[i * n + j];
      double* block = rows + 2 * i * 2 * n + 2 * j;
      block[0] = entry.real(), block[1] = -entry.imag();
      block[2 * n] = entry.imag(), block[2 * n + 1] = entry.real();
    }
  return true;
}

bool read_number(PyObject* result, const StateFunction& f, double* number) {
  if (PyFloat_Check(result)) {
    *number = PyFloat_AS_DOUBLE(result);
    return true;
  }
  const py::object object = numeric_array(result, f, false);
  if (!object) {
    if (!PyErr_Occurred()) set_error(PyExc_TypeError, f.name() + " gave no number");
    return false;
  }
  const auto array = py::reinterpret_borrow<py::array>(object);
  if (array.size() != 1) return wrong_shape(f, "an array of shape " + shape_text(array), "one number");
  std::memcpy(number, array.data(), sizeof(double));
  return true;
}

}  // namespace continuo::python
