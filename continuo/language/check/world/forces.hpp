// continuo/language/check/world/forces.hpp
// `force on`, `torque on`.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

/// After the equations: they may stand in a force.
class Forces {
 public:
  Forces(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work) {}

  /// E226 where a force, a motor or a derivative depends on a measure of the world.
  void make(const Model& model);

 private:
  void make_torque(const Placed<ast::Force>& torque, std::size_t body);
  void refuse_measures(const Model& model);
  /// What characters measure of themselves is known before each step: it may stand in what they wish.
  void refuse_measures(NodeId node, Span span, bool may_ask_characters = false);

  Expressions& expressions_;
  Report& report_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
