// Follows a branch of closed orbits through events, and marks its bifurcations.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbits/continuation/orbit_marks.hpp>
#include <continuo/studies/orbits/hybrid/hybrid_follower.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>

namespace continuo::studies::detail {

namespace {

using Vec = Eigen::VectorXd;

constexpr double no_slope = 1e-6;                     // of a tangent: so little is no change of the parameter
constexpr double beside_crossing = 0.1;               // of the first step
constexpr double near_minus_one = 1e-2;               // of the multiplier where a period doubles
constexpr double same_multipliers = 1e-2;             // of neighbours between which an event comes in that does nothing
constexpr double hardly_crossed = 100;                // a time of an event that moves by so many periods a size
constexpr double most_noise = 1e-5;                   // in multipliers: beyond, tests change their signs by chance
constexpr double grows_by = 1.3, keeps_still = 1e-6;  // of a period, of a parameter in parts of its range
constexpr double seen_all = 1e6;                      // of a multiplier: what grows by more is lost in rounding

/// How often each event passes.
std::map<std::string, int> counts_of(const std::vector<SensitivityEvent>& events) {
  std::map<std::string, int> counts;
  for (const SensitivityEvent& event : events) ++counts[event.name];
  return counts;
}

bool same_events(const std::vector<SensitivityEvent>& a, const std::vector<SensitivityEvent>& b) {
  return std::ranges::equal(a, b, {}, &SensitivityEvent::name, &SensitivityEvent::name);
}

/// An event that passes more often in b than in a.
std::string more_often(const std::vector<SensitivityEvent>& a, const std::vector<SensitivityEvent>& b) {
  auto before = counts_of(a);
  for (const auto& [name, count] : counts_of(b))
    if (count > before[name]) return name;
  return "";
}

}  // namespace

OrbitBranchEnd HybridFollower::followed(OrbitBranch& branch, const Place& from, double direction) {
  Place here = from;
  here.tangent *= direction;
  here.fold *= direction;
  const Place origin = here;
  const std::size_t begin = branch.points.size();
  StepLength step(options_);
  std::optional<Place> beyond;  // of other events
  while (branch.points.size() < options_.most_points) {
    if (is_interrupted()) return {OrbitEnding::interrupted, here.point.constant, "it was interrupted"};
    auto next = steps_.stepped(here, step);
    if (is_interrupted()) return {OrbitEnding::interrupted, here.point.constant, "it was interrupted"};
    const bool alike = next && same_events(here.events, next->events);
    if (!next || here.tangent.dot(next->tangent) < least_cosine_of_neighbours || !alike) {
      if (step.shorten()) continue;
      if (!next || alike || !goes_on(here, *next)) return lost(here);
    }
    if (doubled_) {
      const auto a = steps_.halves(here), b = steps_.halves(*next);
      if (a && b && a->dot(*b) < 0)
        if (auto end = turns_become_one(branch, here, *next, step)) return *end;
    }
    if (next->noise > most_noise)
      return {OrbitEnding::lost, here.point.constant,
              fmt::format("neighbours part on the way round by a factor of {:.1g}, and what comes of it is lost in "
                          "rounding; the period is {:.6g} there",
                          next->noise / 1e-12, here.point.period)};
    mark(branch, here, *next, step);
    if (!inside(*next)) return at_bound(branch, here, *next);
    steps_.complete(*next);
    branch.points.push_back(next->point);
    if (!alike) step = StepLength(options_);
    here = std::move(*next);
    covered_.report(here.point.constant);
    if (auto end = ending_of(std::span(branch.points).subspan(begin), here)) return *end;
    if (branch.points.size() - begin > 20 && comes_back(here, origin, step))
      return {OrbitEnding::closed, here.point.constant, "the branch is closed"};
    steps_.begin_anew(here);
    step.lengthen();
  }
  return {OrbitEnding::too_many_points, here.point.constant,
          fmt::format("it has {} points, as many as are allowed", branch.points.size())};
}

bool HybridFollower::goes_on(const Place& a, const Place& b) {
  if (a.point.multipliers.size() != b.point.multipliers.size()) return false;
  for (std::size_t i = 0; i < a.point.multipliers.size(); ++i)
    if (std::abs(a.point.multipliers[i] - b.point.multipliers[i]) >
        same_multipliers * std::max(1e-2, std::abs(a.point.multipliers[i])))
      return false;
  return a.tangent.dot(b.tangent) > 1 - same_multipliers;
}

OrbitBranchEnd HybridFollower::lost(const Place& here) const {
  const double at = here.point.constant;
  const std::string more = more_often(here.events, steps_.last_events()),
                    less = more_often(steps_.last_events(), here.events);
  const auto grazes = [&](const std::string& what) {
    return OrbitBranchEnd{OrbitEnding::grazing, at,
                          what + " (grazing, or a corner); beyond, other orbits take its place"};
  };
  if (!more.empty()) return grazes(fmt::format("the orbit comes to touch the surface of `{}`", more));
  if (!less.empty()) return grazes(fmt::format("the orbit hardly touches the surface of `{}` any more", less));
  if (!same_events(here.events, steps_.last_events()))
    return grazes("two events come at once, and would pass in the other order");
  for (const SensitivityEvent& event : here.events)
    for (std::size_t i = 0; i < here.point.x.size(); ++i)
      if (std::abs(event.time_moves[i]) * steps_.size_of(i) > hardly_crossed * here.point.period)
        return grazes(fmt::format("the orbit hardly touches the surface of `{}` any more", event.name));
  const double largest = here.point.multipliers.empty() ? 0 : std::abs(here.point.multipliers.front());
  if (largest > seen_all)
    return {OrbitEnding::lost, at,
            fmt::format("neighbours part by a factor of {:.2g} within a period, too fast to follow it", largest)};
  return {OrbitEnding::lost, at,
          fmt::format("it could not be followed further; the period is {:.6g} there{}{}", here.point.period,
                      steps_.status().message.empty() ? "" : ": ", steps_.status().message)};
}

OrbitBranchEnd HybridFollower::at_bound(OrbitBranch& branch, const Place& a, const Place& b) {
  const double bound = b.point.constant > options_.high ? options_.high : options_.low;
  if (auto last = steps_.at_constant(a, b, bound)) {
    steps_.complete(*last);
    last->point.constant = bound;
    branch.points.push_back(std::move(last->point));
  }
  covered_.report(bound);
  return {OrbitEnding::bound, bound, fmt::format("{} reaches the end of its range", name_)};
}

// As OrbitFollower::turns_become_one has it: parameter and period are even in the difference of the two turns.
std::optional<OrbitBranchEnd> HybridFollower::turns_become_one(OrbitBranch& branch, const Place& here,
                                                               const Place& next, double step) {
  const auto apart = steps_.halves(here), after = steps_.halves(next);
  if (!apart || !after) return std::nullopt;
  const auto part_left = [&](const Vec& halves) { return apart->dot(halves) / apart->squaredNorm(); };
  const double zero = step / (1 - part_left(*after));
  const auto half_way = steps_.stepped(here, 0.45 * zero);
  auto last = steps_.stepped(here, 0.75 * zero);
  if (!half_way || !last) return std::nullopt;
  const auto at_half_way = steps_.halves(*half_way), at_last = steps_.halves(*last);
  if (!at_half_way || !at_last) return std::nullopt;
  if (at_last->norm() > 0.5 * apart->norm()) return std::nullopt;  // it does not vanish, it has turned round
  const double a = 1, b = std::pow(part_left(*at_half_way), 2), c = std::pow(part_left(*at_last), 2);
  const auto at_zero = [&](double OrbitPoint::* value) {
    return here.point.*value * b * c / ((a - b) * (a - c)) + half_way->point.*value * a * c / ((b - a) * (b - c)) +
           last->point.*value * a * b / ((c - a) * (c - b));
  };
  steps_.complete(*last);
  last->point.constant = at_zero(&OrbitPoint::constant);
  last->point.period = at_zero(&OrbitPoint::period);
  branch.points.push_back(last->point);
  return OrbitBranchEnd{OrbitEnding::branching, last->point.constant,
                        "its two turns become one, at a period doubling of the orbits of half the period"};
}

std::optional<OrbitBranchEnd> HybridFollower::ending_of(std::span<const OrbitPoint> way, const Place& here) {
  if (steps_.is_forced()) return std::nullopt;
  const OrbitPoint& last = way.back();
  for (std::size_t k = way.size(); k-- > 0;) {
    if (std::abs(way[k].constant - last.constant) > keeps_still * range_ || way[k].period > last.period)
      return std::nullopt;
    if (last.period < grows_by * way[k].period) continue;
    if (!steps_.waits(here)) return std::nullopt;
    return OrbitBranchEnd{
        OrbitEnding::homoclinic, last.constant,
        fmt::format("the period grows without bound ({:.6g} here): a homoclinic orbit is near", last.period)};
  }
  return std::nullopt;
}

bool HybridFollower::comes_back(const Place& here, const Place& origin, double step) const {
  if (here.fold * origin.fold < 0) return false;
  double square = std::pow((here.point.constant - origin.point.constant) / range_, 2) +
                  std::pow((here.point.period - origin.point.period) / origin.point.period, 2);
  for (std::size_t i = 0; i < here.point.low.size(); ++i)
    square += std::pow((here.point.low[i] - origin.point.low[i]) / steps_.size_of(i), 2) +
              std::pow((here.point.high[i] - origin.point.high[i]) / steps_.size_of(i), 2);
  return std::sqrt(square) < step / 2;
}

void HybridFollower::mark(OrbitBranch& branch, const Place& a, const Place& b, double step) {
  mark_between(
      a, b, step, [&](double s) { return steps_.stepped(a, s); },
      [&](OrbitBifurcation kind, Place place, double at) { add(branch, kind, a, std::move(place), at); });
}

void HybridFollower::add(OrbitBranch& branch, OrbitBifurcation kind, const Place& before, Place place, double at) {
  if (!inside(place)) return;
  const auto rotation = borne_out(kind, place.point.multipliers, near_minus_one);
  if (!rotation) return;
  steps_.complete(place);
  // Where branches cross the equations leave two directions open, and the tangent may be any of them: that of this
  // branch leads from the place before to the one behind.
  Vec tangent = place.tangent;
  if (kind == OrbitBifurcation::crossing) {
    const double aside = beside_crossing * options_.first_step;
    const auto ahead = steps_.stepped(before, at + aside), back = steps_.stepped(before, at - aside);
    tangent = ahead && back ? Vec(ahead->z - back->z) : before.tangent;
  }
  branch.marks.push_back({.kind = kind,
                          .at = std::move(place.point),
                          .rotation = *rotation,
                          .tangent = steps_.unscaled_direction(tangent),
                          .begin = std::move(place.start)});
}

OrbitBranch HybridFollower::both_ways(Place first) {
  steps_.complete(first);
  OrbitBranch back;
  back.ends[1] = followed(back, first, -1);
  OrbitBranch branch = turned_round(std::move(back));
  branch.points.push_back(first.point);
  if (branch.ends[0].ending == OrbitEnding::closed || branch.ends[0].ending == OrbitEnding::interrupted) {
    branch.ends[1] = branch.ends[0];
  } else {
    branch.ends[1] = followed(branch, first, 1);
  }
  return branch;
}

OrbitBranch HybridFollower::from_orbit(const model::Instant& start, double period, double constant) {
  OrbitBranch branch;
  auto first = steps_.at_constant(start, period, constant);
  if (!first) {
    branch.status = {.ending = steps_.status() ? Ending::nonlinear_solve_failed : steps_.status().ending,
                     .message = fmt::format("there is no orbit near the start: {}", steps_.status().message)};
    if (is_interrupted()) branch.status = {.ending = Ending::interrupted, .message = "it was interrupted"};
    return branch;
  }
  steps_.begin_anew(*first);
  return both_ways(std::move(*first));
}

std::optional<HybridPlace> HybridFollower::beside(const model::Instant& start, const Vec& z, const Vec& other,
                                                  double direction) {
  std::optional<Place> place;
  for (double small = 1e-2; small > 1e-5 && !place; small /= 3) {
    const Vec guess = z + direction * small * other;
    place = steps_.across(start, guess, other);
    if (place && (place->z - guess).norm() > small) place.reset();  // it leapt to elsewhere
    if (place && doubled_) {                                        // or to orbits of half the period
      const auto apart = steps_.halves(*place);
      if (!apart || apart->norm() < small / 2) place.reset();
    }
    if (place && place->tangent.dot(other) * direction < 0)
      place->tangent = -place->tangent, place->fold = -place->fold;
  }
  if (place) steps_.complete(*place);
  return place;
}

OrbitBranch HybridFollower::from_mark(const OrbitMark& start) {
  OrbitBranch branch;
  doubled_ = start.kind == OrbitBifurcation::period_doubling;
  std::vector<double> way(start.tangent);
  if (doubled_) way[way.size() - 2] *= 2;
  const double period = doubled_ ? 2 * start.at.period : start.at.period;
  const Vec z = steps_.scaled(*start.begin, period, start.at.constant);
  Vec along = steps_.scaled_direction(way);
  along.normalize();
  auto other = steps_.other_direction(*start.begin, z, along);
  // Parameter and period are even in the difference of the two turns: the direction has no part of theirs.
  if (doubled_ && other && std::abs(along[along.size() - 1]) > no_slope) {
    *other -= along * ((*other)[other->size() - 1] / along[along.size() - 1]);
    other->normalize();
  }
  const auto ahead = other ? beside(*start.begin, z, *other, 1) : std::nullopt;
  if (!ahead) {
    branch.status = {.ending = Ending::nonlinear_solve_failed,
                     .message = fmt::format("no orbit was found on the branch that begins at {} = {:.10g}", name_,
                                            start.at.constant)};
    return branch;
  }
  const OrbitBranchEnd whence{OrbitEnding::branching, start.at.constant,
                              fmt::format("it begins at a {}", to_string(start.kind))};
  branch.points = {start.at};
  branch.ends[0] = whence;
  if (doubled_) {
    branch.points.front().period *= 2;
    for (auto& value : branch.points.front().multipliers) value *= value;
  } else if (const auto back = beside(*start.begin, z, *other, -1)) {
    OrbitBranch behind;
    behind.points = {back->point};
    behind.ends[1] = followed(behind, *back, 1);
    branch = turned_round(std::move(behind));
    branch.points.push_back(start.at);
  }
  branch.points.push_back(ahead->point);
  branch.ends[1] = followed(branch, *ahead, 1);
  return branch;
}

}  // namespace continuo::studies::detail
