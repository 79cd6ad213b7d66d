// continuo/studies/orbits/curves/orbit_curve_steps.cpp
// Predictor and corrector on a curve of bifurcations of orbits.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/orbits/collocation/orbit_multipliers.hpp>
#include <continuo/studies/orbits/curves/orbit_curve_steps.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;

constexpr std::size_t most_curve_intervals = 300;
constexpr NewtonLimits limits_of_curve{
    .most_iterations = 10, .solved_to = 1e-9, .rounding = 1e-6, .farthest = 10, .each_is_smaller = true};  // in sizes
constexpr double error_of_tolerance = 100;  // as in orbit_branch

/// Products over multipliers, each factor of size 1 at most.
double product_with(const std::vector<Complex>& values, double sign) {
  Complex product = 1;
  for (const Complex& value : values) product *= (1.0 + sign * value) / (1 + std::abs(value));
  return product.real();
}
double product_of_pairs(const std::vector<Complex>& values) {
  Complex product = 1;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t j = i + 1; j < values.size(); ++j)
      product *= (1.0 - values[i] * values[j]) / (1 + std::abs(values[i] * values[j]));
  return product.real();
}
std::vector<Complex> without(std::vector<Complex> values, const Complex& wanted) {
  const auto nearest =
      std::ranges::min_element(values, {}, [&](const Complex& value) { return std::abs(value - wanted); });
  if (nearest != values.end()) values.erase(nearest);
  return values;
}

/// Zero where a second multiplier comes to where the first one is held, 1 or -1. Of two that are nearly one the product
/// is known, and is 1 there, but not each of them.
double second_at(const std::vector<Complex>& values, double wanted) {
  const auto others = without(values, wanted);
  const auto second =
      *std::ranges::min_element(others, {}, [&](const Complex& value) { return std::abs(value - wanted); });
  const auto first =
      *std::ranges::min_element(values, {}, [&](const Complex& value) { return std::abs(value - wanted); });
  const Complex both = first * second;
  return ((1.0 - both) / (1 + std::abs(both))).real() * product_with(without(others, second), -wanted);
}

}  // namespace

OrbitCurveSteps::OrbitCurveSteps(const ParametricSystem& system, OrbitBifurcation kind,
                                 const OrbitCurveOptions& options)
    : system_(system),
      kind_(kind),
      options_(options),
      error_wanted_(error_of_tolerance * options.rtol),
      sizes_(system.size, 1.0) {}

void OrbitCurveSteps::use(const std::shared_ptr<const OrbitMesh>& mesh) {
  if (mesh == mesh_) return;
  mesh_ = mesh;
  equations_.emplace(
      system_, options_.constants, kind_, mesh,
      std::array{(options_.high[0] - options_.low[0]) / 100, (options_.high[1] - options_.low[1]) / 100});
}

ParametricSystem OrbitCurveSteps::there(const Vector& z) const {
  ParametricSystem system(system_);
  system.constants[options_.constants[0]] = z[z.size() - 3];
  system.constants[options_.constants[1]] = z[z.size() - 2];
  return with_one_constant(system, options_.constants[0], (options_.high[0] - options_.low[0]) / 100);
}

/// Sizes of the components from z, and units of all unknowns on the mesh that is used.
void OrbitCurveSteps::measure(const Vector& z) {
  const std::size_t n = system_.size, states = z.size() - CriticalOrbit::behind;
  Vector sizes(n, 0.0);
  double greatest = 0;
  for (std::size_t j = 0; j < states; ++j) {
    sizes[j % n] = std::max(sizes[j % n], std::abs(z[j]));
    greatest = std::max(greatest, sizes[j % n]);
  }
  for (double& size : sizes) size = size > 1e-12 * greatest ? size : greatest > 0 ? greatest : 1;
  sizes_ = sizes;
  const ParametricSystem one = there(z);
  const OrbitCollocation orbit(one, mesh_);
  scale_.resize(z.size());
  for (std::size_t j = 0; j < states; ++j) scale_[j] = sizes_[j % n] / std::sqrt(orbit.weight(j / n));
  scale_[states] = z[states];
  for (std::size_t c = 0; c < 2; ++c) scale_[states + 1 + c] = options_.high[c] - options_.low[c];
  scale_[states + 3] = 1;
}

Vector OrbitCurveSteps::shift_at(const Vector& z) {
  const ParametricSystem one = there(z);
  const OrbitCollocation orbit(one, mesh_);
  Vector shift = orbit.field(Vector(z.begin(), z.end() - 2));
  shift.resize(z.size());
  for (std::size_t j = 0; j < z.size(); ++j) shift[j] /= scale_[j];
  normalize(shift);
  return shift;
}

