// continuo/language/world.hpp
// The `world` of a checked model: bodies, walls, springs and forces as plain data. Numbers are nodes of the model's
// graph that depend on parameters only; forces may depend on everything. worlds/ builds and moves it.
//
//   if (const WorldDescription* world = loaded.model->world.get())
//     for (const BodyDescription& body : world->bodies) fmt::print("{}\n", body.name);
//
// Numbers are in the model's unit of length (`length_unit`, that of the first position), kilograms where that has a
// unit, and the model's unit of time.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/language/text/source.hpp>
#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {

inline constexpr std::size_t no_body = static_cast<std::size_t>(-1);
using NodePoint = std::array<NodeId, 3>;  // the third is not valid in the plane

/// The contact parameters of a surface.
struct MaterialDescription {
  NodeId restitution, friction, rolling;
};

/// How the numbers of two surfaces become those of their contact: each one of `combinations` (words.hpp).
struct CombineRuleDescription {
  std::string restitution = "maximum", friction = "geometric_mean", rolling = "maximum";
  friend bool operator==(const CombineRuleDescription&, const CombineRuleDescription&) = default;
};

struct PartDescription;

/// The shape of a body in a frame of its own, as in shapes/shape.hpp. What another kind has is not valid.
struct ShapeDescription {
  /// What shapes there are.
  enum class Kind : std::uint8_t { ball, capsule, box, hull, compound };
  Kind kind = Kind::ball;
  NodeId radius;                                 // of a ball, and of the ends of a capsule
  NodeId length;                                 // of a capsule
  NodePoint size;                                // of a box
  NodeId rounding;                               // of a box or a hull
  std::vector<std::array<double, 3>> corners{};  // of a hull: numbers, so that what they depend on decides the model
  std::vector<PartDescription> parts;            // of a compound: their numbers are constants of the graph
};

/// A convex part of a compound, where it stands in the frame of the compound.
struct PartDescription {
  ShapeDescription shape{};                         // no compound
  std::array<double, 3> position{};                 // of its origin
  std::array<double, 4> orientation{1.0, 0, 0, 0};  // a unit quaternion; in the plane the first number is an angle
};

/// What few bodies need, as in bodies/body.hpp. What is not valid is left to the body.
struct TraitsDescription {
  bool sensor = false;                          // has contact events, but pushes nothing
  std::uint8_t locked = 0;                      // bits: x, y, z, the turns about x, y, z
  NodeId gravity_scale, damping, spin_damping;  // of gravity; of the velocity and the spin, per time
  /// Whether it has any.
  [[nodiscard]] bool any() const {
    return sensor || locked != 0 || gravity_scale.valid() || damping.valid() || spin_damping.valid();
  }
};

/// Where it is and how it moves at the start are the initial values of its states.
struct BodyDescription {
  std::string name;  // "ball", "grain[3]"
  ShapeDescription shape{};
  NodeId radius;           // the greatest distance of a point from its centre of mass
  NodeId mass;             // density times volume where none is given
  NodeId density;          // not valid where a mass is given
  bool fixed = false;      // nothing moves it
  bool driven = false;     // fixed, and moves with its velocity and spin
  bool character = false;  // driven, and walks: see CharacterDescription
  TraitsDescription traits{};
  std::uint32_t group = 0;
  MaterialDescription material;
  std::size_t first_state = 0;  // of its body_states(dimension) in Model::states
  Span span;

  /// Whether nothing stops it: it is fixed, and does not walk.
  [[nodiscard]] bool is_unstoppable() const { return fixed && !character; }
};

/// A wall of the half-space normal . x >= offset; a thin one has two sides. A container is several of one name.
struct WallDescription {
  std::string name;  // "wall 2" where it has none
  NodePoint normal;
  NodeId offset;
  MaterialDescription material;
  bool thin = false;
  Span span;
};

/// A surface that never moves: triangles in space, a chain of segments in the plane. Its corners are those of a file,
/// or points of the text; `orientation` turns `scale` times a corner, and `position` moves it.
struct MeshDescription {
  std::string name;                                       // "wall 2" where it has none
  std::vector<NodePoint> points{};                        // of a chain in the text; else empty, and ...
  std::vector<std::array<double, 3>> corners{};           // ... of a file, in the order of the file
  std::vector<std::array<std::uint32_t, 3>> triangles{};  // by their corners, counter-clockwise seen from outside
  bool is_closed = false;                                 // of a chain: from the last point back to the first
  bool thin = false;                                      // free on both sides; else a chain is free on its left
  NodePoint position;                                     // of the origin of its corners
  std::array<NodeId, 4> orientation;                      // a unit quaternion; in the plane the first is an angle
  NodeId scale;                                           // greater than 0
  MaterialDescription material;
  Span span;
};

/// A spring between two bodies, or from a body to a point.
struct SpringDescription {
  std::size_t a = no_body, b = no_body;  // no body: the point
  NodePoint point;
  NodeId stiffness, length, damping;
  Span span;
};

