// Balls of very different sizes in a grid for each octave of size: in a single grid, either a large ball would have to
// search very many cells, or a small one very many others in the cell of a large one (C. Ericson, "Real-time collision
// detection" (2005), 7.2.1).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/time_stepping/sorted_cells.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

template <class Real, int Dim>
class HierarchicalGrid {
 public:
  using V = Vector<Real, Dim>;

  /// Of balls at places from 0 on. All below twice the `smallest` radius are in the first grid.
  void build(std::span<const V> x, std::span<const Real> radius, const Real& smallest) {
    std::array<std::vector<std::uint32_t>, most_levels> places;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const auto level = static_cast<std::size_t>(std::clamp(std::ilogb(radius[k] / smallest), 0, most_levels - 1));
      places[level].push_back(static_cast<std::uint32_t>(k));
    }
    levels_.clear();
    for (const std::vector<std::uint32_t>& of_level : places)
      if (!of_level.empty()) levels_.push_back(level_of(of_level, x, radius));
  }
  void clear() { levels_.clear(); }
  [[nodiscard]] bool is_empty() const { return levels_.empty(); }

  /// Calls visit(place) for the balls that overlap another one.
  template <class Visit>
  void for_each_overlap(const V& x, const Real& radius, Visit&& visit) const {
    for (const Level& level : levels_) {
      V corner;
      for (std::size_t axis = 0; axis < V::size(); ++axis) corner[axis] = radius + level.widest;
      level.cells.for_each_row(x - corner, x + corner, [&](std::uint32_t first, std::uint32_t last) {
        visit_near(std::span(level.balls).subspan(first, last - first), x, radius, visit);
      });
    }
  }

  [[nodiscard]] std::size_t memory() const {
    std::size_t sum = 0;
    for (const Level& level : levels_) sum += level.cells.memory() + level.balls.capacity() * sizeof(Ball);
    return sum;
  }

 private:
  static constexpr int most_levels = 32;
  struct Ball {
    V x{};
    Real radius{};
    std::uint32_t place = 0;
  };
  struct Level {
    SortedCells<Real, Dim> cells{};
    std::vector<Ball> balls{};  // cell by cell
    Real widest{};
  };

  [[nodiscard]] static Level level_of(std::span<const std::uint32_t> places, std::span<const V> x,
                                      std::span<const Real> radius) {
    Level level;
    std::vector<V> at;
    for (const std::uint32_t k : places) {
      at.push_back(x[k]);
      level.widest = std::max(level.widest, radius[k]);
    }
    std::vector<std::uint32_t> order;
    level.cells.sort(at, level.widest, order);
    for (const std::uint32_t i : order) level.balls.push_back({at[i], radius[places[i]], places[i]});
    return level;
  }

  template <class Visit>
  static void visit_near(std::span<const Ball> balls, const V& x, const Real& radius, Visit&& visit) {
    std::array<std::uint32_t, 64> met;
    while (!balls.empty()) {
      const std::span<const Ball> some = balls.first(std::min(balls.size(), met.size()));
      std::size_t count = 0;
      for (const Ball& ball : some) {
        const Real near = radius + ball.radius;
        met[count] = ball.place;
        count += squared(ball.x - x) < near * near;  // no branch: it would be unpredictable
      }
      for (std::size_t i = 0; i < count; ++i) visit(met[i]);
      balls = balls.subspan(some.size());
    }
  }

  std::vector<Level> levels_;
};

}  // namespace continuo
