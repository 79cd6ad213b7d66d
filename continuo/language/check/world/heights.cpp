// Heights over the points of a grid: `wall hills heights "hills.csv"`, `wall hills heights for i in 0..9, j in 0..9 {
// ... } from (0, 0) spacing (1, 1)`. Members of Meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/check/declarations/files.hpp>
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/meshes.hpp>

namespace continuo::model::detail {

namespace {

constexpr double most_triangles = 1'000'000;  // as of a file of triangles

/// Two for each cell, free above, as a HeightField of shapes/ has them; the first axis of the points counts fastest.
std::vector<std::array<std::uint32_t, 3>> triangles_over_grid(std::size_t width, std::size_t depth) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t j = 0; j + 1 < depth; ++j)
    for (std::size_t i = 0; i + 1 < width; ++i) {
      const auto low = static_cast<std::uint32_t>(j * width + i), high = static_cast<std::uint32_t>(low + width + 1);
      triangles.push_back({low, low + 1, high});
      triangles.push_back({low, high, high - 1});
    }
  return triangles;
}

/// The places of a grid along one axis.
struct GridPlaces {
  std::vector<double> all;  // ascending, each once
  double first = 0, apart = 0;

  explicit GridPlaces(std::span<const double> values) : all(values.begin(), values.end()) {
    std::ranges::sort(all);
    const auto rest = std::ranges::unique(all);
    all.erase(rest.begin(), rest.end());
    if (all.size() < 2) return;
    first = all.front();
    apart = (all.back() - first) / static_cast<double>(all.size() - 1);
  }
  /// The first place that is not as far from the one before as all are on average; 0 where there is none. Files have
  /// their numbers with few digits.
  [[nodiscard]] std::size_t uneven() const {
    constexpr double tolerance = 1e-3;  // of the distance
    for (std::size_t k = 1; k < all.size(); ++k)
      if (!std::isfinite(apart) || std::abs(all[k] - all[k - 1] - apart) > tolerance * apart) return k;
    return 0;
  }
  [[nodiscard]] std::size_t number(double value) const {
    return static_cast<std::size_t>(std::lround((value - first) / apart));
  }
};

/// Why points make no grid; empty where they do. `heights`: those of the grid, the first axis first.
std::string grid_fault(const GridPlaces& x, const GridPlaces& y, std::span<const double> xs, std::span<const double> ys,
                       std::span<const double> zs, std::vector<double>& heights) {
  for (const auto& [name, places] : {std::pair("x", &x), std::pair("y", &y)}) {
    if (places->all.size() < 2)
      return fmt::format("all {} points have {} = {:g}: a grid has two places or more along each axis", xs.size(), name,
                         places->all.front());
    if (const std::size_t k = places->uneven())
      return fmt::format(
          "the {} of its points are not evenly apart: {:g} and {:g} follow each other, and on average "
          "they are {:g} apart",
          name, places->all[k - 1], places->all[k], places->apart);
  }
  const std::size_t width = x.all.size(), depth = y.all.size(), count = width * depth;
  if (2.0 * static_cast<double>(width - 1) * static_cast<double>(depth - 1) > most_triangles)
    return fmt::format("a grid of {} x {} points has more than {} triangles", width, depth, most_triangles);
  std::vector<bool> is_there(count, false);
  heights.resize(count);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    const std::size_t place = y.number(ys[i]) * width + x.number(xs[i]);
    if (is_there[place]) return fmt::format("it has two points at x = {:g}, y = {:g}", xs[i], ys[i]);
    is_there[place] = true;
    heights[place] = zs[i];
  }
  const auto missing = std::ranges::find(is_there, false);
  if (missing == is_there.end()) return {};
  const auto place = static_cast<std::size_t>(missing - is_there.begin());
  return fmt::format("it has no point at x = {:g}, y = {:g}", x.all[place % width], y.all[place / width]);
}

}  // namespace

