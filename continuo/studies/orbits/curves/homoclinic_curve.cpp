// Follows curves of homoclinic orbits in two constants, and those that they lead to.
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbits/curves/homoclinic_curve.hpp>
#include <continuo/studies/orbits/curves/homoclinic_steps.hpp>
#include <continuo/studies/orbits/curves/orbit_curve_course.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>
#include <continuo/studies/support/false_position.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

constexpr double ends_open = 0.02;  // of the orbit
constexpr double same_end = 1e-3;   // of the ranges and of the orbit
constexpr std::size_t points_at_rest = 24;
constexpr double stands_still = 1e-5;  // of the ranges, within which so many points lie where a curve winds itself up
constexpr double same_shape = 0.01;    // of the size of the orbit

/// Of a central orbit the truncation is its own, in sizes.
double truncated_by_at_most(const HomoclinicPlace& place) {
  return place.rest.is_saddle_node ? resolved_well : truncated_well;
}

class HomoclinicFollower {
 public:
  HomoclinicFollower(const ParametricSystem& system, const OrbitCurveOptions& options)
      : system_(system),
        options_(options),
        steps_(system, options),
        covered_(options.low[1], options.high[1], options.progress) {}

  std::vector<OrbitCurve> from(const OrbitMark& start, std::size_t most);
  /// What a place where this test is zero is; nothing where it has no name, or the zero is none.
  static std::optional<OrbitDegeneracy> kind_of(HomoclinicTest test, const HomoclinicPlace& place);

 private:
  OrbitCurve first_curve(const OrbitMark& start);
  OrbitCurveEnd followed(OrbitCurve& curve, const HomoclinicPlace& from, double direction);
  struct Found {
    double at;
    HomoclinicTest test;
    std::optional<OrbitDegeneracy> kind;
    HomoclinicPlace place;
  };
  /// All that lies between two neighbours, in the order of the curve.
  std::vector<Found> found_between(const HomoclinicPlace& a, const HomoclinicPlace& b, double step);
  /// Why the curve ends at such a place; nothing where it goes on.
  static std::optional<std::string> reason_to_end(const Found& found);
  /// An orbit of a saddle-node that is not central: where a curve of saddles and one of saddle-nodes end on each other.
  struct NonCentral {
    HomoclinicPlace place;
    HomoclinicTest test;  // which is zero there, on the curve that has ended
  };
  /// The other curve that begins there. Nothing where it is not found.
  std::optional<OrbitCurve> other_curve(const NonCentral& end);
  static HomoclinicRest other_rest(const NonCentral& end, std::size_t n);
  bool is_known(const HomoclinicPlace& place) const;
  /// From which a curve in three constants begins, where the orbit is one of a saddle. A central one is not, nor is its
  /// end; but where it is not central any more the other curve begins.
  std::shared_ptr<const HomoclinicMark> start_in_three(const HomoclinicPlace& place, HomoclinicTest test) const;
  /// Whether the last points differ by the length of the interval alone: the curve goes round a point where the orbit
  /// is one to another equilibrium and back (a T-point, Glendinning and Sparrow, J. Stat. Phys. 43 (1986) 479-488).
  bool winds_up(const OrbitCurve& curve) const;

  const ParametricSystem& system_;
  const OrbitCurveOptions& options_;
  HomoclinicSteps steps_;
  CoveredRange covered_;
  SizesOnCurve sizes_{};
  std::vector<NonCentral> ends_{};  // of all curves so far
};

std::vector<OrbitCurve> HomoclinicFollower::from(const OrbitMark& start, std::size_t most) {
  std::vector<OrbitCurve> curves{first_curve(start)};
  for (std::size_t k = 0; k < ends_.size() && curves.size() < most; ++k) {
    if (options_.interrupt && options_.interrupt->load()) break;
    const NonCentral end = ends_[k];  // other_curve adds to them
    if (auto curve = other_curve(end)) curves.push_back(std::move(*curve));
  }
  return curves;
}

OrbitCurve HomoclinicFollower::first_curve(const OrbitMark& start) {
  OrbitCurve curve{.kind = OrbitBifurcation::homoclinic};
  const auto first = steps_.first(start);
  if (!first) {
    curve.status = first.status();
    return curve;
  }
  if (first->point.truncation > truncated_by_at_most(*first)) {
    curve.status = not_found(
        fmt::format("what is cut off of the homoclinic orbit would move {} by {:.2g} of {}: motions leave the "
                    "saddle, or come to it, too slowly",
                    first->rest.is_saddle_node ? "it" : "the constants", first->point.truncation,
                    first->rest.is_saddle_node ? "its size" : "their ranges"));
    return curve;
  }
  (void)sizes_.part_of(first->point);
  if (first->rest.is_saddle_node) curve.kind = OrbitBifurcation::central_homoclinic;
  curve.points = {first->point};
  return followed_both_ways(curve,
                            [&](OrbitCurve& side, double direction) { return followed(side, *first, direction); });
}