std::optional<OrbitCurvePlace> OrbitCurveSteps::corrected(const Vector& guess, const Vector& reference,
                                                          const Vector& last, const CriticalVectors& borders,
                                                          const std::array<double, 2>& normal) {
  Vector z(guess);
  const Vector shift = shift_at(reference);
  CriticalVectors held(borders);
  const auto correct = [&]() -> NewtonCorrection {
    if (options_.interrupt && options_.interrupt->load()) return NewtonEnding::interrupted;
    if (!equations_->evaluate(z, sizes_, scale_, shift, held)) return NewtonEnding::not_finite;
    if (held.right.empty()) held = equations_->vectors();
    Vector b = equations_->residuals(z, reference, shift);
    for (std::size_t j = 0; j < z.size(); ++j) b.back() += last[j] * (z[j] - guess[j]) / scale_[j];
    if (!equations_->solve(last, b)) return NewtonEnding::singular;
    for (std::size_t j = 0; j < z.size(); ++j) z[j] -= b[j] * scale_[j];
    return length(b);
  };
  const auto is_near = [&, period = z.size() - CriticalOrbit::behind] {
    return z[period] > guess[period] / 2 && z[period] < 2 * guess[period];
  };
  if (!newton_iteration(limits_of_curve, correct, is_near)) return std::nullopt;
  return described(std::move(z), last, normal);
}

std::optional<OrbitCurvePlace> OrbitCurveSteps::described(Vector z, const Vector& along,
                                                          const std::array<double, 2>& normal) {
  OrbitCurvePlace place{.mesh = mesh_, .z = std::move(z)};
  const std::size_t states = place.z.size() - CriticalOrbit::behind;
  const CriticalVectors borders = equations_->vectors();
  if (!equations_->evaluate(place.z, sizes_, scale_, shift_at(place.z), borders)) return std::nullopt;
  place.vectors = equations_->vectors();
  if (kind_ == OrbitBifurcation::fold) place.normal = equations_->normal();
  if (place.normal[0] * normal[0] + place.normal[1] * normal[1] < 0)  // the left vector may point either way
    for (double& part : place.normal) part = -part;
  Vector b(place.z.size());
  b.back() = 1;
  if (!equations_->solve(along, b)) return std::nullopt;
  normalize(b);
  place.tangent = std::move(b);
  const ParametricSystem one = there(place.z);
  const OrbitCollocation orbit(one, mesh_);
  const Vector alone(place.z.begin(), place.z.end() - 2);
  OrbitCurvePoint& point = place.point;
  point.constants = {place.z[states + 1], place.z[states + 2]};
  point.period = place.z[states];
  point.x.assign(place.z.begin(), place.z.begin() + static_cast<std::ptrdiff_t>(system_.size));
  point.multipliers = multipliers_of(one, orbit, alone, sizes_);
  if (point.multipliers.empty()) return std::nullopt;
  if (kind_ == OrbitBifurcation::torus) point.rotation = place.z.back() / (2 * std::numbers::pi);
  place.error = std::ranges::max(orbit.errors(alone, sizes_));
  set_tests(place);
  return place;
}

void OrbitCurveSteps::set_tests(OrbitCurvePlace& place) const {
  using enum OrbitDegeneracy;
  place.tests.fill(std::nan(""));
  const auto set = [&](OrbitDegeneracy kind, double value) { place.tests[static_cast<std::size_t>(kind)] = value; };
  const std::size_t states = place.z.size() - CriticalOrbit::behind;
  const auto& values = place.point.multipliers;
  if (kind_ == OrbitBifurcation::fold) {
    // The curve is upright to the normal; where it stands still in both constants it turns round.
    set(cusp, place.tangent[states + 2] * place.normal[0] - place.tangent[states + 1] * place.normal[1]);
    const auto others = without(values, 1);
    if (others.empty()) return;
    set(resonance_1, second_at(values, 1));
    set(fold_flip, product_with(others, 1));
    if (others.size() > 1) set(fold_torus, product_of_pairs(others));
  } else if (kind_ == OrbitBifurcation::period_doubling) {
    const auto others = without(values, -1);
    if (others.empty()) return;
    set(resonance_2, second_at(values, -1));
    set(fold_flip, product_with(others, -1));
    if (others.size() > 1) set(flip_torus, product_of_pairs(others));
  } else if (kind_ == OrbitBifurcation::torus) {
    const double angle = place.z.back(), pi = std::numbers::pi;
    set(resonance_3, std::cos(angle) + 0.5);
    set(resonance_4, std::cos(angle));
    const auto others = without(without(values, std::polar(1.0, angle)), std::polar(1.0, 2 * pi - angle));
    if (others.empty()) return;
    set(fold_torus, product_with(others, -1));
    set(flip_torus, product_with(others, 1));
    if (others.size() > 1) set(double_torus, product_of_pairs(others));
  }
}

