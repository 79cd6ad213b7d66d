// continuo/language/check/names/declarations.hpp
// What the text declares, families written out: each item with the place of its text and where it stands. Plain data,
// filled by declarations/, states/orders.hpp and world/world_declarations.hpp; the passes after these only read it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <continuo/language/check/names/scope.hpp>
#include <continuo/language/check/names/symbols.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/syntax/ast.hpp>

namespace continuo::model::detail {

/// A param, input, let, output or energy; one for each member of a family.
struct Definition {
  enum class Kind : unsigned char { parameter, input, let, output, energy };
  Kind kind;
  std::string name;  // "m[3]"
  const ast::Expression* value;
  const ast::Definition* text;
  const ast::Input* input = nullptr;
  Instance scope;
  std::uint32_t variable = 0;  // of a parameter or an input
};

/// A variable with a derivative: its components are x, x', ... up to order - 1.
struct Base {
  std::string name;
  std::string_view family;  // without indices
  int order = 0;
  std::size_t first = 0;                      // index of its first state
  Span span;                                  // where its highest derivative stands first
  std::span<const std::size_t> conditions{};  // into Declarations::conditions
  bool in_world = false;                      // of a body or a measure of the world: it has no equation
  bool has_equation = true;                   // else it has an initial value only
  bool is_measure = false;                    // of the world or of a joint: it follows from the bodies
};

template <class T>
struct Placed {
  const T* text;
  Instance scope;
  Span span;
};

struct UnknownText {
  const ast::Unknown* text;
  Instance scope;
  Span span;
  std::string name;
  std::uint32_t variable = 0;
};

struct EquationText {
  const ast::Equation* text;
  Instance scope;
  Span span;
  std::size_t base = no_base;  // of which the left side is a derivative, where it is nothing else
  static constexpr std::size_t no_base = static_cast<std::size_t>(-1);
};

struct ConditionText {
  const ast::Condition* text;
  Instance scope;
  Span span;
  std::size_t base;
};

struct EventText {
  std::variant<const ast::When*, const ast::At*, const ast::Every*, const ast::Initially*> text;
  Instance scope;
  Span span;
};

/// Without modes there is one, named "".
struct ModeText {
  std::string name;
  Span span;
};

struct BodyText {
  const ast::WorldBody* text;  // null: of a pattern
  Instance scope;
  Span span;
  std::string name;
  std::size_t base;  // its first

  [[nodiscard]] bool is_character() const { return text && text->is_character; }
};
struct PatternText {
  const ast::WorldBodies* text;
  Instance scope;
  Span span;
  std::vector<long> counts;
  std::size_t first, count;  // of its bodies
};
struct JointText {
  const ast::WorldJoint* text;
  Instance scope;
  Span span;
  std::string name;            // its own, or that of its first body
  std::string_view family;     // without indices
  std::size_t base = no_base;  // its first measure
  static constexpr std::size_t no_base = static_cast<std::size_t>(-1);

  [[nodiscard]] bool is_named() const { return text->name.has_value(); }
  [[nodiscard]] bool has_motor() const;
};
struct WorldText {
  const ast::World* text = nullptr;  // null: the model has no world
  Span span{};
  int dimension = 2;
  std::vector<Placed<ast::WorldItem>> items{};
  std::vector<BodyText> bodies{};
  std::vector<PatternText> patterns{};
  std::vector<JointText> joints{};
  std::vector<Placed<ast::Force>> forces{};

  [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(dimension); }
};

struct Declarations {
  Symbols symbols;
  std::vector<ModeText> modes;
  std::vector<TableFile> tables;
  std::vector<Definition> definitions;
  std::vector<std::size_t> parameters;  // definitions that are parameters, in the order of the text
  std::vector<Base> bases;
  std::vector<EquationText> equations;
  std::vector<ConditionText> conditions;
  std::vector<std::size_t> conditions_by_base;  // indices of these, those of each base together
  std::vector<Placed<ast::Guess>> guesses;
  std::vector<UnknownText> unknowns;
  std::vector<EventText> events;
  std::vector<Placed<ast::Check>> checks;
  std::vector<Placed<ast::Plot>> plots;
  std::vector<Placed<ast::Draw>> draws;
  WorldText world;
  const ast::Run* run = nullptr;
  Span run_span{};
  const ast::Start* start = nullptr;
  const ast::Sweep* sweep = nullptr;
  Span sweep_span{};

  [[nodiscard]] bool has_modes() const { return modes.size() > 1; }
  [[nodiscard]] const Base& base_of_state(std::size_t state) const { return bases[base_index_of_state(state)]; }
  [[nodiscard]] std::size_t base_index_of_state(std::size_t state) const;
};

/// `npos` where there is none of this name.
[[nodiscard]] std::size_t find_mode(const Declarations& declared, std::string_view name);
/// Reported where there is none of this name.
[[nodiscard]] std::optional<std::size_t> mode_named(const Declarations& declared, const ast::Identifier& name,
                                                    Report& report);

}  // namespace continuo::model::detail
