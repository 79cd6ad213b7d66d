// continuo/studies/orbit_branch.cpp
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/studies/orbit_branch.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr std::size_t most_branch_iterations = 10;
constexpr double no_size = 1e-12;  // of the largest component: what rounding leaves of a zero

double length(const Vector& v) {
  double sum = 0;
  for (const double part : v) sum += part * part;
  return std::sqrt(sum);
}
void normalize(Vector& v) {
  const double size = length(v);
  for (double& part : v) part /= size;
}
double product(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Products over the multipliers, each factor of size 1 at most.
void set_tests(OrbitPlace& place) {
  const auto& values = place.point.multipliers;
  std::complex<double> unity = 1, doubling = 1, torus = 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    unity *= (1.0 - values[i]) / (1 + std::abs(values[i]));
    doubling *= (1.0 + values[i]) / (1 + std::abs(values[i]));
    for (std::size_t j = i + 1; j < values.size(); ++j)
      torus *= (1.0 - values[i] * values[j]) / (1 + std::abs(values[i] * values[j]));
  }
  place.fold = place.tangent.back();
  place.unity = unity.real();
  place.doubling = doubling.real();
  place.torus = values.size() > 1 ? torus.real() : 1;
}

}  // namespace

OrbitPoint as_orbit(const HopfPoint& hopf, bool stable) {
  OrbitPoint point{.constant = hopf.constant,
                   .period = 2 * std::numbers::pi / hopf.angular_frequency,
                   .x = hopf.x,
                   .low = hopf.x,
                   .high = hopf.x,
                   .multipliers = {},
                   .stable = stable};
  // exp(lambda T); of the pair on the axis one is the shift along the orbit.
  std::size_t shift = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hopf.eigenvalues.size(); ++k) {
    const double distance = std::abs(hopf.eigenvalues[k] - std::complex<double>(0, hopf.angular_frequency));
    if (distance < least) least = distance, shift = k;
    point.multipliers.push_back(std::exp(hopf.eigenvalues[k] * point.period));
  }
  point.multipliers.erase(point.multipliers.begin() + static_cast<std::ptrdiff_t>(shift));
  sort_by_size(point.multipliers);
  return point;
}

OrbitBranchSteps::OrbitBranchSteps(const ParametricSystem& system, const OrbitContinuationOptions& options)
    : options_(options),
      equations_(system, options.constant, (options.high - options.low) / 100, options.rtol, options.interrupt),
      n_(system.size),
      points_(equations_.points()),
      unknowns_(equations_.unknowns()),
      sizes_(n_, 0.0),
      scale_(unknowns_, 1.0) {}

void OrbitBranchSteps::forget_sizes(const Vector& sizes) {
  sizes_ = sizes;
}

void OrbitBranchSteps::measure(const Vector& z) {
  double greatest = 0;
  for (std::size_t j = 0; j < n_ * points_; ++j) {
    sizes_[j % n_] = std::max(sizes_[j % n_], std::abs(z[j]));
    greatest = std::max(greatest, sizes_[j % n_]);
  }
  Vector sizes(sizes_);
  for (double& size : sizes) size = size > no_size * greatest ? size : greatest > 0 ? greatest : 1;
  for (std::size_t j = 0; j < n_ * points_; ++j) scale_[j] = sizes[j % n_] * std::sqrt(static_cast<double>(points_));
  scale_[unknowns_ - 2] = equations_.period(z);
  scale_[unknowns_ - 1] = options_.high - options_.low;
  equations_.set_sizes(std::move(sizes));
}

void OrbitBranchSteps::measure(OrbitPlace& place) {
  for (std::size_t j = 0; j < unknowns_; ++j) place.tangent[j] *= scale_[j];
  measure(place.z);
  for (std::size_t j = 0; j < unknowns_; ++j) place.tangent[j] /= scale_[j];
  normalize(place.tangent);
  place.shift = shift_at(place.z);
}

Vector OrbitBranchSteps::shift_at(const Vector& z) const {
  Vector shift = equations_.field(z);
  shift.resize(unknowns_);
  for (std::size_t j = 0; j < unknowns_; ++j) shift[j] /= scale_[j];
  normalize(shift);
  return shift;
}

/// In sizes: (d equations / dz; shift; last) y = b at the last evaluation.
std::optional<Vector> OrbitBranchSteps::solved(const Vector& shift, const Vector& last, Vector b) const {
  DenseLU<double, run_time_size> lu(unknowns_);
  auto&& matrix = lu.matrix();
  const auto rows = equations_.rows();
  for (std::size_t i = 0; i + 2 < unknowns_; ++i)
    for (std::size_t j = 0; j < unknowns_; ++j)
      matrix[i * unknowns_ + j] = rows[i * unknowns_ + j] * scale_[j] / scale_[i];
  const auto end = matrix.begin() + static_cast<std::ptrdiff_t>((unknowns_ - 2) * unknowns_);
  std::ranges::copy(shift, end);
  std::ranges::copy(last, end + static_cast<std::ptrdiff_t>(unknowns_));
  if (!lu.factor()) return std::nullopt;
  lu.solve(b.data());
  if (!std::isfinite(length(b))) return std::nullopt;
  return b;
}

