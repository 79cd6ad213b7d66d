// continuo/language/syntax/ast_world.hpp
// `world { ... }` and `force on ...` in the syntax tree; ast.hpp holds the statements they are.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <continuo/language/syntax/ast_expression.hpp>

namespace continuo::model::ast {

/// `radius 0.5`, `at (0, 10) [m]` (a List, or a Quantity of one), `hull (0, 0) (1, 0) (0, 1)` (a List of these),
/// `limits -90..90 [deg]` (a List of two), `integrator central_difference` (a Name); `fixed` has no value and is
/// Missing.
struct WorldAttribute {
  Identifier name;
  Expression value;

  [[nodiscard]] bool has_value() const { return !std::holds_alternative<Missing>(value.node); }
};
using WorldAttributes = std::vector<WorldAttribute>;

/// `dimension 2`, `gravity (0, -9.81)`, `attraction 6.67e-11 softening 1`, `drag linear 0.1`, `material friction 0.3`,
/// `combine restitution minimum`, `mode fast step 1/60`.
struct WorldSetting {
  Identifier word;
  std::optional<Expression> value;  // of dimension, gravity and attraction; of mode a Name
  WorldAttributes attributes;
};

/// `wall ground (0, 1) at 0 friction 0.3`: where (0, 1) . x >= 0 is free; with `thin` both sides are.
struct WorldWall {
  std::optional<Identifier> name;
  Expression normal, offset;
  WorldAttributes attributes;
};

/// `wall hills mesh "terrain.obj" at (0, 0, 1) scale 2`, `wall track chain (0, 0) (4, 0) (6, 1) friction 0.8`,
/// `wall track chain from "profile.csv"`, `wall track chain for k in 0..9 { (k, h[k]) }`, `wall hills heights
/// "hills.csv"`, `wall hills heights for i in 0..9, j in 0..9 { sin(i)*sin(j) } from (0, 0) spacing (1, 1)`: a surface
/// of triangles or segments that never moves.
struct WorldMesh {
  std::optional<Identifier> name;
  Identifier kind;                                     // `mesh`, `chain` or `heights`
  std::vector<std::pair<Identifier, Range>> families;  // for each index of this range a chain goes on with its points,
                                                       // for each two of these ranges there is a height
  Expression corners;  // a Text: the name of a file; of a chain a List of points, or of heights a number
  WorldAttributes attributes;
};

/// `container box (0, 0) to (20, 20)`: the inside of a box.
struct WorldContainer {
  std::optional<Identifier> name;
  Expression lower, upper;
  WorldAttributes attributes;
};

/// `body ball at (0, 10) radius 0.5 mass 1`, `character hero at (0, 0.9) radius 0.3 height 1.8 walk gas*speed`.
struct WorldBody {
  Name name;
  WorldAttributes attributes;
  bool is_character = false;
};

/// `bodies grain grid 10 x 20 from (1, 1) ...`, `bodies gas random 1000 in (0, 0) to (20, 20) ...`,
/// `bodies tower stack 10 from (3, 0.5) ...`.
enum class Pattern { grid, random, stack };
struct WorldBodies {
  Identifier name;
  Pattern pattern{};
  std::vector<Expression> counts;          // of a grid one per axis
  std::optional<Expression> lower, upper;  // of random
  WorldAttributes attributes;
};

/// `spring ball to anchor stiffness 40`, `spring ball to (0, 5) stiffness 40`.
struct WorldSpring {
  Name a;
  std::variant<Name, Expression> b;
  WorldAttributes attributes;
};

/// `springs of cloth stiffness 40`: between the neighbours of a pattern.
struct WorldSprings {
  Identifier pattern;
  WorldAttributes attributes;
};

/// `hinge door to frame at (0, 1) limits -90..90 [deg]`, `hinge knee: shin to thigh at (0, 1)`,
/// `distance bob to (0, 5)`, `weld sign at (0, 1)`, which is to the world.
struct WorldJoint {
  Identifier kind;
  std::optional<Name> name;
  Name first;
  std::variant<std::monostate, Name, Expression> second;  // nothing: the world; a point: of the world
  WorldAttributes attributes;
};

/// `part of hammer at (0.5, 0) box (0.2, 0.5)`: joined rigidly to the body, in its frame.
struct WorldPart {
  Name of;
  WorldAttributes attributes;
};

/// `fix cloth[1], cloth[8]`.
struct WorldFix {
  std::vector<Name> bodies;
};

/// `ignore pegs with pegs`: bodies of these groups pass through each other.
struct WorldIgnore {
  Identifier a, b;
};

struct WorldItem;

/// `for i in 1..5 { body ball[i] at (i, 0) }` in a world.
struct WorldFamily {
  Identifier index;
  Range range;
  std::vector<WorldItem> body;
};

struct WorldItem {
  std::variant<WorldSetting, WorldWall, WorldMesh, WorldContainer, WorldBody, WorldBodies, WorldSpring, WorldSprings,
               WorldJoint, WorldPart, WorldFix, WorldIgnore, WorldFamily>
      node;
  Span span;
};

struct World {
  std::vector<WorldItem> items;
};

/// `force on ball = (-k*ball.x, 0)`, `torque on ball = -c*ball.angle`.
struct Force {
  Name body;
  Expression value;  // a List, or a Quantity of one; of a torque in the plane a number
  bool is_torque = false;
};

}  // namespace continuo::model::ast
