// continuo/bodies/vehicle.hpp
// A vehicle: a body on wheels with springs. The body is one of the world; the wheels are not, but are found on the
// ground by rays, so that they roll over terrain of any kind without catching on seams. Before each step of the motion,
// `drive` finds the forces of springs and tyres:
//
//   Vehicle<double, 3> car{.chassis = *world.add({.shape = Box<double, 3>{{{4, 1.8, 0.6}}}, .mass = 1200})};
//   for (const double x : {-1.3, 1.3})
//     for (const double y : {-0.8, 0.8}) car.wheels.push_back({.hub = {{x, y, -0.5}}});
//   for (;;) {
//     require(drive(world, Queries(world), car, {.throttle = 1}, 1.0 / 60));
//     require(motion.advance());
//   }
//
// Forwards is along the first axis of the body's shape, upwards along its last one.
#pragma once
#include <limits>
#include <vector>

#include <continuo/bodies/queries.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// What a wheel is: a disc on a spring. Its mass belongs to the body.
template <class Real, int Dim>
struct VehicleWheel {
  Vector<Real, Dim> hub{};           // centre with the spring at its full length, in the frame of the body's shape
  Real radius = Real(0.35);          // of the tyre
  Real travel = Real(0.3);           // by which the spring can be compressed; a stop ends it
  Real stiffness = Real(30'000);     // of the spring, force per length
  Real damping = Real(3'000);        // of the spring, force per speed
  Real friction = Real(1);           // of the tyre, combined with that of the ground by World::combine_rule
  Real inertia = Real(1.2);          // moment about the axle of all that turns with the wheel
  Real greatest_drive = Real(0);     // torque of the motor at full throttle
  Real greatest_brake = Real(1500);  // torque of the brake at its most
  Real greatest_steer = Real(0);     // angle of the wheel at full steer, in radians to the left
  Real top_spin = std::numeric_limits<Real>::infinity();  // that the motor reaches, in radians per time
};

/// How a wheel moves, and what it bears. All zeros is a wheel at rest in the air.
template <class Real, int Dim>
struct WheelState {
  Real spin{};                 // in radians per time, forwards positive, of which the turn of the body is a part
  Real turn{};                 // of the wheel against the body so far, in radians
  Real steer{};                // its angle, in radians to the left
  Real compression{};          // of the spring
  Real stiffness{};            // of the spring, as far as the step allows; see `drive`
  bool is_on_ground = false;   // it touches something
  Vector<Real, Dim> centre{};  // of the wheel
  Vector<Real, Dim> point{};   // of the contact
  Vector<Real, Dim> normal{};  // of the ground there
  BodyHandle ground{};         // the body that it touches, unless that is a wall or a mesh
  Real load{};                 // force along the normal
  Real along{};                // force of friction forwards
  Real aside{};                // force of friction to the left, in space
};

/// What the driver does.
template <class Real>
struct VehicleControls {
  Real throttle = Real(0);  // from -1, full backwards, to 1
  Real brake = Real(0);     // from 0 to 1; who brakes does not drive
  Real steer = Real(0);     // from -1, full to the right, to 1
};

/// A force that `drive` has put into World::constant_force, and what was there without it.
template <class Real, int Dim>
struct VehicleForce {
  BodyHandle body{};           // on which it acts
  Vector<Real, Dim> force{};   // that is part of what is there
  Vector<Real, Dim> others{};  // what was there before
  Vector<Real, Dim> sum{};     // what is there
};

/// A vehicle. A copy of it, with one of its world, is a snapshot.
template <class Real, int Dim>
struct Vehicle {
  BodyHandle chassis{};                           // the body on the wheels
  std::vector<VehicleWheel<Real, Dim>> wheels{};  // at most 64
  QueryFilter filter{};                           // what is ground to it; the chassis and sensors never are
  std::vector<WheelState<Real, Dim>> states{};    // of the wheels, made by `drive`
  std::vector<VehicleForce<Real, Dim>> forces{};  // that act until `drive` is called again
  Real residual{};  // of the impulses: by what part of their sum the last sweep changed them
};

/// Finds the forces of a vehicle for a step of `duration`. The wheels push the chassis by springs and tyres, and what
/// they stand on back. A spring pushes with stiffness times compression plus damping times its rate, never pulls, and
/// ends at a stop. A tyre holds, forwards and sideways together, with at most friction times load, and slides beyond.
/// All forces belong to the end of the step (implicit Euler): the vehicle rests where its springs bear it, and parks on
/// slopes without creeping. A spring is no stiffer than half of the mass that a wheel meets over duration^2, and
/// `WheelState::stiffness` has what it was. They act until the next call: World::constant_force has
/// their sum; their moments, and what loads have grown by, have changed spins and velocities. `queries` is an index of
/// the world as it is now. Fails for a chassis that the world does not have or that cannot move, and for values that
/// make no sense; then nothing is changed. Sensors are no ground. O(wheels) a sweep, mostly some ten and at most 500,
/// with Vehicle::residual for what they left, and nine rays a wheel.
template <class Real, int Dim>
[[nodiscard]] Status drive(World<Real, Dim>& world, const Queries<Real, Dim>& queries, Vehicle<Real, Dim>& vehicle,
                           const VehicleControls<Real>& controls, const Real& duration);

/// Takes the forces of a vehicle away, as before it is parked for good, or its chassis removed.
template <class Real, int Dim>
void release(World<Real, Dim>& world, Vehicle<Real, Dim>& vehicle);

}  // namespace continuo
