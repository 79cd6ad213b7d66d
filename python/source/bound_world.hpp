// What all bindings of a world share: its handles as numbers, and arrays of Python as vectors.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "moving_world.hpp"
#include <continuo/shapes/shape.hpp>

namespace continuo::python {

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// ValueError for invalid input, RuntimeError for what cannot go on.
inline void raise_unless(const Status& status) {
  if (status) return;
  if (status.ending == Ending::invalid_input) throw pybind11::value_error(describe(status));
  throw std::runtime_error(describe(status));
}
template <class Value>
Value answer(const Result<Value>& result) {
  raise_unless(result.status());
  return *result;
}

/// A handle is one number in Python: its slot for the first body, joint or mesh there, which has the generation 1.
template <class Handle>
std::uint64_t number_of(const Handle& handle) {
  return (static_cast<std::uint64_t>(handle.generation - 1) << 32u) | handle.slot;
}
template <class Handle = BodyHandle>
Handle handle_of(std::uint64_t number) {
  return {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32u) + 1};
}

/// The world that a class of the module holds.
template <int Dim>
class BoundWorld {
 public:
  using M = MovingWorld<Dim>;
  using W = World<double, Dim>;
  using V = Vector<double, Dim>;
  using Pointer = std::shared_ptr<M>;

  /// Nobody may look while another thread moves the world.
  static M& idle(const Pointer& moving) {
    if (moving->busy) throw std::runtime_error("the world is being moved by another thread");
    return *moving;
  }
  static V vector(const Array& numbers, const char* what) {
    if (numbers.ndim() != 1 || numbers.shape(0) != Dim)
      throw pybind11::value_error(fmt::format("{} must have {} numbers", what, Dim));
    V vector;
    for (std::size_t k = 0; k < Dim; ++k) vector[k] = numbers.data()[k];
    return vector;
  }
  static std::vector<V> vectors(const Array& rows, const char* what) {
    if (rows.ndim() != 2 || rows.shape(1) != Dim)
      throw pybind11::value_error(fmt::format("{} must have the shape (N, {})", what, Dim));
    std::vector<V> vectors(static_cast<std::size_t>(rows.shape(0)));
    const double* at = rows.data();
    for (V& one : vectors)
      for (std::size_t k = 0; k < Dim; ++k) one[k] = *at++;
    return vectors;
  }
  /// An angle in the plane, a quaternion in space, which gets the length 1.
  static Orientation<double, Dim> orientation(const Array& numbers, const char* what) {
    Orientation<double, Dim> turn;
    if (static_cast<std::size_t>(numbers.size()) != turn.size())
      throw pybind11::value_error(fmt::format("{} must be {}", what, Dim == 2 ? "an angle" : "four numbers"));
    for (std::size_t k = 0; k < turn.size(); ++k) turn[k] = numbers.data()[k];
    if constexpr (Dim == 3) {
      const double size = length(turn);
      if (!(size > 0) || !std::isfinite(size)) throw pybind11::value_error(fmt::format("{} has no length", what));
      turn *= 1 / size;
    }
    return turn;
  }
  template <class Numbers>
  static Array array(const Numbers& v) {
    return Array(static_cast<pybind11::ssize_t>(v.size()), v.components.data());
  }
  static BodyHandle known(const M& m, std::uint64_t number) {
    const BodyHandle handle = handle_of(number);
    if (!m.world().contains(handle))
      throw pybind11::key_error("there is no such body: it was removed, or is of another world");
    return handle;
  }
};

/// A shape as continuo/shapes.py writes it: ("box", size, rounding).
template <int Dim>
[[nodiscard]] Shape<double, Dim> shape_from(const pybind11::tuple& form);

extern template Shape<double, 2> shape_from(const pybind11::tuple&);
extern template Shape<double, 3> shape_from(const pybind11::tuple&);

template <int Dim>
using WorldClass = pybind11::class_<MovingWorld<Dim>, std::shared_ptr<MovingWorld<Dim>>>;

/// The parts of the classes World2 and World3.
/// @{
template <int Dim>
void bind_shapes(WorldClass<Dim>& world);
template <int Dim>
void bind_joints(WorldClass<Dim>& world);
template <int Dim>
void bind_queries(WorldClass<Dim>& world);
template <int Dim>
void bind_vehicles(WorldClass<Dim>& world);
/// @}

extern template void bind_shapes(WorldClass<2>&);
extern template void bind_shapes(WorldClass<3>&);
extern template void bind_joints(WorldClass<2>&);
extern template void bind_joints(WorldClass<3>&);
extern template void bind_queries(WorldClass<2>&);
extern template void bind_queries(WorldClass<3>&);
extern template void bind_vehicles(WorldClass<2>&);
extern template void bind_vehicles(WorldClass<3>&);

}  // namespace continuo::python
