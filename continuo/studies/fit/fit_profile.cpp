// Profiles of the likelihood: fits with one unknown held, out to the limits of its interval.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <continuo/studies/fit/fit_problem.hpp>

namespace continuo::studies {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The fit with one unknown held: the deviations of the measurements stay as they were found.
class Held {
 public:
  Held(const FitRequest& request, const Fit& fit, detail::FitProblem& problem, std::size_t unknown)
      : whole_(problem.least_squares(fit.least.p)),
        options_(request.options),
        unknown_(unknown),
        least_cost_(fit.least.cost),
        scale_(fit.sure.rise),
        others_(fit.least.p) {
    options_.starts = 1;
    options_.progress = {};
    others_.erase(others_.begin() + static_cast<std::ptrdiff_t>(unknown));
    first_ = others_;
  }

  /// How much chi squared rises where the unknown has this value; infinite where no run is possible. The others begin
  /// where the last value has left them.
  double rise(double value) {
    LeastSquares held = whole_;
    const auto at = static_cast<std::ptrdiff_t>(unknown_);
    const auto all = [&](std::span<const double> p) {
      std::vector<double> result(p.begin(), p.end());
      result.insert(result.begin() + at, value);
      return result;
    };
    const std::size_t m = others_.size() + 1, rows = whole_.residuals;
    std::vector<double> slopes(rows * m);
    held.evaluate = [&](std::span<const double> p, std::span<double> r, std::span<double> dr) {
      if (!whole_.evaluate(all(p), r, dr.empty() ? dr : std::span(slopes))) return false;
      for (std::size_t i = 0; i < rows && !dr.empty(); ++i)
        for (std::size_t u = 0, k = 0; u < m; ++u)
          if (u != unknown_) dr[i * (m - 1) + k++] = slopes[i * m + u];
      return true;
    };
    held.low.erase(held.low.begin() + at);
    held.high.erase(held.high.begin() + at);
    double cost = infinite;
    if (others_.empty()) {
      std::vector<double> r(rows);
      if (held.evaluate({}, r, {})) {
        cost = 0;
        for (const double residual : r) cost += loss_of(options_.loss, residual) / 2;
      }
    } else {
      held.start = others_;
      const LeastSquaresResult found = least_squares(held, options_);
      if (found.found) cost = found.cost, others_ = found.p;
    }
    return std::isfinite(cost) ? 2 * (cost - least_cost_) / scale_ : infinite;
  }
  void begin_anew() { others_ = first_; }
  double low() const { return whole_.low[unknown_]; }
  double high() const { return whole_.high[unknown_]; }

 private:
  LeastSquares whole_;
  LeastSquaresOptions options_;
  std::size_t unknown_;
  double least_cost_, scale_;
  std::vector<double> others_, first_;
};

struct Side {
  double limit = infinite;  // on the scale of the search
  bool is_bound = false;
};

/// Outwards from the best value in the direction of `step` until the rise is `threshold`. The root of the rise is about
/// a straight line, along which the next value is aimed at.
Side limit_of(Held& held, double best, double step, double threshold, std::map<double, double>& points) {
  held.begin_anew();
  const double bound = step > 0 ? held.high() : held.low(), aim = std::sqrt(threshold);
  const auto root = [&](double value) {
    const double rise = held.rise(value);
    points[value] = rise;
    return rise == infinite ? infinite : std::copysign(std::sqrt(std::abs(rise)), rise);
  };
  double inside = best, root_inside = 0, outside = best, root_outside = 0;
  constexpr int most_steps = 40;
  for (int k = 0; root_outside < aim; ++k) {
    if (k == most_steps) return {std::copysign(infinite, step), false};
    inside = outside, root_inside = root_outside;
    outside = outside + step;
    const bool at_bound = step > 0 ? outside >= bound : outside <= bound;
    if (at_bound) outside = bound;
    root_outside = root(outside);
    if (root_outside < aim && at_bound) return {bound, true};
    // As far again as the slope asks for, but no further than three times what was gone.
    const double gone = std::abs(outside - best);
    const double wanted = root_outside > 0 ? gone * (aim / root_outside - 1) * 1.1 : 3 * gone;
    step = std::copysign(std::clamp(wanted, 0.2 * gone, 3 * gone), step);
  }
  for (int k = 0; k < most_steps && std::abs(root_outside - aim) > 1e-4 * aim; ++k) {
    const double part = root_outside == infinite ? 0.5 : (aim - root_inside) / (root_outside - root_inside);
    const double middle = inside + std::clamp(part, 0.05, 0.95) * (outside - inside), found = root(middle);
    if (middle == inside || middle == outside) break;
    if (std::abs(found - aim) <= 1e-4 * aim) return {middle, false};
    (found < aim ? inside : outside) = middle;
    (found < aim ? root_inside : root_outside) = found;
  }
  return {outside, false};
}

/// Between the best value and a limit, so that the way there can be seen.
void fill(Held& held, double best, double limit, std::map<double, double>& points) {
  if (!std::isfinite(limit)) return;
  held.begin_anew();
  for (const double part : {0.2, 0.4, 0.6, 0.8}) {
    const double value = best + part * (limit - best);
    points[value] = held.rise(value);
  }
}

}  // namespace

std::vector<Profile> profiles_of(const FitRequest& request, const Fit& fit) {
  std::vector<Profile> profiles;
  detail::FitProblem problem(request);
  problem.take_noise(fit.noise);
  const auto stopped = [&] { return request.options.interrupt != nullptr && request.options.interrupt->load(); };
  const std::size_t m = fit.least.p.size();
  const double widest = m == 0 ? 0 : *std::ranges::max_element(fit.sure.factors);
  for (std::size_t u = 0; u < m && !stopped(); ++u) {
    Held held(request, fit, problem, u);
    const double best = fit.least.p[u];
    const double t = fit.estimates[u].at_bound ? widest : fit.sure.factors[u];
    Profile profile{.unknown = u, .low = -infinite, .high = infinite, .values = {}, .rises = {}};
    if (std::isfinite(t)) {
      profile.threshold = t * t;
      const double deviation = std::sqrt(fit.sure.determined_covariance[u * (m + 1)]);
      const bool usable = deviation > 0 && std::isfinite(deviation) && !fit.estimates[u].undetermined;
      const double step = usable ? t * deviation : best != 0 ? 0.1 * std::abs(best) : 0.1;
      std::map<double, double> points{{best, 0}};
      const Side low = best <= held.low() ? Side{best, true} : limit_of(held, best, -step, profile.threshold, points);
      const Side high = best >= held.high() ? Side{best, true} : limit_of(held, best, step, profile.threshold, points);
      fill(held, best, low.limit, points);
      fill(held, best, high.limit, points);
      profile.low = problem.from_search(u, low.limit);
      profile.high = problem.from_search(u, high.limit);
      profile.low_is_bound = low.is_bound, profile.high_is_bound = high.is_bound;
      for (const auto& [value, rise] : points) {
        profile.values.push_back(problem.from_search(u, value));
        profile.rises.push_back(rise);
        // A hundredth of the threshold is a hundredth of what an interval sees.
        profile.better = profile.better || rise < -0.01 * profile.threshold;
      }
    }
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

}  // namespace continuo::studies