std::optional<OrbitCurvePlace> OrbitCurveSteps::first(const OrbitMark& mark) {
  use(std::make_shared<const OrbitMesh>(mark.mesh));
  Vector z(mark.unknowns);
  z.push_back(system_.constants[options_.constants[1]]);
  z.push_back(kind_ == OrbitBifurcation::period_doubling ? std::numbers::pi : 2 * std::numbers::pi * mark.rotation);
  measure(z);
  if (!equations_->evaluate(z, sizes_, scale_, shift_at(z), {})) return std::nullopt;
  // Any row that leaves the equations regular gives the tangent, and that is the best row to solve them with.
  const std::size_t states = z.size() - CriticalOrbit::behind;
  Vector tangent;
  for (const std::size_t unknown : {states + 2, states + 1, states}) {
    Vector row(z.size()), b(z.size());
    row[unknown] = 1;
    b.back() = 1;
    if (!equations_->solve(row, b) || (!tangent.empty() && length(b) > length(tangent))) continue;
    tangent = std::move(b);
  }
  if (tangent.empty()) return std::nullopt;
  normalize(tangent);
  auto place = corrected(z, z, tangent, {}, {1, 0});
  for (int k = 0; k < 4 && place && !is_exact(*place); ++k)
    if (!renew(*place)) break;
  if (place) complete(*place);
  return place;
}

std::optional<OrbitCurvePlace> OrbitCurveSteps::stepped(const OrbitCurvePlace& from, double step) {
  use(from.mesh);
  measure(from.z);
  return arclength_step(from.z, from.tangent, step, scale_, [&](const Vector& guess) {
    return corrected(guess, from.z, from.tangent, from.vectors, from.normal);
  });
}

std::optional<OrbitCurvePlace> OrbitCurveSteps::at_bound(const OrbitCurvePlace& a, const OrbitCurvePlace& b,
                                                         std::size_t constant, double value) {
  use(a.mesh);
  measure(a.z);
  const std::size_t unknown = a.z.size() - CriticalOrbit::behind + 1 + constant;
  const double part = (value - a.z[unknown]) / (b.z[unknown] - a.z[unknown]);
  Vector guess = between(a.z, b.z, part), last(a.z.size());
  guess[unknown] = value;
  last[unknown] = 1;
  auto place = corrected(guess, a.z, last, a.vectors, a.normal);
  if (place) complete(*place);
  return place;
}

/// Unknowns on the mesh that is used, read off on another.
Vector OrbitCurveSteps::on_mesh(const Vector& z, const OrbitMesh& mesh) {
  const ParametricSystem one = there(z);
  const OrbitCollocation orbit(one, mesh_);
  const std::size_t n = system_.size;
  const Vector alone(z.begin(), z.end() - 2);
  Vector result((mesh.size() - 1) * OrbitCollocation::degree * n);
  for (std::size_t k = 0; k + 1 < mesh.size(); ++k)
    for (std::size_t j = 0; j < OrbitCollocation::degree; ++j)
      orbit.state(alone, mesh[k] + OrbitCollocation::table().nodes[j] * (mesh[k + 1] - mesh[k]),
                  std::span(result).subspan((k * OrbitCollocation::degree + j) * n, n));
  result.insert(result.end(), z.end() - CriticalOrbit::behind, z.end());
  return result;
}

bool OrbitCurveSteps::renew(OrbitCurvePlace& place) {
  use(place.mesh);
  measure(place.z);
  const ParametricSystem one = there(place.z);
  const OrbitCollocation orbit(one, mesh_);
  const auto errors = orbit.errors(Vector(place.z.begin(), place.z.end() - 2), sizes_);
  const auto mesh = orbit.better_mesh(errors, error_wanted_ / 10, most_curve_intervals);
  const double worst = std::ranges::max(errors);
  if (worst <= error_wanted_ / 2 && 2 * mesh->size() >= place.mesh->size()) return true;
  Vector tangent(place.tangent);
  for (std::size_t j = 0; j < tangent.size(); ++j) tangent[j] *= scale_[j];
  const Vector z = on_mesh(place.z, *mesh);
  tangent = on_mesh(tangent, *mesh);
  use(mesh);
  measure(z);
  for (std::size_t j = 0; j < tangent.size(); ++j) tangent[j] /= scale_[j];
  normalize(tangent);
  auto again = corrected(z, z, tangent, {}, place.normal);
  if (!again) return false;
  again->point.low = place.point.low;
  again->point.high = place.point.high;
  place = std::move(*again);
  return true;
}

void OrbitCurveSteps::complete(OrbitCurvePlace& place) {
  use(place.mesh);
  const ParametricSystem one = there(place.z);
  const OrbitCollocation orbit(one, mesh_);
  auto extremes = orbit.extremes(Vector(place.z.begin(), place.z.end() - 2));
  place.point.low = std::move(extremes.low);
  place.point.high = std::move(extremes.high);
}

Vector OrbitCurveSteps::deviations(const OrbitCurvePlace& place) {
  use(place.mesh);
  const ParametricSystem one = there(place.z);
  const OrbitCollocation orbit(one, mesh_);
  const std::size_t n = system_.size, states = place.z.size() - CriticalOrbit::behind;
  Vector mean(n), result(states);
  for (std::size_t j = 0; j < states; ++j) mean[j % n] += place.z[j] * orbit.weight(j / n);
  for (std::size_t j = 0; j < states; ++j) result[j] = (place.z[j] - mean[j % n]) * std::sqrt(orbit.weight(j / n));
  return result;
}

}  // namespace continuo::studies::detail
