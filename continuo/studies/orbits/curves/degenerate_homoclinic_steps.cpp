// Predictor and corrector on a curve of degenerate homoclinic orbits.
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/studies/orbits/curves/degenerate_homoclinic_steps.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr int most_zero_steps = 12;
constexpr double zero_within = 1e-9;                       // along the curve in two constants, in sizes
constexpr double first_trial = 1e-4, farthest_zero = 0.1;  // likewise
constexpr double leaps = 100;                              // times as steep as at the first trial
constexpr double clearly_faster = 1.5;                     // than the constant that is held
constexpr double off_at_most = 2;                          // of a step: what is found from what was predicted
constexpr double probing = 1e-3;                           // of a range: a step to find the direction at the start
constexpr int most_probes = 4;                             // each a tenth as long as the one before

std::array<std::size_t, 2> others_than(std::size_t held) {
  return held == 0   ? std::array<std::size_t, 2>{1, 2}
         : held == 1 ? std::array<std::size_t, 2>{0, 2}
                     : std::array<std::size_t, 2>{0, 1};
}

OrbitCurveOptions in_two(const DegenerateHomoclinicOptions& options, std::size_t held) {
  OrbitCurveOptions two{.rtol = options.rtol, .interrupt = options.interrupt};
  const auto others = others_than(held);
  for (std::size_t c = 0; c < 2; ++c) {
    two.constants[c] = options.constants[others[c]];
    two.low[c] = options.low[others[c]];
    two.high[c] = options.high[others[c]];
  }
  return two;
}

/// As straight as a line near its zero: for Newton's iteration.
double straight_test(HomoclinicTest test, const HomoclinicPlace& place) {
  const auto first = static_cast<std::size_t>(HomoclinicTest::orbit_flip_stable), k = static_cast<std::size_t>(test);
  return k >= first ? place.flips[k - first] : place.test(test);
}

}  // namespace

DegenerateHomoclinicPoint DegeneratePlace::point() const {
  DegenerateHomoclinicPoint point{.constants = constants, .orbit = orbit.point};
  point.orbit.constants = {constants[0], constants[1]};
  return point;
}

DegenerateHomoclinicSteps::Plane::Plane(const ParametricSystem& whole, const DegenerateHomoclinicOptions& of_three,
                                        std::size_t held)
    : system(whole), options(in_two(of_three, held)), steps(system, options), constant(of_three.constants[held]) {}

DegenerateHomoclinicSteps::DegenerateHomoclinicSteps(const ParametricSystem& system, HomoclinicTest test,
                                                     const DegenerateHomoclinicOptions& options)
    : test_(test), options_(options) {
  for (std::size_t held = 0; held < 3; ++held) planes_[held] = std::make_unique<Plane>(system, options, held);
}

// Newton's iteration along the curve in two constants, with the slope of a secant. Where a test leaps, that grows.
std::optional<HomoclinicPlace> DegenerateHomoclinicSteps::zero_from(Plane& plane, HomoclinicPlace place) const {
  double value = straight_test(test_, place), step = first_trial, first_slope = 0, whole = 0;
  for (int k = 0; k < most_zero_steps && std::isfinite(value); ++k) {
    whole += step;
    if (!(std::abs(whole) < farthest_zero)) return std::nullopt;
    auto next = plane.steps.stepped(place, step);
    if (!next) return std::nullopt;
    const double at_next = straight_test(test_, *next), slope = (at_next - value) / step;
    place = std::move(*next);
    value = at_next;
    if (k == 0) first_slope = slope;
    if (!std::isfinite(slope) || slope == 0 || std::abs(slope) > leaps * std::abs(first_slope)) return std::nullopt;
    step = -value / slope;
    if (std::abs(step) < zero_within) return place;
  }
  return std::nullopt;
}

