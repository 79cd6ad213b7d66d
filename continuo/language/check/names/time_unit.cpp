// continuo/language/check/names/time_unit.cpp
// The unit of `run`, and whether declarations have units at all.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/time_unit.hpp>

namespace continuo::model::detail {

namespace {

bool has_units_inside(const ast::Expression& expression) {
  return std::visit(
      [](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Quantity>) {
          return true;
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          return has_units_inside(*node.operand);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          return has_units_inside(*node.left) || has_units_inside(*node.right);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          return std::ranges::any_of(node.arguments, has_units_inside);
        } else if constexpr (std::is_same_v<T, ast::Conditional>) {
          return has_units_inside(*node.condition) || has_units_inside(*node.when_true) ||
                 has_units_inside(*node.when_false);
        } else if constexpr (std::is_same_v<T, ast::Sum>) {
          return has_units_inside(*node.body);
        } else if constexpr (std::is_same_v<T, ast::List>) {
          return std::ranges::any_of(node.items, has_units_inside);
        } else {
          return false;
        }
      },
      expression.node);
}

bool has_units_in_world(const std::vector<ast::WorldItem>& items) {
  const auto in = [](const std::optional<ast::Expression>& value) { return value && has_units_inside(*value); };
  return std::ranges::any_of(items, [&](const ast::WorldItem& item) {
    return std::visit(
        [&](const auto& node) {
          if constexpr (requires { node.attributes; }) {
            if (std::ranges::any_of(node.attributes, [](const auto& one) { return has_units_inside(one.value); }))
              return true;
          }
          if constexpr (requires { node.value; }) return in(node.value);
          if constexpr (requires { node.offset; }) return has_units_inside(node.offset);
          if constexpr (requires { node.lower; }) return in(node.lower) || in(node.upper);
          if constexpr (requires { node.body; }) return has_units_in_world(node.body);
          return false;
        },
        item.node);
  });
}

/// Units in declarations, equations and initial values; those of the experiment alone do not make a model with units.
bool has_units(const std::vector<ast::Statement>& statements) {
  const auto defined = [](const std::vector<ast::Definition>& items) {
    return std::ranges::any_of(items, [](const ast::Definition& item) { return has_units_inside(item.value); });
  };
  return std::ranges::any_of(statements, [&](const ast::Statement& statement) {
    return std::visit(
        [&](const auto& node) {
          using T = std::decay_t<decltype(node)>;
          if constexpr (std::is_same_v<T, ast::Parameters> || std::is_same_v<T, ast::Lets>) {
            return defined(node.items);
          } else if constexpr (std::is_same_v<T, ast::Input>) {
            return has_units_inside(node.definition.value);
          } else if constexpr (std::is_same_v<T, ast::Equation>) {
            return has_units_inside(node.left) || has_units_inside(node.right);
          } else if constexpr (std::is_same_v<T, ast::Condition>) {
            return has_units_inside(node.value);
          } else if constexpr (std::is_same_v<T, ast::Unknown>) {
            return has_units_inside(node.guess);
          } else if constexpr (std::is_same_v<T, ast::Force>) {
            return has_units_inside(node.value);
          } else if constexpr (std::is_same_v<T, ast::World>) {
            return has_units_in_world(node.items);
          } else if constexpr (std::is_same_v<T, ast::Family> || std::is_same_v<T, ast::Mode>) {
            return has_units(node.body);
          } else {
            return false;
          }
        },
        statement.node);
  });
}

void stated_time_unit(TimeUnit& time, const ast::Unit& text, Report& report) {
  const auto unit = unit_of(text, report);
  if (!unit) return;
  if (convertible(*unit, *parse_unit("s")) || !time.model_has_units) {
    time.unit = unit;
  } else {
    report.fail("E201", text.span, "units do not match", fmt::format("time cannot be in {}", to_text(*unit)),
                "a unit of time, as in run 0..60 [s]");
  }
}

}  // namespace

Measured TimeUnit::per_time(const Measured& measured, int times) const {
  if (!measured.is_known() || !unit) return Measured::unknown();
  Unit result = measured.unit;
  for (int i = 0; i < times; ++i) result = result / *unit;
  for (int i = times; i < 0; ++i) result = result * *unit;
  return Measured::known(std::move(result));
}

TimeUnit find_time_unit(const ast::Model& tree, Report& report) {
  TimeUnit time;
  time.model_has_units = has_units(tree.statements);
  for (const ast::Statement& statement : tree.statements) {
    const auto* run = std::get_if<ast::Run>(&statement.node);
    if (!run || !run->interval) continue;
    if (run->interval->unit) stated_time_unit(time, *run->interval->unit, report);
    const auto* last = std::get_if<ast::Quantity>(&run->interval->last->node);
    if (last && !run->interval->unit) stated_time_unit(time, last->unit, report);
    break;
  }
  if (time.model_has_units && !time.unit) time.unit = *parse_unit("s");
  return time;
}

std::optional<Unit> unit_of(const ast::Unit& unit, Report& report) {
  Result<Unit> parsed = parse_unit(unit.text);
  if (parsed) return *std::move(parsed);
  const std::string suggestion = suggested_unit(unit.text);
  report.fail("E203", unit.span, "this is not a unit", parsed.status().message,
              suggestion.empty() ? std::string() : fmt::format("did you mean [{}]?", suggestion));
  return std::nullopt;
}

}  // namespace continuo::model::detail
