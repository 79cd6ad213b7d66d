// continuo/bodies/world.hpp
// The state of a system of bodies at an instant: bodies, walls, static meshes, joints, springs and other forces. A
// world is a value, and a copy of it is a snapshot.
//
//   World<double, 3> world;
//   world.gravity = {{0, 0, -9.81}};
//   world.add_wall({.normal = {{0, 0, 1}}});                                       // the floor z = 0
//   const auto ball = world.add({.position = {{0, 0, 10}}, .material = {.restitution = 1}});
//   if (!ball) std::cerr << describe(ball.status());
//   ExactMotion motion(world);  motion.advance_to(100);
//   world.position_of(*ball)
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <continuo/bodies/body.hpp>
#include <continuo/bodies/joint.hpp>
#include <continuo/bodies/mesh.hpp>
#include <continuo/shapes/solid.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// The points x with normal . x >= offset are free; a body touches the wall where normal . x - radius = offset. A thin
/// wall has two sides: all points off its plane are free, and a body stays on the side of its centre.
template <class Real, int Dim>
struct Wall {
  Vector<Real, Dim> normal = [] {
    Vector<Real, Dim> up;
    up[static_cast<std::size_t>(Dim - 1)] = Real(1);
    return up;
  }();  // of length 1, by default upwards
  Real offset = Real(0);      // normal . x of the points on the wall
  Material<Real> material{};  // of its surface
  bool thin = false;          // true: bodies are on both sides
};
/// The wall with its normal turned to the side of x.
template <class Real, int Dim>
[[nodiscard]] Wall<Real, Dim> facing(Wall<Real, Dim> wall, const Vector<Real, Dim>& x) {
  if (wall.thin && dot(wall.normal, x) < wall.offset) {
    wall.normal = -wall.normal;
    wall.offset = -wall.offset;
  }
  return wall;
}

/// Pulls two bodies, or one body to a point, together with stiffness * (distance - rest_length) + damping * its rate.
template <class Real, int Dim>
struct Spring {
  BodyHandle a{};                                                       // one end, a body
  std::variant<BodyHandle, Vector<Real, Dim>> b = Vector<Real, Dim>{};  // the other, a body or a point
  Real rest_length = Real(0);                                           // at which it does not pull
  Real stiffness = Real(1);                                             // force per length
  Real damping = Real(0);                                               // force per speed
};

/// A drag force against the velocity of every body: linear * v + quadratic * |v| * v.
template <class Real>
struct Drag {
  Real linear = Real(0);     // force per speed
  Real quadratic = Real(0);  // force per square of speed
};

/// The two bodies of every pair attract each other by constant * m1 * m2 * r / (r^2 + softening^2)^(3/2), fixed bodies
/// included.
template <class Real>
struct Attraction {
  Real constant = Real(0);   // of gravitation, in the units of the world
  Real softening = Real(0);  // a length
  Real opening = Real(0);    // of the tree: 0 sums up all pairs, 0.5 is usual, see attraction.hpp
};

template <class Real, int Dim>
class World;

/// A user-defined force: adds to force[i], the force on body i at x[i], v[i]. It has no potential and is not part of
/// the energy.
template <class Real, int Dim>
using ForceLaw = std::function<void(const World<Real, Dim>& world, Real t, std::span<const Vector<Real, Dim>> x,
                                    std::span<const Vector<Real, Dim>> v, std::span<Vector<Real, Dim>> force)>;

/// Fails where a value of the material is invalid.
template <class Real>
[[nodiscard]] Status check(const Material<Real>& material);

/// The states of all bodies: body i has x[i], v[i], orientation[i], spin[i].
template <class Real, int Dim>
struct BodyStates {
  std::span<const Vector<Real, Dim>> x;                 // centres
  std::span<const Vector<Real, Dim>> v;                 // their velocities
  std::span<const Orientation<Real, Dim>> orientation;  // angles or quaternions
  std::span<const Spin<Real, Dim>> spin;                // angular velocities, in radians per time
};
/// A user-defined torque: adds to torque[i], the torque on body i.
template <class Real, int Dim>
using TorqueLaw = std::function<void(const World<Real, Dim>& world, Real t, const BodyStates<Real, Dim>& at,
                                     std::span<Spin<Real, Dim>> torque)>;