HomoclinicRest HomoclinicFollower::other_rest(const NonCentral& end, std::size_t n) {
  switch (end.test) {
    case HomoclinicTest::rest_stable:  // the leading stable eigenvalue becomes the centre's
      return {.stable = end.place.spaces.stable.dimension() - 1, .is_saddle_node = true};
    case HomoclinicTest::leaves_centre:  // it comes back along the centre, which is stable to it
      return {.stable = n - end.place.spaces.unstable.dimension(), .is_saddle_node = false};
    default:
      return {.stable = end.place.spaces.stable.dimension(),
              .is_saddle_node = end.test == HomoclinicTest::rest_unstable};
  }
}

std::optional<OrbitCurve> HomoclinicFollower::other_curve(const NonCentral& end) {
  const bool central = !end.place.rest.is_saddle_node;
  auto begin = steps_.switched(end.place, other_rest(end, system_.size));
  if (!begin) return std::nullopt;
  // The side on which a central orbit leaves and comes along the centre, or the eigenvalue has the sign of its side.
  const bool leaves_strongly = end.test == HomoclinicTest::rest_stable || end.test == HomoclinicTest::leaves_centre;
  const HomoclinicTest test = central
                                  ? leaves_strongly ? HomoclinicTest::leaves_centre : HomoclinicTest::comes_by_centre
                              : leaves_strongly ? HomoclinicTest::rest_stable
                                                : HomoclinicTest::rest_unstable;
  const double wanted = test == HomoclinicTest::rest_stable ? -1 : 1;
  std::optional<double> direction;
  for (double step = options_.first_step; !direction && step > options_.least_step; step /= 4)
    for (const double side : {1.0, -1.0})
      if (const auto next = steps_.stepped(*begin, side * step); next && wanted * next->test(test) > 0)
        direction = side;
  if (!direction) return std::nullopt;
  OrbitCurve curve{.kind = central ? OrbitBifurcation::central_homoclinic : OrbitBifurcation::homoclinic};
  curve.points.push_back(begin->point);
  curve.ends[0] = {OrbitCurveEnding::no_saddle, "it begins at an orbit of a saddle-node that is not central"};
  if (!central)
    curve.marks.push_back({.kind = OrbitDegeneracy::saddle_node,
                           .at = begin->point,
                           .next = 0,
                           .homoclinic = start_in_three(*begin, test)});
  begin->tests[static_cast<std::size_t>(test)] = 0;
  sizes_.forget();
  (void)sizes_.part_of(begin->point);
  curve.ends[1] = followed(curve, *begin, *direction);
  return curve;
}

std::shared_ptr<const HomoclinicMark> HomoclinicFollower::start_in_three(const HomoclinicPlace& place,
                                                                         HomoclinicTest test) const {
  if (place.rest.is_saddle_node) return nullptr;
  return std::make_shared<const HomoclinicMark>(place, test, system_.advance);
}

bool HomoclinicFollower::is_known(const HomoclinicPlace& place) const {
  return std::ranges::any_of(ends_, [&](const NonCentral& other) {
    const OrbitCurvePoint &a = place.point, &b = other.place.point;
    for (std::size_t c = 0; c < 2; ++c)
      if (std::abs(a.constants[c] - b.constants[c]) > same_end * (options_.high[c] - options_.low[c])) return false;
    for (std::size_t i = 0; i < a.low.size(); ++i) {
      const double size = std::max(a.high[i] - a.low[i], b.high[i] - b.low[i]);
      if (std::abs(a.low[i] - b.low[i]) + std::abs(a.high[i] - b.high[i]) > same_end * size) return false;
    }
    return true;
  });
}

bool HomoclinicFollower::winds_up(const OrbitCurve& curve) const {
  if (curve.points.size() < points_at_rest) return false;
  const OrbitCurvePoint& last = curve.points.back();
  const auto before = std::span(curve.points).last(points_at_rest).first(points_at_rest - 1);
  return std::ranges::all_of(before, [&](const OrbitCurvePoint& point) {
    for (std::size_t c = 0; c < 2; ++c)
      if (std::abs(point.constants[c] - last.constants[c]) > stands_still * (options_.high[c] - options_.low[c]))
        return false;
    for (std::size_t i = 0; i < last.low.size(); ++i)
      if (std::abs(point.low[i] - last.low[i]) + std::abs(point.high[i] - last.high[i]) >
          same_shape * sizes_.greatest(i))
        return false;
    return true;
  });
}

