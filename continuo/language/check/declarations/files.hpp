// continuo/language/check/declarations/files.hpp
// Files that a model names: tables, inputs over time, meshes and chains.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <continuo/language/check/names/report.hpp>
#include <continuo/shapes/mesh_shape.hpp>
#include <continuo/symbolic/graph/column.hpp>
#include <continuo/symbolic/graph/table.hpp>

namespace continuo::model::detail {

/// Relative to the folder of the model; E270 and empty where there is no such file. Where only files of that folder may
/// be read it is the name itself: `points_of` finds and reads the file in one.
[[nodiscard]] std::string file_of(const std::string& name, Span span, Report& report);
/// The column of this name where the file has one, else the second; E272 where it is no table. Of the folder of the
/// model alone, as the report's reach says, the messages quote nothing of the file.
[[nodiscard]] std::optional<Table> points_of(const std::string& file, Span span, Table::Between between,
                                             std::string_view column, Report& report);
/// The samples in the column of this name; E270 and E272 as above.
[[nodiscard]] std::optional<NamedColumn> column_of(const std::string& name, Span span, const std::string& column,
                                                   Report& report);
/// The columns `x` and `y` of a table, equally long; E270 and E272 as above.
[[nodiscard]] std::optional<std::array<NamedColumn, 2>> points_of_chain(const std::string& name, Span span,
                                                                        Report& report);
/// The columns `x`, `y` and `z` of a table, equally long; E270 and E272 as above.
[[nodiscard]] std::optional<std::array<NamedColumn, 3>> points_of_heights(const std::string& name, Span span,
                                                                          Report& report);
/// The triangles of a Wavefront OBJ file; E270 as above, E273 where it is none.
[[nodiscard]] std::optional<TriangleMesh<double>> triangles_of(const std::string& name, Span span, Report& report);

}  // namespace continuo::model::detail
