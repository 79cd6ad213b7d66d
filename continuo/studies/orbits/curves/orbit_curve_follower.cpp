// continuo/studies/orbits/curves/orbit_curve_follower.cpp
// Follows a curve of bifurcations of orbits, and locates its special points.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbits/curves/orbit_curve_follower.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;

constexpr double shrunk_away = 5e-3;    // of the largest amplitude
constexpr double all_but_gone = 2e-2;   // likewise, where the equations can no longer be solved
constexpr double about_there = 1e-3;    // of a multiplier from where it should be
constexpr double clearly_seen = 1e-7;   // of a test that is of the size of 1
constexpr std::size_t round_trip = 12;  // points of a closed curve

}  // namespace

OrbitCurve OrbitCurveFollower::from(const OrbitMark& start) {
  OrbitCurve curve{.kind = start.kind};
  const auto first = steps_.first(start);
  if (!first) {
    curve.status =
        not_found(fmt::format("there is no {} near the start that could be followed", to_string(start.kind)));
    return curve;
  }
  first_period_ = first->point.period;
  (void)amplitude(*first);
  curve.points = {first->point};
  return followed_both_ways(curve,
                            [&](OrbitCurve& side, double direction) { return followed(side, *first, direction); });
}

OrbitCurveEnd OrbitCurveFollower::followed(OrbitCurve& curve, const OrbitCurvePlace& from, double direction) {
  OrbitCurvePlace here(from);
  for (double& part : here.tangent) part *= direction;
  here.tests[static_cast<std::size_t>(OrbitDegeneracy::cusp)] *= direction;
  const OrbitCurvePlace origin(here);
  StepLength step(options_);
  while (curve.points.size() < options_.most_points) {
    auto next = steps_.stepped(here, step);
    if (options_.interrupt && options_.interrupt->load()) return {OrbitCurveEnding::interrupted, "it was interrupted"};
    if (next)
      if (auto end = shrinks_between(here, *next)) return *end;
    if (!next || product(here.tangent, next->tangent) < least_cosine_of_neighbours) {
      if (step.shorten()) continue;
      if (amplitude(here) < all_but_gone) return {OrbitCurveEnding::equilibrium, "the orbit shrinks to an equilibrium"};
      return {OrbitCurveEnding::lost,
              fmt::format("the curve could not be followed further; the period is {:.6g} there", here.point.period)};
    }
    if (curve.kind == OrbitBifurcation::torus)
      if (auto resonance = resonance_ahead(here, *next, step); resonance && is_inside(resonance->at, options_)) {
        mark(curve, here, *next, step);
        resonance->next = curve.points.size();
        curve.points.push_back(resonance->at);
        const OrbitCurveEnd end{OrbitCurveEnding::resonance,
                                fmt::format("it ends at a {}", to_string(resonance->kind))};
        curve.marks.push_back(std::move(*resonance));
        return end;
      }
    mark(curve, here, *next, step);
    if (!is_inside(next->point, options_)) return at_bound(curve, here, *next);
    steps_.complete(*next);
    curve.points.push_back(next->point);
    covered_.report(next->point.constants[1]);
    if (next->point.period > options_.longest_period * first_period_)
      return {OrbitCurveEnding::long_period,
              fmt::format("the period has grown to {:.6g}, more than {:.3g} times that at the start",
                          next->point.period, options_.longest_period)};
    if (curve.points.size() > round_trip && comes_back(here.point, next->point, origin.point, options_))
      return {OrbitCurveEnding::closed, "the curve is closed"};
    here = std::move(*next);
    if (!steps_.renew(here))
      return {OrbitCurveEnding::lost,
              fmt::format("no mesh serves the orbits further on; the period is {:.6g} there", here.point.period)};
    step.lengthen();
  }
  return {OrbitCurveEnding::too_many_points,
          fmt::format("it has {} points, as many as are allowed", curve.points.size())};
}

