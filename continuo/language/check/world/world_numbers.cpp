// continuo/language/check/world/world_numbers.cpp
// E225 where a number is not what it may be, E227 where a point has other components than the world.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

namespace {

const ast::List* list_in(const ast::Expression& expression, const ast::Unit** unit) {
  if (const auto* quantity = std::get_if<ast::Quantity>(&expression.node)) {
    *unit = &quantity->unit;
    return std::get_if<ast::List>(&quantity->value->node);
  }
  return std::get_if<ast::List>(&expression.node);
}

bool fits(Sort sort, double value) {
  if (!std::isfinite(value)) return false;
  if (sort == Sort::any) return true;
  if (sort == Sort::positive) return value > 0;
  constexpr double steepest = 1.57;  // in radians, as bodies/character.hpp has it
  return value >= 0 && (sort != Sort::fraction || value <= 1) && (sort != Sort::slope || value < steepest);
}

std::string_view demand(Sort sort) {
  switch (sort) {
    case Sort::positive:
      return "must be greater than 0";
    case Sort::not_negative:
      return "must not be negative";
    case Sort::fraction:
      return "goes from 0 to 1";
    case Sort::slope:
      return "goes from 0 to less than a right angle";
    case Sort::any:
      break;
  }
  return "must be a finite number";
}

}  // namespace

/// The numbers of a point, each with the unit that stands behind the bracket; at least `count`.
std::vector<Term> WorldNumbers::components(const ast::Expression& expression, Scope& scope, std::size_t count) const {
  const ast::Unit* unit = nullptr;
  const ast::List* list = list_in(expression, &unit);
  if (!list || list->items.size() < count) return {};
  std::optional<Unit> stated;
  if (unit) {
    stated = unit_of(*unit, report_);
    if (!stated) return {};
  }
  std::vector<Term> terms;
  for (const ast::Expression& item : list->items) {
    Value value = expressions_.values.number_of(item, scope);
    if (value.bad) return {};
    if (stated) {
      const auto factor = factor_between(value.measured, Measured::known(*stated));
      if (!factor) {
        report_.fail(
            "E201", item.span, "units do not match",
            fmt::format("{} is {}, not {}", report_.quote(item.span), unit_text(value.measured), to_text(*stated)));
        return {};
      }
      value.node = expressions_.workspace.graph.multiply(value.node, expressions_.workspace.graph.constant(*factor));
      value.measured = Measured::known(*stated);
    }
    terms.push_back({item, value});
  }
  return terms;
}

NodePoint WorldNumbers::point(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                              std::string_view what, bool parameters_only) const {
  const ast::Unit* unit = nullptr;
  const ast::List* list = list_in(expression, &unit);
  if (list && list->items.size() != text_.axes()) {
    report_.fail(
        "E227", expression.span,
        fmt::format("{} has {} components in {} dimensions", what, text_.dimension, text_.dimension),
        fmt::format("here are {}", list->items.size()),
        text_.dimension == 2 ? "write `dimension 3` in the world for bodies in space" : "the world says `dimension 3`");
    return {};
  }
  NodePoint made{};
  const std::vector<Term> terms = components(expression, scope, text_.axes());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (parameters_only && !expressions_.values.only_parameters(terms[i].value.node, terms[i].text.span, what))
      return {};
    if (!factor_between(terms[i].value.measured, wanted)) {
      report_.fail("E201", expression.span, "units do not match",
                   fmt::format("{} is {}, {} is {}", report_.quote(terms[i].text.span),
                               unit_text(terms[i].value.measured), what, unit_text(wanted)));
      return {};
    }
    made[i] = expressions_.operations.in_unit(terms[i].text, terms[i].value, wanted, what);
    if (parameters_only) expect(made[i], Sort::any, terms[i].text.span, std::string(what));
  }
  return made;
}

std::vector<NodeId> WorldNumbers::level(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                        std::string_view what, bool parameters_only) const {
  const std::size_t count = text_.axes() - 1, given = size_of_point(expression);
  if (given != count) {
    report_.fail("E227", expression.span,
                 fmt::format("{} has {} in {} dimensions", what, count == 1 ? "one component" : "two components",
                             text_.dimension),
                 given == 1 ? "this is one number" : fmt::format("here are {} components", given),
                 count == 1 ? "it is along x" : "they are along x and y, as in (1, 2)");
    return {};
  }
  std::vector<Term> terms;
  if (count > 1) {
    terms = components(expression, scope, count);
  } else if (const Value value = expressions_.values.number_of(expression, scope); !value.bad) {
    terms.push_back({expression, value});
  }
  std::vector<NodeId> made;
  for (const Term& term : terms) {
    if (parameters_only && !expressions_.values.only_parameters(term.value.node, term.text.span, what)) return {};
    made.push_back(expressions_.operations.in_unit(term.text, term.value, wanted, what));
    if (!made.back().valid()) return {};
    if (parameters_only) expect(made.back(), Sort::any, term.text.span, std::string(what));
  }
  return made;
}

NodeId WorldNumbers::number(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                            std::string_view what, Sort sort) const {
  const Value value = expressions_.values.number_of(expression, scope);
  if (value.bad || !expressions_.values.only_parameters(value.node, expression.span, what)) return {};
  const NodeId node = expressions_.operations.in_unit(expression, value, wanted, what);
  expect(node, sort, expression.span, std::string(what));
  return node;
}

NodeId WorldNumbers::in_plane(const ast::Expression& text, Scope& scope, const Measured& wanted,
                              std::string_view what) const {
  if (!std::holds_alternative<ast::List>(text.node)) return number(text, scope, wanted, what, Sort::any);
  report_.fail("E227", text.span, fmt::format("{} in the plane is one number", what), {},
               "write `dimension 3` in the world for bodies in space");
  return {};
}

NodePoint WorldNumbers::in_space(const ast::Expression& text, Scope& scope, const Measured& wanted,
                                 std::string_view what, bool parameters_only) const {
  if (std::holds_alternative<ast::List>(text.node)) return point(text, scope, wanted, what, parameters_only);
  report_.fail("E227", text.span, fmt::format("{} in space has three components", what), {},
               "its direction is the axis, as in (0, 0, 2)");
  return {};
}

/// Everything at once: what many bodies share is computed once.
void WorldNumbers::judge(const Model& model) const {
  std::vector<NodeId> nodes;
  std::vector<const ToJudge*> judged;
  for (const ToJudge& one : work_.to_judge) {
    if (!one.node.valid()) continue;
    nodes.push_back(one.node);
    judged.push_back(&one);
  }
  const std::vector<double> values = evaluate(model, nodes, expressions_.workspace.registers);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ToJudge& one = *judged[i];
    if (fits(one.sort, values[i])) continue;
    report_.fail("E225", one.span, fmt::format("{} {}", one.what, demand(one.sort)),
                 fmt::format("this is {:g}", values[i]));
  }
}

void WorldNumbers::expect(NodeId node, Sort sort, Span span, std::string what) const {
  work_.to_judge.push_back({node, sort, span, std::move(what)});
}

}  // namespace continuo::model::detail