std::optional<DegeneratePlace> DegenerateHomoclinicSteps::turned(const DegeneratePlace& place, std::size_t held) {
  if (place.held == held) return place;
  Plane& plane = *planes_[held];
  plane.hold(place.constants[held]);
  DegeneratePlace result(place);
  const auto others = others_than(held);
  const std::size_t size = place.orbit.z.size();
  for (std::size_t c = 0; c < 2; ++c) {
    result.orbit.z[size - 2 + c] = place.constants[others[c]];
    if (result.orbit.carried.empty()) continue;
    result.orbit.carried[0][size - 2 + c] = place.direction[others[c]];
    result.orbit.carried[1][size - 2 + c] = place.bend[others[c]];
  }
  // The curve in two constants bends where one of them does not move; the other one does then.
  for (const std::size_t unknown : {size - 1, size - 2}) {
    Vector row(size);
    row[unknown] = 1;
    auto again = plane.steps.near(result.orbit, result.orbit.z, row);
    if (!again) continue;
    again->carried = std::move(result.orbit.carried);
    result.orbit = std::move(*again);
    result.held = held;
    for (std::size_t c = 0; c < 2; ++c) result.constants[others[c]] = result.orbit.z[size - 2 + c];
    return result;
  }
  return std::nullopt;
}

/// With the held constant at a value; the guess has the other two behind the other unknowns.
std::optional<DegeneratePlace> DegenerateHomoclinicSteps::solved(const DegeneratePlace& from, double value,
                                                                 const Vector& guess) {
  Plane& plane = *planes_[from.held];
  plane.hold(value);
  auto near = plane.steps.near(from.orbit, guess, from.orbit.tangent);
  if (!near) return std::nullopt;
  auto orbit = zero_from(plane, std::move(*near));
  if (!orbit) return std::nullopt;
  DegeneratePlace place{.orbit = std::move(*orbit), .held = from.held};
  place.constants[from.held] = value;
  const auto others = others_than(from.held);
  for (std::size_t c = 0; c < 2; ++c) place.constants[others[c]] = place.orbit.z[place.orbit.z.size() - 2 + c];
  return place;
}

