// continuo/language/check/expressions/values.hpp
// Expressions where something particular is wanted: a number, a condition, a constant, a time.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
class Operations;
class Report;
struct Workspace;

class Values {
 public:
  explicit Values(Expressions& expressions);

  /// The highest derivatives in it replaced by what they equal; before the equations are solved they stay.
  [[nodiscard]] Value settle(Value value, Span span, const std::vector<std::uint32_t>& highest) const;
  [[nodiscard]] Value number_of(const ast::Expression& expression, Scope& scope) const;     // settled, and no condition
  [[nodiscard]] Value condition_of(const ast::Expression& expression, Scope& scope) const;  // settled, and one
  /// A number that does not follow a parameter that changes later.
  [[nodiscard]] std::optional<double> constant(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                               std::string_view what) const;
  /// A number that may depend on parameters and follows them.
  [[nodiscard]] std::optional<Setting> setting(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                               std::string_view what) const;
  /// A time without unit is in the unit of the run.
  [[nodiscard]] std::optional<Setting> time_setting(const ast::Expression& expression, Scope& scope,
                                                    std::string_view what) const;
  bool only_parameters(NodeId node, Span span, std::string_view what, std::string help = {}) const;
  /// E281 where it is not; the end of the run decides, where it is known.
  void check_time_in_run(const Setting& time, Span span) const;

 private:
  [[nodiscard]] Value settled(const ast::Expression& expression, Scope& scope) const;

  Expressions& expressions_;
  Workspace& workspace_;
  Report& report_;
  const Operations& operations_;
};

[[nodiscard]] bool is_in_run(const Setting& time, const RunSettings& run);

}  // namespace continuo::model::detail
