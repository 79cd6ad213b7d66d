// Computes regions of absolute stability and the largest stable step of a model.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/accuracy/contour.hpp>
#include <continuo/studies/stability.hpp>
#include <continuo/studies/support/named_solve.hpp>

namespace continuo::studies {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Limit {
  double distance;
  double beyond = 1;  // the factor one part in a hundred farther out
};

/// The limit of `factor(r)`, the growth at the distance r from the origin.
template <class Factor>
Limit limit_of(const Factor& factor, double farthest) {
  // Near the origin all are neutral to some digits; the first look is where explicit methods differ already.
  constexpr double nearest = 0.01, fine = 1.01, coarse = 1.2, fine_up_to = 100;
  const auto grows = [&](double r) { return factor(r) > neutral_factor; };
  if (std::isnan(factor(nearest))) return {unknown};
  if (grows(nearest)) return {0};
  double inside = 0, outside = nearest;
  while (outside <= farthest && !grows(outside)) {
    inside = outside;
    outside *= outside < fine_up_to ? fine : coarse;
  }
  if (outside > farthest) return {infinite};
  while (outside - inside > 4 * std::numeric_limits<double>::epsilon() * outside) {
    const double middle = inside + (outside - inside) / 2;
    if (middle == inside || middle == outside) break;
    (grows(middle) ? outside : inside) = middle;
  }
  // A limit that is one crosses 1 at an angle. Else the factor leaves 1 like a power of r, from the origin on, and was
  // only taken for 1: of the methods without any imaginary segment 1 + C r^k.
  constexpr double crossing = 1e-7;
  const double beyond = factor(1.01 * outside);
  return beyond > 1 + crossing ? Limit{outside, beyond} : Limit{0};
}

}  // namespace

double stability_limit(const StepSequence& sequence, Complex direction, double farthest) {
  direction /= std::abs(direction);
  return limit_of([&](double r) { return amplification(sequence, r * direction); }, farthest).distance;
}

namespace {

/// ln |zeta| over the upper half of a square around the origin.
Grid grid_of(const StepSequence& sequence, double half_side, std::size_t columns, const std::atomic<bool>* interrupt) {
  Grid grid{.columns = columns,
            .rows = columns / 2 + 1,
            .left = -half_side,
            .bottom = 0,
            .width = 2 * half_side / static_cast<double>(columns - 1)};
  grid.height = half_side / static_cast<double>(grid.rows - 1);
  grid.values.reserve(grid.columns * grid.rows);
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i) {
      if (interrupt != nullptr && interrupt->load()) return grid;
      const double factor = amplification(sequence, {grid.x(i), grid.y(j)});
      grid.values.push_back(std::isnan(factor) ? unknown : std::log(std::max(factor, 1e-300) / neutral_factor));
    }
  return grid;
}

/// With the lower half, its mirror image.
Grid both_halves(const Grid& upper) {
  Grid grid = upper;
  grid.rows = 2 * upper.rows - 1;
  grid.bottom = -upper.y(upper.rows - 1);
  grid.values.clear();
  for (std::size_t j = 0; j < grid.rows; ++j) {
    const std::size_t from = j < upper.rows ? upper.rows - 1 - j : j - (upper.rows - 1);
    for (std::size_t i = 0; i < grid.columns; ++i) grid.values.push_back(upper.at(i, from));
  }
  return grid;
}

/// Whether the curve leaves the square, or touches its border: a value in the outermost rows and columns, two on each
/// side, has another sign than the next one.
bool leaves(const Grid& grid) {
  const auto differs = [](double a, double b) { return (a > 0) != (b > 0); };
  for (std::size_t j = 0; j + 1 < grid.rows; ++j)
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}, grid.columns - 2, grid.columns - 1})
      if (differs(grid.at(i, j), grid.at(i, j + 1))) return true;
  for (std::size_t i = 0; i + 1 < grid.columns; ++i)
    for (const std::size_t j : {grid.rows - 2, grid.rows - 1})
      if (differs(grid.at(i, j), grid.at(i + 1, j))) return true;
  return false;
}

/// The smallest of some squares that holds the curve; a middle one where none does.
double side_for(const StepSequence& sequence, const std::atomic<bool>* interrupt) {
  constexpr std::size_t coarse = 42;
  for (const double half_side : {2.5, 4.0, 6.0, 10.0, 16.0, 25.0}) {
    const Grid grid = grid_of(sequence, half_side, coarse, interrupt);
    if (interrupt != nullptr && interrupt->load()) break;
    if (!leaves(grid)) return half_side;
  }
  return 6;
}

}  // namespace