double OrbitCurveFollower::amplitude(const OrbitCurvePlace& place) {
  const std::size_t n = steps_.size();
  const Vector deviations = steps_.deviations(place);
  Vector squares(n);
  for (std::size_t j = 0; j < deviations.size(); ++j) squares[j % n] += deviations[j] * deviations[j];
  greatest_.resize(n);
  double part = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double size = std::sqrt(squares[i]);
    greatest_[i] = std::max(greatest_[i], size);
    if (greatest_[i] > 0) part = std::max(part, size / greatest_[i]);
  }
  return part;
}

std::optional<OrbitCurveEnd> OrbitCurveFollower::shrinks_between(const OrbitCurvePlace& a, const OrbitCurvePlace& b) {
  // Through the equilibrium, to the same orbits half a turn later.
  const Vector from = steps_.deviations(a), to = steps_.deviations(b);
  if (product(from, to) < 0 || amplitude(b) < shrunk_away)
    return OrbitCurveEnd{OrbitCurveEnding::equilibrium, "the orbit shrinks to an equilibrium"};
  return std::nullopt;
}

// A pair turning by a and one turning by -a are the same, so that constants and period are even in the angle: where the
// equations get singular, at angle 0 since 1 is always a multiplier, at half a turn by that symmetry, they are read off
// at three places before, as polynomials of its square.
std::optional<DegenerateOrbit> OrbitCurveFollower::resonance_ahead(const OrbitCurvePlace& a, const OrbitCurvePlace& b,
                                                                   double step) {
  constexpr double pi = std::numbers::pi, near_enough = 0.5;  // radians
  const double angle = std::remainder(b.z.back(), 2 * pi);
  const double goal = std::abs(angle) < pi / 2 ? 0 : pi;
  const auto square = [&](const OrbitCurvePlace& place) {
    return std::pow(std::abs(std::remainder(place.z.back(), 2 * pi)) - goal, 2);
  };
  const double at_a = square(a), at_b = square(b);
  if (at_b > near_enough * near_enough || at_b >= at_a || at_b > 2 * (at_a - at_b)) return std::nullopt;
  auto middle = steps_.stepped(a, step / 2);
  if (!middle) return std::nullopt;
  steps_.complete(*middle);
  OrbitCurvePlace last(b), first(a);
  steps_.complete(last);
  steps_.complete(first);
  const double at_middle = square(*middle);
  const double of_a = at_middle * at_b / ((at_a - at_middle) * (at_a - at_b)),
               of_middle = at_a * at_b / ((at_middle - at_a) * (at_middle - at_b)),
               of_b = at_a * at_middle / ((at_b - at_a) * (at_b - at_middle));
  const auto at_zero = [&](double u, double v, double w) { return of_a * u + of_middle * v + of_b * w; };
  DegenerateOrbit found{.kind = goal == 0 ? OrbitDegeneracy::resonance_1 : OrbitDegeneracy::resonance_2,
                        .at = last.point};
  const OrbitCurvePoint &u = first.point, &v = middle->point, &w = last.point;
  for (std::size_t k = 0; k < 2; ++k) found.at.constants[k] = at_zero(u.constants[k], v.constants[k], w.constants[k]);
  found.at.period = at_zero(u.period, v.period, w.period);
  for (std::size_t i = 0; i < u.low.size(); ++i) {
    found.at.low[i] = at_zero(u.low[i], v.low[i], w.low[i]);
    found.at.high[i] = at_zero(u.high[i], v.high[i], w.high[i]);
    found.at.x[i] = at_zero(u.x[i], v.x[i], w.x[i]);
  }
  found.at.rotation = goal == 0 ? 0 : 0.5;
  // The pair becomes twice 1 or -1.
  for (Complex& value : found.at.multipliers)
    if (std::abs(value - std::polar(1.0, angle)) < 1e-6 || std::abs(value - std::polar(1.0, -angle)) < 1e-6)
      value = goal == 0 ? 1 : -1;
  return found;
}

/// Between a place inside of the ranges and one outside.
OrbitCurveEnd OrbitCurveFollower::at_bound(OrbitCurve& curve, const OrbitCurvePlace& a, const OrbitCurvePlace& b) {
  const LeftRange left = left_range(a.point, b.point, options_);
  if (const auto place = steps_.at_bound(a, b, left.constant, left.bound)) curve.points.push_back(place->point);
  return end_of_range(system_, options_, left);
}

