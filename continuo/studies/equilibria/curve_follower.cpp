// continuo/studies/equilibria/curve_follower.cpp
// Follows a curve of folds or Hopf points, and locates its special points.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/equilibria/curve_follower.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>
#include <continuo/studies/support/chord.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr double far_off = 1e4;          // in sizes at the start
constexpr double same_place = 1e-5;      // in sizes
constexpr double same_frequency = 1e-4;  // in parts of it
constexpr std::size_t least_turn = 10;   // points of a closed curve

}  // namespace

std::optional<CriticalSpace> CurveFollower::space_at(const Vector& z, Bifurcation kind, double frequency) {
  const Vector a = steps_.matrix(z);
  if (a.empty()) return std::nullopt;
  if (kind == Bifurcation::fold) return fold_space(a, steps_.matrix_size());
  if (frequency > 0) return pair_space(a, steps_.matrix_size(), 2 * std::numbers::pi * frequency);
  const auto fold = fold_space(a, steps_.matrix_size());
  return fold ? double_zero_space(a, steps_.matrix_size(), *fold) : std::nullopt;
}

BifurcationCurve CurveFollower::from(const CurveStart& start) {
  BifurcationCurve curve{.kind = start.kind};
  const Vector z = steps_.scaled(start.x, start.constants);
  const auto space = space_at(z, start.kind, start.frequency);
  const auto first = space ? steps_.first(z, *space) : std::nullopt;
  if (!first || (start.kind == Bifurcation::hopf && !(first->space.margin > 0))) {
    curve.status =
        not_found(fmt::format("there is no {} near the start that could be followed", to_string(start.kind)));
    return curve;
  }
  return both_ways(std::move(curve), *first, nullptr);
}

BifurcationCurve CurveFollower::from(const DegeneratePoint& start, Bifurcation kind) {
  BifurcationCurve curve{.kind = kind};
  const Vector z = steps_.scaled(start.at.x, start.at.constants);
  const auto space = space_at(z, kind, start.other_frequency);
  const auto first = space ? steps_.first(z, *space) : std::nullopt;
  if (!first) {
    curve.status = not_found(fmt::format("the curve of {}s there could not be followed", to_string(kind)));
    return curve;
  }
  DegeneratePoint origin(start);
  origin.at = first->point;
  origin.other_frequency = start.kind == Degeneracy::bogdanov_takens ? 0 : start.at.frequency;  // 0 of a fold
  return both_ways(std::move(curve), *first, &origin);
}

BifurcationCurve CurveFollower::both_ways(BifurcationCurve curve, const CurvePlace& first,
                                          const DegeneratePoint* origin) {
  if (origin) {
    curve.marks = {*origin};
    curve.marks.back().next = 0;
  }
  curve.points = {first.point};
  return followed_both_ways(
      curve, [&](BifurcationCurve& side, double direction) { return followed(side, first, direction, origin); });
}

bool CurveFollower::inside(const CurvePoint& point) const {
  return is_within(point.constants, options_.low, options_.high);
}

