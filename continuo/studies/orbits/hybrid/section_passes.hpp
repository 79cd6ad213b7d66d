// Upward passes of a motion through a plane x_i = level, piece by piece. Internal to sections and closed orbits.
#pragma once
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/studies/support/hybrid_run.hpp>

namespace continuo::studies::detail {

/// Pieces are looked at between points so near that a step of the method does not turn twice there.
class SectionPasses {
 public:
  using X = HybridRun::X;

  /// Passes before `from` are left out.
  SectionPasses(std::size_t component, double level, double from, X x, std::vector<SectionPoint>& points)
      : component_(component), level_(level), from_(from), points_(points), x_(std::move(x)) {}

  void piece(double from, double to, const HybridRun::At& at) {
    constexpr int parts = 16;
    double before = std::nextafter(from, to);  // at `from` itself the state is that before what happened there
    double below = height(before, at);
    for (int k = 1; k <= parts; ++k) {
      const double here = k == parts ? to : from + (to - from) * k / parts, above = height(here, at);
      if (below < 0 && above >= 0) add(pass_between(before, here, at), at);
      before = here;
      below = above;
    }
  }
  void jump(double t, const X& before, const X& after) {
    if (before[component_] < level_ && after[component_] >= level_ && t >= from_) points_.push_back({t, after});
  }

 private:
  [[nodiscard]] double height(double t, const HybridRun::At& at) {
    at(t, x_);
    return x_[component_] - level_;
  }
  // By halving, to neighbouring numbers.
  [[nodiscard]] double pass_between(double low, double high, const HybridRun::At& at) {
    for (double middle = low + (high - low) / 2; low < middle && middle < high; middle = low + (high - low) / 2)
      (height(middle, at) < 0 ? low : high) = middle;
    return high;
  }
  void add(double t, const HybridRun::At& at) {
    if (t < from_) return;
    at(t, x_);
    points_.push_back({t, x_});
  }

  std::size_t component_;
  double level_, from_;
  std::vector<SectionPoint>& points_;
  X x_;  // scratch
};

}  // namespace continuo::studies::detail
