// Triangles from Wavefront OBJ files, as modelling programs write them.
//
//   const Result<TriangleMesh<double>> hills = read_wavefront("hills.obj");
//   if (!hills) std::cerr << describe(hills.status());   // "hills.obj:12: corner 9 of 8"
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <continuo/shapes/mesh_shape.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// A file of more triangles is refused.
inline constexpr std::size_t most_wavefront_triangles = 1'000'000;

/// The faces of all objects in a text, `name` being what messages call it: of lines `v x y z` and `f a b c ...`, with
/// corners counted from 1, or from -1 backwards, as a, a/b, a//c or a/b/c. Polygons are cut into triangles, also those
/// that are not convex; all other lines are without meaning here. A failure is unreadable, its place "name:line": where
/// a number is none or is not finite, a face has less than three corners, one that is not there, or no area, crosses
/// itself, or has more than 200 corners, and where there are no faces or too many.
[[nodiscard]] Result<TriangleMesh<double>> parse_wavefront(std::string_view text, const std::string& name);
/// The same from a file.
[[nodiscard]] Result<TriangleMesh<double>> read_wavefront(const std::filesystem::path& file);

}  // namespace continuo
