// continuo/symbolic/units/unit_check.hpp
// What a subexpression measures, and what operations make of it. Every one has one of three kinds:
//   number    a literal, or made of literals only: fits any unit in + and comparisons, a pure number in * and /
//   unknown   something with a name declared without unit in it: contagious, never an error
//   known     it has this unit
#pragma once
#include <optional>

#include <continuo/symbolic/units/units.hpp>

namespace continuo::model::detail {

struct Measured {
  enum class Kind : unsigned char { number, unknown, known };
  Kind kind = Kind::unknown;
  Unit unit{};  // of a known one

  [[nodiscard]] static Measured number() { return {Kind::number, {}}; }
  [[nodiscard]] static Measured unknown() { return {Kind::unknown, {}}; }
  [[nodiscard]] static Measured known(Unit unit) { return {Kind::known, std::move(unit)}; }
  [[nodiscard]] bool is_number() const { return kind == Kind::number; }
  [[nodiscard]] bool is_known() const { return kind == Kind::known; }
};

[[nodiscard]] Measured product(const Measured& a, const Measured& b);
[[nodiscard]] Measured quotient(const Measured& a, const Measured& b);
/// Of a sum or a choice whose sides fit each other.
[[nodiscard]] Measured common(const Measured& a, const Measured& b);
/// The factor that brings a number of `from` to the unit of `to`: 1 where one of them is not known, empty where both
/// are and do not fit.
[[nodiscard]] std::optional<double> factor_between(const Measured& from, const Measured& to);

}  // namespace continuo::model::detail
