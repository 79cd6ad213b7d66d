// continuo/studies/equilibria/continuation.cpp
// Follows a branch of equilibria, and locates folds, Hopf points and crossings on it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <continuo/studies/continuation.hpp>
#include <continuo/studies/equilibria/branch_point.hpp>
#include <continuo/studies/equilibria/equilibrium_branch.hpp>
#include <continuo/studies/equilibria/normal_form.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;

constexpr double near_the_axis = 1e-5;  // of a pair, in parts of its frequency
constexpr double no_slope = 1e-5;       // of a direction of length 1: so little is no change of the constant

// In sizes at the start; of the constant in parts of its range.
constexpr double far_away = 1e4, large = 4, standstill = 1e-3, same_place = 1e-6;

using Place = detail::EquilibriumPlace;

class Follower {
 public:
  Follower(const ParametricSystem& system, const Vector& x, const ContinuationOptions& options)
      : system_(system),
        options_(options),
        steps_(system, x, options),
        n_(system.size),
        range_(options.high - options.low),
        covered_(options.low, options.high, options.progress) {}

  Branch operator()(const Vector& x) {
    Branch branch;
    const Vector z = steps_.scaled(x, system_.constants[options_.constant]);
    const auto start = steps_.corrected(z, z, Vector(n_ + 1, 0.0), true);
    if (!start) {
      branch.status = detail::not_found("there is no equilibrium near the start");
      return branch;
    }
    const Place first = steps_.described(*start, {});
    branch.points.push_back(first.point);
    Branch back = followed(first, -1);
    Branch ahead = back.closed ? Branch{} : followed(first, 1);
    return joined(std::move(back), std::move(branch), std::move(ahead));
  }

  /// The other branch through a crossing. Next to it alone are the equations good enough to go on from.
  Branch through(const BifurcationPoint& from) {
    Branch branch;
    Vector z = steps_.scaled(from.at.x, from.at.constant), along(from.other);
    for (std::size_t i = 0; i <= n_; ++i) along[i] /= steps_.unit(i);
    detail::normalize(along);
    branch.points.push_back(from.at);
    Branch back = beside(z, along, -1);
    if (back.closed) return back;  // it has passed through the crossing
    return joined(std::move(back), std::move(branch), beside(z, along, 1));
  }

  /// Whether the branch passes through this place: where it crosses the plane through the place that is upright on the
  /// way between its two neighbours.
  bool passes(const Branch& branch, const Vector& x, double constant) {
    const Vector z = steps_.scaled(x, constant);
    const auto apart = [&](const Vector& a) { return detail::distance(a, z); };
    for (std::size_t k = 1; k < branch.points.size(); ++k) {
      const Vector a = steps_.scaled(branch.points[k - 1].x, branch.points[k - 1].constant),
                   b = steps_.scaled(branch.points[k].x, branch.points[k].constant);
      if (apart(a) < same_place || apart(b) < same_place) return true;
      Vector way(n_ + 1), guess(n_ + 1);
      double length = 0, part = 0;
      for (std::size_t i = 0; i <= n_; ++i) way[i] = b[i] - a[i], length += way[i] * way[i];
      for (std::size_t i = 0; i <= n_; ++i) part += way[i] * (z[i] - a[i]) / length;
      if (!(part > -0.01 && part < 1.01)) continue;
      for (std::size_t i = 0; i <= n_; ++i) guess[i] = a[i] + part * way[i];
      if (apart(guess) > std::sqrt(length)) continue;
      detail::normalize(way);
      const auto there = steps_.corrected(guess, guess, way, false);
      if (there && apart(*there) < same_place) return true;
    }
    return false;
  }

