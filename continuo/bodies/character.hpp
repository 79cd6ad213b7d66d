// continuo/bodies/character.hpp
// A character that walks: an upright capsule that is moved, not pushed. It goes up slopes and steps, slides along
// walls, falls, and stands on bodies that move. It does not act on the world.
//
//   Character<double, 3> hero{.position = {{0, 0, 1}}};
//   for (;;) {
//     require(motion.advance());
//     hero = require(walk(world, Queries(world), hero, {{1, 0, 0}}, 1.0 / 60));
//   }
#pragma once
#include <continuo/bodies/queries.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// What a character is and can do. Upwards is along the last axis.
template <class Real>
struct CharacterOptions {
  Real radius = Real(0.3);              // of the capsule
  Real height = Real(1.8);              // of the whole capsule, more than two radii
  Real steepest = Real(0.8);            // slope on which it stands, in radians from the horizontal, below a right angle
  Real highest_step = Real(0.3);        // that it goes up, and down without falling
  Real skin = Real(0.005);              // distance that it keeps from all surfaces, to one half of it
  Real fall_acceleration = Real(9.81);  // where there is no ground
  QueryFilter filter{};                 // what is solid to it; sensors never are
};

/// Where a character is, and on what it stands.
template <class Real, int Dim>
struct Character {
  Vector<Real, Dim> position{};    // of the lowest point of the capsule
  Real rise{};                     // speed upwards; set it to jump
  bool is_on_ground = false;       // it stands
  Vector<Real, Dim> normal{};      // of the ground, if it stands
  BodyHandle ground{};             // on which it stands, unless that is a wall or a mesh
  Vector<Real, Dim> local_foot{};  // a point of that body, in the frame of its shape's axes about its centre
  Vector<Real, Dim> foot{};        // where this was
};

/// Fails for options that make no sense; the message says which.
template <class Real>
[[nodiscard]] Status check(const CharacterOptions<Real>& options);

/// The character after `duration`: it is carried by the ground on which it stood, walks with the horizontal part of
/// `velocity`, and falls where there is no ground. On slopes and steps its horizontal velocity stays the same. A
/// character that stands still on still ground keeps its position to the bit. `queries` is an index of the world as it
/// is now. Fails for values that make no sense.
template <class Real, int Dim>
[[nodiscard]] Result<Character<Real, Dim>> walk(const World<Real, Dim>& world, const Queries<Real, Dim>& queries,
                                                const Character<Real, Dim>& character,
                                                const Vector<Real, Dim>& velocity, const Real& duration,
                                                const CharacterOptions<Real>& options = {});

}  // namespace continuo
