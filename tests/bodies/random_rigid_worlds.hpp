// Random worlds of every shape, joint and ground, usual ones and absurd ones, the same on every machine.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/world.hpp>

namespace continuo::test {

/// Random numbers, made of integers alone: the distributions of <random> differ from one standard library to another.
template <class Real>
class RandomNumbers {
 public:
  /// One number in `absurd_one_in` is of any magnitude, infinite or none at all; 0 for never.
  explicit RandomNumbers(unsigned seed, unsigned absurd_one_in = 0) : engine_(seed), absurd_one_in_(absurd_one_in) {}

  [[nodiscard]] bool one_in(unsigned count) { return engine_() % count == 0; }
  [[nodiscard]] std::size_t below(std::size_t count) { return engine_() % count; }
  [[nodiscard]] bool is_absurd() { return absurd_one_in_ > 0 && one_in(absurd_one_in_); }
  [[nodiscard]] Real between(Real low, Real high) {
    if (is_absurd()) return absurd();
    return low + (high - low) * (static_cast<Real>(engine_() >> 9) / Real(1 << 23));
  }
  /// A place on a coarse grid, where many coincide, or anywhere.
  [[nodiscard]] Real place(Real most) {
    if (is_absurd()) return absurd();
    return one_in(3) ? most * static_cast<Real>(static_cast<int>(below(9)) - 4) / 4 : between(-most, most);
  }
  [[nodiscard]] Real absurd() {
    using Limits = std::numeric_limits<Real>;
    constexpr std::array strange{
        Real(0),          Real(-0.0),    Limits::quiet_NaN(), Limits::infinity(), Limits::max(), -Limits::infinity(),
        Limits::lowest(), Limits::min(), Real(1e20),          Real(-1),           Real(1e-20),   Limits::denorm_min(),
        Limits::epsilon()};
    if (one_in(3)) return strange[below(strange.size())];
    Real power = one_in(2) ? Real(1) : Real(-1);
    const bool is_small = one_in(2);
    for (std::size_t n = below(60); n > 0; --n) power *= is_small ? Real(0.5) : Real(2);
    return power;
  }
  template <int Size>
  [[nodiscard]] Vector<Real, Size> vector(Real most) {
    Vector<Real, Size> v;
    for (Real& part : v.components) part = place(most);
    return v;
  }

 private:
  std::mt19937 engine_;
  unsigned absurd_one_in_;
};

/// A world that grows by random bodies, grounds and joints. What the world refuses is counted; what it says of it must
/// be a sentence.
template <class Real, int Dim>
class RandomRigidWorld {
 public:
  using V = Vector<Real, Dim>;
  using O = Orientation<Real, Dim>;
  using S = Spin<Real, Dim>;

  explicit RandomRigidWorld(unsigned seed, unsigned absurd_one_in = 0) : numbers(seed, absurd_one_in) {
    world.gravity[Dim - 1] = numbers.one_in(6) ? Real(0) : Real(-9.81);
    if (numbers.is_absurd()) world.gravity = numbers.template vector<Dim>(Real(20));
    add_ground();
    const std::size_t bodies = numbers.one_in(8) ? 30 + numbers.below(120) : 1 + numbers.below(14);
    const Real size = Real(1) + static_cast<Real>(bodies) / 16;
    const Material<Real> of_all = material();
    for (std::size_t k = 0; k < bodies; ++k) add_body(size, of_all);
    for (std::size_t k = numbers.below(1 + bodies / 2); k > 0; --k) add_joint();
    if (numbers.is_absurd() && world.size() > 1) world.remove(world.handle(numbers.below(world.size())));
    add_fields();
  }

  World<Real, Dim> world;
  RandomNumbers<Real> numbers;
  std::size_t refused = 0;
  bool says_why = true;  // of each refusal so far