/// Bodies in the plane (Dim = 2) or in space (Dim = 3), with walls and forces. The units are yours, as long as they
/// belong together.
template <class Real, int Dim>
class World {
  static_assert(Dim == 2 || Dim == 3);

 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using O = Orientation<Real, Dim>;

  // Forces. All but the last three have a potential energy.
  V gravity{};                                    // the acceleration of every body
  std::vector<Spring<Real, Dim>> springs;         // between bodies and points
  Attraction<Real> attraction{};                  // of all pairs of bodies
  Drag<Real> drag{};                              // on every body
  std::vector<ForceLaw<Real, Dim>> force_laws;    // of your own
  std::vector<TorqueLaw<Real, Dim>> torque_laws;  // of your own
  CombineRule combine_rule{};                     // of the materials of any two surfaces

  // Rules of your own for the fast motion, by the indices of two bodies; called once for each pair and step, by one
  // thread. Where the first one returns false, the two do not collide as long as they stay near each other. Where the
  // second one does, a contact that the two have in this step does not push: its normal is from a to b.
  std::function<bool(const World& world, std::size_t a, std::size_t b)> may_collide{};
  std::function<bool(const World& world, std::size_t a, std::size_t b, const V& normal)> may_push{};

  Real time = Real(0);  // of the present state

  /// Fails for a body without size or mass, or with a number that is not finite; the message says how to correct it.
  /// Amortised O(1).
  Result<BodyHandle> add(const BodyDefinition<Real, Dim>& definition);
  /// False where the world has no such body. O(1): the last body moves to the index that becomes free.
  bool remove(BodyHandle handle);
  /// Whether the body exists.
  [[nodiscard]] bool contains(BodyHandle handle) const {
    return handle.slot < slots_.size() && slots_[handle.slot].generation == handle.generation &&
           slots_[handle.slot].index != nowhere;
  }
  /// The world must contain the body.
  [[nodiscard]] std::size_t index(BodyHandle handle) const { return slots_[handle.slot].index; }
  /// The handle of the body with this index.
  [[nodiscard]] BodyHandle handle(std::size_t index) const {
    return {slot_of_[index], slots_[slot_of_[index]].generation};
  }

  /// A world of some of the bodies, in this order, with all walls and meshes, under gravity alone.
  [[nodiscard]] World part(std::span<const std::uint32_t> bodies) const;

  /// Fails unless normal, offset and material are valid: the normal finite and not zero. The normal is scaled to length
  /// 1.
  [[nodiscard]] Status add_wall(Wall<Real, Dim> wall);
  /// The inside of a box with its faces along the axes.
  [[nodiscard]] Status add_container(const V& lower, const V& upper, const Material<Real>& material = {});
  /// All walls, in the order in which they were added.
  [[nodiscard]] std::span<const Wall<Real, Dim>> walls() const { return walls_; }

  /// Adds a surface that never moves. The fast motion knows it. Fails for a shape without facets, for numbers that are
  /// not finite, and for facets without length or area; the message says which. O(facets log(facets)).
  Result<MeshHandle> add_mesh(const MeshDefinition<Real, Dim>& definition);
  /// False where the world has no such mesh.
  bool remove_mesh(MeshHandle handle);
  /// Whether the mesh exists.
  [[nodiscard]] bool has_mesh(MeshHandle handle) const {
    return handle.slot < meshes_.size() && meshes_[handle.slot].geometry &&
           meshes_[handle.slot].generation == handle.generation;
  }
  /// All meshes by the slots of their handles, and slots without one.
  [[nodiscard]] std::span<const WorldMesh<Real, Dim>> meshes() const { return meshes_; }
  /// Whether there is a mesh.
  [[nodiscard]] bool has_meshes() const;

  /// Adds a joint between bodies that are where it is to hold them. Fails for a body that does not exist, for a joint
  /// of a body with itself, and for places, axes, limits, springs or motors that make no sense.
  Result<JointHandle> add_joint(const JointDefinition<Real, Dim>& definition);
  /// False where the world has no such joint. Joints go with their bodies.
  bool remove_joint(JointHandle handle);
  /// Whether the joint exists.
  [[nodiscard]] bool has_joint(JointHandle handle) const {
    return handle.slot < joints_.size() && joints_[handle.slot].generation == handle.generation &&
           joints_[handle.slot].is_used;
  }
  /// The joint, whose limits, spring, motor, target and strength may be changed; null where the world has no such
  /// joint.
  /// @{
  [[nodiscard]] Joint<Real, Dim>* find(JointHandle handle) {
    return has_joint(handle) ? &joints_[handle.slot].joint : nullptr;
  }
  [[nodiscard]] const Joint<Real, Dim>* find(JointHandle handle) const {
    return has_joint(handle) ? &joints_[handle.slot].joint : nullptr;
  }
  /// @}
  /// The handles of all joints, in the order of their slots. O(joints).
  [[nodiscard]] std::vector<JointHandle> joints() const;
  /// The number of joints.
  [[nodiscard]] std::size_t joint_count() const { return joint_count_; }

