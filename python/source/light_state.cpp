// The type of the light state, written for the interpreter directly: a class of pybind11 costs more than what it holds.
#include "light_state.hpp"

#include <algorithm>

#include <pybind11/numpy.h>

#include "parts.hpp"

namespace py = pybind11;

namespace continuo::python {
namespace {

struct LightState {
  PyObject_VAR_HEAD;
  bool used_as_array;
  double numbers[1];
};
struct Iterator {
  PyObject_HEAD;
  LightState* state;
  Py_ssize_t next;
};

PyTypeObject* state_type = nullptr;
PyTypeObject* iterator_type = nullptr;

[[nodiscard]] LightState* state_of(PyObject* object) {
  return reinterpret_cast<LightState*>(object);
}

// An array of its numbers: a copy, as the state may be used for other numbers later.
[[nodiscard]] PyObject* array_of(PyObject* self) {
  LightState* state = state_of(self);
  state->used_as_array = true;
  try {
    return py::array_t<double>(Py_SIZE(self), state->numbers).release().ptr();
  } catch (py::error_already_set& error) {
    error.restore();
    return nullptr;
  }
}

void destroy(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  PyObject_Free(self);
  Py_DECREF(type);
}

Py_ssize_t length(PyObject* self) {
  return Py_SIZE(self);
}

PyObject* item(PyObject* self, Py_ssize_t i) {
  if (i < 0 || i >= Py_SIZE(self)) {
    PyErr_Format(PyExc_IndexError, "index %zd is out of bounds for a state of %zd components", i, Py_SIZE(self));
    return nullptr;
  }
  return PyFloat_FromDouble(state_of(self)->numbers[i]);
}

PyObject* subscript(PyObject* self, PyObject* key) {
  if (PyLong_CheckExact(key)) {
    const Py_ssize_t i = PyLong_AsSsize_t(key);
    if (i == -1 && PyErr_Occurred()) return nullptr;
    return item(self, i < 0 ? i + Py_SIZE(self) : i);
  }
  PyObject* array = array_of(self);
  if (!array) return nullptr;
  PyObject* result = PyObject_GetItem(array, key);
  Py_DECREF(array);
  return result;
}

int assign(PyObject* self, PyObject* key, PyObject* value) {
  if (!PyLong_Check(key) || !value) {
    PyErr_SetString(PyExc_TypeError, "only single components of this state can be assigned");
    return -1;
  }
  const Py_ssize_t given = PyLong_AsSsize_t(key);
  if (given == -1 && PyErr_Occurred()) return -1;
  const Py_ssize_t i = given < 0 ? given + Py_SIZE(self) : given;
  if (i < 0 || i >= Py_SIZE(self)) {
    PyErr_Format(PyExc_IndexError, "index %zd is out of bounds for a state of %zd components", given, Py_SIZE(self));
    return -1;
  }
  const double number = PyFloat_AsDouble(value);
  if (number == -1 && PyErr_Occurred()) return -1;
  state_of(self)->numbers[i] = number;
  return 0;
}

PyObject* iterate(PyObject* self) {
  auto* iterator = PyObject_New(Iterator, iterator_type);
  if (!iterator) return nullptr;
  Py_INCREF(self);
  iterator->state = state_of(self);
  iterator->next = 0;
  return reinterpret_cast<PyObject*>(iterator);
}
PyObject* iterate_itself(PyObject* self) {
  Py_INCREF(self);
  return self;
}
PyObject* next_item(PyObject* self) {
  auto* iterator = reinterpret_cast<Iterator*>(self);
  if (iterator->next >= Py_SIZE(iterator->state)) return nullptr;
  return PyFloat_FromDouble(iterator->state->numbers[iterator->next++]);
}
void destroy_iterator(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  Py_DECREF(reinterpret_cast<Iterator*>(self)->state);
  PyObject_Free(self);
  Py_DECREF(type);
}

PyObject* attribute(PyObject* self, PyObject* name) {
  PyObject* own = PyObject_GenericGetAttr(self, name);
  if (own || !PyErr_ExceptionMatches(PyExc_AttributeError)) return own;
  PyErr_Clear();
  PyObject* array = array_of(self);
  if (!array) return nullptr;
  PyObject* result = PyObject_GetAttr(array, name);
  Py_DECREF(array);
  return result;
}

// The operand itself, or an array where it is a light state.
[[nodiscard]] PyObject* operand(PyObject* object) {
  if (is_light_state(object)) return array_of(object);
  Py_INCREF(object);
  return object;
}

template <PyObject* (*operation)(PyObject*, PyObject*)>
PyObject* binary(PyObject* left, PyObject* right) {
  PyObject* a = operand(left);
  PyObject* b = a ? operand(right) : nullptr;
  PyObject* result = b ? operation(a, b) : nullptr;
  Py_XDECREF(a);
  Py_XDECREF(b);
  return result;
}
template <PyObject* (*operation)(PyObject*)>
PyObject* unary(PyObject* self) {
  PyObject* array = array_of(self);
  PyObject* result = array ? operation(array) : nullptr;
  Py_XDECREF(array);
  return result;
}
PyObject* power(PyObject* base, PyObject* exponent, PyObject* modulus) {
  PyObject* a = operand(base);
  PyObject* b = a ? operand(exponent) : nullptr;
  PyObject* result = b ? PyNumber_Power(a, b, modulus) : nullptr;
  Py_XDECREF(a);
  Py_XDECREF(b);
  return result;
}
int truth(PyObject* self) {
  PyObject* array = array_of(self);
  if (!array) return -1;
  const int result = PyObject_IsTrue(array);
  Py_DECREF(array);
  return result;
}
PyObject* compare(PyObject* left, PyObject* right, int operation) {
  PyObject* a = operand(left);
  PyObject* b = a ? operand(right) : nullptr;
  PyObject* result = b ? PyObject_RichCompare(a, b, operation) : nullptr;
  Py_XDECREF(a);
  Py_XDECREF(b);
  return result;
}

int give_buffer(PyObject* self, Py_buffer* view, int flags) {
  state_of(self)->used_as_array = true;
  static char format[] = "d";
  static Py_ssize_t stride = sizeof(double);
  if (PyBuffer_FillInfo(view, self, state_of(self)->numbers, Py_SIZE(self) * stride, 0, flags) < 0) return -1;
  if ((flags & PyBUF_FORMAT) == PyBUF_FORMAT) view->format = format;
  view->itemsize = stride;
  if ((flags & PyBUF_ND) == PyBUF_ND) {
    // The shape lives as long as the view does: in the object itself, whose size is its first number.
    view->shape = &reinterpret_cast<PyVarObject*>(self)->ob_size;
    view->ndim = 1;
  }
  if ((flags & PyBUF_STRIDES) == PyBUF_STRIDES) view->strides = &stride;
  return 0;
}

PyObject* method_array(PyObject* self, PyObject* arguments, PyObject* keywords) {
  PyObject *type = Py_None, *copy = Py_None;
  static const char* names[] = {"dtype", "copy", nullptr};
  if (!PyArg_ParseTupleAndKeywords(arguments, keywords, "|OO", const_cast<char**>(names), &type, &copy)) return nullptr;
  PyObject* array = array_of(self);
  if (!array || type == Py_None) return array;
  PyObject* converted = PyObject_CallMethod(array, "astype", "O", type);
  Py_DECREF(array);
  return converted;
}
PyObject* method_reduce(PyObject* self, PyObject*) {
  PyObject* array = array_of(self);
  PyObject* result = array ? PyObject_CallMethod(array, "__reduce__", nullptr) : nullptr;
  Py_XDECREF(array);
  return result;
}
PyObject* get_class(PyObject*, void*) {
  PyObject* type = reinterpret_cast<PyObject*>(py::detail::npy_api::get().PyArray_Type_);
  Py_INCREF(type);
  return type;
}
PyObject* show(PyObject* self) {
  return unary<PyObject_Repr>(self);
}
PyObject* text(PyObject* self) {
  return unary<PyObject_Str>(self);
}

template <class Function>
[[nodiscard]] void* slot(Function function) {
  return reinterpret_cast<void*>(function);
}

PyMethodDef methods[] = {{"__array__", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(method_array)),
                          METH_VARARGS | METH_KEYWORDS, "The numbers as an array of its own."},
                         {"__reduce__", method_reduce, METH_NOARGS, "Pickled as an array."},
                         {nullptr, nullptr, 0, nullptr}};
// isinstance(y, numpy.ndarray) is true: what asks this may use all that an array has.
PyGetSetDef properties[] = {{"__class__", get_class, nullptr, nullptr, nullptr},
                            {nullptr, nullptr, nullptr, nullptr, nullptr}};

[[nodiscard]] PyTypeObject* make_state_type() {
  static PyType_Slot slots[] = {
      {Py_tp_doc,
       const_cast<char*>("The state in a call of a function: a sequence of numbers that does what an array does.")},
      {Py_tp_dealloc, slot(destroy)},
      {Py_tp_getattro, slot(attribute)},
      {Py_tp_iter, slot(iterate)},
      {Py_tp_richcompare, slot(compare)},
      {Py_tp_hash, slot(PyObject_HashNotImplemented)},
      {Py_tp_repr, slot(show)},
      {Py_tp_str, slot(text)},
      {Py_tp_methods, methods},
      {Py_tp_getset, properties},
      {Py_sq_length, slot(length)},
      {Py_sq_item, slot(item)},
      {Py_mp_length, slot(length)},
      {Py_mp_subscript, slot(subscript)},
      {Py_mp_ass_subscript, slot(assign)},
      {Py_bf_getbuffer, slot(give_buffer)},
      {Py_nb_bool, slot(truth)},
      {Py_nb_add, slot(binary<PyNumber_Add>)},
      {Py_nb_subtract, slot(binary<PyNumber_Subtract>)},
      {Py_nb_multiply, slot(binary<PyNumber_Multiply>)},
      {Py_nb_true_divide, slot(binary<PyNumber_TrueDivide>)},
      {Py_nb_floor_divide, slot(binary<PyNumber_FloorDivide>)},
      {Py_nb_remainder, slot(binary<PyNumber_Remainder>)},
      {Py_nb_divmod, slot(binary<PyNumber_Divmod>)},
      {Py_nb_matrix_multiply, slot(binary<PyNumber_MatrixMultiply>)},
      {Py_nb_power, slot(power)},
      {Py_nb_negative, slot(unary<PyNumber_Negative>)},
      {Py_nb_positive, slot(unary<PyNumber_Positive>)},
      {Py_nb_absolute, slot(unary<PyNumber_Absolute>)},
      {Py_nb_float, slot(unary<PyNumber_Float>)},
      {0, nullptr}};
  static PyType_Spec spec = {"continuo._continuo.State", static_cast<int>(offsetof(LightState, numbers)),
                             static_cast<int>(sizeof(double)), Py_TPFLAGS_DEFAULT, slots};
  return reinterpret_cast<PyTypeObject*>(PyType_FromSpec(&spec));
}

[[nodiscard]] PyTypeObject* make_iterator_type() {
  static PyType_Slot slots[] = {{Py_tp_dealloc, slot(destroy_iterator)},
                                {Py_tp_iter, slot(iterate_itself)},
                                {Py_tp_iternext, slot(next_item)},
                                {0, nullptr}};
  static PyType_Spec spec = {"continuo._continuo.StateIterator", static_cast<int>(sizeof(Iterator)), 0,
                             Py_TPFLAGS_DEFAULT, slots};
  return reinterpret_cast<PyTypeObject*>(PyType_FromSpec(&spec));
}

}  // namespace

PyObject* new_light_state(const double* numbers, std::size_t size) {
  auto* state = PyObject_NewVar(LightState, state_type, static_cast<Py_ssize_t>(size));
  if (!state) return nullptr;
  state->used_as_array = false;
  std::copy_n(numbers, size, state->numbers);
  return reinterpret_cast<PyObject*>(state);
}

bool refill_light_state(PyObject* self, const double* numbers) {
  if (Py_REFCNT(self) != 1) return false;
  state_of(self)->used_as_array = false;
  std::copy_n(numbers, Py_SIZE(self), state_of(self)->numbers);
  return true;
}

bool was_used_as_array(PyObject* self) {
  return state_of(self)->used_as_array;
}

bool is_light_state(PyObject* object) {
  return Py_TYPE(object) == state_type;
}

}  // namespace continuo::python

void add_light_state(py::module_& module) {
  using namespace continuo::python;
  state_type = make_state_type();
  iterator_type = make_iterator_type();
  if (!state_type || !iterator_type) throw py::error_already_set();
  module.attr("State") = py::handle(reinterpret_cast<PyObject*>(state_type));
}
