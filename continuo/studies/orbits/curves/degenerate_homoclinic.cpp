// Follows a curve of degenerate homoclinic orbits in three constants.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/degenerate_homoclinic.hpp>
#include <continuo/studies/orbits/curves/degenerate_homoclinic_steps.hpp>
#include <continuo/studies/orbits/curves/homoclinic_curve.hpp>
#include <continuo/studies/orbits/curves/orbit_curve_course.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>
#include <continuo/studies/support/chord.hpp>
#include <continuo/studies/support/false_position.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>

namespace continuo::studies {

namespace detail {
namespace {

constexpr double bends_not_back = 0.5;  // the cosine of 60 degrees
constexpr double near_axis = 0.02;      // of the largest eigenvalue
constexpr double to_bend = 1e-3;        // of the orbit's size: a step to see how the centre manifold is run through

/// What points of a curve have in common whatever their mesh, in the sizes of one of them.
std::vector<double> seen_in_sizes(const DegenerateHomoclinicPoint& point, const DegenerateHomoclinicPoint& unit,
                                  const DegenerateHomoclinicOptions& options) {
  std::vector<double> v;
  for (std::size_t k = 0; k < 3; ++k) v.push_back(point.constants[k] / (options.high[k] - options.low[k]));
  for (std::size_t i = 0; i < point.orbit.low.size(); ++i) {
    const double size = std::max({std::abs(unit.orbit.low[i]), std::abs(unit.orbit.high[i]), 1e-12});
    v.push_back(point.orbit.low[i] / size);
    v.push_back(point.orbit.high[i] / size);
  }
  return v;
}
Chord chord_between(const DegenerateHomoclinicPoint& a, const DegenerateHomoclinicPoint& b,
                    const DegenerateHomoclinicPoint& of, const DegenerateHomoclinicOptions& options) {
  return {seen_in_sizes(a, of, options), seen_in_sizes(b, of, options), seen_in_sizes(of, of, options)};
}

bool is_of_stable_side(HomoclinicTest test) {
  using enum HomoclinicTest;
  return test == divergent_stable || test == double_stable || test == triple_stable || test == rest_stable ||
         test == orbit_flip_stable || test == inclination_flip_stable;
}
bool is_flip(HomoclinicTest test) {
  return test >= HomoclinicTest::orbit_flip_stable;
}
bool is_rest(HomoclinicTest test) {
  return test == HomoclinicTest::rest_stable || test == HomoclinicTest::rest_unstable;
}
bool is_double(HomoclinicTest test) {
  return test == HomoclinicTest::double_stable || test == HomoclinicTest::double_unstable;
}
bool is_triple(HomoclinicTest test) {
  return test == HomoclinicTest::triple_stable || test == HomoclinicTest::triple_unstable;
}

/// Whether a test says something where another one is zero. Where leading eigenvalues are alike, rounding decides which
/// leads, and whether they are a pair: what is asked of the leading one of that side has no answer.
bool says_something(HomoclinicTest test, HomoclinicTest fixed) {
  if (test == fixed) return false;
  const bool same_side = test != HomoclinicTest::neutral && is_of_stable_side(test) == is_of_stable_side(fixed);
  if ((is_double(fixed) || is_triple(fixed)) && same_side) return is_rest(test);
  return true;
}

class DegenerateHomoclinicFollower {
 public:
  DegenerateHomoclinicFollower(const ParametricSystem& system, const HomoclinicMark& start, OrbitDegeneracy kind,
                               const DegenerateHomoclinicOptions& options)
      : system_(system),
        start_(start),
        test_(start.test),
        options_(options),
        steps_(system, start.test, options),
        covered_(options.low[2], options.high[2], options.progress) {
    curve_.kind = kind;
  }
  DegenerateHomoclinicCurve curve();

 private:
  OrbitCurveEnd followed(DegenerateHomoclinicCurve& side, const DegeneratePlace& from, double direction);
  /// Where the curve goes on to: nothing, and why, where it does not.
  std::optional<DegeneratePlace> next_from(DegeneratePlace& here, StepLength& step, OrbitCurveEnd& end);
  struct Found {
    double at;
    OrbitDegeneracy kind;
    HomoclinicTest test;
    DegenerateHomoclinicPoint point;
  };
  /// All that lies between two neighbours, in the order of the curve.
  std::vector<Found> found_between(const DegeneratePlace& a, const DegeneratePlace& b);
  /// Marks what lies between; why the curve ends at one of them, if it does.
  std::optional<OrbitCurveEnd> marked(DegenerateHomoclinicCurve& side, const DegeneratePlace& here,
                                      const DegeneratePlace& next);
  std::optional<OrbitCurveEnd> end_at(const Found& found) const;
  /// Why the curve ends at, or just before, `next`, or between both.
  std::optional<OrbitCurveEnd> end_between(DegenerateHomoclinicCurve& side, const DegeneratePlace& here,
                                           const DegeneratePlace& next);
  OrbitCurveEnd out_of_range(DegenerateHomoclinicCurve& side, const DegeneratePlace& here, const DegeneratePlace& next);
  double towards_rest(const DegeneratePlace& place) const;
  bool is_near_another_zero(const DegeneratePlace& place) const;