OrbitCurveEnd HomoclinicFollower::followed(OrbitCurve& curve, const HomoclinicPlace& from, double direction) {
  HomoclinicPlace here(from);
  for (double& part : here.tangent) part *= direction;
  // The adjoint solution is normalised by the tangent, and turns with it.
  for (const HomoclinicTest test : {HomoclinicTest::inclination_flip_stable, HomoclinicTest::inclination_flip_unstable})
    here.tests[static_cast<std::size_t>(test)] *= direction;
  const OrbitCurvePoint origin(here.point);
  StepLength step(options_);
  while (curve.points.size() < options_.most_points) {
    auto next = steps_.stepped(here, step);
    if (options_.interrupt && options_.interrupt->load()) return {OrbitCurveEnding::interrupted, "it was interrupted"};
    const bool is_coarse = next && next->error > resolved_well;
    // Along a centre the ends are brought nearer by a longer interval, which is found from ends that are near enough.
    const bool is_open = next && next->rest.is_saddle_node && std::max(next->apart_first, next->apart_last) > ends_open;
    if (!next || is_coarse || is_open || product(here.tangent, next->tangent) < least_cosine_of_neighbours) {
      if (step.shorten()) continue;
      return {OrbitCurveEnding::lost,
              is_coarse ? "no mesh serves the orbits further on" : "the curve could not be followed further"};
    }
    for (Found& found : found_between(here, *next, step)) {
      if (!is_inside(found.place.point, options_)) break;
      if (found.kind)
        curve.marks.push_back({.kind = *found.kind,
                               .at = found.place.point,
                               .next = curve.points.size(),
                               .homoclinic = start_in_three(found.place, found.test)});
      const auto reason = reason_to_end(found);
      if (!reason) continue;
      curve.points.push_back(found.place.point);
      const bool other_begins =
          found.kind == OrbitDegeneracy::saddle_node || found.kind == OrbitDegeneracy::non_central;
      if (other_begins && !is_known(found.place)) {
        (void)steps_.renew(found.place);
        ends_.push_back({std::move(found.place), found.test});
      }
      return {OrbitCurveEnding::no_saddle, *reason};
    }
    if (!is_inside(next->point, options_)) {
      const LeftRange left = left_range(here.point, next->point, options_);
      if (const auto place = steps_.at_bound(here, *next, left.constant, left.bound))
        curve.points.push_back(place->point);
      return end_of_range(system_, options_, left);
    }
    if (sizes_.part_of(next->point) < shrunk_to_rest)
      return {OrbitCurveEnding::equilibrium, "the orbit shrinks to an equilibrium"};
    const bool is_served = steps_.renew(*next);
    if (next->point.truncation > truncated_by_at_most(*next))
      return {OrbitCurveEnding::long_period,
              fmt::format("what is cut off of the orbit would move {} by {:.2g} of {} further on: "
                          "motions leave the saddle, or come to it, too slowly",
                          next->rest.is_saddle_node ? "it" : "the constants", next->point.truncation,
                          next->rest.is_saddle_node ? "its size" : "their ranges")};
    curve.points.push_back(next->point);
    covered_.report(next->point.constants[1]);
    if (curve.points.size() > points_round && comes_back(here.point, next->point, origin, options_))
      return {OrbitCurveEnding::closed, "the curve is closed"};
    if (winds_up(curve))
      return {OrbitCurveEnding::long_period,
              "nothing changes any more but how long the orbit takes: it comes ever nearer to another equilibrium"};
    here = std::move(*next);
    if (!is_served) return {OrbitCurveEnding::lost, "no mesh serves the orbits further on"};
    step.lengthen();
  }
  return {OrbitCurveEnding::too_many_points,
          fmt::format("it has {} points, as many as are allowed", curve.points.size())};
}