  void add_body(Real size, const Material<Real>& of_most) {
    BodyDefinition<Real, Dim> body;
    body.shape = shape();
    body.position = numbers.template vector<Dim>(size);
    body.position[Dim - 1] += size;
    if (!numbers.one_in(3)) body.velocity = numbers.template vector<Dim>(numbers.one_in(6) ? Real(100) : Real(3));
    body.orientation = orientation();
    if (numbers.one_in(3)) body.spin = numbers.template vector<S::size()>(Real(5));
    if (numbers.one_in(3)) body.mass = numbers.between(Real(0.1), numbers.one_in(4) ? Real(1000) : Real(2));
    if (numbers.one_in(8)) body.density = numbers.between(Real(0.01), Real(100));
    body.fixed = numbers.one_in(8);
    body.material = numbers.one_in(4) ? material() : of_most;
    body.group = static_cast<std::uint32_t>(numbers.below(numbers.is_absurd() ? 40 : 4));
    if (numbers.one_in(8)) body.traits = traits();
    note(world.add(body));
  }
  void add_joint() {
    JointDefinition<Real, Dim> joint;
    joint.kind = static_cast<JointKind>(numbers.below(9));
    joint.b = some_body();
    if (!numbers.one_in(4)) joint.a = some_body();
    joint.anchor = numbers.one_in(2) ? place_of(joint.b) : V(place_of(joint.b) + numbers.template vector<Dim>(Real(1)));
    if (numbers.one_in(3) || joint.kind == JointKind::distance)
      joint.anchor_b = place_of(joint.b) + numbers.template vector<Dim>(Real(0.5));
    if (!numbers.one_in(3)) joint.axis = numbers.template vector<Dim>(Real(1));
    if (!numbers.one_in(3)) joint.axle = numbers.template vector<Dim>(Real(1));
    add_drives(joint);
    if (numbers.one_in(4)) joint.ratio = numbers.place(Real(3));
    if (numbers.one_in(8)) joint.breaks_at = numbers.between(Real(0), Real(200));
    if (numbers.one_in(8)) joint.breaks_at_torque = numbers.between(Real(0), Real(50));
    joint.collide = numbers.one_in(4);
    note(world.add_joint(joint));
  }

  [[nodiscard]] Shape<Real, Dim> shape() {
    switch (numbers.below(7)) {
      case 0:
        return Compound<Real, Dim>{parts(1 + numbers.below(5))};
      case 1:
        return Sphere<Real>{size()};
      case 2:
        return capsule();
      case 3:
        return hull();
      case 4:
        return stone();
      default:
        return box();
    }
  }
  [[nodiscard]] O orientation() {
    O turned = upright<Real, Dim>();
    if (numbers.one_in(2)) return turned;
    for (Real& part : turned.components) part = numbers.place(Real(3));
    return turned;
  }

