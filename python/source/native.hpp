// A right-hand side that is compiled: the address of a C function, and what keeps its data alive.
#pragma once
#include <cstddef>
#include <optional>

#include <pybind11/pybind11.h>

namespace continuo::python {

/// x' = f(t, x) as a C function, which a run calls without the interpreter.
struct Native {
  using Derivative = void (*)(double t, const double* x, double* dxdt, void* user);
  using Jacobian = void (*)(double t, const double* x, double* rows, void* user);

  Derivative derivative = nullptr;
  Jacobian jacobian = nullptr;  // df/dx row by row, n*n numbers that begin as zeros; null: by differences
  Jacobian entries = nullptr;   // df/dx where it may differ from zero, in the order of a pattern; null: not known
  void* user = nullptr;         // handed to both
  std::size_t size = 0;         // the number of components; 0: not known
  pybind11::object owner{};     // kept alive as long as the functions may be called
  // A callback of ctypes that raises writes nothing: its result begins as no numbers, lest the one before stay.
  bool may_write_nothing = false;
  bool has_arguments = false;  // the further arguments are in `user`
};

/// What `f` is, where it is compiled: a Native, an object with __continuo_native__, a cfunc of numba, a
/// scipy.LowLevelCallable, a ctypes function. __continuo_native__ gets the tuple of further arguments, if there are
/// any. None for all that is called as a Python function. Throws a TypeError for a compiled function of another
/// signature.
[[nodiscard]] std::optional<Native> native_of(pybind11::handle f, pybind11::handle arguments);

}  // namespace continuo::python