 private:
  static Branch joined(Branch back, Branch middle, Branch ahead) {
    Branch branch = std::move(back);
    detail::turn_round(branch.points, branch.bifurcations);
    for (Branch* part : {&middle, &ahead})
      detail::append(branch.points, branch.bifurcations, std::move(part->points), std::move(part->bifurcations));
    branch.closed = branch.closed || ahead.closed;
    branch.status = first_failure(std::move(branch.status), std::move(ahead.status));
    return branch;
  }
  Branch beside(const Vector& z, const Vector& along, double direction) {
    for (double step = options_.first_step; step > options_.least_step; step /= 2) {
      const Vector guess = detail::predicted(z, along, direction * step);
      const auto found = steps_.corrected(guess, guess, along, false);
      if (!found || detail::distance(*found, guess) > step / 2) continue;  // it leapt to elsewhere
      Branch branch;
      const Place place = steps_.described(*found, along);
      if (!inside(place.z)) return {};
      Branch rest = followed(place, direction);
      branch.points.push_back(place.point);
      return joined({}, std::move(branch), std::move(rest));
    }
    Branch branch;
    branch.status = detail::not_found("the branch could not be followed from where it crosses the other");
    return branch;
  }
  bool inside(const Vector& z) const {
    return steps_.constant_of(z) >= options_.low && steps_.constant_of(z) <= options_.high;
  }

  Branch followed(const Place& from, double direction) {
    Branch branch;
    Place here = from;
    for (double& part : here.tangent) part *= direction;
    here.direction_sign *= direction;
    const Place origin = here;
    detail::StepLength step(options_);
    double reached = 1, reached_at = origin.z[n_];
    while (branch.points.size() < options_.most_points) {
      if (options_.interrupt && options_.interrupt->load()) {
        branch.status = {.ending = Ending::interrupted, .message = "interrupted"};
        return branch;
      }
      // States that grow far beyond their size at the start are measured by what they are now; where they double and
      // the constant keeps still there is nothing more to see.
      double reach = 1;
      for (std::size_t i = 0; i < n_; ++i) reach = std::max(reach, std::abs(here.z[i]));
      if (reach >= 2 * reached) {
        const bool still = std::abs(here.z[n_] - reached_at) < standstill;
        if (reach > far_away || (still && reached >= large)) {
          branch.status = {.ending = Ending::cannot_continue, .message = "it diverges to infinity"};
          return branch;
        }
        reached = reach;
        reached_at = here.z[n_];
      }
      auto next = steps_.stepped(here, step * reach);
      if (!next || detail::product(here.tangent, next->tangent) < detail::least_cosine_of_neighbours) {
        if (step.shorten()) continue;
        branch.status = detail::not_found("the branch could not be followed further");
        return branch;
      }
      if (const auto last = step_onto(origin, here, step * reach)) {
        mark(branch, here, origin, *last);
        branch.points.push_back(origin.point);
        branch.closed = true;
        return branch;
      }
      mark(branch, here, *next, step * reach);
      const Place before = std::exchange(here, std::move(*next));
      if (inside(here.z)) {
        branch.points.push_back(here.point);
      } else if (auto last = at_bound(before, here, step * reach)) {
        branch.points.push_back(std::move(last->point));
      }
      covered_.report(here.point.constant);
      if (!inside(here.z)) return branch;
      step.lengthen();
    }
    branch.status = {.ending = Ending::too_many_steps, .message = "too many points"};
    return branch;
  }
  /// Between a place inside of the range and the one outside that a step leads to.
  std::optional<Place> at_bound(const Place& a, const Place& b, double step) {
    const double bound = std::clamp(steps_.constant_of(b.z), options_.low, options_.high) / range_;
    if (a.z[n_] == b.z[n_] || a.z[n_] == bound) return std::nullopt;
    const double part = (bound - a.z[n_]) / (b.z[n_] - a.z[n_]);
    Vector guess = detail::between(a.z, b.z, part);
    guess[n_] = bound;
    if (auto z = steps_.corrected(guess, guess, {}, true)) return steps_.described(std::move(*z), {});
    // Where another branch crosses at the bound, the constant does not determine the state: the longest step that stays
    // inside does.
    std::optional<Place> last;
    double low = 0, high = step;
    for (int k = 0; k < 60; ++k) {
      const double middle = (low + high) / 2;
      auto place = steps_.stepped(a, middle);
      if (!place) break;
      (inside(place->z) ? low : high) = middle;
      if (inside(place->z)) last = std::move(place);
    }
    return last;
  }
  /// The length of the step that ends at `origin`, where the branch comes back to it within the next `step`.
  std::optional<double> step_onto(const Place& origin, const Place& here, double step) {
    double length = 0;
    for (std::size_t i = 0; i <= n_; ++i) length += here.tangent[i] * (origin.z[i] - here.z[i]);
    if (!(length > 0 && length < 1.001 * step) || detail::distance(origin.z, here.z) > 2 * step ||
        detail::product(here.tangent, origin.tangent) < detail::least_cosine_of_neighbours)
      return std::nullopt;
    const auto there = steps_.stepped(here, length);
    return there && detail::distance(there->z, origin.z) < same_place ? std::optional(length) : std::nullopt;
  }

