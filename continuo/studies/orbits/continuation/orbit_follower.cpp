// continuo/studies/orbits/continuation/orbit_follower.cpp
// Follows a branch of closed orbits in both directions, and marks its bifurcations.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/orbits/continuation/orbit_follower.hpp>
#include <continuo/studies/orbits/continuation/orbit_marks.hpp>
#include <continuo/studies/support/arclength.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Place = OrbitPlace;

constexpr double shrunk_part =
    1e-3;  // of the largest amplitude of the branch: so small, and a Hopf point is looked for
constexpr double about_minus_one = 0.5;  // of the multiplier where a period doubles

}  // namespace

OrbitBranchEnd OrbitFollower::followed(OrbitBranch& branch, const Place& from, double direction) {
  Place here = from;
  steps_.measure(here);
  for (double& part : here.tangent) part *= direction;
  here.fold *= direction;
  const Place origin = here;
  const std::size_t begin = branch.points.size();
  StepLength step(options_);
  std::size_t refinements = 0;
  while (branch.points.size() < options_.most_points) {
    auto next = is_interrupted() ? std::nullopt : steps_.stepped(here, step);
    if (is_interrupted()) return ended(OrbitEnding::interrupted, here.point.constant, "it was interrupted");
    const bool vanished = next && vanishes(here, *next);
    if (vanished || (next && amplitude(*next) < shrunk_part * amplitude_))
      if (const auto hopf = hopf_near(vanished ? here : *next)) {
        branch.points.push_back(as_orbit(*hopf, here.point.stable));
        return ended(OrbitEnding::hopf, hopf->constant, "the orbit shrinks to an equilibrium, a Hopf point");
      }
    if (!next || vanished || steps_.alike(here, *next) < least_cosine_of_neighbours) {
      if (step.shorten()) continue;
      return with_last(lost(here), here);
    }
    if (next && doubled_ && !vanished && product(steps_.halves(here), steps_.halves(*next)) < 0)
      if (auto end = turns_become_one(branch, here, *next, step)) return *end;
    const std::size_t iterations = steps_.iterations();
    if (!steps_.is_exact(*next) && refinements < most_refinements && steps_.refine(here, *next)) {
      ++refinements;
      continue;
    }
    refinements = 0;
    mark(branch, here, *next, step);
    if (!inside(*next)) return at_bound(branch, here, *next);
    steps_.complete(*next);
    branch.points.push_back(next->point);
    amplitude_ = std::max(amplitude_, amplitude(*next));
    here = std::move(*next);
    covered_.report(here.point.constant);
    const std::span<const OrbitPoint> way(branch.points.begin() + static_cast<std::ptrdiff_t>(begin),
                                          branch.points.end());
    if (auto end = ending_of(way, here)) return with_last(std::move(*end), here);
    if (way.size() > 20 && comes_back(here, origin, step))
      return ended(OrbitEnding::closed, here.point.constant, "the branch is closed");
    steps_.measure(here);
    if (iterations <= 4) step.lengthen();
  }
  return ended(OrbitEnding::too_many_points, here.point.constant,
               fmt::format("it has {} points, as many as are allowed", branch.points.size()));
}

/// From a homoclinic end a curve in two constants may begin.
OrbitBranchEnd OrbitFollower::with_last(OrbitBranchEnd end, const Place& place) {
  if (end.ending == OrbitEnding::homoclinic)
    end.last = OrbitMark{.kind = OrbitBifurcation::homoclinic,
                         .at = place.point,
                         .mesh = *place.mesh,
                         .unknowns = place.z,
                         .tangent = {}};
  return end;
}

/// Through the equilibrium, to the same orbits half a turn later.
bool OrbitFollower::vanishes(const Place& a, const Place& b) {
  return product(steps_.deviations(a), steps_.deviations(b)) < 0;
}

// The difference a of the two turns goes through zero there and the equations are singular, but constant and period are
// even in a: they are read off at three places before, as polynomials of a^2.
std::optional<OrbitBranchEnd> OrbitFollower::turns_become_one(OrbitBranch& branch, const Place& here, const Place& next,
                                                              double step) {
  const Vector apart = steps_.halves(here);
  const auto part_left = [&](const Place& place) {
    return product(apart, steps_.halves(place)) / product(apart, apart);
  };
  const double zero = step / (1 - part_left(next));
  const auto half_way = steps_.stepped(here, 0.45 * zero);
  auto last = steps_.stepped(here, 0.75 * zero);
  if (!half_way || !last) return std::nullopt;
  const double a = 1, b = std::pow(part_left(*half_way), 2), c = std::pow(part_left(*last), 2);
  const auto at_zero = [&](double OrbitPoint::* value) {
    return here.point.*value * b * c / ((a - b) * (a - c)) + half_way->point.*value * a * c / ((b - a) * (b - c)) +
           last->point.*value * a * b / ((c - a) * (c - b));
  };
  const Vector between = steps_.halves(*last);
  for (std::size_t j = 0; j < between.size(); ++j) last->z[j] -= between[j] * steps_.size(j) / 2;
  steps_.complete(*last);
  last->point.x.assign(last->z.begin(), last->z.begin() + static_cast<std::ptrdiff_t>(system_.size));
  last->point.constant = at_zero(&OrbitPoint::constant);
  last->point.period = at_zero(&OrbitPoint::period);
  branch.points.push_back(last->point);
  return ended(OrbitEnding::branching, last->point.constant,
               "its two turns become one, at a period doubling of the orbits of half the period");
}

OrbitBranchEnd OrbitFollower::at_bound(OrbitBranch& branch, const Place& a, const Place& b) {
  const double bound = b.point.constant > options_.high ? options_.high : options_.low;
  const double part = (bound - a.point.constant) / (b.point.constant - a.point.constant);
  if (auto last = steps_.at_constant(between(a.z, b.z, part), bound)) {
    steps_.complete(*last);
    branch.points.push_back(std::move(last->point));
  }
  covered_.report(bound);
  return ended(OrbitEnding::bound, bound, fmt::format("{} reaches the end of its range", name()));
}

bool OrbitFollower::comes_back(const Place& here, const Place& origin, double step) const {
  if (here.fold * origin.fold < 0) return false;
  Vector apart{(here.point.constant - origin.point.constant) / range_,
               (here.point.period - origin.point.period) / origin.point.period};
  for (std::size_t i = 0; i < system_.size; ++i) {
    apart.push_back((here.point.low[i] - origin.point.low[i]) / steps_.size_of(i));
    apart.push_back((here.point.high[i] - origin.point.high[i]) / steps_.size_of(i));
  }
  return length(apart) < step / 2;
}

void OrbitFollower::mark(OrbitBranch& branch, const Place& a, const Place& b, double step) {
  mark_between(
      a, b, step, [&](double s) { return steps_.stepped(a, s); },
      [&](OrbitBifurcation kind, Place place, double) { add(branch, kind, a, std::move(place)); });
}

/// `before`: a place of the branch from which it was found, on the same mesh.
void OrbitFollower::add(OrbitBranch& branch, OrbitBifurcation kind, const Place& before, Place place) {
  if (!inside(place)) return;
  const auto rotation = borne_out(kind, place.point.multipliers, about_minus_one);
  if (!rotation) return;
  steps_.complete(place);
  Vector tangent(before.tangent);
  for (std::size_t j = 0; j < tangent.size(); ++j) tangent[j] *= steps_.size(j);
  branch.marks.push_back(
      {kind, std::move(place.point), *rotation, *place.mesh, std::move(place.z), std::move(tangent)});
}

}  // namespace continuo::studies::detail
