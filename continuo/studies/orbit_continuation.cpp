// continuo/studies/orbit_continuation.cpp
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/flow.hpp>
#include <continuo/studies/orbit_branch.hpp>
#include <continuo/studies/orbit_continuation.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;
using Place = detail::OrbitPlace;

constexpr std::string_view forced = "the equations depend on time; an orbit is looked for where they do not";
constexpr double shortest_step = 1e-7;
constexpr double shrunk_part =
    1e-3;  // of the largest amplitude of the branch: so small, and a Hopf point is looked for
// A homoclinic orbit is near where the period grows by this factor while the constant keeps still to so many parts of
// its range: there constant - limit ~ exp(-rate * period).
constexpr double growth_of_size = 5;  // of the first orbit beside a Hopf point: twenty steps make it ten times as large
constexpr double growth_of_period = 1.3, standstill = 1e-6;
constexpr double upright = 1e-11;              // of the range: so little between neighbours is no change at all
constexpr double still_neutral = 1e-5;         // of a multiplier: how near to 1
constexpr double about_one = 1e-2;             // of the multiplier where branches cross
constexpr std::size_t points_of_a_family = 8;  // without a change of the constant
constexpr double still_on_circle = 1e-5;       // how near to 1 the size of a located pair is

double length(const Vector& v) {
  double sum = 0;
  for (const double part : v) sum += part * part;
  return std::sqrt(sum);
}

class Follower {
 public:
  Follower(const ParametricSystem& system, const OrbitContinuationOptions& options)
      : system_(system), options_(options), steps_(system, options), range_(options.high - options.low) {}

  /// `orbit`: its state at a part of the period; `mesh` says where that changes fast.
  OrbitBranch from_orbit(const std::function<Vector(double part)>& orbit, double period, const Vector& mesh) {
    OrbitBranch branch;
    steps_.use(first_mesh(mesh));
    Vector z;
    for (std::size_t k = 0; k < steps_.equations().nodes(); ++k) {
      const Vector x = orbit(steps_.equations().place(k));
      z.insert(z.end(), x.begin(), x.end());
    }
    z.push_back(period);
    z.push_back(system_.constants[options_.constant]);
    steps_.measure(z);
    auto first = steps_.at_constant(z, z.back());
    if (first) refine(*first);
    if (!first) {
      branch.message = is_interrupted() ? "it was interrupted" : "there is no orbit near the start";
      return branch;
    }
    steps_.complete(*first);
    amplitude_ = amplitude(*first);
    OrbitBranch back;
    back.ends[1] = followed(back, *first, -1);
    std::ranges::reverse(back.points);
    std::ranges::reverse(back.marks);
    branch = std::move(back);
    branch.ends[0] = std::exchange(branch.ends[1], {});
    branch.points.push_back(first->point);
    if (branch.ends[0].ending == OrbitEnding::closed || branch.ends[0].ending == OrbitEnding::interrupted) {
      branch.ends[1] = branch.ends[0];
    } else {
      // Anew, for the sizes have grown on the way.
      steps_.use(first->mesh);
      steps_.measure(first->z);
      if (auto again = steps_.at_constant(first->z, first->z.back())) first = std::move(again);
      steps_.complete(*first);
      branch.ends[1] = followed(branch, *first, 1);
    }
    return branch;
  }

  OrbitBranch from_hopf(const HopfPoint& start) {
    OrbitBranch branch;
    const std::size_t n = system_.size;
    steps_.use(first_mesh({}));
    const std::size_t nodes = steps_.equations().nodes();
    Vector rest;
    for (std::size_t k = 0; k < nodes; ++k) rest.insert(rest.end(), start.x.begin(), start.x.end());
    rest.push_back(2 * std::numbers::pi / start.angular_frequency);
    rest.push_back(start.constant);
    Vector sizes(start.x);
    for (double& size : sizes) size = std::max(std::abs(size), 1.0);
    steps_.forget_sizes(sizes);
    steps_.measure(rest);
    Vector along(rest.size());
    for (std::size_t k = 0; k < nodes; ++k) {
      const auto turn = std::polar(1.0, 2 * std::numbers::pi * steps_.equations().place(k));
      for (std::size_t i = 0; i < n; ++i) along[k * n + i] = (start.vector[i] * turn).real() / steps_.size(k * n + i);
    }
    const double size = length(along);
    for (double& part : along) part /= size;
    std::optional<Place> first;
    for (double small = 1e-2; small > 1e-7 && !first; small /= 10) {
      Vector z(rest);
      for (std::size_t j = 0; j < z.size(); ++j) z[j] += small * along[j] * steps_.size(j);
      first = steps_.across(z, along);
    }
    if (!first) {
      branch.message = "no orbit was found near the Hopf point";
      return branch;
    }
    // What the orbit tells of the sizes: it is going to grow.
    for (std::size_t i = 0; i < n; ++i) {
      sizes[i] = std::abs(start.x[i]);
      for (std::size_t k = 0; k < nodes; ++k)
        sizes[i] = std::max(sizes[i], growth_of_size * std::abs(first->z[k * n + i] - start.x[i]));
    }
    first->tangent = along;
    steps_.forget_sizes(sizes);
    steps_.measure(*first);
    first = steps_.across(first->z, first->tangent);
    if (first) refine(*first);
    if (!first) {
      branch.message = "no orbit was found near the Hopf point";
      return branch;
    }
    steps_.complete(*first);
    amplitude_ = amplitude(*first);
    branch.points = {detail::as_orbit(start, first->point.stable), first->point};
    branch.ends[0] = {OrbitEnding::hopf, start.constant, "it begins at a Hopf point"};
    branch.ends[1] = followed(branch, *first, 1);
    return branch;
  }