  /// What lies between two neighbours, narrowed down to where its test is zero.
  void mark(Branch& branch, const Place& a, const Place& b, double step) {
    double at = 0;  // how far from a what was located last is
    const auto located = [&](auto&& test) {
      double low = 0, high = step;
      std::optional<Place> best;
      const bool positive = test(a) > 0;
      for (int k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2;
        auto place = steps_.stepped(a, middle);
        if (!place) break;
        ((test(*place) > 0) == positive ? low : high) = middle;
        best = std::move(place);
        at = middle;
      }
      return best;
    };
    const auto add = [&](Bifurcation kind, std::optional<Place> place, double frequency) {
      if (!place || !inside(place->z)) return;
      BifurcationPoint point{kind, std::move(place->point), frequency, branch.points.size()};
      Vector p(system_.constants);
      p[options_.constant] = point.at.constant;
      if (kind == Bifurcation::fold) point.coefficient = fold_coefficient(system_, point.at.x, p, options_.t);
      if (kind == Bifurcation::hopf)
        if (const auto found =
                first_lyapunov_coefficient(system_, point.at.x, p, 2 * std::numbers::pi * frequency, options_.t))
          point.coefficient = std::abs(found->value) <= found->rounding ? 0 : found->value;
      branch.bifurcations.push_back(std::move(point));
    };
    const bool crosses = a.direction_sign * b.direction_sign < 0;  // a pitchfork also turns round
    if (a.tangent[n_] * b.tangent[n_] < 0 && !crosses)
      add(Bifurcation::fold, located([&](const Place& p) { return p.tangent[n_]; }), 0);
    if (crosses) add_crossing(branch, located([](const Place& p) { return p.direction_sign; }));
    if (a.hopf_test * b.hopf_test < 0)
      if (const auto near = located([](const Place& p) { return p.hopf_test; }))
        if (auto place = hopf_point_near(a, *near, at, step))
          add(Bifurcation::hopf, std::move(place->first), place->second / (2 * std::numbers::pi));
  }

  /// The pair that passes the axis near a place where the test changes its sign, located, and its angular frequency.
  /// Other pairs may lie on the axis all along, to rounding: of the one that passes the real part is more than
  /// rounding, and of opposite sign, at both ends of some way round the place. Nothing where two real eigenvalues of
  /// opposite sign are what vanishes, or where a pair comes to the axis and stays.
  std::optional<std::pair<Place, double>> hopf_point_near(const Place& a, const Place& place, double at, double step) {
    for (const std::complex<double>& pair : place.point.eigenvalues) {
      const double near =
          std::max(near_the_axis * pair.imag(), 10 * detail::rounding_of_sum * size_of(place.point.eigenvalues));
      if (!(pair.imag() > 0) || std::abs(pair.real()) > near) continue;
      for (double wide = 1e-9 * step; wide < step; wide *= 10)
        if (auto found = passing(a, pair.imag(), at - wide, at + wide)) return found;
    }
    return std::nullopt;
  }
  /// Bisected between the two, if the pair nearest to i times the frequency passes the axis there.
  std::optional<std::pair<Place, double>> passing(const Place& a, double frequency, double low, double high) {
    const auto pair_at = [&](const Place& p) {
      std::complex<double> nearest = std::numeric_limits<double>::infinity();
      for (const std::complex<double>& value : p.point.eigenvalues)
        if (value.imag() > 0 && std::abs(value - std::complex<double>(0, frequency)) <
                                    std::abs(nearest - std::complex<double>(0, frequency)))
          nearest = value;
      return nearest;
    };
    const auto before = steps_.stepped(a, low), after = steps_.stepped(a, high);
    if (!before || !after) return std::nullopt;
    const double first = pair_at(*before).real(), last = pair_at(*after).real();
    const double rounding = detail::rounding_of_sum * size_of(after->point.eigenvalues);
    if (!(first * last < 0) || std::min(std::abs(first), std::abs(last)) <= rounding) return std::nullopt;
    std::optional<std::pair<Place, double>> best;
    for (int k = 0; k < 60; ++k) {
      const double middle = (low + high) / 2;
      auto place = steps_.stepped(a, middle);
      if (!place) break;
      const std::complex<double> pair = pair_at(*place);
      (pair.real() * first > 0 ? low : high) = middle;
      best = {std::move(*place), pair.imag()};
    }
    return best;
  }
  static double size_of(const std::vector<std::complex<double>>& values) {
    double size = 0;
    for (const auto& value : values) size = std::max(size, std::abs(value));
    return size;
  }

