// Follows a curve of degenerate homoclinic orbits in three constants.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/degenerate_homoclinic.hpp>
#include <continuo/studies/orbits/curves/degenerate_homoclinic_steps.hpp>
#include <continuo/studies/orbits/curves/homoclinic_curve.hpp>
#include <continuo/studies/support/false_position.hpp>

namespace continuo::studies {

namespace detail {
namespace {

constexpr double bends_little = 0.906;    // the cosine of 25 degrees
constexpr double bends_not_back = 0.5;    // of 60 degrees
constexpr double truncated_well = 1e-6;   // of the ranges: by how much constants may be off
constexpr double resolved_well = 1e-4;    // likewise of the orbit
constexpr double shrunk_to_rest = 5e-4;   // of the greatest size on the curve
constexpr double exactly_there = 1e-6;    // of a test that is of the size of 1
constexpr double above_rounding = 1e-9;   // likewise
constexpr std::size_t points_round = 12;  // of a closed curve
constexpr double same_orbit = 2e-3;       // in sizes: chords of a curve are not nearer to it
constexpr double near_axis = 0.02;        // of the largest eigenvalue
constexpr double to_bend = 1e-3;          // of the orbit's size: a step to see how the centre manifold is run through

/// What a line between neighbours has to do with another point of the curve, in sizes.
struct Chord {
  Chord(const DegenerateHomoclinicPoint& a, const DegenerateHomoclinicPoint& b, const DegenerateHomoclinicPoint& of,
        const DegenerateHomoclinicOptions& options) {
    const auto u = coordinates(a, of, options), v = coordinates(b, of, options), o = coordinates(of, of, options);
    double square = 0, along = 0, rest = 0;
    for (std::size_t i = 0; i < o.size(); ++i) {
      square += (v[i] - u[i]) * (v[i] - u[i]);
      along += (v[i] - u[i]) * (o[i] - u[i]);
    }
    whole = std::sqrt(square);
    part = along / square;
    for (std::size_t i = 0; i < o.size(); ++i) rest += std::pow(u[i] + part * (v[i] - u[i]) - o[i], 2);
    apart = std::sqrt(rest);
  }
  bool passes() const { return part >= 0 && part <= 1; }
  double whole = 0, part = 0, apart = 0;

 private:
  static std::vector<double> coordinates(const DegenerateHomoclinicPoint& point, const DegenerateHomoclinicPoint& unit,
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
};

bool is_inside(const DegenerateHomoclinicPoint& point, const DegenerateHomoclinicOptions& options) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!(point.constants[k] >= options.low[k] && point.constants[k] <= options.high[k])) return false;
  return true;
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
      : system_(system), start_(start), test_(start.test), options_(options), steps_(system, start.test, options) {
    curve_.kind = kind;
  }
  DegenerateHomoclinicCurve curve();

 private:
  OrbitCurveEnd followed(DegenerateHomoclinicCurve& side, const DegeneratePlace& from, double direction);
  /// Where the curve goes on to: nothing, and why, where it does not.
  std::optional<DegeneratePlace> next_from(DegeneratePlace& here, double& step, OrbitCurveEnd& end);
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
  double size_of(const OrbitCurvePoint& point);
  void report(double value);