/// The points of a file, in any order.
void Meshes::read_heights(const std::string& file, const ast::WorldMesh& mesh, MeshDescription& made) const {
  for (const std::string_view word : {"from", "spacing"})
    if (const ast::Expression* given = attribute(mesh.attributes, word))
      report_.fail("E225", given->span, fmt::format("the file says where its points are: leave `{}` out", word), {},
                   "`at` moves them, and `scale` makes them larger");
  const Span span = mesh.corners.span;
  auto columns = points_of_heights(file, span, report_);
  if (!columns) return;
  constexpr std::array<std::string_view, 3> names = {"x", "y", "z"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto factor = factor_of((*columns)[k].unit, names[k], span);
    if (!factor) return;
    for (double& value : (*columns)[k].values) value *= *factor;
  }
  const auto& [xs, ys, zs] = *columns;
  const GridPlaces x(xs.values), y(ys.values);
  std::vector<double> heights;
  if (const std::string fault = grid_fault(x, y, xs.values, ys.values, zs.values, heights); !fault.empty()) {
    report_.fail("E272", span, "these points make no grid", fault,
                 "give a height at each point of a grid: columns `x`, `y` and `z`, in any order of the lines");
    return;
  }
  for (std::size_t j = 0; j < y.all.size(); ++j)
    for (std::size_t i = 0; i < x.all.size(); ++i)
      made.corners.push_back({x.all[i], y.all[j], heights[j * x.all.size() + i]});
  made.triangles = triangles_over_grid(x.all.size(), y.all.size());
}

/// A height for each two indices, at `from` plus their number times `spacing`.
void Meshes::make_heights(const ast::WorldMesh& mesh, MeshDescription& made, Scope& scope) const {
  const auto &first = mesh.families.front(), &second = mesh.families.back();
  const ast::Expression *from = attribute(mesh.attributes, "from"), *apart = attribute(mesh.attributes, "spacing");
  if (!apart) {
    report_.fail("E225", mesh.kind.span, "how far apart are the points of the grid?", {}, "add spacing (1, 1)");
    return;
  }
  const NodeId zero = graph_.constant(0);
  std::vector<NodeId> origin{zero, zero};
  if (from) origin = numbers_.level(*from, scope, work_.length, "the origin of heights");
  const std::vector<NodeId> spacing = numbers_.level(*apart, scope, work_.length, "the spacing of heights");
  const auto columns = expressions_.indices.bounds(first.second, scope);
  const auto rows = expressions_.indices.bounds(second.second, scope);
  if (origin.empty() || spacing.empty() || !columns || !rows) return;
  for (const NodeId node : spacing) numbers_.expect(node, Sort::positive, apart->span, "the spacing of heights");
  const auto width = static_cast<std::size_t>(std::max(columns->second - columns->first + 1, 0L));
  const auto depth = static_cast<std::size_t>(std::max(rows->second - rows->first + 1, 0L));
  if (width < 2 || depth < 2) {
    report_.fail("E225", (width < 2 ? first : second).second.span, "a grid has two points or more along each axis",
                 fmt::format("here {} {}", std::min(width, depth) == 1 ? "is" : "are", std::min(width, depth)));
    return;
  }
  const auto place = [&](std::size_t axis, std::size_t number) {
    return graph_.add(origin[axis], graph_.multiply(graph_.constant(static_cast<double>(number)), spacing[axis]));
  };
  bool are_good = true;
  expressions_.indices.for_each_index(second.first, second.second, scope, [&](std::size_t rows_left) {
    expressions_.indices.for_each_index(first.first, first.second, scope, [&](std::size_t columns_left) {
      const NodeId height =
          are_good ? numbers_.number(mesh.corners, scope, work_.length, "a height", Sort::any) : NodeId{};
      are_good = height.valid();
      made.points.push_back({place(0, width - 1 - columns_left), place(1, depth - 1 - rows_left), height});
    });
  });
  if (!are_good || made.points.size() != width * depth) {  // said already
    made.points.clear();
    return;
  }
  made.triangles = triangles_over_grid(width, depth);
}

}  // namespace continuo::model::detail