 private:
  template <class Added>
  void note(const Added& added) {
    if (added) return;
    ++refused;
    if constexpr (requires { added.message; }) {
      says_why = says_why && added.message.size() > 10;
    } else {
      says_why = says_why && added.status().message.size() > 10;
    }
  }
  [[nodiscard]] Real size() { return numbers.between(Real(0.1), numbers.one_in(6) ? Real(3) : Real(0.7)); }
  [[nodiscard]] Capsule<Real> capsule() {
    const Real length = size();
    return {length, size() / 2};
  }
  [[nodiscard]] Box<Real, Dim> box() {
    Box<Real, Dim> made;
    for (Real& side : made.size.components) side = size();
    if (numbers.one_in(2)) made.size[numbers.below(Dim)] = numbers.between(Real(0.01), Real(0.1));
    if (numbers.one_in(4)) made.rounding = numbers.between(Real(0), Real(0.05));
    return made;
  }
  /// Any points, which may be in a plane, on a line, or at one place.
  [[nodiscard]] Hull<Real, Dim> hull() {
    Hull<Real, Dim> made;
    const std::size_t flat = numbers.below(numbers.is_absurd() ? 4 : 40);
    for (std::size_t k = numbers.is_absurd() ? numbers.below(100) : 4 + numbers.below(12); k > 0; --k) {
      V& point = made.points.emplace_back(numbers.template vector<Dim>(Real(0.6)));
      for (std::size_t axis = flat; axis < Dim; ++axis) point[axis] = Real(0.25);
      if (numbers.one_in(8)) made.points.push_back(point);
    }
    if (numbers.one_in(3)) made.rounding = numbers.between(Real(0), Real(0.1));
    return made;
  }
  /// The corners of a box, moved a little: faces that are nearly parallel.
  [[nodiscard]] Hull<Real, Dim> stone() {
    Hull<Real, Dim> made;
    for (unsigned corner = 0; corner < 1u << Dim; ++corner) {
      V point;
      for (std::size_t axis = 0; axis < Dim; ++axis)
        point[axis] =
            (corner >> axis & 1u ? Real(0.4) : Real(-0.4)) + (numbers.one_in(3) ? numbers.place(Real(0.05)) : 0);
      made.points.push_back(point);
    }
    return made;
  }
  [[nodiscard]] std::vector<ShapePart<Real, Dim>> parts(std::size_t count) {
    std::vector<ShapePart<Real, Dim>> made(numbers.is_absurd() ? 0 : count);
    for (ShapePart<Real, Dim>& part : made) {
      const std::size_t kind = numbers.below(4);
      if (kind == 0) part.shape = Sphere<Real>{size()};
      if (kind == 1) part.shape = capsule();
      if (kind == 2) part.shape = box();
      if (kind == 3) part.shape = hull();
      part.position = numbers.template vector<Dim>(Real(0.8));
      part.orientation = orientation();
    }
    return made;
  }
  [[nodiscard]] Material<Real> material() {
    Material<Real> made;
    made.restitution = numbers.one_in(3) ? numbers.between(Real(0), Real(1)) : Real(0);
    made.friction = numbers.one_in(4) ? Real(0) : numbers.between(Real(0), Real(1.5));
    return made;
  }
  [[nodiscard]] BodyTraits<Real> traits() {
    BodyTraits<Real> made;
    made.is_driven = numbers.one_in(2), made.is_sensor = numbers.one_in(5);
    if (numbers.one_in(3)) made.locked = static_cast<Locked>(numbers.below(numbers.is_absurd() ? 200 : 64));
    if (numbers.one_in(3)) made.gravity_scale = numbers.between(Real(-1), Real(2));
    if (numbers.one_in(3)) made.damping = numbers.between(Real(0), Real(9));
    if (numbers.one_in(3)) made.spin_damping = numbers.between(Real(0), Real(9));
    if (numbers.one_in(3)) made.category = 1 + numbers.below(4);
    if (numbers.one_in(3)) made.mask = numbers.below(8);
    return made;
  }

