// continuo/studies/continuation.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/continuation.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;

/// A place on the branch: x and, behind it, the constant; in units in which all are about 1.
struct Place {
  Vector z;
  Vector tangent;             // of length 1
  double direction_sign = 0;  // of det (df/dz; tangent): changes where another branch crosses
  BranchPoint point;
  double hopf_test = 0;  // product of the sums of all pairs of eigenvalues: zero where a pair is on the axis
};

class Follower {
 public:
  Follower(const ParametricSystem& system, const Vector& x, const ContinuationOptions& options)
      : system_(system), options_(options), n_(system.size), p_(system.constants), units_(n_ + 1) {
    for (std::size_t i = 0; i < n_; ++i) units_[i] = std::max(std::abs(x[i]), 1.0);
    units_[n_] = options.high - options.low;
  }

  Branch operator()(Vector x) {
    Branch branch;
    Vector z = std::move(x);
    z.push_back(p_[options_.constant]);
    for (std::size_t i = 0; i <= n_; ++i) z[i] /= units_[i];
    const auto start = corrected(z, z, Vector(n_ + 1, 0.0), true);
    if (!start) {
      branch.message = "there is no equilibrium near the start";
      return branch;
    }
    Place first = described(*start, {});
    Branch back = followed(first, -1), ahead = followed(first, 1);
    std::ranges::reverse(back.points);
    std::ranges::reverse(back.bifurcations);
    for (BifurcationPoint& point : back.bifurcations) point.next = back.points.size() - point.next;
    for (BifurcationPoint& point : ahead.bifurcations) point.next += back.points.size() + 1;
    branch = std::move(back);
    branch.points.push_back(first.point);
    branch.points.insert(branch.points.end(), ahead.points.begin(), ahead.points.end());
    branch.bifurcations.insert(branch.bifurcations.end(), ahead.bifurcations.begin(), ahead.bifurcations.end());
    branch.complete = branch.complete && ahead.complete;
    if (branch.message.empty()) branch.message = ahead.message;
    return branch;
  }

 private:
  double constant_of(const Vector& z) const { return z[n_] * units_[n_]; }
  Vector state_of(const Vector& z) const {
    Vector x(n_);
    for (std::size_t i = 0; i < n_; ++i) x[i] = z[i] * units_[i];
    return x;
  }
  bool inside(const Vector& z) const { return constant_of(z) >= options_.low && constant_of(z) <= options_.high; }

  /// What is small of each constant: of that which moves a part of its range, for its value may be zero on the way.
  Vector sizes_of_constants() const {
    Vector sizes(p_);
    for (double& size : sizes) size = size == 0 ? 1 : std::abs(size);
    sizes[options_.constant] = units_[n_] / 100;
    return sizes;
  }

