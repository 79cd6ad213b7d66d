// continuo/language/check/world/world_declarations.hpp
// The bodies of a world by name, and the states they make.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/world.hpp>

namespace continuo::model::detail {

/// Fills Declarations::world but for its forces, and adds the bases of bodies.
class WorldDeclarations {
 public:
  WorldDeclarations(Declarations& declared, Expressions& expressions)
      : declared_(declared), world_(declared.world), expressions_(expressions), report_(expressions.report) {}

  /// Their states are the first of the model.
  void declare(const ast::Model& tree);
  /// `world.kinetic`, `door.torque` and their like, behind the states of the equations.
  void declare_measures();

 private:
  void find_world(const ast::Model& tree);
  void read_dimension(Scope& scope);
  void declare_items(const std::vector<ast::WorldItem>& items, Scope& scope);
  [[nodiscard]] bool declare_body(const std::string& name, std::span<const long> indices, Span span);
  void declare_pattern(const ast::WorldBodies& bodies, Scope& scope, Span span);
  void declare_joint(const ast::WorldJoint& joint, Scope& scope, Span span);
  void add_measure(const std::string& name, std::string_view family, Span span);
  void add_base(const std::string& name, std::string_view family, int order, Span span);

  Declarations& declared_;
  WorldText& world_;
  Expressions& expressions_;
  Report& report_;
};

}  // namespace continuo::model::detail