std::optional<Vector> OrbitBranchSteps::corrected(const Vector& guess, const Vector& reference, const Vector& shift,
                                                  const Vector& last) {
  Vector z(guess);
  double before = 0;
  for (iterations_ = 1; iterations_ <= most_branch_iterations; ++iterations_) {
    if (!equations_.evaluate(z)) return std::nullopt;
    Vector b(equations_.residuals().begin(), equations_.residuals().end());
    b.resize(unknowns_);
    for (std::size_t j = 0; j + 2 < unknowns_; ++j) b[j] /= scale_[j];
    for (std::size_t j = 0; j < unknowns_; ++j) {
      b[unknowns_ - 2] += shift[j] * (z[j] - reference[j]) / scale_[j];
      b[unknowns_ - 1] += last[j] * (z[j] - guess[j]) / scale_[j];
    }
    const auto step = solved(shift, last, std::move(b));
    if (!step) return std::nullopt;
    for (std::size_t j = 0; j < unknowns_; ++j) z[j] -= (*step)[j] * scale_[j];
    const double size = length(*step);
    // What the integration's own errors leave, or half way there by a correction that grows no smaller.
    const double noise = options_.rtol;
    if (size <= 10 * noise || (iterations_ > 1 && size > before / 2 && size < 1000 * noise)) return z;
    const double period = equations_.period(z) / equations_.period(guess);
    if (!(period > 0.5 && period < 2) || size > 10 || (iterations_ > 2 && size > before)) return std::nullopt;
    before = size;
  }
  return std::nullopt;
}

/// The tangent nearest to `along`, multipliers and tests.
std::optional<OrbitPlace> OrbitBranchSteps::described(Vector z, const Vector& along) {
  OrbitPlace place{.z = std::move(z), .tangent = {}, .shift = {}, .point = {}};
  place.shift = shift_at(place.z);
  Vector b(unknowns_);
  b[unknowns_ - 1] = 1;
  auto tangent = solved(place.shift, along, b);
  for (std::size_t j = unknowns_; j-- > 0 && !tangent;) {  // a fold just here: any other row will do
    Vector row(unknowns_);
    row[j] = 1;
    tangent = solved(place.shift, row, b);
  }
  if (!tangent) return std::nullopt;
  place.tangent = std::move(*tangent);
  normalize(place.tangent);
  OrbitPoint& point = place.point;
  point.constant = equations_.constant(place.z);
  point.period = equations_.period(place.z);
  point.x.assign(place.z.begin(), place.z.begin() + static_cast<std::ptrdiff_t>(n_));
  point.multipliers = equations_.multipliers(equations_.field(place.z));
  point.stable = std::ranges::all_of(point.multipliers, [](const auto& value) { return std::abs(value) < 1; });
  set_tests(place);
  return place;
}

std::optional<OrbitPlace> OrbitBranchSteps::at_constant(Vector z, double value) {
  z.back() = value;
  Vector last(unknowns_);
  last.back() = 1;
  auto found = corrected(z, z, shift_at(z), last);
  return found ? described(std::move(*found), last) : std::nullopt;
}

std::optional<OrbitPlace> OrbitBranchSteps::across(const Vector& z, const Vector& along) {
  auto found = corrected(z, z, shift_at(z), along);
  return found ? described(std::move(*found), along) : std::nullopt;
}

std::optional<OrbitPlace> OrbitBranchSteps::stepped(const OrbitPlace& from, double step) {
  Vector guess(from.z);
  for (std::size_t j = 0; j < unknowns_; ++j) guess[j] += step * from.tangent[j] * scale_[j];
  auto z = corrected(guess, from.z, from.shift, from.tangent);
  if (!z) return std::nullopt;
  Vector moved(unknowns_);
  for (std::size_t j = 0; j < unknowns_; ++j) moved[j] = ((*z)[j] - guess[j]) / scale_[j];
  if (length(moved) > step) return std::nullopt;  // it leapt to elsewhere
  return described(std::move(*z), from.tangent);
}

void OrbitBranchSteps::complete(OrbitPlace& place) const {
  auto extremes = equations_.extremes(place.z);
  place.point.low = std::move(extremes.low);
  place.point.high = std::move(extremes.high);
}

Vector OrbitBranchSteps::mean(const Vector& z) const {
  Vector result(n_);
  for (std::size_t j = 0; j < n_ * points_; ++j) result[j % n_] += z[j] / static_cast<double>(points_);
  return result;
}
Vector OrbitBranchSteps::deviations(const Vector& z) const {
  const Vector middle = mean(z);
  Vector result(n_ * points_);
  for (std::size_t j = 0; j < result.size(); ++j) result[j] = (z[j] - middle[j % n_]) / scale_[j];
  return result;
}

double OrbitBranchSteps::alike(const OrbitPlace& a, const OrbitPlace& b) {
  return product(a.tangent, b.tangent);
}

}  // namespace continuo::studies::detail