 private:
  static constexpr std::size_t most_first_intervals = 400, even_intervals = 20, most_refinements = 6;

  /// From a mesh that knows where an orbit changes fast, or an even one.
  static std::shared_ptr<const detail::OrbitMesh> first_mesh(const Vector& known) {
    const std::size_t intervals = known.size() < 2 ? 0 : known.size() - 1;
    if (intervals < even_intervals) {
      detail::OrbitMesh even;
      for (std::size_t k = 0; k <= even_intervals; ++k)
        even.push_back(static_cast<double>(k) / static_cast<double>(even_intervals));
      return std::make_shared<const detail::OrbitMesh>(std::move(even));
    }
    const std::size_t each = (intervals + most_first_intervals - 1) / most_first_intervals;
    detail::OrbitMesh mesh;
    for (std::size_t k = 0; k < intervals; k += each) mesh.push_back(known[k] / known.back());
    mesh.push_back(1);
    return std::make_shared<const detail::OrbitMesh>(std::move(mesh));
  }
  /// Until its mesh serves it, as far as that goes.
  void refine(Place& place) {
    for (std::size_t k = 0; k < most_refinements && !steps_.is_exact(place); ++k)
      if (!steps_.refine(place, place)) return;
  }

  double amplitude(const Place& place) { return length(steps_.deviations(place)); }
  bool inside(const Place& place) const {
    return place.point.constant >= options_.low && place.point.constant <= options_.high;
  }
  bool is_interrupted() const { return options_.interrupt && options_.interrupt->load(); }
  OrbitBranchEnd ended(OrbitEnding ending, double constant, std::string reason) const {
    return {ending, constant, std::move(reason)};
  }
  std::string name() const { return system_.constant_name(options_.constant); }

  OrbitBranchEnd followed(OrbitBranch& branch, const Place& from, double direction) {
    Place here = from;
    steps_.measure(here);
    for (double& part : here.tangent) part *= direction;
    here.fold *= direction;
    const Place origin = here;
    const std::size_t begin = branch.points.size();
    double step = options_.first_step;
    std::size_t refinements = 0;
    while (branch.points.size() < options_.most_points) {
      auto next = is_interrupted() ? std::nullopt : steps_.stepped(here, step);
      if (is_interrupted()) return ended(OrbitEnding::interrupted, here.point.constant, "it was interrupted");
      const bool vanished = next && vanishes(here, *next);
      if (vanished || (next && amplitude(*next) < shrunk_part * amplitude_))
        if (const auto hopf = hopf_near(vanished ? here : *next)) {
          branch.points.push_back(detail::as_orbit(*hopf, here.point.stable));
          return ended(OrbitEnding::hopf, hopf->constant, "the orbit shrinks to an equilibrium, a Hopf point");
        }
      if (!next || vanished || steps_.alike(here, *next) < 0.906) {  // by more than 25 degrees: too long a step
        step /= 2;
        if (step > shortest_step) continue;
        return lost(here);
      }
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
      report(here.point.constant);
      const std::span<const OrbitPoint> way(branch.points.begin() + static_cast<std::ptrdiff_t>(begin),
                                            branch.points.end());
      if (auto end = ending_of(way, here)) return *end;
      if (way.size() > 20 && comes_back(here, origin, step))
        return ended(OrbitEnding::closed, here.point.constant, "it comes back to where it began");
      steps_.measure(here);
      if (iterations <= 4) step = std::min(1.3 * step, options_.largest_step);
    }
    return ended(OrbitEnding::too_many_points, here.point.constant,
                 fmt::format("it has {} points, as many as are allowed", branch.points.size()));
  }

