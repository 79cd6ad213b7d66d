// continuo/language/check/world/world_numbers.hpp
// Numbers and points of a world, each with its unit and what it may be.
#pragma once
#include <string_view>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_at_work.hpp>

namespace continuo::model::detail {

class WorldNumbers {
 public:
  WorldNumbers(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        text_(expressions.workspace.declared.world),
        work_(work) {}

  /// Of parameters; judged later. Not valid where it is wrong.
  [[nodiscard]] NodeId number(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                              std::string_view what, Sort sort) const;
  /// (1, 2); of parameters unless everything may stand in it.
  [[nodiscard]] NodePoint point(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                std::string_view what, bool parameters_only = true) const;
  /// (1, 2) along all axes but the last one; empty where it is wrong.
  [[nodiscard]] std::vector<NodeId> level(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                          std::string_view what, bool parameters_only = true) const;
  /// About an axis: in the plane one number, in space three.
  [[nodiscard]] NodeId in_plane(const ast::Expression& text, Scope& scope, const Measured& wanted,
                                std::string_view what) const;
  [[nodiscard]] NodePoint in_space(const ast::Expression& text, Scope& scope, const Measured& wanted,
                                   std::string_view what, bool parameters_only = true) const;
  /// The numbers of a point, each with the unit that stands behind the bracket; at least `count`.
  [[nodiscard]] std::vector<Term> components(const ast::Expression& expression, Scope& scope, std::size_t count) const;
  /// To be judged with the others.
  void expect(NodeId node, Sort sort, Span span, std::string what) const;
  /// Everything at once, with the parameters as written: what many bodies share is computed once.
  void judge(const Model& model) const;

 private:
  Expressions& expressions_;
  Report& report_;
  const WorldText& text_;
  WorldAtWork& work_;
};

}  // namespace continuo::model::detail
