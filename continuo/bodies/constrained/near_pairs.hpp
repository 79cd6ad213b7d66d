// Pairs that may meet in the next step, listed for some steps at once.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// The greatest distance of a body from its earlier position.
template <class Real, int Dim>
[[nodiscard]] Real farthest_way(const World<Real, Dim>& world, const std::vector<Vector<Real, Dim>>& before) {
  using std::sqrt;
  Real farthest(0);
  for (std::size_t i = 0; i < before.size(); ++i)
    farthest = std::max(farthest, squared(Vector<Real, Dim>(world.position[i] - before[i])));
  return sqrt(farthest);
}

template <class Real, int Dim>
class NearPairs {
 public:
  /// Lists the pairs again where, in a step of at most `h` under accelerations of at most `pull`, a body may leave the
  /// range of the list.
  void renew(const World<Real, Dim>& world, const Real& h, const Real& pull) {
    using std::sqrt;
    Real fastest(0);
    for (const auto& v : world.velocity) fastest = std::max(fastest, squared(v));
    const Real needed = 4 * h * (sqrt(fastest) + 2 * pull * h);
    if (!listed_at_.empty() && !(farthest_way(world, listed_at_) > reach_ - needed)) return;
    reach_ = std::max(8 * needed, Real(std::ranges::min(world.radius) / 8));
    listed_at_ = world.position;
    pairs_ = pairs_within(world, reach_);
  }
  /// In order.
  [[nodiscard]] std::span<const Touching> pairs() const { return pairs_; }

 private:
  std::vector<Touching> pairs_;
  std::vector<Vector<Real, Dim>> listed_at_;  // where bodies were then
  Real reach_{};
};

}  // namespace continuo