  /// Through the equilibrium, to the same orbits half a turn later.
  bool vanishes(const Place& a, const Place& b) {
    const Vector from = steps_.deviations(a), to = steps_.deviations(b);
    double sum = 0;
    for (std::size_t j = 0; j < from.size(); ++j) sum += from[j] * to[j];
    return sum < 0;
  }
  /// The Hopf point to which so small an orbit belongs: as far away as the orbit is wide, and no more.
  std::optional<HopfPoint> hopf_near(const Place& place) {
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

  OrbitBranchEnd at_bound(OrbitBranch& branch, const Place& a, const Place& b) {
    const double bound = b.point.constant > options_.high ? options_.high : options_.low;
    const double part = (bound - a.point.constant) / (b.point.constant - a.point.constant);
    Vector z(a.z);
    for (std::size_t j = 0; j < z.size(); ++j) z[j] += part * (b.z[j] - a.z[j]);
    if (auto last = steps_.at_constant(std::move(z), bound)) {
      steps_.complete(*last);
      branch.points.push_back(std::move(last->point));
    }
    report(bound);
    return ended(OrbitEnding::bound, bound, fmt::format("{} reaches the end of its range", name()));
  }
  OrbitBranchEnd lost(const Place& here) const {
    return ended(OrbitEnding::lost, here.point.constant,
                 fmt::format("it could not be followed further; the period is {:.6g} there", here.point.period));
  }

  /// What the last points say. `here` is the last of them.
  std::optional<OrbitBranchEnd> ending_of(std::span<const OrbitPoint> way, const Place& here) {
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
  /// Whether the orbit is within a hundredth of its size of an equilibrium for half of its period: near a homoclinic
  /// one all but a fixed time is spent there. Where the constant stands still and the period grows without that, as in
  /// the explosion of a canard, the branch goes on.
  bool waits_at_an_equilibrium(const Place& place) {
    const std::size_t n = system_.size, nodes = place.z.size() / n;
    const Vector field = [&] {
      steps_.use(place.mesh);
      return steps_.equations().field(place.z);
    }();
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
    const auto distance = [&](std::size_t k) {
      for (std::size_t i = 0; i < n; ++i) apart[i] = place.z[k * n + i] - rest.x[i];
      return std::sqrt(square(apart));
    };
    for (std::size_t k = 0; k < nodes; ++k) extent = std::max(extent, distance(k));
    for (std::size_t k = 0; k < nodes; ++k)
      if (distance(k) < 0.01 * extent) waited += steps_.equations().weight(k);
    return waited > 0.5;
  }
  bool comes_back(const Place& here, const Place& origin, double step) const {
    if (here.fold * origin.fold < 0) return false;
    Vector apart{(here.point.constant - origin.point.constant) / range_,
                 (here.point.period - origin.point.period) / origin.point.period};
    for (std::size_t i = 0; i < system_.size; ++i) {
      apart.push_back((here.point.low[i] - origin.point.low[i]) / steps_.size_of(i));
      apart.push_back((here.point.high[i] - origin.point.high[i]) / steps_.size_of(i));
    }
    return length(apart) < step / 2;
  }
  void report(double constant) {
    low_ = std::min(low_, constant);
    high_ = std::max(high_, constant);
    if (options_.progress) options_.progress(std::min((high_ - low_) / range_, 1.0));
  }

  /// What lies between two neighbours, narrowed down to where its test is zero.
  void mark(OrbitBranch& branch, const Place& a, const Place& b, double step) {
    const auto add = [&](OrbitBifurcation kind, double Place::* test) {
      auto place = located(a, b, step, test);
      if (!place || !inside(*place)) return;
      if (kind == OrbitBifurcation::crossing && std::ranges::none_of(place->point.multipliers, [](const auto& value) {
            return std::abs(value - 1.0) < about_one;
          }))
        return;
      double rotation = 0;
      if (kind == OrbitBifurcation::torus) {
        // Two real multipliers whose product is 1 are no torus: nothing happens.
        const auto& values = place->point.multipliers;
        const auto pair = std::ranges::find_if(values, [](const std::complex<double>& value) {
          return value.imag() > 0 && std::abs(std::abs(value) - 1) < still_on_circle;
        });
        if (pair == values.end()) return;
        rotation = std::arg(*pair) / (2 * std::numbers::pi);
      }
      steps_.complete(*place);
      branch.marks.push_back({kind, std::move(place->point), rotation});
    };
    const auto changes = [&](double Place::* test) { return (a.*test < 0) != (b.*test < 0); };
    // At a fold both change, at a crossing on a branch that goes straight on the multiplier passes 1 alone, on one that
    // begins there the branch turns alone. It may also turn by what rounding leaves of a constant that keeps still, as
    // in the explosion of a canard: then no multiplier is near 1.
    const bool turns = changes(&Place::fold), passes = changes(&Place::unity);
    if (turns && passes) add(OrbitBifurcation::fold, &Place::fold);
    if (turns != passes) add(OrbitBifurcation::crossing, turns ? &Place::fold : &Place::unity);
    if (changes(&Place::doubling)) add(OrbitBifurcation::period_doubling, &Place::doubling);
    if (changes(&Place::torus)) add(OrbitBifurcation::torus, &Place::torus);
  }
  /// Illinois false position, with a bisection where it is slow.
  std::optional<Place> located(const Place& a, const Place& b, double step, double Place::* test) {
    constexpr int most = 60;
    constexpr double exact = 1e-10;
    double low = 0, high = step, at_low = a.*test, at_high = b.*test;
    std::optional<Place> best;
    int last_side = 0;
    for (int k = 0; k < most && high - low > exact * step; ++k) {
      const double secant = high - at_high * (high - low) / (at_high - at_low);
      const double s = k % 4 == 3 || !(secant > low && secant < high) ? (low + high) / 2 : secant;
      auto place = steps_.stepped(a, s);
      if (!place) break;
      const double value = (*place).*test;
      best = std::move(place);
      if (std::abs(value) < exact) break;
      const int side = (value < 0) == (at_low < 0) ? -1 : 1;
      if (side < 0) {
        low = s, at_low = value;
        if (last_side < 0) at_high /= 2;
      } else {
        high = s, at_high = value;
        if (last_side > 0) at_low /= 2;
      }
      last_side = side;
    }
    return best;
  }

  const ParametricSystem& system_;
  const OrbitContinuationOptions& options_;
  detail::OrbitBranchSteps steps_;
  double range_, amplitude_ = 0;                                         // the largest so far
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;  // the part of the range that was covered
};

/// Why nothing can be followed; empty where it can.
std::string what_is_wrong(const ParametricSystem& system, const OrbitContinuationOptions& options, double begin) {
  if (options.constant >= system.parameters())
    return fmt::format("there is no constant number {}; there are {}", options.constant, system.parameters());
  const std::string name = system.constant_name(options.constant);
  if (!(options.low < options.high)) return fmt::format("the range of {} is empty", name);
  if (system.size < 2) return "one state alone never comes back; an orbit needs two";
  if (!(begin >= options.low && begin <= options.high))
    return fmt::format("{} is {:.10g} at the start, outside of {:.10g}..{:.10g}", name, begin, options.low,
                       options.high);
  return "";
}

}  // namespace

std::string_view to_string(OrbitBifurcation kind) {
  constexpr std::array<std::string_view, 4> names{"fold", "period doubling", "torus", "crossing of branches"};
  return names[static_cast<std::size_t>(kind)];
}

OrbitBranch continue_orbit(const ParametricSystem& system, const PeriodicOrbit& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  const double begin = options.constant < system.parameters() ? system.constants[options.constant] : 0;
  branch.message = what_is_wrong(system, options, begin);
  if (branch.message.empty() && !start.outcome) branch.message = start.outcome.hint;
  if (!branch.message.empty()) return branch;
  return Follower(system, options)
      .from_orbit([&](double part) { return start.orbit(part); }, start.period, start.orbit.mesh);
}

OrbitBranch continue_orbit(const ParametricSystem& system, const OrbitPoint& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  branch.message = what_is_wrong(system, options, start.constant);
  if (branch.message.empty() && depends_on_time(system, start.x)) branch.message = forced;
  if (!branch.message.empty()) return branch;
  Vector p(system.constants);
  p[options.constant] = start.constant;
  ParametricSystem there(system);
  there.constants = p;
  const auto turn = run_flow(there, p, start.x, {0, start.period},
                             {.rtol = options.rtol,
                              .atol = 1e-3 * options.rtol,
                              .save = Save<Vector>::dense(),
                              .interrupt = options.interrupt});
  if (!turn.outcome) {
    branch.message = describe(turn.outcome);
    return branch;
  }
  return Follower(there, options)
      .from_orbit([&](double part) { return turn(part * start.period); }, start.period, turn.t);
}

OrbitBranch continue_orbit(const ParametricSystem& system, const HopfPoint& start,
                           const OrbitContinuationOptions& options) {
  OrbitBranch branch;
  branch.message = what_is_wrong(system, options, start.constant);
  if (branch.message.empty() && depends_on_time(system, start.x)) branch.message = forced;
  return branch.message.empty() ? Follower(system, options).from_hopf(start) : branch;
}

}  // namespace continuo::studies