  const ParametricSystem& system_;
  const HomoclinicMark& start_;
  HomoclinicTest test_;
  const DegenerateHomoclinicOptions& options_;
  DegenerateHomoclinicSteps steps_;
  DegenerateHomoclinicCurve curve_;
  SizesOnCurve sizes_{};
  CoveredRange covered_;
};

DegenerateHomoclinicCurve DegenerateHomoclinicFollower::curve() {
  const auto first = steps_.first(start_.place);
  if (!first) {
    curve_.status = detail::not_found("the curve could not be followed from there");
    return curve_;
  }
  if (is_rest(test_) && !(towards_rest(*first) > 0)) {
    curve_.status =
        detail::not_found("the orbit there is on the side of the saddle-node on which motions go the other way");
    return curve_;
  }
  (void)sizes_.part_of(first->orbit.point);
  curve_.points = {first->point()};
  return followed_both_ways(
      curve_, [&](DegenerateHomoclinicCurve& side, double direction) { return followed(side, *first, direction); });
}

/// On the centre manifold of a saddle-node y' = c y^2: positive where the orbit's end has y on the side from which, or
/// to which, it is to go; not a number where no eigenvalue is zero alone.
double DegenerateHomoclinicFollower::towards_rest(const DegeneratePlace& place) const {
  const HomoclinicPlace& orbit = place.orbit;
  const std::size_t n = system_.size, rest = orbit.z.size() - 2 - n;
  const bool at_end = test_ == HomoclinicTest::rest_stable;
  std::vector<double> p(system_.constants), x0(orbit.point.x), f(n);
  for (std::size_t k = 0; k < 3; ++k) p[options_.constants[k]] = place.constants[k];
  const auto a = jacobian_of(system_, 0, x0, p);
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = a[i * n + j];
    size = std::max(size, orbit.point.high[i] - orbit.point.low[i]);
  }
  const auto spaces = saddle_spaces(matrix, orbit.spaces.stable.dimension());
  if (!spaces) return std::nan("");
  const Eigenspace& side = at_end ? spaces->stable : spaces->unstable;
  if (!side.leading_is_real()) return std::nan("");
  const Eigen::VectorXd right = real_vector(side.right.col(0)), left = real_vector(side.left.col(0));
  const double step = to_bend * size, common = left.dot(right);
  double bent = 0, apart = 0;
  for (const double sign : {1.0, -1.0, 0.0}) {
    std::vector<double> x(x0);
    for (std::size_t i = 0; i < n; ++i) x[i] += sign * step * right(static_cast<Eigen::Index>(i));
    system_.derivative(0, x, p, f);
    for (std::size_t i = 0; i < n; ++i) bent += (sign == 0 ? -2 : 1) * left(static_cast<Eigen::Index>(i)) * f[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = at_end && !system_.advance.empty() ? system_.advance[i] : 0;
    apart += left(static_cast<Eigen::Index>(i)) * (orbit.z[(at_end ? rest - n : 0) + i] - x0[i] - turn);
  }
  return (at_end ? -1 : 1) * bent / (common * step * step) * (apart / common) / size;
}

/// Whether a second eigenvalue is nearly zero where one is.
bool DegenerateHomoclinicFollower::is_near_another_zero(const DegeneratePlace& place) const {
  const auto& values = place.orbit.point.eigenvalues;
  double greatest = 0;
  for (const auto& value : values) greatest = std::max(greatest, std::abs(value));
  const auto near =
      std::ranges::count_if(values, [&](const auto& value) { return std::abs(value.real()) < near_axis * greatest; });
  return near > (is_rest(test_) ? 1 : 0);
}

std::optional<DegeneratePlace> DegenerateHomoclinicFollower::next_from(DegeneratePlace& here, StepLength& step,
                                                                       OrbitCurveEnd& end) {
  while (true) {
    auto next = steps_.stepped(here, step);
    if (options_.interrupt && options_.interrupt->load()) {
      end = {OrbitCurveEnding::interrupted, "it was interrupted"};
      return std::nullopt;
    }
    const bool is_coarse = next && next->orbit.error > resolved_well;
    const double cosine = next ? steps_.alike(here, *next) : 0;
    if (next && !is_coarse && cosine > least_cosine_of_neighbours) return next;
    // A shorter secant is nearer to the tangent than that of the step before, which another mesh may have changed.
    if (next && !is_coarse && cosine > bends_not_back) DegenerateHomoclinicSteps::take_direction(here, *next);
    if (step.shorten()) continue;
    end = {OrbitCurveEnding::lost, is_coarse ? "no mesh serves the orbits further on"
                                   : is_near_another_zero(here)
                                       ? "the curve could not be followed further: another eigenvalue of the place of "
                                         "rest comes near to the imaginary axis"
                                       : "the curve could not be followed further"};
    return std::nullopt;
  }
}

OrbitCurveEnd DegenerateHomoclinicFollower::followed(DegenerateHomoclinicCurve& side, const DegeneratePlace& from,
                                                     double direction) {
  DegeneratePlace here(from);
  for (double& part : here.orbit.carried[0]) part *= direction;
  for (double& part : here.direction) part *= direction;
  const DegenerateHomoclinicPoint origin = from.point();
  StepLength step(options_);
  while (side.points.size() < options_.most_points) {
    const auto turned = steps_.turned(here, steps_.fastest(here));
    if (turned) here = *turned;
    OrbitCurveEnd end;
    auto next = next_from(here, step, end);
    if (!next) return end;
    if (auto at_mark = marked(side, here, *next)) return *at_mark;
    if (auto there = end_between(side, here, *next)) return *there;
    side.points.push_back(next->point());
    covered_.report(next->constants[2]);
    const Chord chord = chord_between(here.point(), next->point(), origin, options_);
    if (side.points.size() > points_round && chord.passes() && chord.apart < 0.1 * chord.length)
      return {OrbitCurveEnding::closed, "the curve is closed"};
    here = std::move(*next);
    if (!steps_.renew(here)) return {OrbitCurveEnding::lost, "no mesh serves the orbits further on"};
    step.lengthen();
  }
  return {OrbitCurveEnding::too_many_points,
          fmt::format("it has {} points, as many as are allowed", side.points.size())};
}

std::optional<OrbitCurveEnd> DegenerateHomoclinicFollower::marked(DegenerateHomoclinicCurve& side,
                                                                  const DegeneratePlace& here,
                                                                  const DegeneratePlace& next) {
  for (Found& found : found_between(here, next)) {
    if (!is_within(found.point.constants, options_.low, options_.high)) return std::nullopt;
    side.marks.push_back({.kind = found.kind, .at = found.point, .next = side.points.size()});
    auto end = end_at(found);
    if (!end) continue;
    side.points.push_back(found.point);
    return end;
  }
  return std::nullopt;
}

std::optional<OrbitCurveEnd> DegenerateHomoclinicFollower::end_at(const Found& found) const {
  if (found.kind == OrbitDegeneracy::hopf)
    return OrbitCurveEnd{OrbitCurveEnding::no_saddle,
                         "the saddle has a pair of imaginary eigenvalues there, a Hopf point"};
  if (found.kind == OrbitDegeneracy::saddle_node)
    return OrbitCurveEnd{OrbitCurveEnding::no_saddle, "the saddle meets another equilibrium there, a saddle-node"};
  const bool same_side = is_of_stable_side(found.test) == is_of_stable_side(test_);
  const bool of_leading =
      is_flip(test_) || test_ == HomoclinicTest::divergent_stable || test_ == HomoclinicTest::divergent_unstable;
  if ((is_double(found.test) || is_triple(found.test)) &&
      (test_ == HomoclinicTest::neutral || (of_leading && same_side)))
    return OrbitCurveEnd{OrbitCurveEnding::merged, "leading eigenvalues meet there, and behind it another one leads"};
  if (is_rest(test_) && same_side &&
      (found.test == HomoclinicTest::orbit_flip_stable || found.test == HomoclinicTest::orbit_flip_unstable))
    return OrbitCurveEnd{OrbitCurveEnding::no_saddle,
                         "behind it the orbit is on the side of the saddle-node on which motions go the other way"};
  return std::nullopt;
}

OrbitCurveEnd DegenerateHomoclinicFollower::out_of_range(DegenerateHomoclinicCurve& side, const DegeneratePlace& here,
                                                         const DegeneratePlace& next) {
  const LeftRange left = left_range(here.constants, next.constants, options_.low, options_.high);
  // An orbit that lies on the bound already is that place.
  if (const auto place = left.part > 0 ? steps_.at_bound(here, next, left.constant, left.bound) : std::nullopt)
    side.points.push_back(place->point());
  return end_of_range(system_, options_, left);
}

std::optional<OrbitCurveEnd> DegenerateHomoclinicFollower::end_between(DegenerateHomoclinicCurve& side,
                                                                       const DegeneratePlace& here,
                                                                       const DegeneratePlace& next) {
  const DegenerateHomoclinicPoint point = next.point();
  if (!is_within(point.constants, options_.low, options_.high)) return out_of_range(side, here, next);
  if (sizes_.part_of(point.orbit) < shrunk_to_rest)
    return OrbitCurveEnd{OrbitCurveEnding::equilibrium, "the orbit shrinks to an equilibrium"};
  if (point.orbit.truncation > truncated_well)
    return OrbitCurveEnd{
        OrbitCurveEnding::long_period,
        fmt::format("what is cut off of the orbit would move the constants by {:.2g} of their ranges further on: "
                    "motions leave the saddle, or come to it, too slowly",
                    point.orbit.truncation)};
  const double towards = is_rest(test_) ? towards_rest(next) : 1;
  if (std::isnan(towards))
    return OrbitCurveEnd{OrbitCurveEnding::no_saddle, "another eigenvalue of the saddle-node becomes zero there"};
  if (towards > 0) return std::nullopt;
  double at = 0;
  const auto place =
      located_zero([&](double part) { return steps_.between(here, next, part); },
                   [&](const DegeneratePlace& each) { return towards_rest(each); }, 1, towards_rest(here), towards, at);
  if (place) side.points.push_back(place->point());
  return OrbitCurveEnd{OrbitCurveEnding::no_saddle,
                       "the saddle-node meets a third equilibrium there, a cusp: behind it the orbit is on the side "
                       "on which motions go the other way"};
}

std::vector<DegenerateHomoclinicFollower::Found> DegenerateHomoclinicFollower::found_between(const DegeneratePlace& a,
                                                                                             const DegeneratePlace& b) {
  std::vector<Found> all;
  for (std::size_t k = 0; k < homoclinic_tests; ++k) {
    const auto test = static_cast<HomoclinicTest>(k);
    if (!says_something(test, test_)) continue;
    const double at_a = a.orbit.test(test), at_b = b.orbit.test(test);
    if (!(at_a * at_b < 0) || std::max(std::abs(at_a), std::abs(at_b)) < above_rounding) continue;
    double at = 0;
    const auto place =
        located_zero([&](double part) { return steps_.between(a, b, part); },
                     [&](const DegeneratePlace& each) { return each.orbit.test(test); }, 1, at_a, at_b, at);
    if (!place || !(std::abs(place->orbit.test(test)) < exactly_there)) continue;
    if (const auto kind = degeneracy_of(test, place->orbit)) all.push_back({at, *kind, test, place->point()});
  }
  std::ranges::sort(all, {}, &Found::at);
  return all;
}

}  // namespace
}  // namespace detail

DegenerateHomoclinicCurve follow_degenerate_homoclinic(const ParametricSystem& system, const DegenerateOrbit& start,
                                                       const DegenerateHomoclinicOptions& options) {
  DegenerateHomoclinicCurve curve{.kind = start.kind};
  if (!start.homoclinic) {
    curve.status = invalid_input("only what is marked on a curve of homoclinic orbits is followed in three parameters");
    return curve;
  }
  if (start.kind == OrbitDegeneracy::hopf) {
    curve.status = invalid_input(
        "orbits homoclinic to a Hopf point are not followed: whether they converge to it depends on how it attracts");
    return curve;
  }
  ParametricSystem turning(system);
  turning.advance = start.homoclinic->advance;
  return detail::DegenerateHomoclinicFollower(turning, *start.homoclinic, start.kind, options).curve();
}

std::vector<DegenerateHomoclinicCurve> degenerate_homoclinic_curves(const ParametricSystem& system,
                                                                    const std::vector<OrbitCurveOfDiagram>& curves,
                                                                    const DegenerateHomoclinicOptions& options,
                                                                    std::size_t most_curves) {
  std::vector<DegenerateHomoclinicCurve> all;
  const auto is_known = [&](const DegenerateOrbit& mark) {
    const DegenerateHomoclinicPoint at{
        .constants = {mark.at.constants[0], mark.at.constants[1], system.constants[options.constants[2]]},
        .orbit = mark.at};
    return std::ranges::any_of(all, [&](const DegenerateHomoclinicCurve& curve) {
      if (curve.kind != mark.kind) return false;
      for (std::size_t k = 1; k < curve.points.size(); ++k) {
        const detail::Chord chord = detail::chord_between(curve.points[k - 1], curve.points[k], at, options);
        if (chord.passes() && chord.apart < detail::same_orbit_on_chord) return true;
      }
      return false;
    });
  };
  for (const OrbitCurveOfDiagram& of : curves)
    for (const DegenerateOrbit& mark : of.curve.marks) {
      if (!mark.homoclinic || all.size() >= most_curves || is_known(mark)) continue;
      if (options.interrupt && options.interrupt->load()) return all;
      all.push_back(follow_degenerate_homoclinic(system, mark, options));
    }
  return all;
}

}  // namespace continuo::studies
