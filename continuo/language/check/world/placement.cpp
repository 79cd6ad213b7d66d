// continuo/language/check/world/placement.cpp
// Places spheres at random without overlap, by a grid of cells.
#include <algorithm>
#include <cmath>

#include <continuo/language/check/world/placement.hpp>

namespace continuo::model {

namespace {

using Point = std::array<double, 3>;

/// Which places lie in each cell of a grid, no cell smaller than a ball: what can touch lies in neighbours.
class Cells {
 public:
  Cells(const RandomPlacement& wanted, double edge) : wanted_(wanted) {
    // Along an axis: not many more cells than bodies.
    const double most =
        std::ceil(std::pow(4 * static_cast<double>(wanted.count), 1 / static_cast<double>(wanted.dimension)));
    for (std::size_t axis = 0; axis < wanted.dimension; ++axis) {
      const double size = wanted.upper[axis] - wanted.lower[axis];
      counts_[axis] = static_cast<long>(std::clamp(std::floor(size / edge), 1.0, most));
      edges_[axis] = size / static_cast<double>(counts_[axis]);
    }
    lists_.resize(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]));
  }

  template <class Visit>
  bool any_near(const Point& at, Visit&& visit) const {
    const auto cell = cell_of(at);
    std::array<long, 3> k{};
    for (k[2] = low(cell, 2); k[2] <= high(cell, 2); ++k[2])
      for (k[1] = low(cell, 1); k[1] <= high(cell, 1); ++k[1])
        for (k[0] = low(cell, 0); k[0] <= high(cell, 0); ++k[0])
          if (std::ranges::any_of(lists_[number(k)], visit)) return true;
    return false;
  }
  void add(const Point& at) { lists_[number(cell_of(at))].push_back(at); }

 private:
  std::array<long, 3> cell_of(const Point& at) const {
    std::array<long, 3> cell{};
    for (std::size_t axis = 0; axis < wanted_.dimension; ++axis) {
      const auto k = static_cast<long>((at[axis] - wanted_.lower[axis]) / edges_[axis]);
      cell[axis] = std::clamp(k, 0L, counts_[axis] - 1);
    }
    return cell;
  }
  static long low(const std::array<long, 3>& cell, std::size_t axis) { return std::max(cell[axis] - 1, 0L); }
  long high(const std::array<long, 3>& cell, std::size_t axis) const {
    return std::min(cell[axis] + 1, counts_[axis] - 1);
  }
  std::size_t number(const std::array<long, 3>& k) const {
    return static_cast<std::size_t>(k[0] + counts_[0] * (k[1] + counts_[1] * k[2]));
  }

  const RandomPlacement& wanted_;
  std::array<long, 3> counts_{1, 1, 1};
  std::array<double, 3> edges_{1, 1, 1};
  std::vector<std::vector<Point>> lists_;
};

}  // namespace

std::array<double, 3> Random::direction(std::size_t dimension) {
  while (true) {
    Point point{};
    double square = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      point[axis] = between(-1, 1);
      square += point[axis] * point[axis];
    }
    if (!(square > 1e-6) || square > 1) continue;
    for (double& component : point) component /= std::sqrt(square);
    return point;
  }
}

std::vector<Point> place_at_random(const RandomPlacement& wanted, Random& random) {
  std::vector<Point> places;
  for (std::size_t axis = 0; axis < wanted.dimension; ++axis) {
    if (!(wanted.upper[axis] - wanted.lower[axis] >= 2 * wanted.radius)) return places;
  }
  constexpr std::size_t most_tries = 2'000;  // for one body
  Cells cells(wanted, 2 * wanted.radius);
  while (places.size() < wanted.count) {
    bool found = false;
    for (std::size_t k = 0; k < most_tries && !found; ++k) {
      Point at{};
      for (std::size_t axis = 0; axis < wanted.dimension; ++axis)
        at[axis] = random.between(wanted.lower[axis] + wanted.radius, wanted.upper[axis] - wanted.radius);
      found = !cells.any_near(at, [&](const Point& other) {
        double square = 0;
        for (std::size_t axis = 0; axis < wanted.dimension; ++axis)
          square += (at[axis] - other[axis]) * (at[axis] - other[axis]);
        return square <= 4 * wanted.radius * wanted.radius;
      });
      if (found) places.push_back(at);
    }
    if (!found) break;
    cells.add(places.back());
  }
  return places;
}

}  // namespace continuo::model
