// Traces the zero lines of a function on a grid.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <continuo/studies/accuracy/contour.hpp>

namespace continuo::studies {

namespace {

/// An edge between neighbours of the grid: the one to the right of (i, j) has an even number, the one above an odd one.
using Edge = std::size_t;

class Tracer {
 public:
  explicit Tracer(const Grid& grid) : grid_(grid) {
    for (std::size_t j = 0; j + 1 < grid.rows; ++j)
      for (std::size_t i = 0; i + 1 < grid.columns; ++i) add_cell(i, j);
  }

  std::vector<Polyline> lines() {
    std::vector<Polyline> result;
    for (const auto& [edge, next] : joined_)  // open lines first, from their ends
      if (next.size() == 1) follow(edge, result);
    for (const auto& [edge, next] : joined_) follow(edge, result);
    return result;
  }

 private:
  Edge right_of(std::size_t i, std::size_t j) const { return 2 * (j * grid_.columns + i); }
  Edge above(std::size_t i, std::size_t j) const { return right_of(i, j) + 1; }

  void add_cell(std::size_t i, std::size_t j) {
    const std::array corner{grid_.at(i, j), grid_.at(i + 1, j), grid_.at(i + 1, j + 1), grid_.at(i, j + 1)};
    const std::array edge{right_of(i, j), above(i + 1, j), right_of(i, j + 1), above(i, j)};
    std::array<Edge, 4> crossed{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (std::isnan(corner[k])) return;
      if ((corner[k] > 0) != (corner[(k + 1) % 4] > 0)) crossed[count++] = edge[k];
    }
    if (count == 2) join(crossed[0], crossed[1]);
    if (count == 4) {  // a saddle: the mean says which corners lie together
      const bool as_first = (corner[0] + corner[1] + corner[2] + corner[3] > 0) == (corner[0] > 0);
      join(crossed[0], crossed[as_first ? 1 : 3]);
      join(crossed[2], crossed[as_first ? 3 : 1]);
    }
  }

  void join(Edge a, Edge b) {
    joined_[a].push_back(b);
    joined_[b].push_back(a);
  }

  std::pair<double, double> crossing(Edge edge) const {
    const std::size_t i = edge / 2 % grid_.columns, j = edge / 2 / grid_.columns;
    const bool up = edge % 2 == 1;
    const double here = grid_.at(i, j), there = up ? grid_.at(i, j + 1) : grid_.at(i + 1, j);
    const double part = std::isfinite(here / (here - there)) ? here / (here - there) : 0.5;
    return {grid_.x(i) + (up ? 0 : part * grid_.width), grid_.y(j) + (up ? part * grid_.height : 0)};
  }

  void follow(Edge edge, std::vector<Polyline>& lines) {
    if (used_[edge]) return;
    Polyline line{crossing(edge)};
    const Edge begin = edge;
    used_[edge] = true;
    for (bool more = true; more;) {
      more = false;
      for (const Edge next : joined_[edge]) {
        if (used_[next]) continue;
        used_[next] = true;
        line.push_back(crossing(next));
        edge = next;
        more = true;
        break;
      }
    }
    const auto& last = joined_[edge];
    if (line.size() > 2 && std::find(last.begin(), last.end(), begin) != last.end()) line.push_back(line.front());
    if (line.size() > 1) lines.push_back(std::move(line));
  }

  const Grid& grid_;
  std::map<Edge, std::vector<Edge>> joined_;
  std::map<Edge, bool> used_;
};

/// The grid in a frame of positive values so large that lines between it and the grid end at the grid's border.
Grid framed(const Grid& grid) {
  double greatest = 1;
  for (const double value : grid.values)
    if (std::isfinite(value)) greatest = std::max(greatest, std::abs(value));
  const double outside = 1e9 * greatest;
  Grid result{.columns = grid.columns + 2,
              .rows = grid.rows + 2,
              .left = grid.left - grid.width,
              .bottom = grid.bottom - grid.height,
              .width = grid.width,
              .height = grid.height,
              .values = std::vector<double>((grid.columns + 2) * (grid.rows + 2), outside)};
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i)
      if (!std::isnan(grid.at(i, j))) result.values[(j + 1) * result.columns + i + 1] = grid.at(i, j);
  return result;
}

/// Twice the area, positive where it winds to the left.
double winding_area(const Polyline& loop) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < loop.size(); ++i)
    sum += loop[i].first * loop[i + 1].second - loop[i + 1].first * loop[i].second;
  return sum;
}

/// By the parity of crossings of a ray to the right.
bool encloses(const Polyline& loop, std::pair<double, double> point) {
  bool inside = false;
  for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
    const auto [x1, y1] = loop[i];
    const auto [x2, y2] = loop[i + 1];
    if ((y1 > point.second) != (y2 > point.second) && point.first < x1 + (point.second - y1) / (y2 - y1) * (x2 - x1))
      inside = !inside;
  }
  return inside;
}

}  // namespace

std::vector<Polyline> zero_lines(const Grid& grid) {
  return Tracer(grid).lines();
}

Polyline path_round_negative(const Grid& grid) {
  const std::vector<Polyline> loops = zero_lines(framed(grid));  // nothing leaves the frame: they are closed
  Polyline path;
  for (const Polyline& loop : loops) {
    std::size_t depth = 0;
    for (const Polyline& other : loops)
      if (&other != &loop && encloses(other, loop.front())) ++depth;
    // The outermost wind to the left, holes in them to the right, islands in holes to the left again.
    const bool leftwards = depth % 2 == 0;
    if ((winding_area(loop) > 0) == leftwards) {
      path.insert(path.end(), loop.begin(), loop.end());
    } else {
      path.insert(path.end(), loop.rbegin(), loop.rend());
    }
    path.push_back(loops.front().front());
  }
  return path;
}

}  // namespace continuo::studies
