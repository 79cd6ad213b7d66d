// Vehicles: a body of a world on wheels, driven before each step. A vehicle is a class of its own, which knows no
// world.
#include <memory>
#include <vector>

#include <pybind11/stl.h>

#include "bound_world.hpp"
#include <continuo/bodies/vehicle.hpp>

namespace py = pybind11;

namespace continuo::python {

namespace {

template <int Dim>
using VehiclePointer = std::shared_ptr<Vehicle<double, Dim>>;

/// The fields of Wheel in vehicles.py.
template <int Dim>
VehicleWheel<double, Dim> wheel_from(const py::tuple& fields) {
  const auto number = [&](std::size_t k) { return fields[k].cast<double>(); };
  return {.hub = BoundWorld<Dim>::vector(fields[0].cast<Array>(), "hub"),
          .radius = number(1),
          .travel = number(2),
          .stiffness = number(3),
          .damping = number(4),
          .friction = number(5),
          .inertia = number(6),
          .greatest_drive = number(7),
          .greatest_brake = number(8),
          .greatest_steer = number(9),
          .top_spin = number(10)};
}

/// The fields of WheelState there.
template <int Dim>
py::list states_of(const Vehicle<double, Dim>& vehicle) {
  using B = BoundWorld<Dim>;
  py::list all;
  for (const WheelState<double, Dim>& state : vehicle.states) {
    const bool is_body = state.ground != BodyHandle{};
    all.append(py::make_tuple(state.spin, state.turn, state.steer, state.compression, state.stiffness,
                              state.is_on_ground, B::array(state.centre), B::array(state.point), B::array(state.normal),
                              is_body ? py::object(py::int_(number_of(state.ground))) : py::object(py::none()),
                              state.load, state.along, state.aside));
  }
  return all;
}

}  // namespace

template <int Dim>
void bind_vehicles(WorldClass<Dim>& world) {
  using B = BoundWorld<Dim>;
  using P = typename B::Pointer;
  using Of = Vehicle<double, Dim>;
  py::class_<Of, VehiclePointer<Dim>>(world, "Vehicle")
      .def("states", &states_of<Dim>)
      .def("chassis", [](const Of& vehicle) { return number_of(vehicle.chassis); })
      .def("copy", [](const Of& vehicle) { return std::make_shared<Of>(vehicle); });
  world
      .def("vehicle",
           [](const P& m, std::uint64_t chassis, const std::vector<py::tuple>& wheels) {
             auto made = std::make_shared<Of>();
             made->chassis = B::known(B::idle(m), chassis);
             for (const py::tuple& wheel : wheels) made->wheels.push_back(wheel_from<Dim>(wheel));
             return made;
           })
      .def("drive",
           [](const P& m, const VehiclePointer<Dim>& vehicle, double throttle, double brake, double steer,
              double duration) {
             raise_unless(B::idle(m).push([&](typename B::W& at) {
               const VehicleControls<double> controls{.throttle = throttle, .brake = brake, .steer = steer};
               return drive(at, Queries<double, Dim>(at), *vehicle, controls, duration);
             }));
           })
      .def("release", [](const P& m, const VehiclePointer<Dim>& vehicle) {
        raise_unless(B::idle(m).push([&](typename B::W& at) {
          release(at, *vehicle);
          return Status{};
        }));
      });
}

template void bind_vehicles(WorldClass<2>&);
template void bind_vehicles(WorldClass<3>&);

}  // namespace continuo::python
