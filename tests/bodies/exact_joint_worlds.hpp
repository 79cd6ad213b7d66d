// Random worlds whose joints have limits and springs, with the coordinates of the joints and the energy of the springs
// from the places of the bodies alone.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "exact_worlds.hpp"
#include <continuo/bodies/exact_rigid/exact_body.hpp>

namespace continuo::test {

/// Adds joints to a random world of convex bodies. Springs are those of which the mass they meet stays the same: of
/// angles, of ways, and of the distance of two centres. So they have an energy.
template <int Dim>
class ExactJointWorld : public ExactWorld<Dim> {
 public:
  using V = Vector<double, Dim>;
  using ExactWorld<Dim>::world, ExactWorld<Dim>::joined;
  struct Driven {
    JointHandle joint{};
    std::size_t a = none, b = none;  // bodies
    V axis{};                        // in the frame of a, of hinges and ways
    V across_a{}, across_b{};        // of hinges in space, in the frames of the bodies: the same at the beginning
    V end_a{}, end_b{};              // in the frames of the bodies
    double start = 0;                // of the coordinate
    double mass = 0;                 // of the spring
  };
  std::vector<Driven> driven;

  ExactJointWorld(unsigned seed, bool alike) : ExactWorld<Dim>(seed, alike), numbers_(seed + 12345) {
    for (std::size_t k = 1 + numbers_.below(4); k > 0; --k) add();
  }
  /// How far a joint is beyond its limits; below 0 where it is within.
  [[nodiscard]] double beyond(const Driven& of) const {
    const auto& limits = world.find(of.joint)->limits;
    if (!limits) return -std::numeric_limits<double>::infinity();
    const double at = coordinate(of);
    return std::max(limits->lower - at, at - limits->upper);
  }
  /// How far the ends are apart that a hinge keeps together, or beside the line of a slider or wheel.
  [[nodiscard]] double error(const Driven& of) const {
    const V apart = place(of.b, of.end_b) - place(of.a, of.end_a);
    switch (world.find(of.joint)->kind) {
      case JointKind::hinge:
        return length(apart);
      case JointKind::distance:
        return 0;
      default: {
        const V axis = direction(of.a, of.axis);
        return length(apart - axis * dot(axis, apart));
      }
    }
  }
  [[nodiscard]] double energy_of_springs() const {
    double sum = 0;
    for (const Driven& one : driven) {
      const auto& spring = world.find(one.joint)->spring;
      if (!spring) continue;
      const double w = 2 * std::numbers::pi * spring->hertz, way = coordinate(one) - one.start - spring->rest;
      sum += one.mass * w * w * way * way / 2;
    }
    return sum;
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] Matrix<double, Dim> axes(std::size_t i) const {
    return i == none ? identity_matrix<double, Dim>() : rotation(world.orientation[i]);
  }
  [[nodiscard]] V direction(std::size_t i, const V& in_body) const { return axes(i) * in_body; }
  [[nodiscard]] V place(std::size_t i, const V& in_body) const {
    return (i == none ? V{} : world.position[i]) + direction(i, in_body);
  }
  [[nodiscard]] double coordinate(const Driven& of) const {
    const V apart = place(of.b, of.end_b) - place(of.a, of.end_a);
    switch (world.find(of.joint)->kind) {
      case JointKind::distance:
        return length(apart);
      case JointKind::hinge:
        if constexpr (Dim == 2) {
          return world.orientation[of.b][0] - (of.a == none ? 0 : world.orientation[of.a][0]) - of.across_a[0];
        } else {
          const V from = direction(of.a, of.across_a), to = direction(of.b, of.across_b);
          return std::atan2(dot(direction(of.a, of.axis), moment(from, to)), dot(from, to));
        }
      default:
        return dot(direction(of.a, of.axis), apart);
    }
  }
  void add() {
    const std::size_t i = numbers_.one_in(3) ? none : numbers_.below(world.size()), j = numbers_.below(world.size());
    const std::pair pair(std::min(i, j), std::max(i, j));
    if (i == j || std::ranges::find(joined, pair) != joined.end()) return;
    constexpr std::array kinds{JointKind::hinge, JointKind::slider, JointKind::distance, JointKind::wheel};
    JointDefinition<double, Dim> of{.kind = kinds[numbers_.below(kinds.size())], .b = world.handle(j)};
    if (i != none) of.a = world.handle(i);
    V beside = world.position[j];
    for (double& x : beside.components) x += numbers_.between(-1, 1);
    const V from = i == none ? beside : world.position[i];
    of.anchor = of.kind == JointKind::distance ? from
                : of.kind == JointKind::hinge  ? (from + world.position[j]) * 0.5
                                               : world.position[j];
    if (of.kind == JointKind::distance) of.anchor_b = world.position[j];
    for (double& x : of.axis.components) x = numbers_.between(-1, 1);
    if constexpr (Dim == 3)
      for (double& x : of.axle.components) x = numbers_.between(-1, 1);
    drive(of, length(V(world.position[j] - from)));
    const auto added = world.add_joint(of);
    if (!added) return;
    if (i != none) joined.push_back(pair);
    note(*added, i, j);
  }
  void drive(JointDefinition<double, Dim>& of, double distance) {
    const double start = of.kind == JointKind::distance ? distance : 0;
    const bool has_spring = numbers_.one_in(2);
    // Of a hinge in space without limits the angle, and so the energy of the spring, jumps at half a turn.
    const bool may_jump = Dim == 3 && of.kind == JointKind::hinge;
    if (!has_spring || may_jump || numbers_.one_in(2)) {
      of.limits = JointLimits<double>{.lower = start - numbers_.between(0, 1), .upper = start + numbers_.between(0, 1)};
      if (of.kind == JointKind::distance && numbers_.one_in(2)) of.limits->lower = 0;
    }
    if (has_spring)
      of.spring = JointSpring<double>{.hertz = numbers_.between(0.3, 3),
                                      .damping = numbers_.one_in(2) ? 0 : numbers_.between(0, 0.5),
                                      .rest = numbers_.between(-0.5, 0.5)};
  }
  void note(JointHandle handle, std::size_t i, std::size_t j) {
    const Joint<double, Dim>& joint = *world.find(handle);
    Driven one{.joint = handle, .a = i, .b = j, .end_a = joint.anchor_a, .end_b = joint.anchor_b};
    one.axis = joint.axes_a[0], one.across_a = joint.axes_a[1], one.across_b = joint.axes_b[1];
    if constexpr (Dim == 2) one.across_a[0] = world.orientation[j][0] - (i == none ? 0 : world.orientation[i][0]);
    if (joint.kind == JointKind::distance) one.start = joint.length;
    one.mass = 1 / (compliance(one, i) + compliance(one, j));
    driven.push_back(one);
  }
  /// That of a body for a force along the coordinate.
  [[nodiscard]] double compliance(const Driven& of, std::size_t i) const {
    if (i == none) return 0;
    const V axis = direction(of.a, of.axis);
    const JointKind of_joint = world.find(of.joint)->kind;
    const auto inverse_inertia = turned_inertia(axes(i), inverse(world.inertia(i)));
    if (of_joint == JointKind::distance) return world.inverse_mass[i];
    if (of_joint == JointKind::hinge) {
      if constexpr (Dim == 2) {
        return inverse_inertia[0][0];
      } else {
        return dot(axis, inverse_inertia * axis);
      }
    }
    const auto lever = moment(V(place(of.b, of.end_b) - world.position[i]), axis);
    return world.inverse_mass[i] + dot(lever, inverse_inertia * lever);
  }
  RandomNumbers<double> numbers_;
};

}  // namespace continuo::test
