// continuo/language/check/world/bodies.hpp
// Bodies one by one and by pattern: what they are and where they begin.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/body_shapes.hpp>
#include <continuo/language/check/world/turns.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

/// Adds them to the world and gives their states initial values.
class Bodies {
 public:
  Bodies(Expressions& expressions, WorldAtWork& work, std::vector<State>& states)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        states_(states),
        numbers_(expressions, work),
        shapes_(expressions, work),
        turns_(expressions, work) {}

  void make();

 private:
  void make_body(const BodyText& body);
  void make_pattern(const PatternText& pattern);
  void find_parts();  // compounds.cpp
  [[nodiscard]] MadeShape make_compound(const BodyText& body, const std::vector<const Placed<ast::WorldItem>*>& parts);
  template <int Dim>
  [[nodiscard]] MadeShape measured_compound(ShapeDescription shape, Span span);
  [[nodiscard]] std::optional<PartDescription> part_of(const ast::WorldAttributes& attributes, Scope& scope,
                                                       bool has_place);
  [[nodiscard]] TraitsDescription traits_of(const ast::WorldAttributes& attributes, Scope& scope);
  [[nodiscard]] BodyDescription description_of(const ast::WorldAttributes& attributes, const MadeShape& made,
                                               Scope& scope);
  [[nodiscard]] std::uint32_t group_of(const ast::WorldAttributes& attributes);
  [[nodiscard]] NodePoint velocity_of(const ast::WorldAttributes& attributes, Scope& scope);
  void set_start(std::size_t body, const NodePoint& position, const NodePoint& velocity, const Turn& turn);
  void place_grid(const PatternText& pattern, const NodePoint& velocity, const Turn& turn);
  void place_random(const PatternText& pattern, const NodePoint& velocity, const Turn& turn);
  void place_stack(const PatternText& pattern, NodeId height, const NodePoint& velocity, const Turn& turn);

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  std::vector<State>& states_;
  WorldNumbers numbers_;
  BodyShapes shapes_;
  Turns turns_;
  std::map<std::size_t, std::vector<const Placed<ast::WorldItem>*>> parts_;  // of bodies that are compounds
};

}  // namespace continuo::model::detail
