// continuo/language/check/names/declarations.hpp
// What the check has in hand while it works: scopes, values with what they measure, and each declaration with the place
// of its text and how far it has come. Plain data; the check itself is checker.hpp.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/language/syntax/ast.hpp>
#include <continuo/language/world.hpp>
#include <continuo/symbolic/units/unit_check.hpp>

namespace continuo::model::detail {

/// `for i in ...`: what i is at the moment.
struct Index {
  std::string_view name;
  long value;
};

/// Where an expression stands.
struct Scope {
  static constexpr int no_mode = -1;
  std::vector<Index> indices = {};
  int mode = no_mode;
  std::string_view constant = {};           // what must be constant here: "an index"; empty: everything may stand here
  std::vector<Sample>* samples = nullptr;   // where h(1) may stand: in checks and conditions
  const ast::Expression* moment = nullptr;  // of a condition: what changes is named with its time, x(0)
  std::vector<std::uint32_t>* highest = nullptr;  // notes the bases whose highest derivatives stand in the expression
  std::size_t depth = 0;                          // of expressions and definitions inside each other

  bool is_constant() const { return !constant.empty(); }
};

/// A node with what it measures. `bad`: an error was reported, nothing more is said about it.
struct Value {
  NodeId node;
  Measured measured = Measured::unknown();
  bool condition = false;
  bool bad = false;
};

/// A value and the text it came from, for messages.
struct Term {
  const ast::Expression& text;
  Value value;
};

enum class Progress : unsigned char { untouched, busy, done };

/// A param, input, let, output or energy; one for each member of a family.
struct Definition {
  enum class Kind : unsigned char { parameter, input, let, output, energy };
  Kind kind;
  std::string name;  // "m[3]"
  const ast::Expression* value;
  const ast::Definition* text;
  const ast::Input* input = nullptr;
  Scope scope;
  Progress progress = Progress::untouched, constant_progress = Progress::untouched;
  Value result{}, constant_result{};
  std::vector<std::uint32_t> highest{};  // highest derivatives in `result`, as indices of bases
  std::uint32_t variable = 0;            // of a parameter or an input
  bool structural = false;
};

/// A variable with a derivative: its components are x, x', ... up to order - 1.
struct Base {
  std::string name;
  std::string family;  // without indices
  int order = 0;
  std::size_t first = 0;                  // index of its first state
  Span span;                              // where its highest derivative stands first
  std::vector<std::size_t> conditions{};  // into Checker::conditions, those at the start
  bool in_world = false;                  // of a body or a measure of the world: it has no equation
};

struct Symbol {
  enum class Kind : unsigned char { definition, base, unknown, table, body };
  Kind kind;
  std::size_t index;
  Span span;
};

/// What is written under a name with and without indices, for messages about indices.
struct FamilyShape {
  Symbol::Kind kind{};
  std::size_t dimensions = 0;
  std::vector<long> low{}, high{};
};

template <class T>
struct Placed {
  const T* text;
  Scope scope;
  Span span;
};

struct UnknownText {
  const ast::Unknown* text;
  Scope scope;
  Span span;
  std::string name;
  std::uint32_t variable = 0;
  Measured measured = Measured::unknown();
};

struct ConditionText {
  const ast::Condition* text;
  Scope scope;
  Span span;
  std::size_t base;
  std::optional<Setting> time{};
  Value value{};
  std::vector<Sample> samples{};  // `x(10)` in the value
  Progress progress = Progress::untouched;
};

/// What a number of the world may be.
enum class Sort : unsigned char { any, positive, not_negative, fraction };

struct BodyText {
  const ast::WorldBody* text;  // null: of a pattern
  Scope scope;
  Span span;
  std::string name;
  std::size_t base;  // its first
};
/// How a body stands and turns at the start: an angle and one spin in the plane, in space a quaternion and three.
struct Turn {
  std::array<NodeId, 4> orientation;
  NodePoint spin;
};
struct PatternText {
  const ast::WorldBodies* text;
  Scope scope;
  Span span;
  std::vector<long> counts;
  std::size_t first, count;  // of its bodies
};
/// What a query asks about: a body, a wall, or a point.
struct Thing {
  std::size_t body = no_body, wall = no_body;  // wall: by its number
  NodePoint point{};                           // of a body its centre
  bool is_wall() const { return wall != no_body; }
};
/// Who asks, and about what.
using Pairs = std::vector<std::pair<Thing, Thing>>;
/// Numbers that are held to their sort all at once.
struct ToJudge {
  NodeId node;
  Sort sort;
  Span span;
  std::string what;
};
struct WorldAtWork {
  const ast::World* text = nullptr;
  Span span{};
  int dimension = 2;
  std::vector<Placed<ast::WorldItem>> items{};  // families written out
  std::vector<BodyText> bodies{};
  std::vector<PatternText> patterns{};
  std::vector<Placed<ast::Force>> forces{};
  std::vector<std::string> groups{""};  // by number
  MaterialDescription material{};
  std::vector<ToJudge> to_judge{};
  Measured length = Measured::unknown(), mass = Measured::unknown();
  WorldDescription made{};
  bool bodies_are_made = false, is_made = false;  // is_made: walls, too

  std::size_t axes() const { return static_cast<std::size_t>(dimension); }
};

}  // namespace continuo::model::detail