CurveEnd CurveFollower::followed(BifurcationCurve& curve, const CurvePlace& from, double direction,
                                 const DegeneratePoint* begin) {
  CurvePlace here(from);
  for (double& part : here.tangent) part *= direction;
  // The test of a cusp goes with the direction.
  here.tests[static_cast<std::size_t>(Degeneracy::cusp)] *= direction;
  // What it begins at is known.
  if (begin) here.tests[static_cast<std::size_t>(begin->kind)] = std::nan("");
  const bool at_double_zero = curve.kind == Bifurcation::hopf && begin && begin->kind == Degeneracy::bogdanov_takens;
  const CurvePlace origin(here);
  StepLength step(options_);
  while (curve.points.size() < options_.most_points) {
    if (options_.interrupt && options_.interrupt->load()) return {CurveEnding::interrupted, "it was interrupted"};
    double reach = 1;
    for (std::size_t i = 0; i < steps_.size(); ++i) reach = std::max(reach, std::abs(here.z[i]));
    if (reach > far_off) return {CurveEnding::infinity, "it diverges to infinity"};
    auto next = steps_.stepped(here, step * reach);
    if (!next || product(here.tangent, next->tangent) < least_cosine_of_neighbours) {
      if (step.shorten()) continue;
      return {CurveEnding::lost, "the curve could not be followed further"};
    }
    if (at_double_zero && curve.points.empty() && next->space.margin <= 0)
      return {CurveEnding::bogdanov_takens, "it begins at a Bogdanov-Takens point"};
    const std::size_t known = curve.marks.size();
    mark(curve, here, *next, step * reach);
    if (curve.kind == Bifurcation::hopf && next->space.margin <= 0) {
      for (std::size_t k = known; k < curve.marks.size(); ++k)
        if (curve.marks[k].kind == Degeneracy::bogdanov_takens) {
          curve.points.push_back(curve.marks[k].at);
          return {CurveEnding::bogdanov_takens, "it ends at a Bogdanov-Takens point"};
        }
      return {CurveEnding::lost, "the frequency goes to zero"};
    }
    if (!inside(next->point)) return at_bound(curve, here, *next);
    if (curve.points.size() > least_turn && comes_back(here, *next, origin))
      return {CurveEnding::closed, "the curve is closed"};
    here = std::move(*next);
    curve.points.push_back(here.point);
    covered_.report(here.point.constants[1]);
    step.lengthen();
  }
  return {CurveEnding::too_many_points, fmt::format("it has {} points, as many as are allowed", curve.points.size())};
}

/// Between a place inside of the ranges and one outside.
CurveEnd CurveFollower::at_bound(BifurcationCurve& curve, const CurvePlace& a, const CurvePlace& b) {
  const LeftRange left = left_range(a.point.constants, b.point.constants, options_.low, options_.high);
  const std::size_t unknown = steps_.size() + left.constant;
  Vector guess = between(a.z, b.z, left.part), last(guess.size());
  guess[unknown] = left.bound / steps_.unit(unknown);
  last[unknown] = 1;
  if (auto found = steps_.corrected(guess, a.space, last))
    if (distance(found->z, guess) <= distance(a.z, b.z))
      if (const auto place = steps_.described(std::move(*found), a.tangent)) curve.points.push_back(place->point);
  return {CurveEnding::bound,
          fmt::format("{} reaches the end of its range", system_.constant_name(options_.constants[left.constant]))};
}

bool CurveFollower::comes_back(const CurvePlace& a, const CurvePlace& b, const CurvePlace& origin) const {
  const Chord chord(a.z, b.z, origin.z);
  return chord.passes() && chord.apart < 0.2 * chord.length &&
         product(a.tangent, origin.tangent) > least_cosine_of_neighbours;
}

bool CurveFollower::passes(const BifurcationCurve& curve, const CurvePoint& place, double frequency) {
  const Vector z = steps_.scaled(place.x, place.constants);
  const auto space = space_at(z, curve.kind, frequency);
  if (!space) return false;
  for (std::size_t k = 1; k < curve.points.size(); ++k) {
    const Vector a = steps_.scaled(curve.points[k - 1].x, curve.points[k - 1].constants),
                 b = steps_.scaled(curve.points[k].x, curve.points[k].constants);
    // Two curves of Hopf points meet at a double one, each with its frequency.
    const double from = curve.points[k - 1].frequency, to = curve.points[k].frequency;
    if (std::abs((from + to) / 2 - frequency) > 2 * std::abs(to - from) + same_frequency * frequency) continue;
    if (distance(a, z) < same_place || distance(b, z) < same_place) return true;
    const double whole = distance(a, b);
    double part = 0;
    for (std::size_t i = 0; i < z.size(); ++i) part += (b[i] - a[i]) * (z[i] - a[i]) / (whole * whole);
    if (!(part > -0.01 && part < 1.01)) continue;
    const Vector guess = between(a, b, part);
    if (distance(guess, z) > whole) continue;
    Vector way(z.size());
    for (std::size_t i = 0; i < way.size(); ++i) way[i] = (b[i] - a[i]) / whole;
    const auto there = steps_.corrected(guess, *space, way);
    if (there && distance(there->z, z) < same_place) return true;
  }
  return false;
}

}  // namespace continuo::studies::detail
