// Where a mesh has corners of a file, they are numbers; the points of a chain in the text are expressions.
#include <string>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/declarations/files.hpp>
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/materials.hpp>
#include <continuo/language/check/world/meshes.hpp>

namespace continuo::model::detail {

void Meshes::add(const ast::WorldMesh& mesh, Scope& scope, Span span) {
  if (!fits_dimension(mesh)) return;
  const NodeId zero = graph_.constant(0);
  MeshDescription made{.name = {},
                       .is_closed = attribute(mesh.attributes, "closed") != nullptr,
                       .thin = attribute(mesh.attributes, "thin") != nullptr,
                       .position = {zero, zero, zero},
                       .orientation = turns_.turn_of(mesh.attributes, scope).orientation,
                       .scale = graph_.constant(1),
                       .material = material_of(mesh.attributes, scope, work_, numbers_),
                       .span = span};
  made.name =
      mesh.name ? mesh.name->text : fmt::format("wall {}", work_.made.walls.size() + work_.made.meshes.size() + 1);
  if (const ast::Expression* at = attribute(mesh.attributes, "at"))
    made.position = numbers_.point(*at, scope, work_.length, "the place of a mesh");
  if (const ast::Expression* scale = attribute(mesh.attributes, "scale"))
    made.scale = numbers_.number(*scale, scope, Measured::known(Unit()), "the scale", Sort::positive);
  for (NodeId* node : {&made.position[0], &made.position[1], &made.position[2], &made.orientation[0],
                       &made.orientation[1], &made.orientation[2], &made.orientation[3], &made.scale})
    if (!node->valid()) *node = zero;  // said already: what is wrong is no mesh, but has a name
  refuse_rolling(mesh, made, span);
  if (const auto* file = std::get_if<ast::Text>(&mesh.corners.node)) {
    mesh.kind.text == "chain"     ? read_chain(file->value, made, mesh.corners.span)
    : mesh.kind.text == "heights" ? read_heights(file->value, mesh, made)
                                  : read_triangles(file->value, made, mesh.corners.span);
  } else if (mesh.kind.text == "heights") {
    make_heights(mesh, made, scope);
  } else {
    read_points(mesh, made, scope);
  }
  work_.made.meshes.push_back(std::move(made));
}

bool Meshes::fits_dimension(const ast::WorldMesh& mesh) const {
  const bool is_chain = mesh.kind.text == "chain", plane = text_.dimension == 2;
  if (is_chain == plane) return true;
  report_.fail("E227", mesh.kind.span,
               is_chain                   ? "a chain is ground of the plane"
               : mesh.kind.text == "mesh" ? "a mesh is ground of space"
                                          : "heights over a grid are ground of space",
               fmt::format("the world has {} dimensions", text_.dimension),
               plane ? "write `dimension 3` in the world, or a chain: wall ground chain (0, 0) (4, 0) (6, 1)"
                     : "in space ground is a mesh of triangles: wall ground mesh \"hills.obj\"");
  return false;
}

/// The motion of meshes has none: said here, and not in the middle of a run.
void Meshes::refuse_rolling(const ast::WorldMesh& mesh, const MeshDescription& made, Span span) const {
  const ast::Expression* text = attribute(mesh.attributes, "rolling");
  const auto value = made.material.rolling.valid() ? graph_.value(made.material.rolling) : std::nullopt;
  if (!text && value == 0.0) return;
  report_.fail("E225", text ? text->span : span, "there is no rolling resistance in a world with meshes or chains", {},
               text ? "leave `rolling` out" : "leave `rolling` out of `material`");
}

void Meshes::read_points(const ast::WorldMesh& mesh, MeshDescription& made, Scope& scope) const {
  bool are_good = true;
  const auto add_all = [&](Scope& inner) {
    for (const ast::Expression& text : std::get<ast::List>(mesh.corners.node).items)
      are_good = are_good && add_point(text, made, inner);
  };
  if (!mesh.families.empty()) {
    const auto& [index, range] = mesh.families.front();
    are_good =
        expressions_.indices.for_each_index(index, range, scope, [&](std::size_t) { add_all(scope); }) && are_good;
  } else {
    add_all(scope);
  }
  const std::size_t needed = made.is_closed ? 3 : 2;
  if (are_good && made.points.size() < needed)
    report_.fail("E225", mesh.corners.span,
                 fmt::format("a{} chain has {} points or more", made.is_closed ? " closed" : "", needed),
                 fmt::format("here {} {}", made.points.size() == 1 ? "is" : "are", made.points.size()),
                 "as in chain (0, 0) (4, 0) (6, 1)");
}

bool Meshes::add_point(const ast::Expression& text, MeshDescription& made, Scope& scope) const {
  const NodePoint point = numbers_.point(text, scope, work_.length, "a point of a chain");
  if (!point[0].valid() || !point[1].valid()) return false;
  if (!made.points.empty()) {
    const NodePoint& last = made.points.back();
    const NodeId way =
        graph_.apply(Op::hypotenuse, graph_.subtract(point[0], last[0]), graph_.subtract(point[1], last[1]));
    numbers_.expect(way, Sort::positive, text.span, "the way from the point before");
  }
  made.points.push_back(point);
  return true;
}

void Meshes::read_chain(const std::string& file, MeshDescription& made, Span span) const {
  const auto columns = points_of_chain(file, span, report_);
  if (!columns) return;
  const auto& [x, y] = *columns;
  const auto of_x = factor_of(x.unit, "x", span), of_y = factor_of(y.unit, "y", span);
  if (!of_x || !of_y) return;
  for (std::size_t i = 0; i < x.values.size(); ++i)
    made.corners.push_back({x.values[i] * *of_x, y.values[i] * *of_y, 0});
}

/// What a number of this unit is in the world's unit of length; E201 where it is no length.
std::optional<double> Meshes::factor_of(const std::string& unit, std::string_view column, Span span) const {
  if (unit.empty()) return 1;
  const auto stated = parse_unit(unit);
  const auto factor =
      stated ? factor_between(Measured::known(*stated), work_.length) : std::optional<double>(std::nullopt);
  if (factor && work_.length.is_known()) return factor;
  report_.fail("E201", span, "units do not match",
               fmt::format("the column `{}` is in {}, a length is {}", column, unit, unit_text(work_.length)));
  return std::nullopt;
}

void Meshes::read_triangles(const std::string& file, MeshDescription& made, Span span) const {
  auto read = triangles_of(file, span, report_);
  if (!read) return;
  made.corners.reserve(read->corners.size());
  for (const Vector<double, 3>& corner : read->corners) made.corners.push_back(corner.components);
  made.triangles = std::move(read->triangles);
}

}  // namespace continuo::model::detail