StabilityRegion stability_region(const StepSequence& sequence, std::size_t points, const std::atomic<bool>* interrupt) {
  StabilityRegion region;
  region.real_limit = stability_limit(sequence, -1);
  region.imaginary_limit = stability_limit(sequence, Complex(0, 1));
  region.outside = region.real_limit == infinite;
  if (std::isnan(region.real_limit) || points < 2) return region;  // on one axis only there is no curve
  region.half_side = side_for(sequence, interrupt);
  const Grid grid = grid_of(sequence, region.half_side, points, interrupt);
  if (grid.values.size() < grid.columns * grid.rows) return region;
  for (const Polyline& line : zero_lines(grid)) {
    for (const double sign : {1.0, -1.0}) {  // conjugate z have conjugate factors
      for (const auto& [x, y] : line) region.x.push_back(x), region.y.push_back(sign * y);
      region.x.push_back(unknown), region.y.push_back(unknown);
    }
  }
  constexpr double beyond = 20, border = 1 - 1e-6;
  for (const auto& [x, y] : path_round_negative(both_halves(grid))) {
    const double factor = std::max(std::abs(x), std::abs(y)) > border * region.half_side ? beyond : 1;
    region.area_x.push_back(factor * x), region.area_y.push_back(factor * y);
  }
  return region;
}

Spectrum spectrum_along(const ParametricSystem& system, const std::vector<double>& times,
                        const std::vector<std::vector<double>>& states) {
  Spectrum spectrum;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto found = eigenvalues(jacobian_of(system, times[k], states[k], system.constants), system.size);
    if (!found.found) continue;
    spectrum.times.push_back(times[k]);
    spectrum.values.push_back(found.values);
  }
  return spectrum;
}

namespace {

/// What counts as neutral next to the fastest motion: eigenvalues that are 0 come out as rounding.
constexpr double negligible = 1e-10;
/// Times |lambda|: whoever is stable there is taken to be so always.
constexpr double farthest_step = 1e4;

void lower(StepLimit& limit, const Limit& own, double size, Complex eigenvalue, double time) {
  const double step = own.distance / size;
  if (!(step < limit.step) && !std::isnan(step)) return;
  if (!std::isnan(limit.step)) limit = {step, eigenvalue, time, own.beyond};
}

/// Methods for x'' = a move a position and its velocity together: their eigenvalues come by twos, conjugates, or the
/// two real ones of a motion that does not swing. More than two real ones could be put together in several ways.
void lower_by_pairs(std::string_view method, const std::vector<Complex>& values, double time, StepLimit& limit) {
  const auto steps = motion_steps_of(method);
  const auto lower_for = [&](Complex z1, Complex z2) {
    const double size = std::max(std::abs(z1), std::abs(z2));
    const auto factor = [&](double r) {
      return amplification([&](Complex, std::size_t n) { return steps(r / size * z1, r / size * z2, n); }, 0);
    };
    lower(limit, limit_of(factor, farthest_step), size, z2, time);
  };
  double fastest = 0;
  for (const Complex& value : values) fastest = std::max(fastest, std::abs(value));
  std::vector<Complex> real;
  for (const Complex& value : values) {
    if (value.imag() == 0) real.push_back(value);
    if (value.imag() <= 0 || value.real() > negligible * fastest) continue;
    const Complex z(std::abs(value.real()) < negligible * fastest ? 0 : value.real(), value.imag());
    lower_for(std::conj(z), z);
  }
  if (real.empty() || real.front().real() > negligible * fastest) return;
  if (real.size() > 2) {
    lower(limit, {unknown}, 1, real.back(), time);
  } else if (std::abs(real.back()) > negligible * fastest) {
    lower_for(real.front(), real.back());
  }
}

}  // namespace