/// Reached by `part` of the direction there. A parabola through three places goes on by b s (s + 1) beyond the line.
void DegenerateHomoclinicSteps::set_direction(DegeneratePlace& place, const DegeneratePlace& from, double part) const {
  Vector secant(place.orbit.z), bend(secant.size());
  const bool first = from.orbit.carried.empty();
  const auto bent = [&](double change, double before) { return (change - part * before) * part / (part + 1); };
  for (std::size_t j = 0; j < secant.size(); ++j) {
    secant[j] -= from.orbit.z[j];
    if (!first) bend[j] = bent(secant[j], from.orbit.carried[0][j]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    place.direction[k] = place.constants[k] - from.constants[k];
    place.bend[k] = first ? 0 : bent(place.direction[k], from.direction[k]);
  }
  place.orbit.carried = {std::move(secant), std::move(bend)};
}

void DegenerateHomoclinicSteps::take_direction(DegeneratePlace& place, const DegeneratePlace& of) {
  place.direction = of.direction;
  place.bend = {};
  place.orbit.carried = {of.orbit.carried[0], Vector(of.orbit.z.size())};
}

/// The direction `of` a place as it counts `at` one with the same mesh and the same constant held.
DegenerateHomoclinicSteps::Vector DegenerateHomoclinicSteps::in_sizes(const DegeneratePlace& at,
                                                                      const DegeneratePlace& of) {
  Vector direction = planes_[at.held]->steps.in_sizes(at.orbit, of.orbit.carried[0]);
  direction.push_back(of.direction[at.held] / range(at.held));
  return direction;
}

double DegenerateHomoclinicSteps::alike(const DegeneratePlace& a, const DegeneratePlace& b) {
  const Vector u = in_sizes(a, a), v = in_sizes(a, b);
  return product(u, v) / (length(u) * length(v));
}

std::size_t DegenerateHomoclinicSteps::fastest(const DegeneratePlace& place) const {
  const auto speed = [&](std::size_t k) { return std::abs(place.direction[k]) / range(k); };
  std::size_t best = place.held;
  for (std::size_t k = 0; k < 3; ++k)
    if (speed(k) > speed(best) * (best == place.held ? clearly_faster : 1)) best = k;
  return best;
}

/// A place next to the first one, with its secant.
std::optional<DegeneratePlace> DegenerateHomoclinicSteps::near_start(const DegeneratePlace& start, std::size_t held) {
  const auto from = turned(start, held);
  if (!from) return std::nullopt;
  const bool ahead = from->constants[held] <= (options_.low[held] + options_.high[held]) / 2;
  double step = (ahead ? probing : -probing) * range(held);
  for (int k = 0; k < most_probes; ++k, step /= 10) {
    auto place = solved(*from, from->constants[held] + step, from->orbit.z);
    if (!place) continue;
    set_direction(*place, *from, 1);
    if (length(in_sizes(*from, *place)) > farthest_zero) continue;
    DegeneratePlace here(*from);
    take_direction(here, *place);
    return here;
  }
  return std::nullopt;
}

std::optional<DegeneratePlace> DegenerateHomoclinicSteps::first(const HomoclinicPlace& start) {
  for (const auto& plane : planes_) plane->steps.take_up(start, options_.longest_interval * start.length);
  DegeneratePlace place{.orbit = start, .held = 2};
  place.constants = {start.point.constants[0], start.point.constants[1],
                     planes_[2]->system.constants[options_.constants[2]]};
  planes_[2]->hold(place.constants[2]);
  for (const std::size_t held : std::array<std::size_t, 3>{2, 1, 0})
    if (auto here = near_start(place, held)) return here;
  return std::nullopt;
}

std::optional<DegeneratePlace> DegenerateHomoclinicSteps::stepped(const DegeneratePlace& from, double step) {
  const double part = step / length(in_sizes(from, from)), bent = part * (part + 1);
  const auto further = [&](double direction, double bend) { return part * direction + bent * bend; };
  Vector guess(from.orbit.z);
  for (std::size_t j = 0; j < guess.size(); ++j)
    guess[j] += further(from.orbit.carried[0][j], from.orbit.carried[1][j]);
  const std::size_t held = from.held;
  auto place = solved(from, from.constants[held] + further(from.direction[held], from.bend[held]), guess);
  if (!place) return std::nullopt;
  Vector moved(place->orbit.z);
  for (std::size_t j = 0; j < moved.size(); ++j) moved[j] -= guess[j];
  if (length(planes_[held]->steps.in_sizes(from.orbit, std::move(moved))) > off_at_most * step) return std::nullopt;
  set_direction(*place, from, part);
  return place;
}

std::optional<DegeneratePlace> DegenerateHomoclinicSteps::between(const DegeneratePlace& a, const DegeneratePlace& b,
                                                                  double part) {
  return solved(a, a.constants[a.held] + part * (b.constants[a.held] - a.constants[a.held]),
                detail::between(a.orbit.z, b.orbit.z, part));
}

std::optional<DegeneratePlace> DegenerateHomoclinicSteps::at_bound(const DegeneratePlace& a, const DegeneratePlace& b,
                                                                   std::size_t constant, double value) {
  const double part = (value - a.constants[constant]) / (b.constants[constant] - a.constants[constant]);
  auto near = between(a, b, part);
  if (near) near = turned(*near, constant);
  if (!near) return std::nullopt;
  return solved(*near, value, near->orbit.z);
}

bool DegenerateHomoclinicSteps::renew(DegeneratePlace& place) {
  Plane& plane = *planes_[place.held];
  plane.hold(place.constants[place.held]);
  if (!plane.steps.renew(place.orbit)) return false;
  const auto others = others_than(place.held);
  for (std::size_t c = 0; c < 2; ++c) place.constants[others[c]] = place.orbit.z[place.orbit.z.size() - 2 + c];
  return true;
}

}  // namespace continuo::studies::detail
