// Hulls of the plane by sorting, of space from what Qhull finds.
extern "C" {
#include <libqhull_r/qhull_ra.h>  // in C
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include <continuo/shapes/hull.hpp>

namespace continuo {
namespace {

using Plane = Vector<double, 2>;
using Space = Vector<double, 3>;

// Flatness and parallel faces are judged relative to the extent of the points: far above rounding, far below what
// anyone sees.
constexpr double flat = 1e-9;

double turn(const Plane& a, const Plane& b, const Plane& c) {
  return moment(b - a, c - a)[0];
}

template <int Dim>
double extent(std::span<const Vector<double, Dim>> points) {
  double greatest = 0;
  for (const auto& point : points) greatest = std::max(greatest, length(point - points[0]));
  return greatest;
}

template <int Dim>
Status check_points(std::span<const Vector<double, Dim>> points) {
  if (points.size() <= static_cast<std::size_t>(Dim))
    return invalid_input("a hull needs at least " + std::to_string(Dim + 1) + " points, not " +
                         std::to_string(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_finite(points[i])) return invalid_input("point " + std::to_string(i) + " of the hull is not finite");
  return {};
}
Status too_many_corners(std::size_t corners) {
  return invalid_input("the hull has " + std::to_string(corners) + " corners, and at most " +
                       std::to_string(Polytope<double, 3>::most_corners) +
                       " are possible: give fewer points, or several hulls");
}

// One chain of the hull, from left to right or back: points in order, each of them a turn to the left.
void append_chain(std::span<const Plane> sorted, double least_turn, std::vector<Plane>& chain) {
  const std::size_t begin = chain.size();
  for (const Plane& point : sorted) {
    while (chain.size() >= begin + 2 &&
           !(turn(chain[chain.size() - 2], chain.back(), point) > least_turn * length(point - chain[chain.size() - 2])))
      chain.pop_back();
    chain.push_back(point);
  }
  chain.pop_back();  // begins the other chain
}

// What Qhull says when it fails, in one sentence.
class Messages {
 public:
  Messages() : file_(open_memstream(&text_, &size_)) {}
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  ~Messages() {
    std::fclose(file_);
    std::free(text_);
  }
  [[nodiscard]] std::FILE* file() const { return file_; }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* file_;
};

// The hull as Qhull has it, freed at the end.
class QhullRun {
 public:
  explicit QhullRun(std::span<const Space> points) {
    coordinates_.reserve(points.size() * 3);
    for (const Space& point : points) coordinates_.insert(coordinates_.end(), {point[0], point[1], point[2]});
    qh_zero(&qh_, messages_.file());
    char command[] = "qhull Pp";
    exit_code_ = qh_new_qhull(&qh_, 3, static_cast<int>(points.size()), coordinates_.data(), False, command, nullptr,
                              messages_.file());
  }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;
  ~QhullRun() {
    qh_freeqhull(&qh_, !qh_ALL);
    int kept = 0, total = 0;
    qh_memfreeshort(&qh_, &kept, &total);
  }
  [[nodiscard]] bool has_failed() const { return exit_code_ != 0; }

  // The numbers of the points of each face, counter-clockwise seen from outside.
  [[nodiscard]] std::vector<std::vector<std::size_t>> loops() {
    std::vector<std::vector<std::size_t>> all;
    for (facetT* facet = qh_.facet_list; facet != nullptr && facet->next != nullptr; facet = facet->next) {
      std::vector<std::size_t>& loop = all.emplace_back();
      setT* corners = qh_facet3vertex(&qh_, facet);
      for (int i = 0, n = qh_setsize(&qh_, corners); i < n; ++i) {
        const auto* corner = static_cast<const vertexT*>(corners->e[i].p);
        loop.push_back(static_cast<std::size_t>(qh_pointid(&qh_, corner->point)));
      }
      qh_settempfree(&qh_, &corners);
      if (is_clockwise(loop, {{facet->normal[0], facet->normal[1], facet->normal[2]}})) std::ranges::reverse(loop);
    }
    return all;
  }

 private:
  [[nodiscard]] Space point(std::size_t i) const {
    return {{coordinates_[3 * i], coordinates_[3 * i + 1], coordinates_[3 * i + 2]}};
  }
  [[nodiscard]] bool is_clockwise(const std::vector<std::size_t>& loop, const Space& normal) const {
    Space area{};
    for (std::size_t k = 1; k + 1 < loop.size(); ++k)
      area += moment(point(loop[k]) - point(loop[0]), point(loop[k + 1]) - point(loop[0]));
    return dot(area, normal) < 0;
  }

  Messages messages_;
  std::vector<double> coordinates_;
  qhT qh_{};
  int exit_code_ = 0;
};

// Twice the area of a loop times its normal (M. E. Newell's sum), about its first corner.
Space area_vector(const std::vector<Space>& corners, std::span<const std::uint8_t> loop) {
  Space sum{};
  for (std::size_t k = 1; k + 1 < loop.size(); ++k)
    sum += moment(corners[loop[k]] - corners[loop[0]], corners[loop[k + 1]] - corners[loop[0]]);
  return sum;
}

// The edges, each from the two faces that have it in opposite directions; empty where a face has none beside it.
std::vector<Edge> edges_of(const Polytope<double, 3>& polytope) {
  constexpr std::size_t most = Polytope<double, 3>::most_corners;
  constexpr int none = -1;
  std::array<std::array<int, most>, most> face_at;
  for (auto& row : face_at) row.fill(none);
  const auto each_side = [&](auto&& act) {
    for (std::size_t face = 0; face < polytope.faces.size(); ++face) {
      const auto loop = polytope.loop(face);
      for (std::size_t k = 0; k < loop.size(); ++k) act(loop[k], loop[(k + 1) % loop.size()], static_cast<int>(face));
    }
  };
  bool is_closed = true;
  each_side([&](std::size_t a, std::size_t b, int face) {
    is_closed = is_closed && face_at[a][b] == none;
    face_at[a][b] = face;
  });
  std::vector<Edge> edges;
  each_side([&](std::uint8_t a, std::uint8_t b, int face) {
    const int beside = face_at[b][a];
    is_closed = is_closed && beside != none;
    if (beside != none && a < b)
      edges.push_back({a, b, static_cast<std::uint8_t>(face), static_cast<std::uint8_t>(beside)});
  });
  if (!is_closed || polytope.corners.size() + polytope.faces.size() != edges.size() + 2) edges.clear();
  return edges;
}

}  // namespace

Result<Polytope<double, 2>> convex_hull(std::span<const Plane> points) {
  if (Status status = check_points(points); !status) return status;
  std::vector<Plane> sorted(points.begin(), points.end());
  std::ranges::sort(sorted, {}, &Plane::components);
  const double least_turn = flat * extent(points);
  Polytope<double, 2> hull;
  append_chain(sorted, least_turn, hull.corners);
  std::ranges::reverse(sorted);
  append_chain(sorted, least_turn, hull.corners);
  const std::size_t n = hull.corners.size();
  if (n < 3) return invalid_input("the points of the hull lie on one line: a capsule is a line with a radius");
  if (n > Polytope<double, 2>::most_corners) return too_many_corners(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Plane side = hull.corners[(i + 1) % n] - hull.corners[i];
    const Plane normal = Plane{{side[1], -side[0]}} * (1 / length(side));
    hull.faces.push_back({normal, dot(normal, hull.corners[i])});
  }
  return hull;
}

Result<Polytope<double, 3>> convex_hull(std::span<const Space> points) {
  if (Status status = check_points(points); !status) return status;
  QhullRun run(points);
  const Status is_flat = invalid_input("the points of the hull lie in one plane: a hull in space needs a thickness");
  if (run.has_failed()) return is_flat;
  const auto loops = run.loops();
  constexpr std::size_t unused = ~std::size_t{0};
  std::vector<std::size_t> corner_of(points.size(), unused);
  Polytope<double, 3> hull;
  for (const auto& loop : loops)
    for (const std::size_t point : loop)
      if (corner_of[point] == unused) {
        corner_of[point] = hull.corners.size();
        hull.corners.push_back(points[point]);
      }
  if (hull.corners.size() > Polytope<double, 3>::most_corners) return too_many_corners(hull.corners.size());
  hull.loop_begin.push_back(0);
  for (const auto& loop : loops) {
    for (const std::size_t point : loop) hull.loops.push_back(static_cast<std::uint8_t>(corner_of[point]));
    hull.loop_begin.push_back(static_cast<std::uint16_t>(hull.loops.size()));
  }
  const double size = extent(points);
  for (std::size_t face = 0; face < loops.size(); ++face) {
    const Space area = area_vector(hull.corners, hull.loop(face));
    if (!(length(area) > flat * flat * size * size)) return is_flat;
    const Space normal = area * (1 / length(area));
    double offset = -std::numeric_limits<double>::infinity();
    for (const std::uint8_t corner : hull.loop(face)) offset = std::max(offset, dot(normal, hull.corners[corner]));
    hull.faces.push_back({normal, offset});
  }
  hull.edges = edges_of(hull);
  if (hull.edges.empty()) return is_flat;
  return hull;
}

}  // namespace continuo
