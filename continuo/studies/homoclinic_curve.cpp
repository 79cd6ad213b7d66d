#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/false_position.hpp>
#include <continuo/studies/homoclinic_curve.hpp>
#include <continuo/studies/homoclinic_steps.hpp>
#include <continuo/studies/orbit_curve_course.hpp>
#include <continuo/studies/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

constexpr double bends_little = 0.906;    // the cosine of 25 degrees
constexpr double truncated_well = 1e-6;   // of the ranges: by how much constants may be off
constexpr double resolved_well = 1e-4;    // likewise of the orbit
constexpr double shrunk_to_rest = 5e-4;   // of the greatest size on the curve
constexpr double exactly_there = 1e-6;    // of a test that is of the size of 1
constexpr double above_rounding = 1e-9;   // likewise
constexpr std::size_t points_round = 12;  // of a closed curve

class HomoclinicFollower {
 public:
  HomoclinicFollower(const ParametricSystem& system, const OrbitCurveOptions& options)
      : system_(system), options_(options), steps_(system, options), covered_(options) {}

  OrbitCurve from(const OrbitMark& start);
  /// What a place where this test is zero is; nothing where the zero is none.
  static std::optional<OrbitDegeneracy> kind_of(HomoclinicTest test, const HomoclinicPlace& place);

 private:
  OrbitCurveEnd followed(OrbitCurve& curve, const HomoclinicPlace& from, double direction);
  struct Found {
    double at;
    OrbitDegeneracy kind;
    HomoclinicTest test;
    HomoclinicPlace place;
  };
  /// All that lies between two neighbours, in the order of the curve.
  std::vector<Found> found_between(const HomoclinicPlace& a, const HomoclinicPlace& b, double step);
  double size_of(const OrbitCurvePoint& point);

  const ParametricSystem& system_;
  const OrbitCurveOptions& options_;
  HomoclinicSteps steps_;
  CoveredRange covered_;
  std::vector<double> greatest_{};  // how far each component has gone from the saddle so far
};

OrbitCurve HomoclinicFollower::from(const OrbitMark& start) {
  OrbitCurve curve{.kind = OrbitBifurcation::homoclinic};
  const auto first = steps_.first(start, curve.message);
  if (!first) return curve;
  if (first->point.truncation > truncated_well) {
    curve.message = fmt::format(
        "what is cut off of the homoclinic orbit would move the constants by {:.2g} of their ranges: motions leave the "
        "saddle, or come to it, too slowly",
        first->point.truncation);
    return curve;
  }
  (void)size_of(first->point);
  return followed_both_ways(curve.kind, first->point,
                            [&](OrbitCurve& side, double direction) { return followed(side, *first, direction); });
}

double HomoclinicFollower::size_of(const OrbitCurvePoint& point) {
  greatest_.resize(point.x.size());
  double part = 0;
  for (std::size_t i = 0; i < point.x.size(); ++i) {
    const double size = std::max(point.high[i] - point.x[i], point.x[i] - point.low[i]);
    greatest_[i] = std::max(greatest_[i], size);
    if (greatest_[i] > 0) part = std::max(part, size / greatest_[i]);
  }
  return part;
}

OrbitCurveEnd HomoclinicFollower::followed(OrbitCurve& curve, const HomoclinicPlace& from, double direction) {
  HomoclinicPlace here(from);
  for (double& part : here.tangent) part *= direction;
  // The adjoint solution is normalised by the tangent, and turns with it.
  for (const HomoclinicTest test : {HomoclinicTest::inclination_flip_stable, HomoclinicTest::inclination_flip_unstable})
    here.tests[static_cast<std::size_t>(test)] *= direction;
  const OrbitCurvePoint origin(here.point);
  double step = options_.first_step;
  while (curve.points.size() < options_.most_points) {
    auto next = steps_.stepped(here, step);
    if (options_.interrupt && options_.interrupt->load()) return {OrbitCurveEnding::interrupted, "it was interrupted"};
    const bool is_coarse = next && next->error > resolved_well;
    if (!next || is_coarse || product(here.tangent, next->tangent) < bends_little) {
      step /= 2;
      if (step > options_.least_step) continue;
      return {OrbitCurveEnding::lost,
              is_coarse ? "no mesh serves the orbits further on" : "the curve could not be followed further"};
    }
    for (Found& found : found_between(here, *next, step)) {
      if (!is_inside(found.place.point, options_)) break;
      curve.marks.push_back({.kind = found.kind,
                             .at = found.place.point,
                             .next = curve.points.size(),
                             .homoclinic = std::make_shared<HomoclinicMark>(found.place, found.test, system_.advance)});
      if (found.kind != OrbitDegeneracy::saddle_node && found.kind != OrbitDegeneracy::hopf) continue;
      curve.points.push_back(found.place.point);
      return {OrbitCurveEnding::no_saddle, found.kind == OrbitDegeneracy::hopf
                                               ? "the saddle has a pair of imaginary eigenvalues there, a Hopf point"
                                               : "the saddle meets another place of rest there, a saddle-node"};
    }
    if (!is_inside(next->point, options_)) {
      const LeftRange left = left_range(here.point, next->point, options_);
      if (const auto place = steps_.at_bound(here, *next, left.constant, left.bound))
        curve.points.push_back(place->point);
      return end_of_range(system_, options_, left);
    }
    if (size_of(next->point) < shrunk_to_rest)
      return {OrbitCurveEnding::equilibrium, "the orbit shrinks to an equilibrium"};
    if (next->point.truncation > truncated_well)
      return {OrbitCurveEnding::long_period,
              fmt::format("what is cut off of the orbit would move the constants by {:.2g} of their ranges further on: "
                          "motions leave the saddle, or come to it, too slowly",
                          next->point.truncation)};
    curve.points.push_back(next->point);
    covered_.report(next->point.constants[1]);
    if (curve.points.size() > points_round && comes_back(here.point, next->point, origin, options_))
      return {OrbitCurveEnding::closed, "it comes back to where it began"};
    here = std::move(*next);
    if (!steps_.renew(here)) return {OrbitCurveEnding::lost, "no mesh serves the orbits further on"};
    step = std::min(1.3 * step, options_.largest_step);
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
    if (const auto kind = kind_of(test, *place)) all.push_back({at, *kind, test, std::move(*place)});
  }
  std::ranges::sort(all, {}, &Found::at);
  return all;
}

std::optional<OrbitDegeneracy> HomoclinicFollower::kind_of(HomoclinicTest test, const HomoclinicPlace& place) {
  using enum OrbitDegeneracy;
  const Eigenspace &stable = place.spaces.stable, &unstable = place.spaces.unstable;
  const bool stable_pair = !stable.leading_is_real(), unstable_pair = !unstable.leading_is_real();
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
      return stable_pair ? hopf : saddle_node;
    case HomoclinicTest::rest_unstable:
      return unstable_pair ? hopf : saddle_node;
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

}  // namespace

std::optional<OrbitDegeneracy> degeneracy_of(HomoclinicTest test, const HomoclinicPlace& place) {
  return HomoclinicFollower::kind_of(test, place);
}

OrbitCurve homoclinic_curve(const ParametricSystem& system, const OrbitMark& start, const OrbitCurveOptions& options) {
  return HomoclinicFollower(system, options).from(start);
}

}  // namespace continuo::studies::detail