  /// From now on, bodies of groups a and b do not collide. Fails for a group that does not exist.
  [[nodiscard]] Status ignore(std::uint32_t a, std::uint32_t b) {
    if (a >= ignored_.size() || b >= ignored_.size()) return invalid_input("groups are numbered from 0 to 31");
    ignored_[a] |= 1u << b;
    ignored_[b] |= 1u << a;
    return {};
  }
  /// The group of body i, below 32.
  [[nodiscard]] std::uint32_t group(std::size_t i) const { return group_[i]; }
  /// Bit j of element i: whether the groups i and j ignore each other.
  [[nodiscard]] const std::array<std::uint32_t, 32>& ignored_groups() const { return ignored_; }
  /// Whether any two groups have been told to ignore each other.
  [[nodiscard]] bool has_ignored_groups() const { return ignored_ != std::array<std::uint32_t, 32>{}; }
  /// Whether bodies i and j may collide: their groups do not ignore each other, and one of them can move.
  [[nodiscard]] bool collide(std::size_t i, std::size_t j) const {
    if (!traits_.empty() &&
        ((traits_[i].category & traits_[j].mask) == 0 || (traits_[j].category & traits_[i].mask) == 0))
      return false;
    return (ignored_[group_[i]] >> group_[j] & 1u) == 0 && (inverse_mass[i] > 0 || inverse_mass[j] > 0);
  }
  /// What few bodies need, of body i.
  [[nodiscard]] BodyTraits<Real> traits(std::size_t i) const {
    return traits_.empty() ? BodyTraits<Real>{} : traits_[i];
  }
  /// Fails where the world has no such body, or for values that make no sense.
  [[nodiscard]] Status set_traits(BodyHandle body, const BodyTraits<Real>& traits);
  /// Whether a body has other traits than by default.
  [[nodiscard]] bool has_traits() const { return !traits_.empty(); }

  /// The number of bodies.
  [[nodiscard]] std::size_t size() const { return position.size(); }
  /// Reserves memory for so many bodies. Without it, growing arrays occupy up to twice the memory that they need.
  void reserve(std::size_t bodies) {
    for_each_array(*this, [&](auto& array) { array.reserve(bodies); });
    slots_.reserve(bodies);
  }
  /// Bytes of memory for bodies.
  [[nodiscard]] std::size_t memory() const {
    std::size_t sum = slots_.capacity() * sizeof(Slot) + free_slots_.capacity() * sizeof(std::uint32_t);
    for_each_array(*this, [&](const auto& array) { sum += array.capacity() * sizeof(array[0]); });
    return sum;
  }

  // By index: body i has position[i] and so on. An index is valid until a body is removed, a handle for ever.
  std::vector<V> position;               // of centres of mass
  std::vector<V> velocity;               // of centres of mass
  std::vector<V> constant_force;         // at the centre
  std::vector<O> orientation;            // an angle in the plane, a unit quaternion in space
  std::vector<S> spin;                   // the angular velocity, in radians per time
  std::vector<Real> radius;              // of balls; of other bodies, the greatest distance of a point from the centre
  std::vector<Real> mass;                // in the unit of mass
  std::vector<Real> inverse_mass;        // 0 of fixed bodies
  std::vector<Real> inverse_inertia;     // 0 of fixed bodies; in space, of bodies that are not balls, of the mean
  std::vector<Material<Real>> material;  // of surfaces

