// A closed path cut to a rectangle, side by side: I. E. Sutherland, G. W. Hodgman, "Reentrant polygon clipping", Comm.
// ACM 17 (1974). What winds round outside is left along the sides, where it covers nothing.
#include <cstddef>

#include <continuo/results/figure.hpp>

namespace continuo::results {
namespace {

/// What lies on one side of a line across the axis of `along`: above `limit` for a positive sign, else below.
Curve cut(const Curve& path, std::vector<double> Curve::* along, std::vector<double> Curve::* across, double limit,
          double sign) {
  Curve result = path;
  result.x.clear();
  result.y.clear();
  const std::size_t count = path.x.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = i == 0 ? count - 1 : i - 1;
    const double here = (path.*along)[i], there = (path.*along)[before];
    const bool inside = sign * (here - limit) >= 0, was_inside = sign * (there - limit) >= 0;
    if (inside != was_inside) {
      const double part = (limit - there) / (here - there);
      (result.*along).push_back(limit);
      (result.*across).push_back((path.*across)[before] + part * ((path.*across)[i] - (path.*across)[before]));
    }
    if (!inside) continue;
    (result.*along).push_back(here);
    (result.*across).push_back((path.*across)[i]);
  }
  return result;
}

}  // namespace

Curve clipped(const Curve& path, Range x, Range y) {
  Curve result = cut(path, &Curve::x, &Curve::y, x.low, 1);
  result = cut(result, &Curve::x, &Curve::y, x.high, -1);
  result = cut(result, &Curve::y, &Curve::x, y.low, 1);
  return cut(result, &Curve::y, &Curve::x, y.high, -1);
}

}  // namespace continuo::results
