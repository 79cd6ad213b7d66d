// continuo/studies/equilibria/curve_marks.cpp: the degenerate points of a curve.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <continuo/studies/equilibria/curve_follower.hpp>
#include <continuo/studies/equilibria/degenerate_points.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;

constexpr double on_the_axis = 1e-5;      // of a real part, in parts of the frequency
constexpr double no_eigenvalue = 1e-4;    // in parts of |A|: twice zero is known to the root of rounding alone
constexpr double rounding_leaves = 1e-8;  // of a test, where that is of the size of 1
constexpr double has_vanished = 1e-3;     // of a coefficient, in parts of what it is at the neighbours

double norm_of(const Vector& a, std::size_t n) {
  double norm = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += std::abs(a[i * n + j]);
    norm = std::max(norm, sum);
  }
  return norm;
}

}  // namespace

void CurveFollower::mark(BifurcationCurve& curve, const CurvePlace& a, const CurvePlace& b, double step) {
  using enum Degeneracy;
  const std::size_t begin = curve.marks.size();
  std::vector<double> distances;
  for (const Degeneracy kind : {cusp, bogdanov_takens, generalized_hopf, zero_hopf, double_hopf}) {
    if (!(a.test(kind) * b.test(kind) < 0) || !is_seen(kind, a, b)) continue;
    const std::size_t before = curve.marks.size();
    add(curve, kind, a, b, step);
    if (curve.marks.size() > before) distances.push_back(located_at_);
  }
  for (std::size_t i = 0; i < distances.size(); ++i)  // in the order of the curve
    for (std::size_t j = i + 1; j < distances.size(); ++j)
      if (distances[j] < distances[i]) {
        std::swap(distances[i], distances[j]);
        std::swap(curve.marks[begin + i], curve.marks[begin + j]);
      }
}

bool CurveFollower::is_seen(Degeneracy kind, const CurvePlace& a, const CurvePlace& b) {
  double size = std::max(std::abs(a.test(kind)), std::abs(b.test(kind)));
  if (kind == Degeneracy::generalized_hopf) {
    // l1 is about |A| / (omega x^2).
    double unit = 1;
    for (std::size_t i = 0; i < steps_.size(); ++i) unit = std::max(unit, steps_.unit(i));
    const double norm = norm_of(steps_.matrix(a.z), steps_.matrix_size());
    size *= unit * unit * 2 * std::numbers::pi * a.point.frequency / norm;
  }
  if (kind == Degeneracy::bogdanov_takens && a.space.dimension == 2) {
    const double norm = norm_of(steps_.matrix(a.z), steps_.matrix_size());
    size /= norm * norm;
    return size > rounding_leaves * rounding_leaves;
  }
  return size > rounding_leaves;
}

void CurveFollower::add(BifurcationCurve& curve, Degeneracy kind, const CurvePlace& a, const CurvePlace& b,
                        double step) {
  const auto place = located(kind, a, b, step);
  if (!place || !inside(place->point)) return;
  DegeneratePoint point{.kind = kind, .at = place->point, .next = curve.points.size(), .numbers = {}};
  if (!is_what(kind, *place, a, b, point.other_frequency)) return;
  // Next to it the test is on either side of zero, which of a zero that rounding has made it need not be.
  const double at = located_at_, aside = 1e-3 * std::min({step, at, step - at});
  if (aside > 1e-7 * step) {
    const auto before = steps_.stepped(a, at - aside), after = steps_.stepped(a, at + aside);
    if (!before || !after || !(before->test(kind) * after->test(kind) < 0)) return;
  }
  located_at_ = at;
  point.numbers = numbers_of(kind, point.at);
  curve.marks.push_back(std::move(point));
}

/// Bisection, with a step of the secant between.
std::optional<CurvePlace> CurveFollower::located(Degeneracy kind, const CurvePlace& a, const CurvePlace& b,
                                                 double step) {
  constexpr int most = 70;
  constexpr double exact = 1e-13;
  double low = 0, high = step, at_low = a.test(kind), at_high = b.test(kind);
  std::optional<CurvePlace> best;
  for (int k = 0; k < most && high - low > exact * step; ++k) {
    const double secant = low - at_low * (high - low) / (at_high - at_low);
    const double s = k % 2 == 1 || !(secant > low && secant < high) ? (low + high) / 2 : secant;
    auto place = steps_.stepped(a, s);
    if (!place) break;
    const double value = place->test(kind);
    best = std::move(place);
    located_at_ = s;
    if (value == 0) break;
    if (!std::isfinite(value)) return std::nullopt;
    if ((value < 0) == (at_low < 0)) {
      low = s, at_low = value;
    } else {
      high = s, at_high = value;
    }
  }
  return best;
}

bool CurveFollower::is_what(Degeneracy kind, const CurvePlace& place, const CurvePlace& a, const CurvePlace& b,
                            double& other_frequency) {
  const std::size_t n = steps_.matrix_size();
  const double norm = norm_of(steps_.matrix(place.z), n);
  const auto others = other_eigenvalues(place.point.eigenvalues, place.space);
  const auto vanishes = [&](const std::optional<double>& coefficient) {
    if (!coefficient) return false;
    const double neighbours =
        std::max(std::abs(a.point.coefficient.value_or(0)), std::abs(b.point.coefficient.value_or(0)));
    return std::abs(*coefficient) < has_vanished * neighbours;
  };
  const auto has_a_zero = [&] {
    return std::ranges::any_of(others, [&](const Complex& value) { return std::abs(value) < no_eigenvalue * norm; });
  };
  switch (kind) {
    case Degeneracy::cusp:
      return system_.algebraic > 0 || vanishes(place.point.coefficient);
    case Degeneracy::bogdanov_takens:
      if (place.space.dimension == 1) return has_a_zero();
      {  // Without a Jordan block A vanishes on the plane: something else, and more.
        const auto fold = fold_space(steps_.matrix(place.z), n);
        return fold && std::abs(fold->margin) < no_eigenvalue && std::abs(fold->test) < no_eigenvalue * norm;
      }
    case Degeneracy::generalized_hopf:
      return vanishes(place.point.coefficient);
    case Degeneracy::zero_hopf:
      if (place.space.dimension == 2) return has_a_zero();
      [[fallthrough]];
    case Degeneracy::double_hopf: {
      // A pair that is real, of opposite sign, also has the sum zero: nothing happens.
      const auto pair = std::ranges::find_if(others, [](const Complex& value) {
        return value.imag() > 0 && std::abs(value.real()) < on_the_axis * value.imag();
      });
      if (pair == others.end()) return false;
      other_frequency = pair->imag() / (2 * std::numbers::pi);
      return true;
    }
  }
  return false;
}

std::vector<NormalFormNumber> CurveFollower::numbers_of(Degeneracy kind, const CurvePoint& point) const {
  Vector p(system_.constants);
  for (std::size_t k = 0; k < 2; ++k) p[options_.constants[k]] = point.constants[k];
  if (kind == Degeneracy::cusp) return cusp_numbers(system_, point.x, p, options_.t);
  if (kind == Degeneracy::bogdanov_takens) return double_zero_numbers(system_, point.x, p, options_.t);
  return {};
}

}  // namespace continuo::studies::detail