std::vector<HomoclinicFollower::Found> HomoclinicFollower::found_between(const HomoclinicPlace& a,
                                                                         const HomoclinicPlace& b, double step) {
  std::vector<Found> all;
  for (std::size_t k = 0; k < homoclinic_tests; ++k) {
    const auto test = static_cast<HomoclinicTest>(k);
    const double at_a = a.test(test), at_b = b.test(test);
    if (!(at_a * at_b < 0) || std::max(std::abs(at_a), std::abs(at_b)) < above_rounding) continue;
    double at = 0;
    auto place = located_zero([&](double s) { return steps_.stepped(a, s); },
                              [&](const HomoclinicPlace& each) { return each.test(test); }, step, at_a, at_b, at);
    if (!place || !(std::abs(place->test(test)) < exactly_there)) continue;
    const bool is_end = test == HomoclinicTest::leaves_centre || test == HomoclinicTest::comes_by_centre;
    if (is_end) place->point.truncation = place->truncation_of_ends[test == HomoclinicTest::leaves_centre ? 0 : 1];
    Found found{at, test, kind_of(test, *place), std::move(*place)};
    if (found.kind || reason_to_end(found)) all.push_back(std::move(found));
  }
  std::ranges::sort(all, {}, &Found::at);
  return all;
}

std::optional<OrbitDegeneracy> HomoclinicFollower::kind_of(HomoclinicTest test, const HomoclinicPlace& place) {
  using enum OrbitDegeneracy;
  const Eigenspace &stable = place.spaces.stable, &unstable = place.spaces.unstable;
  const auto leads_by_pair = [](const Eigenspace& space) { return space.dimension() > 0 && !space.leading_is_real(); };
  const bool stable_pair = leads_by_pair(stable), unstable_pair = leads_by_pair(unstable);
  switch (test) {
    case HomoclinicTest::neutral:
      return stable_pair && unstable_pair   ? neutral_focus_focus
             : stable_pair || unstable_pair ? neutral_saddle_focus
                                            : neutral_saddle;
    case HomoclinicTest::divergent_stable:
      return stable_pair && !unstable_pair ? std::optional(divergent_saddle_focus) : std::nullopt;
    case HomoclinicTest::divergent_unstable:
      return unstable_pair && !stable_pair ? std::optional(divergent_saddle_focus) : std::nullopt;
    case HomoclinicTest::double_stable:
      return double_leading_stable;
    case HomoclinicTest::double_unstable:
      return double_leading_unstable;
    case HomoclinicTest::triple_stable:
      return triple_leading_stable;
    case HomoclinicTest::triple_unstable:
      return triple_leading_unstable;
    case HomoclinicTest::rest_stable:
      return place.rest.is_saddle_node ? std::nullopt : std::optional(stable_pair ? hopf : saddle_node);
    case HomoclinicTest::rest_unstable:
      return place.rest.is_saddle_node ? std::nullopt : std::optional(unstable_pair ? hopf : saddle_node);
    case HomoclinicTest::leaves_centre:
    case HomoclinicTest::comes_by_centre:
      return non_central;
    case HomoclinicTest::curvature:
      return std::nullopt;
    case HomoclinicTest::orbit_flip_stable:
      return orbit_flip_stable;
    case HomoclinicTest::orbit_flip_unstable:
      return orbit_flip_unstable;
    case HomoclinicTest::inclination_flip_stable:
      return inclination_flip_stable;
    case HomoclinicTest::inclination_flip_unstable:
      return inclination_flip_unstable;
  }
  return std::nullopt;
}

std::optional<std::string> HomoclinicFollower::reason_to_end(const Found& found) {
  if (found.kind == OrbitDegeneracy::hopf) return "the saddle has a pair of imaginary eigenvalues there, a Hopf point";
  if (found.kind == OrbitDegeneracy::saddle_node) return "the saddle meets another equilibrium there, a saddle-node";
  if (found.kind == OrbitDegeneracy::non_central)
    return fmt::format("the orbit {} in a strong direction there, no longer along the centre of the saddle-node",
                       found.test == HomoclinicTest::leaves_centre ? "leaves" : "comes back");
  if (!found.place.rest.is_saddle_node) return std::nullopt;
  if (found.test == HomoclinicTest::curvature) return "three equilibria meet there, a cusp";
  return "a second eigenvalue of the saddle-node comes to the imaginary axis there";
}

}  // namespace

std::optional<OrbitDegeneracy> degeneracy_of(HomoclinicTest test, const HomoclinicPlace& place) {
  return HomoclinicFollower::kind_of(test, place);
}

std::vector<OrbitCurve> homoclinic_curves(const ParametricSystem& system, const OrbitMark& start,
                                          const OrbitCurveOptions& options, std::size_t most) {
  return HomoclinicFollower(system, options).from(start, most);
}

}  // namespace continuo::studies::detail
