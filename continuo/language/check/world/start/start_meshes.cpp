// Bodies are sorted along the first axis, so that a facet is held only against those above and below it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/check/world/start/start_meshes.hpp>
#include <continuo/language/described_mesh.hpp>
#include <continuo/shapes/mesh_check.hpp>

namespace continuo::model::detail {

namespace {

template <int Dim>
using Corners = std::array<Vector<double, Dim>, static_cast<std::size_t>(Dim)>;

std::vector<Corners<2>> facets_of(const Chain<double>& chain) {
  std::vector<Corners<2>> facets;
  const std::size_t n = chain.points.size();
  for (std::size_t i = 0; i + (chain.is_loop ? 0 : 1) < n; ++i)
    facets.push_back({chain.points[i], chain.points[(i + 1) % n]});
  return facets;
}
std::vector<Corners<3>> facets_of(const TriangleMesh<double>& mesh) {
  std::vector<Corners<3>> facets;
  for (const auto& [a, b, c] : mesh.triangles) facets.push_back({mesh.corners[a], mesh.corners[b], mesh.corners[c]});
  return facets;
}

Vector<double, 2> across(const Corners<2>& facet) {
  const Vector<double, 2> along = facet[1] - facet[0];
  return {{along[1], -along[0]}};
}
Vector<double, 3> across(const Corners<3>& facet) {
  return moment(facet[1] - facet[0], facet[2] - facet[0]);
}

/// How far a point falls along a unit vector to a facet, and whether it comes from the free side; nothing where it
/// passes beside.
struct Fall {
  double way;
  bool to_front;
};
template <int Dim>
std::optional<Fall> fall(const Vector<double, Dim>& from, const Vector<double, Dim>& down, const Corners<Dim>& facet) {
  const Vector<double, Dim> normal = across(facet);
  const double rate = -dot(normal, down), way = dot(normal, Vector<double, Dim>(from - facet[0])) / rate;
  if (!(std::abs(rate) > 0) || !(way >= 0)) return std::nullopt;
  const Vector<double, Dim> hit = from + down * way;
  for (std::size_t k = 0; k < facet.size(); ++k) {  // with the point in place of a corner it keeps its direction
    Corners<Dim> part = facet;
    part[k] = hit;
    if (dot(across(part), normal) < 0) return std::nullopt;
  }
  return Fall{way, rate > 0};
}

template <int Dim>
class MeshAtStart {
 public:
  using V = Vector<double, Dim>;

  MeshAtStart(const WorldDescription& made, const MeshDescription& mesh, const StartShapes& starts, Report& report)
      : made_(made), mesh_(mesh), starts_(starts), report_(report) {}

  void look(const MeshShape<double, Dim>& shape, const V& gravity) {
    std::visit(
        [&](const auto& surface) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(surface)>, HeightField<double, Dim>>) {
            if (const Status fault = check(surface); !fault) {
              report_.fail("E225", mesh_.span, fmt::format("`{}` cannot be ground", mesh_.name), fault.message);
              return;
            }
            facets_ = facets_of(surface);
          }
        },
        shape);
    look_within();
    if (!mesh_.thin && length(gravity) > 0) look_behind(gravity * (1 / length(gravity)));
  }

 private:
  V centre(std::size_t body) const {
    V x;
    for (std::size_t axis = 0; axis < x.size(); ++axis) x[axis] = starts_.centre[body][axis];
    return x;
  }

  void look_within() {
    std::vector<std::size_t> order(made_.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t i) { return made_.bodies[i].is_unstoppable(); });
    const auto place = [&](std::size_t i) { return starts_.centre[i][0]; };
    std::ranges::sort(order, {}, place);
    double reach = 0;
    for (const std::size_t i : order) reach = std::max(reach, starts_.radius[i]);
    std::vector<double> depth(made_.bodies.size());
    for (const Corners<Dim>& facet : facets_) {
      const auto [low, high] = std::ranges::minmax(facet, {}, [](const V& corner) { return corner[0]; });
      auto at = std::ranges::lower_bound(order, low[0] - reach, {}, place);
      for (; at != order.end() && place(*at) <= high[0] + reach; ++at)
        if (is_near(*at, facet)) depth[*at] = std::max(depth[*at], starts_.depth_in_facet<Dim>(*at, facet));
    }
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < depth.size(); ++i)
      if (depth[i] > least_depth * starts_.radius[i]) found.push_back(i);
    if (found.empty()) return;
    const BodyDescription& body = made_.bodies[found.front()];
    report_.warn("E295", body.span, fmt::format("`{}` begins within `{}`", body.name, mesh_.name),
                 fmt::format("by {:.3g}{}", depth[found.front()],
                             found.size() == 1 ? std::string() : fmt::format(", {} such in all", found.size())),
                 "leave room in front of it");
  }
  bool is_near(std::size_t body, const Corners<Dim>& facet) const {
    const V x = centre(body);
    for (std::size_t axis = 0; axis < x.size(); ++axis) {
      const auto [low, high] = std::ranges::minmax(facet, {}, [&](const V& corner) { return corner[axis]; });
      if (x[axis] + starts_.radius[body] < low[axis] || x[axis] - starts_.radius[body] > high[axis]) return false;
    }
    return true;
  }

  /// A body that falls to the back of a surface first falls through it. Of so much work at most: it is a warning.
  void look_behind(const V& down) {
    constexpr std::size_t most = 20'000'000;
    std::size_t work = 0;
    for (std::size_t i = 0; i < made_.bodies.size(); ++i) {
      const BodyDescription& body = made_.bodies[i];
      if (body.is_unstoppable()) continue;
      work += facets_.size();
      if (work > most) return;
      Fall nearest{std::numeric_limits<double>::infinity(), true};
      for (const Corners<Dim>& facet : facets_)
        if (const auto one = fall<Dim>(centre(i), down, facet); one && one->way < nearest.way) nearest = *one;
      if (nearest.to_front) continue;
      report_.warn("E295", body.span, fmt::format("`{}` falls through `{}`", body.name, mesh_.name),
                   Dim == 2 ? "it begins behind it: what is free is on the left of the way from point to point"
                            : "it begins behind it: what is free is where the corners go counter-clockwise",
                   Dim == 2 ? "write the points in the other order, or `thin`, which is free on both sides"
                            : "turn the mesh, or write `thin`, which is free on both sides");
      return;
    }
  }

  const WorldDescription& made_;
  const MeshDescription& mesh_;
  const StartShapes& starts_;
  Report& report_;
  std::vector<Corners<Dim>> facets_;
};

template <int Dim>
void look_at(const Model& model, const WorldDescription& made, const StartShapes& starts,
             std::span<const double> variables, Report& report) {
  const std::vector<double> gravity =
      evaluate(model, std::vector<NodeId>(made.gravity.begin(), made.gravity.begin() + Dim), variables);
  Vector<double, Dim> down;
  for (std::size_t axis = 0; axis < down.size(); ++axis) down[axis] = gravity[axis];
  for (const MeshDescription& mesh : made.meshes) {
    const std::vector<double> values = evaluate(model, mesh_nodes(mesh, Dim), variables);
    MeshAtStart<Dim>(made, mesh, starts, report).look(described_mesh<Dim>(mesh, values), down);
  }
}

}  // namespace

void look_at_meshes(const Model& model, const WorldDescription& made, const StartShapes& starts,
                    std::span<const double> variables, Report& report) {
  if (made.dimension == 2) return look_at<2>(model, made, starts, variables, report);
  look_at<3>(model, made, starts, variables, report);
}

}  // namespace continuo::model::detail
