// The state as a Python function gets it where it has few components: a sequence of numbers whose items are Python's
// floats, which costs a fraction of an array. What a sequence cannot do is done by a NumPy array of its numbers.
#pragma once
#include <cstddef>

#include <pybind11/pybind11.h>

namespace continuo::python {

/// A new state of these numbers. Null, with a Python error, where there is no memory.
[[nodiscard]] PyObject* new_light_state(const double* numbers, std::size_t size);
/// Gives a state that nobody else holds other numbers. True where it could.
[[nodiscard]] bool refill_light_state(PyObject* state, const double* numbers);
/// Whether an array has been made of this state, since it was made or refilled.
[[nodiscard]] bool was_used_as_array(PyObject* state);
/// Whether it is one.
[[nodiscard]] bool is_light_state(PyObject* object);

}  // namespace continuo::python