  void add_ground() {
    if (numbers.one_in(2)) note(world.add_wall({.material = material()}));
    for (std::size_t k = numbers.below(3); k > 0; --k) {
      const V normal = numbers.template vector<Dim>(Real(1));
      const Real offset = numbers.between(Real(-3), Real(0));
      note(world.add_wall({.normal = normal, .offset = offset, .material = material(), .thin = numbers.one_in(3)}));
    }
    if (numbers.one_in(6)) {
      const V lower = numbers.template vector<Dim>(Real(1)) - filled(Real(4));
      const V upper = numbers.template vector<Dim>(Real(1)) + filled(Real(4));
      note(world.add_container(lower, upper, material()));
    }
    if (numbers.one_in(4)) add_surface();
    if (numbers.one_in(4)) add_heights();
  }
  [[nodiscard]] static V filled(Real value) {
    V made;
    made.components.fill(value);
    return made;
  }
  void add_surface() {
    MeshDefinition<Real, Dim> mesh{.material = material()};
    const std::size_t corners = 3 + numbers.below(12);
    if constexpr (Dim == 2) {
      Chain<Real> chain{.is_loop = numbers.one_in(4), .is_two_sided = numbers.one_in(3)};
      for (std::size_t k = 0; k < corners; ++k)
        chain.points.push_back(V{{Real(4) - static_cast<Real>(k), numbers.place(Real(0.5))}});
      if (numbers.one_in(4)) chain.before = numbers.template vector<2>(Real(5));
      if (numbers.one_in(4)) chain.after = numbers.template vector<2>(Real(5));
      mesh.shape = std::move(chain);
    } else {
      TriangleMesh<Real> triangles{.is_two_sided = numbers.one_in(3)};
      for (std::size_t k = 0; k < corners; ++k) triangles.corners.push_back(numbers.template vector<3>(Real(4)));
      for (std::size_t k = numbers.below(14); k > 0; --k) {
        auto& corners_of = triangles.triangles.emplace_back();
        for (std::uint32_t& corner : corners_of)
          corner = static_cast<std::uint32_t>(numbers.below(corners + (numbers.is_absurd() ? 3 : 0)));
      }
      mesh.shape = std::move(triangles);
    }
    if (numbers.one_in(5)) mesh.category = numbers.below(4), mesh.mask = numbers.below(8);
    note(world.add_mesh(mesh));
  }
  void add_heights() {
    HeightField<Real, Dim> field;
    std::size_t points = 1;
    field.origin = numbers.template vector<Dim>(Real(1)) - filled(Real(4));
    field.origin[Dim - 1] = Real(0);
    for (std::size_t axis = 0; axis < Dim - 1; ++axis) {
      field.counts[axis] = static_cast<std::uint32_t>(2 + numbers.below(8));
      field.spacing[axis] = numbers.between(Real(0.3), Real(2));
      points *= field.counts[axis];
    }
    for (std::size_t k = numbers.is_absurd() ? 1 : 0; k < points; ++k)
      field.heights.push_back(numbers.place(Real(0.4)));
    note(world.add_mesh({.shape = std::move(field), .material = material()}));
  }

  [[nodiscard]] BodyHandle some_body() {
    if (world.size() == 0 || numbers.is_absurd()) return {static_cast<std::uint32_t>(numbers.below(200)), 1};
    return world.handle(numbers.below(world.size()));
  }
  [[nodiscard]] V place_of(BodyHandle body) const { return world.contains(body) ? world.position_of(body) : V{}; }
  void add_drives(JointDefinition<Real, Dim>& joint) {
    const bool has_coordinate = joint.kind == JointKind::hinge || joint.kind == JointKind::slider ||
                                joint.kind == JointKind::distance || joint.kind == JointKind::wheel;
    if (!has_coordinate && !numbers.is_absurd()) return;
    if (numbers.one_in(2)) {
      joint.limits.emplace();
      if (!numbers.one_in(3)) joint.limits->lower = numbers.between(Real(-1), Real(0.3));
      if (!numbers.one_in(3)) joint.limits->upper = numbers.between(Real(0.3), Real(1.5));
    }
    if (numbers.one_in(3)) {
      joint.spring.emplace();
      joint.spring->hertz = numbers.between(Real(0), Real(30));
      joint.spring->damping = numbers.between(Real(0), Real(2));
      joint.spring->rest = numbers.place(Real(0.5));
    }
    if (joint.kind == JointKind::distance && !numbers.is_absurd()) return;
    if (numbers.one_in(3)) {
      joint.motor.emplace();
      joint.motor->speed = numbers.place(Real(10));
      joint.motor->most =
          numbers.one_in(4) ? std::numeric_limits<Real>::infinity() : numbers.between(Real(0), Real(50));
    }
  }
  void add_fields() {
    if (numbers.one_in(4)) note(world.ignore(static_cast<std::uint32_t>(numbers.below(4)), 1));
    if (numbers.one_in(12)) world.drag.linear = numbers.between(Real(0), Real(2));
    if (numbers.one_in(12)) world.attraction.constant = numbers.between(Real(0), Real(2));
    if (!numbers.one_in(6) || world.size() == 0) return;
    Spring<Real, Dim> spring{.a = some_body()};
    if (numbers.one_in(2)) spring.b = some_body();
    spring.rest_length = numbers.between(Real(0), Real(1));
    spring.stiffness = numbers.between(Real(0), Real(100));
    spring.damping = numbers.between(Real(0), Real(2));
    world.springs.push_back(spring);
  }
};

}  // namespace continuo::test
