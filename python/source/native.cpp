// The class Native, and the compiled functions of other packages as one.
#include "native.hpp"

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <pybind11/stl.h>

#include "parts.hpp"

namespace py = pybind11;

namespace continuo::python {
namespace {

using WithoutUser = void (*)(double t, const double* x, double* dxdt);

// A function of three arguments is called through this one: its address is the user's pointer.
void call_without_user(double t, const double* x, double* dxdt, void* user) {
  reinterpret_cast<WithoutUser>(reinterpret_cast<std::uintptr_t>(user))(t, x, dxdt);
}

template <class Function>
[[nodiscard]] Function function_at(std::uintptr_t address) {
  return reinterpret_cast<Function>(address);
}

[[nodiscard]] Native native_at(std::uintptr_t address, std::size_t arguments, void* user, py::handle owner) {
  if (address == 0) throw py::value_error("the address of the compiled right-hand side is zero");
  Native native;
  native.owner = py::reinterpret_borrow<py::object>(owner);
  if (arguments == 3) {
    native.derivative = call_without_user;
    native.user = reinterpret_cast<void*>(address);
  } else {
    native.derivative = function_at<Native::Derivative>(address);
    native.user = user;
  }
  return native;
}

[[noreturn]] void refuse(const std::string& what, const std::string& has) {
  throw py::type_error("the compiled right-hand side " + what + " has the signature `" + has +
                       "`; needed is `void (double t, double* y, double* dydt, void* user)`, or the same without "
                       "`user`");
}

// "void (double, double *, double *, void *)" without spaces and `const`: 4 for it, 3 without the last argument.
[[nodiscard]] std::size_t arguments_of(const std::string& signature, const char* what) {
  std::string plain;
  for (const char c : signature)
    if (c != ' ') plain += c;
  for (std::size_t at = plain.find("const"); at != std::string::npos; at = plain.find("const")) plain.erase(at, 5);
  if (plain == "void(double,double*,double*,void*)" || plain == "void(double,double*,double*,double*)") return 4;
  if (plain == "void(double,double*,double*)") return 3;
  refuse(what, signature);
}

/// The memory of a function of ctypes is the pointer to it; ctypes.cast takes a quarter of the time of a short run.
[[nodiscard]] std::uintptr_t address_of_ctypes(py::handle function) {
  Py_buffer memory;
  if (PyObject_GetBuffer(function.ptr(), &memory, PyBUF_SIMPLE) != 0) throw py::error_already_set();
  std::uintptr_t address = 0;
  if (memory.len == sizeof address) std::memcpy(&address, memory.buf, sizeof address);
  PyBuffer_Release(&memory);
  return address;
}

// By its name: to import a module of Python in every call takes longer than a step.
[[nodiscard]] bool is_type(py::handle type, std::string_view name) {
  return PyType_Check(type.ptr()) && reinterpret_cast<PyTypeObject*>(type.ptr())->tp_name == name;
}

[[nodiscard]] Native of_ctypes(py::handle f) {
  const py::object types = f.attr("argtypes");
  if (types.is_none())
    throw py::type_error(
        "the ctypes function has no argtypes: set `f.argtypes = [c_double, POINTER(c_double), POINTER(c_double), "
        "c_void_p]` and `f.restype = None`");
  const std::size_t arguments = py::len(types);
  const auto first = py::reinterpret_steal<py::object>(arguments == 0 ? nullptr : PySequence_GetItem(types.ptr(), 0));
  if (arguments > 0 && !first) throw py::error_already_set();
  if (!first || !is_type(first, "c_double") || (arguments != 3 && arguments != 4))
    refuse("of ctypes", py::str(types).cast<std::string>());
  Native native = native_at(address_of_ctypes(f), arguments, nullptr, f);
  native.may_write_nothing = true;
  return native;
}

// The tuple of a LowLevelCallable begins with a capsule of the function, named by its signature.
[[nodiscard]] Native of_low_level_callable(py::handle f) {
  PyObject* capsule = PyTuple_GET_ITEM(f.ptr(), 0);
  const char* name = PyCapsule_GetName(capsule);
  if (name == nullptr) {
    PyErr_Clear();
    refuse("of a LowLevelCallable", "");
  }
  void* function = PyCapsule_GetPointer(capsule, name);
  void* user = PyCapsule_GetContext(capsule);
  if (PyErr_Occurred()) throw py::error_already_set();
  return native_at(reinterpret_cast<std::uintptr_t>(function), arguments_of(name, "of a LowLevelCallable"), user, f);
}

[[nodiscard]] Native of_numba(py::handle f) {
  std::size_t arguments = 4;
  if (const py::object signature = py::getattr(f, "_sig", py::none()); !signature.is_none()) {
    arguments = py::len(signature.attr("args"));
    if (arguments != 3 && arguments != 4) refuse("of numba", py::str(signature).cast<std::string>());
  }
  return native_at(f.attr("address").cast<std::uintptr_t>(), arguments, nullptr, f);
}

[[nodiscard]] bool has_base(PyTypeObject* type, std::string_view name, std::string_view module) {
  for (Py_ssize_t i = 0; i < PyTuple_GET_SIZE(type->tp_mro); ++i) {
    const py::handle base(PyTuple_GET_ITEM(type->tp_mro, i));
    const std::string_view full = reinterpret_cast<PyTypeObject*>(base.ptr())->tp_name;
    if (full.substr(full.rfind('.') + 1) != name) continue;  // all of it where there is no dot
    if (const py::object in = py::getattr(base, "__module__", py::none());
        py::isinstance<py::str>(in) && in.cast<std::string>().starts_with(module))
      return true;
  }
  return false;
}

[[nodiscard]] Native of_protocol(py::handle f, const py::object& make, py::handle arguments) {
  const bool has_arguments = !arguments.is_none() && py::len(arguments) > 0;
  const py::object given = has_arguments ? make(arguments) : make();
  if (!py::isinstance<Native>(given))
    throw py::type_error("__continuo_native__ gave a " + std::string(Py_TYPE(given.ptr())->tp_name) +
                         ", and must give a continuo._continuo.Native");
  Native native = given.cast<Native>();
  native.owner = py::make_tuple(f, given);
  native.has_arguments = has_arguments;
  return native;
}

}  // namespace

std::optional<Native> native_of(py::handle f, py::handle arguments) {
  if (PyFunction_Check(f.ptr()) || PyMethod_Check(f.ptr())) return {};
  if (py::isinstance<Native>(f)) {
    Native native = f.cast<Native>();
    native.owner = py::reinterpret_borrow<py::object>(f);
    return native;
  }
  if (PyTuple_Check(f.ptr()) && has_base(Py_TYPE(f.ptr()), "LowLevelCallable", "scipy"))
    return of_low_level_callable(f);
  if (has_base(Py_TYPE(f.ptr()), "CFuncPtr", "_ctypes")) return of_ctypes(f);
  if (has_base(Py_TYPE(f.ptr()), "CFunc", "numba")) return of_numba(f);
  if (const py::object make = py::getattr(f, "__continuo_native__", py::none());
      !make.is_none() && !PyType_Check(f.ptr()))
    return of_protocol(f, make, arguments);
  if (py::hasattr(f, "address") && py::hasattr(f, "native_name")) return of_numba(f);
  return {};
}

}  // namespace continuo::python

