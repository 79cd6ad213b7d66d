// continuo/studies/orbits/continuation/orbit_endings.cpp
// How a branch of closed orbits ends: at a Hopf point, a homoclinic orbit, or lost.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/orbits/continuation/orbit_follower.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Place = OrbitPlace;

// A homoclinic orbit is near where the period grows by this factor while the constant keeps still to so many parts of
// its range: there constant - limit ~ exp(-rate * period).
constexpr double growth_of_period = 1.3, standstill = 1e-6;
constexpr double upright = 1e-11;              // of the range: so little between neighbours is no change at all
constexpr double still_neutral = 1e-5;         // of a multiplier: how near to 1
constexpr std::size_t points_of_a_family = 8;  // without a change of the constant

}  // namespace

/// The Hopf point to which so small an orbit belongs: as far away as the orbit is wide, and no more.
std::optional<HopfPoint> OrbitFollower::hopf_near(const Place& place) {
  const double frequency = 2 * std::numbers::pi / place.point.period;
  const Vector middle = steps_.mean(place);
  auto hopf = find_hopf_point(system_, {.constant = options_.constant,
                                        .value = place.point.constant,
                                        .low = options_.low - range_ / 10,
                                        .high = options_.high + range_ / 10,
                                        .x = middle,
                                        .angular_frequency = frequency});
  if (!hopf || std::abs(hopf->angular_frequency - frequency) > 0.2 * frequency) return std::nullopt;
  Vector apart(system_.size);
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] = (hopf->x[i] - middle[i]) / steps_.size_of(i);
  const double wide = 2 * amplitude(place);
  if (length(apart) > wide || std::abs(hopf->constant - place.point.constant) > wide * range_) return std::nullopt;
  return hopf;
}

OrbitBranchEnd OrbitFollower::lost(const Place& here) {
  if (waits_at_an_equilibrium(here))
    return ended(
        OrbitEnding::homoclinic, here.point.constant,
        fmt::format("the period grows ({:.6g} here), most of it near an equilibrium: a homoclinic orbit is near",
                    here.point.period));
  return ended(OrbitEnding::lost, here.point.constant,
               fmt::format("it could not be followed further; the period is {:.6g} there", here.point.period));
}

/// What the last points say. `here` is the last of them.
std::optional<OrbitBranchEnd> OrbitFollower::ending_of(std::span<const OrbitPoint> way, const Place& here) {
  const OrbitPoint& last = way.back();
  double low = last.constant, high = last.constant;
  std::size_t looked_at = 0;
  bool neutral = true;  // neighbours neither come nearer nor go away, in one direction beside that of the motion
  for (std::size_t k = way.size(); k-- > 0; ++looked_at) {
    low = std::min(low, way[k].constant);
    high = std::max(high, way[k].constant);
    neutral = neutral && std::ranges::any_of(way[k].multipliers, [](const std::complex<double>& value) {
                return std::abs(value - 1.0) < still_neutral;
              });
    if (high - low > standstill * range_) return std::nullopt;
    if (neutral && looked_at + 1 == points_of_a_family && high - low <= upright * range_)
      return ended(OrbitEnding::family, last.constant,
                   "orbits lie next to each other at one value, as where energy is kept");
    if (way[k].period > last.period) return std::nullopt;
    if (last.period >= growth_of_period * way[k].period && waits_at_an_equilibrium(here))
      return ended(
          OrbitEnding::homoclinic, last.constant,
          fmt::format("the period grows without bound ({:.6g} here): a homoclinic orbit is near", last.period));
  }
  return std::nullopt;
}

/// Whether the orbit is within a hundredth of its size of an equilibrium for a third of its period: near a homoclinic
/// one all but a fixed time is spent there. Where the constant stands still and the period grows without that, as in
/// the explosion of a canard, the branch goes on.
bool OrbitFollower::waits_at_an_equilibrium(const Place& place) {
  const std::size_t n = system_.size;
  const Vector field = [&] {
    steps_.use(place.mesh);
    return steps_.equations().field(place.z);
  }();
  const std::size_t nodes = field.size() / n;  // z has the period and the constant behind them
  const auto square = [&](std::span<const double> v) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += std::pow(v[i] / steps_.size_of(i), 2);
    return sum;
  };
  std::size_t slowest = 0;
  const auto speed = [&](std::size_t k) { return square(std::span(field).subspan(k * n, n)); };
  for (std::size_t k = 1; k < nodes; ++k)
    if (speed(k) < speed(slowest)) slowest = k;
  Vector p(system_.constants);
  p[options_.constant] = place.point.constant;
  const auto begin = place.z.begin() + static_cast<std::ptrdiff_t>(slowest * n);
  const auto rest = find_equilibrium(system_, Vector(begin, begin + static_cast<std::ptrdiff_t>(n)), p);
  if (rest.ending != EquilibriumEnding::found) return false;
  Vector apart(n);
  double extent = 0, waited = 0;
  const Vector& advance = system_.advance;
  const auto distance_after = [&](std::size_t k, double turns) {
    for (std::size_t i = 0; i < n; ++i)
      apart[i] = place.z[k * n + i] - rest.x[i] + (advance.empty() ? 0 : turns * advance[i]);
    return std::sqrt(square(apart));
  };
  // What turns over waits where it was a turn before.
  const auto distance = [&](std::size_t k) {
    if (advance.empty()) return distance_after(k, 0);
    return std::min({distance_after(k, -1), distance_after(k, 0), distance_after(k, 1)});
  };
  for (std::size_t k = 0; k < nodes; ++k) extent = std::max(extent, distance(k));
  for (std::size_t k = 0; k < nodes; ++k)
    if (distance(k) < 0.01 * extent) waited += steps_.equations().weight(k);
  return waited > 0.3;
}

}  // namespace continuo::studies::detail