/// A joint between two bodies, or a body and the world. Places and axes are those at the start.
struct JointDescription {
  std::string name;                       // "door" of one without a name is that of its first body
  std::string kind;                       // one of `joint_kinds` (words.hpp)
  std::size_t first = no_body;            // the coordinate is that of this body ...
  std::size_t second = no_body;           // ... against this one; no body: the world
  NodePoint anchor_first, anchor_second;  // where it holds them; of a gear of no meaning
  NodePoint axis, axle;                   // not valid where they are of no meaning
  NodeId lower, upper;                    // limits of the coordinate; not valid: none
  NodeId hertz, damping, rest;            // of a spring; not valid: none
  NodeId motor_speed, motor_most;         // not valid: none; the speed may depend on everything
  NodeId ratio;                           // of a gear
  NodePoint target{};                     // of a pull: where it draws the first body to; it may depend on everything
  NodeId breaks_at, breaks_at_torque;     // not valid: never; of a pull the greatest force
  bool collide = false;                   // the two bodies with each other
  bool is_named = false;                  // only then has it a measure of its coordinate
  std::size_t first_measure = no_body;    // of `joint_measures` in Model::states; no_body: none
  Span span{};
};

/// A body that walks, as in bodies/character.hpp: an upright capsule, driven, and a sensor to all others.
struct CharacterDescription {
  std::size_t body = no_body;
  NodeId radius{}, height{};  // of the capsule
  NodeId steepest{};          // slope on which it stands, in radians
  NodeId highest_step{};      // that it goes up
  NodePoint walk{};           // the horizontal velocity that it wishes: one component in the plane, two in space ...
  NodeId jump{};              // ... and the speed at which it leaves the ground, if above 0: both of everything
  std::size_t first_measure = no_body;  // of `character_measures` in Model::states
  Span span{};
};

/// `force on ball = (...)`, or `torque on ball = ...`, which has one component in the plane: any expressions of the
/// model.
struct ForceDescription {
  std::size_t body;
  NodePoint components;
  Span span;
};

/// How it is moved unless the caller says otherwise. What is not valid is left to the motion.
struct WorldMode {
  bool fast = false;
  NodeId tolerance, contact_time;                  // exact
  NodeId step, hertz, sleep_after, sleep_speed;    // fast
  int substeps = 4, threads = 1;                   //
  std::string integrator = "semi_implicit_euler";  //
};

/// The world of a model.
struct WorldDescription {
  int dimension = 2;
  std::string length_unit, mass_unit;
  NodePoint gravity;
  NodeId attraction, softening, opening;  // not valid without attraction
  NodeId drag_linear, drag_quadratic;     // not valid without drag
  CombineRuleDescription combine_rule;
  std::vector<BodyDescription> bodies;  // their states are the first of the model, in this order
  std::vector<WallDescription> walls;
  std::vector<MeshDescription> meshes;
  std::vector<SpringDescription> springs;
  std::vector<JointDescription> joints;
  std::vector<CharacterDescription> characters;
  std::vector<ForceDescription> forces, torques;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ignored;  // groups
  WorldMode mode;
  // Of `world_measures(dimension)` in Model::states: world.kinetic, ...; those of joints and of characters follow, as
  // the last states.
  std::size_t first_measure = 0;
  Span span;

  /// Whether it has joints or meshes, or bodies that are not balls, are driven or have traits.
  [[nodiscard]] bool is_rigid() const;
  /// Whether it is rigid and moved by the fast motion: then the exact one is no reference for it.
  [[nodiscard]] bool is_moved_fast() const { return mode.fast && is_rigid(); }

  /// The number of states of all bodies.
  [[nodiscard]] std::size_t body_states() const { return bodies.size() * states_of_body(dimension); }
  /// In the plane x, x', y, y', angle, angle'; in space x, x', y, y', z, z', q_w, q_x, q_y, q_z, spin_x, spin_y,
  /// spin_z.
  [[nodiscard]] static constexpr std::size_t states_of_body(int dimension) { return dimension == 2 ? 6 : 13; }
};

/// What a world tells of itself: `world.kinetic`, `world.potential`, `world.momentum_x`, ..., `world.collisions`.
[[nodiscard]] std::vector<std::string> world_measures(int dimension);

/// What a joint tells of itself: a hinge `angle`, sliders, distances and wheels `length`, if it has a name; the force
/// and the torque on its first body, `force_x`, ..., `torque` in the plane, `torque_x`, ... in space; `motor_torque` or
/// `motor_force`.
[[nodiscard]] std::vector<std::string> joint_measures(std::string_view kind, int dimension, bool is_named,
                                                      bool has_motor);

/// What a character tells of itself beyond a body: `on_ground`, 1 where it stands, else 0.
[[nodiscard]] std::vector<std::string> character_measures();

/// So many there were until the model was in this state.
[[nodiscard]] double collisions_of(const WorldDescription& world, std::span<const double> state);

}  // namespace continuo::model
