// Shapes of bodies, static meshes, and the outlines of bodies for display.
#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "bound_world.hpp"
#include <continuo/worlds/world_shapes.hpp>

namespace py = pybind11;

namespace continuo::python {

namespace {

template <int Dim>
ShapePart<double, Dim> part_from(const py::tuple& form) {
  using B = BoundWorld<Dim>;
  ShapePart<double, Dim> part;
  std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<decltype(shape), const Compound<double, Dim>&>) {
          throw py::value_error("a part of a compound is no compound");
        } else {
          part.shape = shape;
        }
      },
      shape_from<Dim>(form[0].cast<py::tuple>()));
  part.position = B::vector(form[1].cast<Array>(), "position of a part");
  part.orientation = B::orientation(form[2].cast<Array>(), "orientation of a part");
  return part;
}

/// A mesh as continuo/shapes.py writes it.
template <int Dim>
MeshShape<double, Dim> mesh_from(const py::tuple& form) {
  using B = BoundWorld<Dim>;
  const auto kind = form[0].cast<std::string>();
  if (kind == "height_field") {
    HeightField<double, Dim> field;
    field.origin = B::vector(form[1].cast<Array>(), "origin");
    const auto spacing = form[2].cast<Array>(), heights = form[3].cast<Array>();
    if (spacing.ndim() != 1 || spacing.shape(0) != Dim - 1 || heights.ndim() != Dim - 1)
      throw py::value_error(fmt::format("heights must have {} dimension{}", Dim - 1, Dim == 2 ? "" : "s"));
    std::size_t axis = 0;
    for (double& one : field.spacing) one = spacing.data()[axis++];
    // Rows of NumPy are along the last axis; the first one counts fastest here.
    for (std::size_t k = 0; k < Dim - 1; ++k)
      field.counts[k] = static_cast<std::uint32_t>(heights.shape(static_cast<py::ssize_t>(k)));
    const std::size_t rows = field.counts[0], columns = Dim == 2 ? 1 : field.counts[Dim - 2];
    for (std::size_t j = 0; j < columns; ++j)
      for (std::size_t i = 0; i < rows; ++i) field.heights.push_back(heights.data()[i * columns + j]);
    return field;
  }
  if constexpr (Dim == 2) {
    if (kind != "chain") throw py::value_error("triangles exist in space only");
    Chain<double> chain{.points = B::vectors(form[1].cast<Array>(), "points")};
    chain.is_loop = form[2].cast<bool>(), chain.is_two_sided = form[3].cast<bool>();
    if (!form[4].is_none()) chain.before = B::vector(form[4].cast<Array>(), "before");
    if (!form[5].is_none()) chain.after = B::vector(form[5].cast<Array>(), "after");
    return chain;
  } else {
    if (kind != "triangles") throw py::value_error("chains exist in the plane only");
    TriangleMesh<double> mesh{.corners = B::vectors(form[1].cast<Array>(), "corners")};
    const auto triangles = form[2].cast<py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>>();
    if (triangles.ndim() != 2 || triangles.shape(1) != 3) throw py::value_error("triangles must have the shape (N, 3)");
    const std::uint32_t* at = triangles.data();
    for (py::ssize_t k = 0; k < triangles.shape(0); ++k, at += 3) mesh.triangles.push_back({at[0], at[1], at[2]});
    mesh.is_two_sided = form[3].cast<bool>();
    return mesh;
  }
}

/// The convex hull of points of the plane, counter-clockwise (A. M. Andrew, Inf. Proc. Letters 9 (1979)).
std::vector<Vector<double, 2>> hull_of(std::vector<Vector<double, 2>> points) {
  std::ranges::sort(points, {}, [](const auto& at) { return std::pair(at[0], at[1]); });
  std::vector<Vector<double, 2>> hull;
  const auto add = [&](const Vector<double, 2>& at, std::size_t least) {
    const auto turns_right = [&] {
      const auto last = hull.back() - hull[hull.size() - 2], next = at - hull.back();
      return last[0] * next[1] - last[1] * next[0] <= 0;
    };
    while (hull.size() > least && turns_right()) hull.pop_back();
    hull.push_back(at);
  };
  for (const auto& at : points) add(at, 1);
  const std::size_t lower = hull.size();
  for (std::size_t k = points.size() - 1; k-- > 0;) add(points[k], lower);
  hull.pop_back();
  return hull;
}