  /// df/dz, n rows of n + 1.
  Vector jacobian(const Vector& z) {
    p_[options_.constant] = constant_of(z);
    const Vector x = state_of(z), by_x = jacobian_of(system_, options_.t, x, p_),
                 by_p = constant_jacobian_of(system_, options_.t, x, p_, sizes_of_constants());
    Vector rows(n_ * (n_ + 1));
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) rows[i * (n_ + 1) + j] = by_x[i * n_ + j] * units_[j];
      rows[i * (n_ + 1) + n_] = by_p[i * p_.size() + options_.constant] * units_[n_];
    }
    return rows;
  }
  /// (df/dz; last row) y = b. Empty where it is singular.
  Vector solved(const Vector& rows, const Vector& last, Vector b) const {
    DenseLU<double, run_time_size> lu(n_ + 1);
    auto&& matrix = lu.matrix();
    std::ranges::copy(rows, matrix.begin());
    std::ranges::copy(last, matrix.begin() + static_cast<std::ptrdiff_t>(n_ * (n_ + 1)));
    if (!lu.factor()) return {};
    lu.solve(b.data());
    return b;
  }

  /// Newton to f = 0 with (z - guess) . tangent = 0; at fixed constant where `at_constant`.
  std::optional<Vector> corrected(const Vector& guess, Vector z, const Vector& tangent, bool at_constant) {
    Vector last(tangent);
    if (at_constant) {
      last.assign(n_ + 1, 0.0);
      last[n_] = 1;
    }
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 12; ++k) {
      Vector b(n_ + 1);
      p_[options_.constant] = constant_of(z);
      system_.derivative(options_.t, state_of(z), p_, std::span(b).first(n_));
      for (std::size_t i = 0; i <= n_; ++i) b[n_] += (z[i] - guess[i]) * last[i];
      const Vector step = solved(jacobian(z), last, b);
      if (step.empty()) return std::nullopt;
      double size = 0;
      for (std::size_t i = 0; i <= n_; ++i) {
        z[i] -= step[i];
        size = std::max(size, std::abs(step[i]) / std::max(1.0, std::abs(z[i])));
      }
      if (!(size < 1e6)) return std::nullopt;
      if (size < 1e-13 || (size < 1e-9 && size > before / 4)) return z;
      before = size;
    }
    return std::nullopt;
  }

  /// The tangent nearest to `along`, eigenvalues and tests.
  Place described(Vector z, const Vector& along) {
    Place place{.z = std::move(z), .tangent = {}, .point = {}};
    const Vector rows = jacobian(place.z);
    Vector last(along), b(n_ + 1);
    b[n_] = 1;
    if (last.empty()) {
      last.assign(n_ + 1, 0.0);
      last[n_] = 1;
    }
    place.tangent = solved(rows, last, b);
    if (place.tangent.empty()) {  // a fold just here: any other row will do
      for (std::size_t i = 0; i < n_ && place.tangent.empty(); ++i) {
        last.assign(n_ + 1, 0.0);
        last[i] = 1;
        place.tangent = solved(rows, last, b);
      }
    }
    double length = 0;
    for (const double part : place.tangent) length += part * part;
    for (double& part : place.tangent) part /= std::sqrt(length);
    Vector square(rows);
    square.insert(square.end(), place.tangent.begin(), place.tangent.end());
    double sign = 1;
    for (const auto& value : eigenvalues(square, n_ + 1).values)
      if (value.imag() == 0 && value.real() < 0) sign = -sign;
    place.direction_sign = sign;
    describe(place);
    return place;
  }
  void describe(Place& place) {
    place.point.constant = constant_of(place.z);
    place.point.x = state_of(place.z);
    p_[options_.constant] = place.point.constant;
    const Equilibrium equilibrium = describe_equilibrium(system_, place.point.x, p_, options_.t);
    place.point.eigenvalues = equilibrium.eigenvalues;
    place.point.stability = equilibrium.stability;
    place.hopf_test = 1;
    const auto& values = place.point.eigenvalues;
    double size = 0;
    for (const auto& value : values) size = std::max(size, std::abs(value));
    std::complex<double> product = 1;
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = i + 1; j < values.size(); ++j) product *= (values[i] + values[j]) / size;
    place.hopf_test = product.real();
  }

  Branch followed(const Place& from, double direction) {
    Branch branch;
    Place here = from;
    for (double& part : here.tangent) part *= direction;
    here.direction_sign *= direction;
    const Vector origin = here.z;
    double step = options_.first_step;
    while (branch.points.size() < options_.most_points) {
      if (options_.interrupt && options_.interrupt->load()) {
        branch.message = "interrupted";
        return branch;
      }
      auto next = stepped(here, step);
      if (!next || turns(here, *next)) {
        step /= 2;
        if (step > 1e-7) continue;
        branch.message = "the branch could not be followed further";
        return branch;
      }
      mark(branch, here, *next, step);
      here = std::move(*next);
      if (inside(here.z)) branch.points.push_back(here.point);
      report(here.point.constant);
      if (!inside(here.z) || (branch.points.size() > 20 && near(here.z, origin, step))) {
        branch.complete = true;
        return branch;
      }
      step = std::min(1.3 * step, options_.largest_step);
    }
    branch.message = "too many points";
    return branch;
  }
  void report(double constant) {
    low_ = std::min(low_, constant);
    high_ = std::max(high_, constant);
    if (options_.progress) options_.progress(std::min((high_ - low_) / units_[n_], 1.0));
  }
  std::optional<Place> stepped(const Place& from, double step) {
    Vector guess(from.z);
    for (std::size_t i = 0; i <= n_; ++i) guess[i] += step * from.tangent[i];
    auto z = corrected(guess, guess, from.tangent, false);
    if (!z) return std::nullopt;
    double moved = 0;
    for (std::size_t i = 0; i <= n_; ++i) moved += ((*z)[i] - guess[i]) * ((*z)[i] - guess[i]);
    if (std::sqrt(moved) > step) return std::nullopt;  // it leapt to elsewhere
    return described(std::move(*z), from.tangent);
  }
  /// By more than 25 degrees: the step was too long to be sure of the branch.
  static bool turns(const Place& a, const Place& b) {
    double cosine = 0;
    for (std::size_t i = 0; i < a.tangent.size(); ++i) cosine += a.tangent[i] * b.tangent[i];
    return cosine < 0.906;
  }
  static bool near(const Vector& a, const Vector& b, double step) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum) < step / 2;
  }

  /// What lies between two neighbours, narrowed down to where its test is zero.
  void mark(Branch& branch, const Place& a, const Place& b, double step) {
    const auto located = [&](auto&& test) {
      double low = 0, high = step;
      std::optional<Place> best;
      const bool positive = test(a) > 0;
      for (int k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2;
        auto place = stepped(a, middle);
        if (!place) break;
        ((test(*place) > 0) == positive ? low : high) = middle;
        best = std::move(place);
      }
      return best;
    };
    const auto add = [&](Bifurcation kind, std::optional<Place> place, double frequency) {
      if (place && inside(place->z))
        branch.bifurcations.push_back({kind, std::move(place->point), frequency, branch.points.size()});
    };
    const bool crosses = a.direction_sign * b.direction_sign < 0;  // a pitchfork also turns round
    if (a.tangent[n_] * b.tangent[n_] < 0 && !crosses)
      add(Bifurcation::fold, located([&](const Place& p) { return p.tangent[n_]; }), 0);
    if (crosses) add(Bifurcation::crossing, located([](const Place& p) { return p.direction_sign; }), 0);
    if (a.hopf_test * b.hopf_test < 0) {
      auto place = located([](const Place& p) { return p.hopf_test; });
      if (!place) return;
      // The pair whose sum vanishes: complex, or two real ones of opposite sign (then nothing happens).
      double frequency = 0, least = std::numeric_limits<double>::infinity();
      for (const auto& value : place->point.eigenvalues) {
        if (value.imag() <= 0 || std::abs(value.real()) >= least) continue;
        least = std::abs(value.real());
        frequency = value.imag();
      }
      if (frequency > 0 && least < 1e-5 * frequency)
        add(Bifurcation::hopf, std::move(place), frequency / (2 * std::numbers::pi));
    }
  }

  const ParametricSystem& system_;
  const ContinuationOptions& options_;
  std::size_t n_;
  Vector p_, units_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;  // what has been covered
};

}  // namespace

std::string_view to_string(Bifurcation kind) {
  constexpr std::array<std::string_view, 3> names{"fold", "Hopf point", "crossing of branches"};
  return names[static_cast<std::size_t>(kind)];
}

Branch continue_equilibrium(const ParametricSystem& system, std::vector<double> x, const ContinuationOptions& options) {
  return Follower(system, x, options)(x);
}

}  // namespace continuo::studies
