// Meshes of triangles and chains of segments: `wall hills mesh "hills.obj"`, `wall track chain (0, 0) (4, 0) (6, 1)`.
#pragma once
#include <continuo/language/check/world/turns.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

class Meshes {
 public:
  Meshes(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work),
        turns_(expressions, work) {}

  void add(const ast::WorldMesh& mesh, Scope& scope, Span span);

 private:
  [[nodiscard]] bool fits_dimension(const ast::WorldMesh& mesh) const;
  void refuse_rolling(const ast::WorldMesh& mesh, const MeshDescription& made, Span span) const;
  void read_points(const ast::WorldMesh& mesh, MeshDescription& made, Scope& scope) const;
  [[nodiscard]] bool add_point(const ast::Expression& text, MeshDescription& made, Scope& scope) const;
  void read_chain(const std::string& file, MeshDescription& made, Span span) const;
  void read_triangles(const std::string& file, MeshDescription& made, Span span) const;
  void make_heights(const ast::WorldMesh& mesh, MeshDescription& made, Scope& scope) const;  // heights.cpp
  void read_heights(const std::string& file, const ast::WorldMesh& mesh, MeshDescription& made) const;
  [[nodiscard]] std::optional<double> factor_of(const std::string& unit, std::string_view column, Span span) const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
  Turns turns_;
};

}  // namespace continuo::model::detail