StepLimit largest_stable_step(std::string_view method, const Spectrum& spectrum) {
  const MethodInfo* info = find_method(method);
  StepLimit limit{.step = infinite};
  if (info == nullptr) return {.step = unknown};
  const StepSequence sequence = steps_of(method);
  // The same direction comes again and again along a linear model's run.
  std::vector<std::pair<Complex, Limit>> known;
  const auto along = [&](Complex direction) {
    for (const auto& [d, r] : known)
      if (std::abs(d - direction) < 1e-12) return r;
    const auto factor = [&](double r) { return amplification(sequence, r * direction); };
    known.emplace_back(direction, limit_of(factor, farthest_step));
    return known.back().second;
  };
  for (std::size_t k = 0; k < spectrum.times.size(); ++k) {
    if (k > 0 && spectrum.values[k] == spectrum.values[k - 1]) continue;
    if (info->second_order) {
      lower_by_pairs(method, spectrum.values[k], spectrum.times[k], limit);
      continue;
    }
    double fastest = 0;
    for (const Complex& value : spectrum.values[k]) fastest = std::max(fastest, std::abs(value));
    for (const Complex& value : spectrum.values[k]) {
      const double size = std::abs(value);
      if (value.imag() < 0 || size <= negligible * fastest || value.real() > negligible * fastest) continue;
      const Complex direction =
          std::abs(value.real()) < negligible * size ? Complex(0, 1) : value / size;  // no damping but by rounding
      lower(limit, along(direction), size, value, spectrum.times[k]);
    }
  }
  return limit;
}

std::string_view to_string(Fate fate) {
  switch (fate) {
    case Fate::bounded:
      return "bounded";
    case Fate::grows:
      return "grows";
    case Fate::no_run:
      break;
  }
  return "no run";
}

namespace {

/// Every `stride`-th state of a run, as many as a look at its growth needs.
struct Watched {
  std::vector<std::vector<double>> states{};
  Ending ending = Ending::invalid_input;
};
Watched watch(std::string_view method, const NamedSystem<double>& system, std::vector<double> x,
              Interval<double> interval, double step, std::size_t stride) {
  Watched watched;
  Options<std::vector<double>> options{.rtol = 1e-10, .atol = 1e-12, .step = step};
  options.save.callback = [&, n = std::size_t{0}](double, const std::vector<double>& state) mutable {
    if (n++ % stride == 0) watched.states.push_back(state);
  };
  watched.ending = named_solve<double>(method, system, std::move(x), interval, options).outcome.ending;
  return watched;
}

}  // namespace

Fate fate_of(std::string_view method, const ParametricSystem& system, const Pairing& pairing, double t,
             const std::vector<double>& x, double step, double factor) {
  constexpr double least_steps = 300, most_steps = 1e6, kept = 5000;
  constexpr std::size_t windows = 10;
  // What grows as expected has grown by `told` in all, by told^0.9 from the first window to the last; what is bounded
  // stays below `grown`, even where it first swells as motions close to a limit do: the leapfrog's one part in a
  // hundred before its limit by 1/sqrt(1 - 0.99^2) = 7.
  constexpr double told = 1e5, grown = 100;
  const double wanted = std::max(least_steps, std::log(told) / std::log(factor));
  if (!(wanted <= most_steps)) return Fate::no_run;
  const auto stride = static_cast<std::size_t>(wanted / kept) + 1;
  auto named = named_system<double>(system.size, [&](double time, Values state, std::span<double> dxdt) {
    system.derivative(time, state, system.constants, dxdt);
  });
  named.given_jacobian = [&](double time, Values state, std::span<double> rows) {
    const auto entries = jacobian_of(system, time, state, system.constants);
    std::copy(entries.begin(), entries.end(), rows.begin());
  };
  named.pairs = pairing.pairs;
  named.velocity_free = pairing.velocity_free;
  std::vector<double> beside = x;
  constexpr double faint = 1e-6;
  for (std::size_t i = 0; i < x.size(); ++i)  // some of every motion: no symmetry leaves one out
    beside[i] += faint * std::max(std::abs(x[i]), 1.0) * std::cos(1.7 * static_cast<double>(i * i) + 1);
  const Interval<double> interval{t, t + step * std::ceil(wanted)};
  const Watched one = watch(method, named, x, interval, step, stride);
  if (one.ending == Ending::invalid_input) return Fate::no_run;
  const Watched other = watch(method, named, beside, interval, step, stride);
  if (!succeeded(one.ending) || !succeeded(other.ending)) return Fate::grows;
  std::array<double, windows> farthest{};
  const std::size_t count = std::min(one.states.size(), other.states.size());
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t i = 0; i < x.size(); ++i) {
      double& most = farthest[n * windows / count];
      most = std::max(most, std::abs(one.states[n][i] - other.states[n][i]));
    }
  return farthest.back() > grown * farthest.front() ? Fate::grows : Fate::bounded;
}

}  // namespace continuo::studies