/// What is seen of a body along the middle axis, the outline of each of its parts; none of a ball.
template <int Dim>
py::list outlines_of(const World<double, Dim>& world, std::size_t i) {
  py::list outlines;
  if (world.solid(i) == nullptr) return outlines;
  const Pose<double, Dim> pose{world.position[i], rotation(world.orientation[i])};
  for (const SolidPart<double, Dim>& part : world.solid(i)->parts) {
    Solid<double, Dim> alone;
    alone.parts = {part};
    std::vector<Vector<double, 2>> seen;
    for (const worlds::Point& corner : worlds::form_of(alone).corners) {
      Vector<double, Dim> at;
      for (std::size_t axis = 0; axis < at.size(); ++axis) at[axis] = corner[axis];
      const Vector<double, Dim> place = pose.place(at);
      seen.push_back({{place[0], place[Dim - 1]}});
    }
    const auto hull = hull_of(std::move(seen));
    py::array_t<double> outline({static_cast<py::ssize_t>(hull.size()), py::ssize_t{2}});
    for (std::size_t k = 0; k < hull.size(); ++k)
      for (py::ssize_t axis = 0; axis < 2; ++axis)
        outline.mutable_at(static_cast<py::ssize_t>(k), axis) = hull[k][static_cast<std::size_t>(axis)];
    outlines.append(outline);
  }
  return outlines;
}

}  // namespace

template <int Dim>
Shape<double, Dim> shape_from(const py::tuple& form) {
  using B = BoundWorld<Dim>;
  const auto kind = form[0].cast<std::string>();
  if (kind == "sphere") return Sphere<double>{form[1].cast<double>()};
  if (kind == "capsule") return Capsule<double>{form[1].cast<double>(), form[2].cast<double>()};
  if (kind == "box") {
    Box<double, Dim> box;
    box.size = B::vector(form[1].cast<Array>(), "size of a box");
    box.rounding = form[2].cast<double>();
    return box;
  }
  if (kind == "hull") {
    Hull<double, Dim> hull;
    hull.points = B::vectors(form[1].cast<Array>(), "points of a hull");
    hull.rounding = form[2].cast<double>();
    return hull;
  }
  Compound<double, Dim> compound;
  for (const py::handle part : form[1]) compound.parts.push_back(part_from<Dim>(part.cast<py::tuple>()));
  return compound;
}

template <int Dim>
void bind_shapes(WorldClass<Dim>& world) {
  using B = BoundWorld<Dim>;
  using P = typename B::Pointer;
  world
      .def("add_mesh",
           [](const P& m, const py::tuple& form, std::array<double, 3> material, std::uint64_t category,
              std::uint64_t mask) {
             return number_of(answer(B::idle(m).forces().add_mesh({.shape = mesh_from<Dim>(form),
                                                                   .material = {material[0], material[1], material[2]},
                                                                   .category = category,
                                                                   .mask = mask})));
           })
      .def("remove_mesh",
           [](const P& m, std::uint64_t mesh) {
             if (!B::idle(m).forces().remove_mesh(handle_of<MeshHandle>(mesh)))
               throw py::key_error("there is no such mesh: it was removed, or is of another world");
           })
      .def("outlines", [](const P& m, std::size_t i) { return outlines_of<Dim>(B::idle(m).world(), i); })
      .def("origins", [](const P& m) {
        const auto& of = B::idle(m).world();
        py::array_t<double> origins({static_cast<py::ssize_t>(of.size()), py::ssize_t{Dim}});
        for (std::size_t i = 0; i < of.size(); ++i)
          for (std::size_t axis = 0; axis < Dim; ++axis)
            origins.mutable_at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(axis)) = of.origin(i)[axis];
        return origins;
      });
}

template Shape<double, 2> shape_from(const py::tuple&);
template Shape<double, 3> shape_from(const py::tuple&);
template void bind_shapes(WorldClass<2>&);
template void bind_shapes(WorldClass<3>&);

}  // namespace continuo::python
