// continuo/language/check/names/time_unit.hpp
// In which unit time is.
#pragma once
#include <optional>
#include <string>

#include <continuo/language/check/names/report.hpp>
#include <continuo/language/syntax/ast.hpp>
#include <continuo/symbolic/units/unit_check.hpp>

namespace continuo::model::detail {

struct TimeUnit {
  std::optional<Unit> unit{};    // none: the model has no units that reach t
  bool model_has_units = false;  // else only the experiment may have them

  /// Of t in expressions: unknown where only the experiment has units.
  [[nodiscard]] Measured in_expressions() const { return model_has_units ? in_experiment() : Measured::unknown(); }
  /// Of times of the experiment and of events.
  [[nodiscard]] Measured in_experiment() const { return unit ? Measured::known(*unit) : Measured::unknown(); }
  /// Divided by the time unit so many times; multiplied where `times` is negative.
  [[nodiscard]] Measured per_time(const Measured& measured, int times = 1) const;
  [[nodiscard]] std::string text() const { return unit ? to_text(*unit) : std::string(); }
};

/// Before anything is translated: is t a quantity, and in which unit? The unit of `run`, else seconds.
[[nodiscard]] TimeUnit find_time_unit(const ast::Model& tree, Report& report);

/// E203 where the text is not a unit.
[[nodiscard]] std::optional<Unit> unit_of(const ast::Unit& unit, Report& report);

}  // namespace continuo::model::detail
