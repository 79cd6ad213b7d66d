// The straight line between two neighbours on a curve, as another place sees it: whether the curve passes there.
#pragma once
#include <cmath>
#include <cstddef>
#include <span>

namespace continuo::studies::detail {

/// All coordinates in units in which they are comparable.
struct Chord {
  Chord(std::span<const double> from, std::span<const double> to, std::span<const double> place) {
    double square = 0, along = 0, rest = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      square += (to[i] - from[i]) * (to[i] - from[i]);
      along += (to[i] - from[i]) * (place[i] - from[i]);
    }
    length = std::sqrt(square);
    part = along / square;
    for (std::size_t i = 0; i < place.size(); ++i) rest += std::pow(from[i] + part * (to[i] - from[i]) - place[i], 2);
    apart = std::sqrt(rest);
  }
  /// The foot of the perpendicular lies between both.
  [[nodiscard]] bool passes() const { return part >= 0 && part <= 1; }

  double length = 0, part = 0, apart = 0;  // `part`: of the way to the foot; `apart`: how far that is from the place
};

}  // namespace continuo::studies::detail
