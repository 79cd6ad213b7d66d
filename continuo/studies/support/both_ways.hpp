// A curve that is followed to both sides of its first point, joined to one: points, and marks whose `next` is the first
// point behind them.
#pragma once
#include <algorithm>
#include <iterator>
#include <utility>

namespace continuo::studies::detail {

/// What was found on the way outwards, in the order of the curve that ends where it began.
template <class Points, class Marks>
void turn_round(Points& points, Marks& marks) {
  std::ranges::reverse(points);
  std::ranges::reverse(marks);
  if constexpr (requires { marks.front().next; })
    for (auto& mark : marks) mark.next = points.size() - mark.next;
}
/// Likewise with both ends.
template <class Curve>
[[nodiscard]] Curve turned_round(Curve curve) {
  turn_round(curve.points, curve.marks);
  std::swap(curve.ends[0], curve.ends[1]);
  return curve;
}

/// Behind what there is.
template <class Points, class Marks>
void append(Points& points, Marks& marks, Points further, Marks further_marks) {
  for (auto& mark : further_marks) mark.next += points.size();
  std::ranges::move(further, std::back_inserter(points));
  std::ranges::move(further_marks, std::back_inserter(marks));
}

/// `begin`: a curve of its first point alone, with what is marked there. `followed(side, direction)` appends to `side`,
/// which is empty, what lies on that side of the first point, and says why it ends; -1 comes first. A closed curve is
/// followed once round, and has its first point at both ends.
template <class Curve, class Followed>
[[nodiscard]] Curve followed_both_ways(const Curve& begin, const Followed& followed) {
  Curve curve{.kind = begin.kind}, ahead{.kind = begin.kind};
  curve.ends[0] = followed(curve, -1);
  turn_round(curve.points, curve.marks);
  using Ending = decltype(curve.ends[0].ending);
  const bool is_closed = curve.ends[0].ending == Ending::closed;
  if (is_closed) {
    curve.points.insert(curve.points.begin(), begin.points.front());
    for (auto& mark : curve.marks) ++mark.next;
  }
  append(curve.points, curve.marks, begin.points, begin.marks);
  if (is_closed || curve.ends[0].ending == Ending::interrupted) {
    curve.ends[1] = curve.ends[0];
    return curve;
  }
  curve.ends[1] = followed(ahead, 1);
  append(curve.points, curve.marks, std::move(ahead.points), std::move(ahead.marks));
  return curve;
}

}  // namespace continuo::studies::detail
