// Questions about the present state of a world: rays, many at once, regions, shapes that move, and a character that
// walks.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "bound_world.hpp"
#include <continuo/bodies/character.hpp>
#include <continuo/bodies/queries.hpp>

namespace py = pybind11;

namespace continuo::python {

namespace {

template <int Dim>
class Questions {
 public:
  using B = BoundWorld<Dim>;
  using P = typename B::Pointer;
  using Q = Queries<double, Dim>;

  static Q index(const P& moving) { return Q(B::idle(moving).world()); }

  /// The fields of a RayHit in world.py.
  static py::tuple told(const RayHit<double, Dim>& hit) {
    const auto number = [](bool is_it, std::uint64_t value) {
      return is_it ? py::object(py::int_(value)) : py::object(py::none());
    };
    return py::make_tuple(
        number(!hit.is_wall() && !hit.is_mesh(), hit.is_wall() || hit.is_mesh() ? 0 : number_of(hit.body)),
        number(hit.is_wall(), hit.wall), hit.distance, B::array(hit.point), B::array(hit.normal),
        number(hit.is_mesh(), hit.mesh));
  }
  static py::list told(const std::vector<RayHit<double, Dim>>& hits) {
    py::list all;
    for (const auto& hit : hits) all.append(told(hit));
    return all;
  }
  static py::list ray(const P& moving, const Array& origin, const Array& direction, double reach, bool all) {
    const Q queries = index(moving);
    const Ray<double, Dim> ray{B::vector(origin, "origin"), B::vector(direction, "direction"), reach};
    return told(answer(all ? queries.all_hits(ray) : queries.first_hit(ray)));
  }
  /// The first hit of each ray, as arrays; no body, wall or mesh is -1.
  static py::tuple first_hits(const P& moving, const Array& origins, const Array& directions, double reach,
                              int threads) {
    const auto from = B::vectors(origins, "origin"), along = B::vectors(directions, "direction");
    std::vector<Ray<double, Dim>> rays;
    for (std::size_t i = 0; i < from.size(); ++i) rays.push_back({from[i], along[i], reach});
    const auto hits = answer(index(moving).first_hits(rays, {}, threads));
    const auto n = static_cast<py::ssize_t>(hits.size());
    py::array_t<std::int64_t> body(n), wall(n), mesh(n);
    py::array_t<double> distance(n), point({n, py::ssize_t{Dim}}), normal({n, py::ssize_t{Dim}});
    for (py::ssize_t i = 0; i < n; ++i) {
      const RayHit<double, Dim>& hit = hits[static_cast<std::size_t>(i)];
      const bool is_body = !hit.is_wall() && !hit.is_mesh() && std::isfinite(hit.distance);
      body.mutable_at(i) = is_body ? static_cast<std::int64_t>(number_of(hit.body)) : -1;
      wall.mutable_at(i) = hit.is_wall() ? static_cast<std::int64_t>(hit.wall) : -1;
      mesh.mutable_at(i) = hit.is_mesh() ? static_cast<std::int64_t>(hit.mesh) : -1;
      distance.mutable_at(i) = hit.distance;
      for (py::ssize_t k = 0; k < Dim; ++k) {
        point.mutable_at(i, k) = hit.point[static_cast<std::size_t>(k)];
        normal.mutable_at(i, k) = hit.normal[static_cast<std::size_t>(k)];
      }
    }
    return py::make_tuple(body, wall, distance, point, normal, mesh);
  }
  static py::tuple touched(const Overlap& overlap, bool with_meshes) {
    std::vector<std::uint64_t> bodies;
    for (const BodyHandle body : overlap.bodies) bodies.push_back(number_of(body));
    if (with_meshes) return py::make_tuple(bodies, overlap.walls, overlap.meshes);
    return py::make_tuple(bodies, overlap.walls);
  }
  static PlacedShape<double, Dim> placed(const py::tuple& form, const Array& position, const Array& orientation) {
    return {.shape = shape_from<Dim>(form),
            .position = B::vector(position, "position"),
            .orientation = B::orientation(orientation, "orientation")};
  }
  static py::list near(const P& moving, const py::tuple& form, const Array& position, const Array& orientation,
                       double reach) {
    py::list found;
    for (const auto& one : answer(index(moving).near_shape(placed(form, position, orientation), reach))) {
      RayHit<double, Dim> as_hit{.body = one.body, .wall = one.wall, .mesh = one.mesh};
      as_hit.distance = one.distance, as_hit.point = one.point, as_hit.normal = one.normal;
      found.append(told(as_hit));
    }
    return found;
  }
  static py::list nearest(const P& moving, const Array& point, std::size_t count) {
    py::list found;
    for (const auto& neighbour : answer(index(moving).nearest(B::vector(point, "point"), count)))
      found.append(py::make_tuple(number_of(neighbour.body), neighbour.distance));
    return found;
  }
  /// A character is the fields of Character in world.py.
  static py::tuple walk(const P& moving, const py::tuple& fields, const Array& velocity, double duration,
                        std::array<double, 6> sizes) {
    const auto& world = B::idle(moving).world();
    Character<double, Dim> character{.position = B::vector(fields[0].cast<Array>(), "position"),
                                     .rise = fields[1].cast<double>(),
                                     .is_on_ground = fields[2].cast<bool>()};
    if (!fields[3].is_none()) character.normal = B::vector(fields[3].cast<Array>(), "normal");
    if (!fields[4].is_none()) {
      character.ground = handle_of(fields[4].cast<std::uint64_t>());
      character.local_foot = B::vector(fields[5].cast<Array>(), "local_foot");
      character.foot = B::vector(fields[6].cast<Array>(), "foot");
    }
    const CharacterOptions<double> options{.radius = sizes[0],
                                           .height = sizes[1],
                                           .steepest = sizes[2],
                                           .highest_step = sizes[3],
                                           .skin = sizes[4],
                                           .fall_acceleration = sizes[5]};
    const auto after =
        answer(continuo::walk(world, index(moving), character, B::vector(velocity, "velocity"), duration, options));
    const bool has_ground = after.ground != BodyHandle{};
    return py::make_tuple(B::array(after.position), after.rise, after.is_on_ground, B::array(after.normal),
                          has_ground ? py::object(py::int_(number_of(after.ground))) : py::object(py::none()),
                          B::array(after.local_foot), B::array(after.foot));
  }
};

}  // namespace

template <int Dim>
void bind_queries(WorldClass<Dim>& world) {
  using Of = Questions<Dim>;
  using B = BoundWorld<Dim>;
  using P = typename B::Pointer;
  world.def("ray", &Of::ray)
      .def("first_hits", &Of::first_hits)
      .def("in_sphere",
           [](const P& m, const Array& centre, double radius) {
             return Of::touched(answer(Of::index(m).in_sphere(B::vector(centre, "centre"), radius)), false);
           })
      .def("in_box",
           [](const P& m, const Array& lower, const Array& upper) {
             return Of::touched(answer(Of::index(m).in_box(B::vector(lower, "lower"), B::vector(upper, "upper"))),
                                false);
           })
      .def("in_shape",
           [](const P& m, const py::tuple& form, const Array& position, const Array& orientation) {
             return Of::touched(answer(Of::index(m).in_shape(Of::placed(form, position, orientation))), true);
           })
      .def("first_contact",
           [](const P& m, const py::tuple& form, const Array& position, const Array& orientation, const Array& way) {
             return Of::told(
                 answer(Of::index(m).first_contact(Of::placed(form, position, orientation), B::vector(way, "way"))));
           })
      .def("near_shape", &Of::near)
      .def("nearest", &Of::nearest)
      .def("walk", &Of::walk);
}

template void bind_queries(WorldClass<2>&);
template void bind_queries(WorldClass<3>&);

}  // namespace continuo::python
