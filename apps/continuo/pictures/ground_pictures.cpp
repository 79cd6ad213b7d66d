// A convex body in front of the plane of a facet is hidden by no part of it, and one behind it hides none: the plane
// decides, and not the distance, by which a large facet under a body would often be nearer than the body.
#include <algorithm>
#include <cmath>
#include <string>

#include <apps/continuo/pictures/ground_pictures.hpp>
#include <apps/continuo/pictures/lit_color.hpp>
#include <fmt/format.h>

namespace continuo::app {

using worlds::dot, worlds::Point;

namespace {

/// Whether a triangle is within this distance of a point.
bool is_near(const std::array<Flat, 3>& corners, Flat p, double reach) {
  int left = 0, right = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat a = corners[k], b = corners[(k + 1) % 3];
    const double ux = b.x - a.x, uy = b.y - a.y, vx = p.x - a.x, vy = p.y - a.y, square = ux * ux + uy * uy;
    const double part = square > 0 ? std::clamp((ux * vx + uy * vy) / square, 0.0, 1.0) : 0;
    if (std::hypot(vx - part * ux, vy - part * uy) <= reach) return true;
    (ux * vy - uy * vx > 0 ? left : right) += 1;
  }
  return left == 3 || right == 3;
}

}  // namespace

GroundPictures::GroundPictures(const std::vector<worlds::StaticMeshShape>& meshes) {
  for (const worlds::StaticMeshShape& mesh : meshes)
    for (std::size_t facet = 0; facet < mesh.facets.size(); ++facet) add(mesh, facet);
  std::ranges::sort(facets_, {}, &Facet::nearness);
  sort_into_cells();
}

/// Lit as the faces of bodies; the backs, which are open, are darker.
void GroundPictures::add(const worlds::StaticMeshShape& mesh, std::size_t facet) {
  constexpr std::size_t few = 5000;  // of more, edges would hide the faces
  std::array<Point, 3> at;
  Facet made{
      .corners = {}, .normal = {}, .offset = 0, .nearness = 0, .color = 0, .has_edges = mesh.facets.size() <= few};
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = mesh.corners[mesh.facets[facet][k]];
    made.corners[k] = flat_of(at[k][0], at[k][1], at[k][2]);
    made.nearness += results::nearness_in_space(at[k][0], at[k][1], at[k][2]);
    frame_.take(made.corners[k], 0);
  }
  const auto& [a, b, c] = at;
  const Point u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v = {c[0] - b[0], c[1] - b[1], c[2] - b[2]};
  Point normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double size = std::sqrt(dot(normal, normal));
  const bool is_front = results::nearness_in_space(normal[0], normal[1], normal[2]) > 0;
  for (double& component : normal) component *= (is_front ? 1 : -1) / size;
  made.normal = normal, made.offset = dot(normal, a);
  made.color = is_front || mesh.thin ? lit_by(0xD9D9D9, dot(normal, sun)) : still;
  facets_.push_back(made);
}

void GroundPictures::sort_into_cells() {
  if (facets_.empty() || frame_.empty()) return;
  constexpr double most = 200;
  cells_along_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(facets_.size())), 1.0, most));
  cells_.resize(cells_along_ * cells_along_);
  for (std::uint32_t k = 0; k < facets_.size(); ++k) {
    PictureFrame of_facet;
    for (const Flat corner : facets_[k].corners) of_facet.take(corner, 0);
    if (of_facet.empty()) continue;
    for (std::size_t j = cell_of(of_facet.low, frame_.low, frame_.high - frame_.low);
         j <= cell_of(of_facet.high, frame_.low, frame_.high - frame_.low); ++j)
      for (std::size_t i = cell_of(of_facet.left, frame_.left, frame_.right - frame_.left);
           i <= cell_of(of_facet.right, frame_.left, frame_.right - frame_.left); ++i)
        cells_[j * cells_along_ + i].push_back(k);
  }
}

std::size_t GroundPictures::cell_of(double place, double low, double size) const {
  const double last = static_cast<double>(cells_along_ - 1);
  return size > 0 ? static_cast<std::size_t>(std::clamp((place - low) / size * (last + 1), 0.0, last)) : 0;
}

void GroundPictures::draw(PictureParts& parts) const {
  std::vector<std::uint32_t> all(facets_.size());
  for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
  draw(all, parts);
}

void GroundPictures::draw_before(const Point& centre, double radius, PictureParts& parts) const {
  if (cells_.empty()) return;
  const Flat at = flat_of(centre[0], centre[1], centre[2]);
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return;
  std::vector<std::uint32_t> hiding;
  const double wide = frame_.right - frame_.left, high = frame_.high - frame_.low;
  for (std::size_t j = cell_of(at.y - radius, frame_.low, high); j <= cell_of(at.y + radius, frame_.low, high); ++j)
    for (std::size_t i = cell_of(at.x - radius, frame_.left, wide); i <= cell_of(at.x + radius, frame_.left, wide); ++i)
      for (const std::uint32_t k : cells_[j * cells_along_ + i]) {
        const Facet& facet = facets_[k];
        if (dot(facet.normal, centre) < facet.offset && is_near(facet.corners, at, radius)) hiding.push_back(k);
      }
  std::ranges::sort(hiding);
  const auto rest = std::ranges::unique(hiding);
  hiding.erase(rest.begin(), rest.end());
  draw(hiding, parts);
}

void GroundPictures::draw(const std::vector<std::uint32_t>& facets, PictureParts& parts) const {
  std::string areas, edges;
  for (const std::uint32_t k : facets) {
    const Facet& facet = facets_[k];
    for (const std::size_t c : {0U, 1U, 2U, 0U}) {
      areas += fmt::format("{:.7g} {:.7g} {}\n", facet.corners[c].x, facet.corners[c].y, facet.color);
      if (facet.has_edges) edges += fmt::format("{:.7g} {:.7g}\n", facet.corners[c].x, facet.corners[c].y);
    }
    areas += '\n';
    if (facet.has_edges) edges += '\n';
  }
  if (!areas.empty()) parts.curve(as_polygons, areas);
  if (!edges.empty()) parts.curve(fmt::format("with lines lw 0.5 lc rgb '{}'", edge_color), edges);
}

}  // namespace continuo::app