void OrbitCurveFollower::mark(OrbitCurve& curve, const OrbitCurvePlace& a, const OrbitCurvePlace& b, double step) {
  std::vector<std::pair<double, DegenerateOrbit>> found;
  for (std::size_t k = 0; k < orbit_degeneracies; ++k) {
    const auto kind = static_cast<OrbitDegeneracy>(k);
    if (!(a.test(kind) * b.test(kind) < 0)) continue;
    if (std::max(std::abs(a.test(kind)), std::abs(b.test(kind))) < clearly_seen) continue;
    auto place = located(kind, a, b, step);
    if (!place || !is_inside(place->point, options_) || !is_what(kind, curve.kind, *place)) continue;
    const double at = located_at_, aside = 1e-2 * std::min({step, at, step - at});
    if (aside > 1e-6 * step) {  // of a zero that rounding has made it need not be on either side
      const auto before = steps_.stepped(a, at - aside), after = steps_.stepped(a, at + aside);
      if (!before || !after || !(before->test(kind) * after->test(kind) < 0)) continue;
    }
    steps_.complete(*place);
    found.emplace_back(at, DegenerateOrbit{.kind = kind, .at = place->point, .next = curve.points.size()});
  }
  std::ranges::sort(found, {}, [](const auto& entry) { return entry.first; });
  for (auto& entry : found) curve.marks.push_back(std::move(entry.second));
}

/// The secant, with a bisection where it is slow.
std::optional<OrbitCurvePlace> OrbitCurveFollower::located(OrbitDegeneracy kind, const OrbitCurvePlace& a,
                                                           const OrbitCurvePlace& b, double step) {
  constexpr int most = 40;
  constexpr double exact = 1e-10;
  double low = 0, high = step, at_low = a.test(kind), at_high = b.test(kind);
  std::optional<OrbitCurvePlace> best;
  double least = 1;
  for (int k = 0; k < most && high - low > exact * step; ++k) {
    const double secant = low - at_low * (high - low) / (at_high - at_low);
    const double s = k % 3 == 2 || !(secant > low && secant < high) ? (low + high) / 2 : secant;
    auto place = steps_.stepped(a, s);
    if (!place) break;
    const double value = place->test(kind);
    if (!std::isfinite(value)) return std::nullopt;
    if (std::abs(value) <= least) {
      least = std::abs(value);
      best = std::move(place);
      located_at_ = s;
    }
    if (std::abs(value) < exact) break;
    if ((value < 0) == (at_low < 0)) {
      low = s, at_low = value;
    } else {
      high = s, at_high = value;
    }
  }
  return least < 1e-6 ? best : std::nullopt;
}

bool OrbitCurveFollower::is_what(OrbitDegeneracy kind, OrbitBifurcation curve, const OrbitCurvePlace& place) {
  using enum OrbitDegeneracy;
  const auto& values = place.point.multipliers;
  const auto how_many_at = [&](const Complex& wanted, double slack) {
    return std::ranges::count_if(values, [&](const Complex& value) { return std::abs(value - wanted) < slack; });
  };
  const auto pairs = [&] {
    return std::ranges::count_if(values, [](const Complex& value) {
      return value.imag() > about_there && std::abs(std::abs(value) - 1) < about_there * value.imag();
    });
  };
  // A double multiplier is known to the root of what a simple one is.
  constexpr double of_double = 3e-2;
  switch (kind) {
    case cusp:
      return true;
    case resonance_1:
      return how_many_at(1, of_double) >= 2;
    case resonance_2:
      return how_many_at(-1, of_double) >= 2;
    case resonance_3:
    case resonance_4:
      return pairs() >= 1;
    case fold_flip:
      return how_many_at(1, about_there) >= 1 && how_many_at(-1, about_there) >= 1;
    case fold_torus:
      return how_many_at(1, about_there) >= 1 && pairs() >= 1;
    case flip_torus:
      return how_many_at(-1, about_there) >= 1 && pairs() >= 1;
    case double_torus:
      return curve == OrbitBifurcation::torus && pairs() >= 2;
    default:  // of homoclinic orbits
      return false;
  }
  return false;
}

}  // namespace continuo::studies::detail
