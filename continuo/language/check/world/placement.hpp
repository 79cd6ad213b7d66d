// continuo/language/check/world/placement.hpp
// Numbers and places at random that are the same on every machine.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace continuo::model {

/// The engine is the standard's to the last bit; its distributions are not, so they stand here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// From 0 to below 1, 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  [[nodiscard]] double between(double low, double high) { return low + (high - low) * uniform(); }
  /// A unit vector, all directions alike: one of a ball's points, made longer (J. von Neumann, 1951).
  [[nodiscard]] std::array<double, 3> direction(std::size_t dimension);

 private:
  std::mt19937_64 engine_;
};

struct RandomPlacement {
  std::size_t dimension = 2, count = 0;
  std::array<double, 3> lower{}, upper{};  // the box that holds the bodies whole
  double radius = 0.5;
};

/// Centres of balls that do not touch, one after the other where there is room (random sequential addition). Fewer than
/// asked for where the box is full: it ends at about 0.55 of the plane and 0.38 of space.
[[nodiscard]] std::vector<std::array<double, 3>> place_at_random(const RandomPlacement& wanted, Random& random);

}  // namespace continuo::model