  /// Whether a branch that leaves a place upright turns to either side. It does not where all of it is at rest for one
  /// value of the constant.
  bool bends(const Vector& z, const Vector& along) {
    for (const double step : {0.1, -0.1, 0.01, -0.01}) {
      const Vector guess = detail::predicted(z, along, step);
      const auto there = steps_.corrected(guess, guess, along, false);
      if (there) return std::abs((*there)[n_] - z[n_]) > 1e-10;
    }
    return true;
  }

  void add_crossing(Branch& branch, const std::optional<Place>& near_it) {
    if (!near_it) return;
    const detail::CrossingEquations equations{.n = n_,
                                              .f = [this](const Vector& z) { return steps_.f(z); },
                                              .jacobian = [this](const Vector& z) { return steps_.jacobian(z); }};
    const auto crossing = detail::find_crossing(equations, near_it->z, near_it->tangent);
    BifurcationPoint point{Bifurcation::crossing, near_it->point, 0, branch.points.size()};
    if (crossing) {
      Place place{.z = crossing->z, .tangent = {}, .point = {}};
      steps_.describe(place);
      point.at = std::move(place.point);
      const bool own_upright = std::abs(crossing->own[n_]) < no_slope,
                 upright = own_upright || std::abs(crossing->other[n_]) < no_slope;
      if (!upright) point.kind = Bifurcation::transcritical;
      if (upright && bends(crossing->z, own_upright ? crossing->own : crossing->other))
        point.kind = Bifurcation::pitchfork;
      point.other = crossing->other;
      for (std::size_t i = 0; i <= n_; ++i) point.other[i] *= steps_.unit(i);
    }
    if (point.at.constant >= options_.low && point.at.constant <= options_.high)
      branch.bifurcations.push_back(std::move(point));
  }

  const ParametricSystem& system_;
  const ContinuationOptions& options_;
  detail::EquilibriumSteps steps_;
  std::size_t n_;
  double range_;
  detail::CoveredRange covered_;
};

}  // namespace

std::string_view to_string(Bifurcation kind) {
  constexpr std::array<std::string_view, 5> names{"fold", "Hopf point", "transcritical point", "pitchfork",
                                                  "crossing of branches"};
  return names[static_cast<std::size_t>(kind)];
}

Branch continue_equilibrium(const ParametricSystem& system, std::vector<double> x, const ContinuationOptions& options) {
  return Follower(system, x, options)(x);
}
Branch continue_equilibrium(const ParametricSystem& system, const BifurcationPoint& from,
                            const ContinuationOptions& options) {
  if (!from.other.empty()) return Follower(system, from.at.x, options).through(from);
  Branch branch;
  branch.status = {.ending = Ending::invalid_input, .message = "no other branch is known there"};
  return branch;
}

bool passes_through(const ParametricSystem& system, const Branch& branch, const BranchStart& place,
                    const ContinuationOptions& options) {
  return Follower(system, place.x, options).passes(branch, place.x, place.constant);
}

}  // namespace continuo::studies