  /// The centre of a body; not a number where the world has no such body.
  [[nodiscard]] V position_of(BodyHandle body) const {
    return contains(body) ? position[index(body)] : nowhere_at_all();
  }
  /// The velocity of a body; not a number where the world has no such body.
  [[nodiscard]] V velocity_of(BodyHandle body) const {
    return contains(body) ? velocity[index(body)] : nowhere_at_all();
  }
  /// The geometry of body i; null of a ball, which has its radius.
  [[nodiscard]] const Solid<Real, Dim>* solid(std::size_t i) const {
    return i < solids_.size() ? solids_[i].get() : nullptr;
  }
  /// The same, to be kept beyond the life of the world.
  [[nodiscard]] std::shared_ptr<const Solid<Real, Dim>> shared_solid(std::size_t i) const {
    return i < solids_.size() ? solids_[i] : nullptr;
  }
  /// Whether there is a body that is not a ball.
  [[nodiscard]] bool has_solids() const { return solid_count_ > 0; }
  /// Where the origin of the shape of body i is: of balls the centre.
  [[nodiscard]] V origin(std::size_t i) const {
    const Solid<Real, Dim>* const of_body = solid(i);
    return of_body ? V(position[i] - rotation(orientation[i]) * of_body->centre) : position[i];
  }
  /// The moment of inertia of body i about its centre of mass, in the frame of its shape, as if it could move.
  [[nodiscard]] Inertia<Real, Dim> inertia(std::size_t i) const;
  /// Whether body i is fixed.
  [[nodiscard]] bool is_fixed(std::size_t i) const { return inverse_mass[i] == Real(0); }

 private:
  friend struct SnapshotAccess;  // snapshots/snapshot_members.hpp
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();
  struct Slot {
    std::uint32_t index = nowhere, generation = 1;  // so that a handle of nothing, {}, is never valid
  };
  [[nodiscard]] static V nowhere_at_all() {
    V x;
    x.components.fill(std::numeric_limits<Real>::quiet_NaN());
    return x;
  }
  template <class Self, class Act>
  static void for_each_array(Self& self, Act&& act) {
    act(self.position), act(self.velocity), act(self.constant_force), act(self.orientation), act(self.spin),
        act(self.radius), act(self.mass), act(self.inverse_mass), act(self.inverse_inertia), act(self.material),
        act(self.group_), act(self.slot_of_);
  }

  struct JointSlot {
    Joint<Real, Dim> joint{};
    std::uint32_t generation = 1;
    bool is_used = false;
  };
  void keep_solid(std::shared_ptr<const Solid<Real, Dim>> of_last);
  [[nodiscard]] Result<std::shared_ptr<const Solid<Real, Dim>>> solid_of(const Shape<Real, Dim>& shape) const;

  std::vector<std::uint32_t> group_, slot_of_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<Wall<Real, Dim>> walls_;
  std::array<std::uint32_t, 32> ignored_{};
  std::vector<std::shared_ptr<const Solid<Real, Dim>>> solids_;  // none, or one for each body, null of a ball
  std::vector<BodyTraits<Real>> traits_;                         // none, or one for each body
  std::size_t solid_count_ = 0;                                  // of those that are not null
  std::vector<JointSlot> joints_;
  std::size_t joint_count_ = 0;
  std::vector<WorldMesh<Real, Dim>> meshes_;
};

/// Fails where the fields of a world contradict each other: a radius or a mass that is not above 0, an inverse mass
/// that is neither 0 nor that of the mass, arrays of different lengths. Both motions ask before they move. O(bodies).
template <class Real, int Dim>
[[nodiscard]] Status check_bodies(const World<Real, Dim>& world);

/// Sums over all bodies that move. Angular momentum is about the origin, spin included.
template <class Real, int Dim>
[[nodiscard]] Real kinetic_energy(const World<Real, Dim>& world);
/// The potential energy of gravity, constant forces, springs and attraction.
template <class Real, int Dim>
[[nodiscard]] Real potential_energy(const World<Real, Dim>& world);
/// The sum of mass times velocity over all bodies.
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> momentum(const World<Real, Dim>& world);
/// The angular momentum about the origin of all bodies that move, spin included; one number in the plane.
template <class Real, int Dim>
[[nodiscard]] Spin<Real, Dim> angular_momentum(const World<Real, Dim>& world);

/// A hash of the time and of every body's position, orientation, velocity and spin, to the last bit: equal runs have
/// equal hashes (FNV-1a; G. Fowler, L. C. Noll, K.-P. Vo).
template <class Real, int Dim>
[[nodiscard]] std::uint64_t state_hash(const World<Real, Dim>& world);

extern template class World<float, 2>;
extern template class World<float, 3>;
extern template class World<double, 2>;
extern template class World<double, 3>;

}  // namespace continuo
