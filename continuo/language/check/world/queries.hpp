// continuo/language/check/world/queries.hpp
// What is where in a world, as expressions of the places of its bodies: `distance(ball, wall)`, `within(ball, 0.5)`,
// `ray(car, (1, 0), 5)`. They are written out body by body, and so stand wherever expressions do: in outputs,
// conditions of events, forces, checks.
#pragma once
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/sight_lines.hpp>
#include <continuo/language/check/world/world_at_work.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

[[nodiscard]] bool is_query(std::string_view name);

class Queries {
 public:
  Queries(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work),
        lines_(expressions.workspace.graph, work.made, text_.dimension) {}

  [[nodiscard]] Value query(const ast::Call& node, Span span, Scope& scope) const;

 private:
  /// Who asks, and about what.
  using ThingPairs = std::vector<std::pair<Thing, Thing>>;

  [[nodiscard]] std::optional<ThingPairs> pairs_of(const ast::Call& node, std::size_t first, Span span,
                                                   Scope& scope) const;
  [[nodiscard]] bool replace_by_facets(std::vector<Thing>& things, Span span) const;
  [[nodiscard]] bool are_balls(const std::vector<Thing>& things, std::string_view query, Span span) const;
  [[nodiscard]] std::optional<std::vector<Thing>> things(const ast::Expression& text, Scope& scope) const;
  [[nodiscard]] std::optional<std::vector<Thing>> things_named(const ast::Name& name, Scope& scope) const;
  [[nodiscard]] Thing thing_of(std::size_t body) const;
  [[nodiscard]] Value least_gap(const ThingPairs& pairs) const;
  [[nodiscard]] Value count_within(const ThingPairs& pairs, const ast::Call& node, Scope& scope) const;
  [[nodiscard]] Value cast_ray(const ThingPairs& pairs, const ast::Call& node, Scope& scope) const;
  [[nodiscard]] Measured measure_of_direction(const ast::Expression& text, const Scope& scope) const;
  [[nodiscard]] NodeId length_in(const ast::Expression& text, Scope& scope, std::string_view what) const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
  SightLines lines_;
};

}  // namespace continuo::model::detail