  const ParametricSystem& system_;
  const HomoclinicMark& start_;
  HomoclinicTest test_;
  const DegenerateHomoclinicOptions& options_;
  DegenerateHomoclinicSteps steps_;
  DegenerateHomoclinicCurve curve_;
  std::vector<double> greatest_{};  // how far each component has gone from the saddle so far
  double least_third_ = std::numeric_limits<double>::infinity(), greatest_third_ = -least_third_;
};

DegenerateHomoclinicCurve DegenerateHomoclinicFollower::curve() {
  const auto first = steps_.first(start_.place);
  if (!first) {
    curve_.message = "the curve could not be followed from there";
    return curve_;
  }
  if (is_rest(test_) && !(towards_rest(*first) > 0)) {
    curve_.message = "the orbit there is on the side of the saddle-node on which motions go the other way";
    return curve_;
  }
  (void)size_of(first->orbit.point);
  DegenerateHomoclinicCurve back, ahead;
  curve_.ends[0] = followed(back, *first, -1);
  const bool closed = curve_.ends[0].ending == OrbitCurveEnding::closed;
  if (closed) back.points.push_back(first->point());
  std::ranges::reverse(back.points);
  std::ranges::reverse(back.marks);
  for (MarkedHomoclinic& mark : back.marks) mark.next = back.points.size() - mark.next - (closed ? 1 : 0);
  curve_.points = std::move(back.points);
  curve_.marks = std::move(back.marks);
  curve_.points.push_back(first->point());
  curve_.ends[1] = curve_.ends[0];
  if (closed || curve_.ends[0].ending == OrbitCurveEnding::interrupted) return curve_;
  curve_.ends[1] = followed(ahead, *first, 1);
  for (MarkedHomoclinic& mark : ahead.marks) mark.next += curve_.points.size();
  curve_.points.insert(curve_.points.end(), ahead.points.begin(), ahead.points.end());
  curve_.marks.insert(curve_.marks.end(), ahead.marks.begin(), ahead.marks.end());
  return curve_;
}

double DegenerateHomoclinicFollower::size_of(const OrbitCurvePoint& point) {
  greatest_.resize(point.x.size());
  double part = 0;
  for (std::size_t i = 0; i < point.x.size(); ++i) {
    const double size = std::max(point.high[i] - point.x[i], point.x[i] - point.low[i]);
    greatest_[i] = std::max(greatest_[i], size);
    if (greatest_[i] > 0) part = std::max(part, size / greatest_[i]);
  }
  return part;
}

void DegenerateHomoclinicFollower::report(double value) {
  least_third_ = std::min(least_third_, value);
  greatest_third_ = std::max(greatest_third_, value);
  const double whole = options_.high[2] - options_.low[2];
  if (options_.progress) options_.progress(std::min((greatest_third_ - least_third_) / whole, 1.0));
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

std::optional<DegeneratePlace> DegenerateHomoclinicFollower::next_from(DegeneratePlace& here, double& step,
                                                                       OrbitCurveEnd& end) {
  while (true) {
    auto next = steps_.stepped(here, step);
    if (options_.interrupt && options_.interrupt->load()) {
      end = {OrbitCurveEnding::interrupted, "it was interrupted"};
      return std::nullopt;
    }
    const bool is_coarse = next && next->orbit.error > resolved_well;
    const double cosine = next ? steps_.alike(here, *next) : 0;
    if (next && !is_coarse && cosine > bends_little) return next;
    // A shorter secant is nearer to the tangent than that of the step before, which another mesh may have changed.
    if (next && !is_coarse && cosine > bends_not_back) DegenerateHomoclinicSteps::take_direction(here, *next);
    step /= 2;
    if (step > options_.least_step) continue;
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
  double step = options_.first_step;
  while (side.points.size() < options_.most_points) {
    const auto turned = steps_.turned(here, steps_.fastest(here));
    if (turned) here = *turned;
    OrbitCurveEnd end;
    auto next = next_from(here, step, end);
    if (!next) return end;
    if (auto at_mark = marked(side, here, *next)) return *at_mark;
    if (auto there = end_between(side, here, *next)) return *there;
    side.points.push_back(next->point());
    report(next->constants[2]);
    const Chord chord(here.point(), next->point(), origin, options_);
    if (side.points.size() > points_round && chord.passes() && chord.apart < 0.1 * chord.whole)
      return {OrbitCurveEnding::closed, "it comes back to where it began"};
    here = std::move(*next);
    if (!steps_.renew(here)) return {OrbitCurveEnding::lost, "no mesh serves the orbits further on"};
    step = std::min(1.3 * step, options_.largest_step);
  }
  return {OrbitCurveEnding::too_many_points,
          fmt::format("it has {} points, as many as are allowed", side.points.size())};
}

std::optional<OrbitCurveEnd> DegenerateHomoclinicFollower::marked(DegenerateHomoclinicCurve& side,
                                                                  const DegeneratePlace& here,
                                                                  const DegeneratePlace& next) {
  for (Found& found : found_between(here, next)) {
    if (!is_inside(found.point, options_)) return std::nullopt;
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
    return OrbitCurveEnd{OrbitCurveEnding::no_saddle, "the saddle meets another place of rest there, a saddle-node"};
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
  std::size_t constant = 0;
  double first = 2, bound = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double to = next.constants[k], limit = std::clamp(to, options_.low[k], options_.high[k]);
    if (to == limit) continue;
    const double at = (limit - here.constants[k]) / (to - here.constants[k]);
    if (at < first) first = at, constant = k, bound = limit;
  }
  // An orbit that lies on the bound already is that place.
  if (const auto place = first > 0 ? steps_.at_bound(here, next, constant, bound) : std::nullopt)
    side.points.push_back(place->point());
  return {OrbitCurveEnding::bound,
          fmt::format("{} reaches the end of its range", system_.constant_name(options_.constants[constant]))};
}

std::optional<OrbitCurveEnd> DegenerateHomoclinicFollower::end_between(DegenerateHomoclinicCurve& side,
                                                                       const DegeneratePlace& here,
                                                                       const DegeneratePlace& next) {
  const DegenerateHomoclinicPoint point = next.point();
  if (!is_inside(point, options_)) return out_of_range(side, here, next);
  if (size_of(point.orbit) < shrunk_to_rest)
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
                       "the saddle-node meets a third place of rest there, a cusp: behind it the orbit is on the side "
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
    curve.message = "only what is marked on a curve of homoclinic orbits is followed in three parameters";
    return curve;
  }
  if (start.kind == OrbitDegeneracy::hopf) {
    curve.message =
        "orbits homoclinic to a Hopf point are not followed: whether they come to rest there hangs on how it attracts";
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
        const detail::Chord chord(curve.points[k - 1], curve.points[k], at, options);
        if (chord.passes() && chord.apart < detail::same_orbit) return true;
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
