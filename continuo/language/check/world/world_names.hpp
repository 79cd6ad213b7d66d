// continuo/language/check/world/world_names.hpp
// `ball.x`, `ball.mass`, `world.kinetic` and queries in expressions.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_at_work.hpp>

namespace continuo::model::detail {

/// Also of a model without a world: then it says so.
class WorldNames : public WorldExpressions {
 public:
  WorldNames(const Declarations& declared, WorldAtWork& work) : declared_(declared), work_(work) {}

  [[nodiscard]] Value member(const ast::Name& name, Scope& scope, Expressions& expressions) const override;
  [[nodiscard]] bool is_query(const ast::Name& callee, const Scope& scope) const override;
  [[nodiscard]] Value query(const ast::Call& node, Span span, Scope& scope, Expressions& expressions) const override;

 private:
  [[nodiscard]] Value own_of_body(const ast::Name& name, std::size_t body, Scope& scope,
                                  Expressions& expressions) const;
  [[nodiscard]] Value no_member_of_joint(const ast::Name& name, std::size_t joint, Expressions& expressions) const;
  [[nodiscard]] Value no_member_of_world(const ast::Name& name, const std::string& key, Expressions& expressions) const;

  const Declarations& declared_;
  WorldAtWork& work_;
};

}  // namespace continuo::model::detail