void add_native(py::module_& module) {
  using continuo::python::Native;
  py::class_<Native>(module, "Native", R"(A compiled right-hand side, which a run calls without the interpreter.

Parameters
----------
address : int
    The address of ``void f(double t, const double *y, double *dydt, void *user)``.
jacobian : int, optional
    The address of ``void jac(double t, const double *y, double *rows, void *user)``, which writes df/dy row by
    row into n*n numbers that begin as zeros. 0: by differences.
entries : int, optional
    The address of ``void entries(double t, const double *y, double *values, void *user)``, which writes those of
    df/dy that may differ from zero, column by column. 0: not known.
user : int, optional
    The address that both get as `user`.
size : int, optional
    The number of components of y, with which that of y0 is compared.
owner : object, optional
    What is kept alive as long as the functions may be called.)")
      .def(py::init([](std::uintptr_t address, std::uintptr_t jacobian, std::uintptr_t user,
                       std::optional<std::size_t> size, py::object owner, std::uintptr_t entries) {
             if (address == 0) throw py::value_error("the address of the compiled right-hand side is zero");
             return Native{continuo::python::function_at<Native::Derivative>(address),
                           continuo::python::function_at<Native::Jacobian>(jacobian),
                           continuo::python::function_at<Native::Jacobian>(entries),
                           reinterpret_cast<void*>(user),
                           size.value_or(0),
                           std::move(owner)};
           }),
           py::arg("address"), py::arg("jacobian") = 0, py::arg("user") = 0, py::arg("size") = py::none(),
           py::arg("owner") = py::none(), py::arg("entries") = 0)
      .def_property_readonly("address",
                             [](const Native& native) { return reinterpret_cast<std::uintptr_t>(native.derivative); })
      .def_property_readonly("jacobian",
                             [](const Native& native) { return reinterpret_cast<std::uintptr_t>(native.jacobian); })
      .def_property_readonly("user", [](const Native& native) { return reinterpret_cast<std::uintptr_t>(native.user); })
      .def_property_readonly(
          "size", [](const Native& native) { return native.size == 0 ? std::optional<std::size_t>() : native.size; })
      .def_property_readonly("owner", [](const Native& native) { return native.owner; });
}
