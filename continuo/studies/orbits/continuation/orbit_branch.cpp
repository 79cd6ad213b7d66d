// continuo/studies/orbits/continuation/orbit_branch.cpp
// Predictor and corrector on a branch of closed orbits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/orbits/collocation/orbit_multipliers.hpp>
#include <continuo/studies/orbits/continuation/multiplier_tests.hpp>
#include <continuo/studies/orbits/continuation/orbit_branch.hpp>
#include <continuo/studies/support/arclength.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr std::size_t most_intervals = 1500;
constexpr NewtonLimits limits_of_branch{
    .most_iterations = 12, .solved_to = 1e-9, .rounding = 1e-6, .farthest = 10, .each_is_smaller = true};  // in sizes
constexpr double error_for_tolerance = 100;  // inside of an interval; at its ends and of the period far less is left
constexpr double no_size = 1e-12;            // of the largest component: what rounding leaves of a zero

void set_tests(OrbitPlace& place) {
  place.fold = place.tangent.back();
  place.tests = tests_of(place.point.multipliers);
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
      system_(with_one_constant(system, options.constant, (options.high - options.low) / 100)),
      error_wanted_(error_for_tolerance * options.rtol),
      n_(system.size),
      sizes_(n_, 0.0),
      component_sizes_(n_, 1.0) {}

void OrbitBranchSteps::use(const std::shared_ptr<const OrbitMesh>& mesh) {
  if (equations_ && equations_->mesh() == mesh) return;
  equations_.emplace(system_, mesh);
  unknowns_ = equations_->unknowns();
  scale_.assign(unknowns_, 1.0);
}

void OrbitBranchSteps::use_for(const OrbitPlace& place) {
  if (equations_ && equations_->mesh() == place.mesh) return;
  use(place.mesh);
  set_scales(place.z);
}

void OrbitBranchSteps::forget_sizes(const Vector& sizes) {
  sizes_ = sizes;
}

/// From the components' sizes, for the mesh that is used.
void OrbitBranchSteps::set_scales(const Vector& z) {
  for (std::size_t j = 0; j + 2 < unknowns_; ++j)
    scale_[j] = component_sizes_[j % n_] / std::sqrt(equations_->weight(j / n_));
  scale_[unknowns_ - 2] = equations_->period(z);
  scale_[unknowns_ - 1] = options_.high - options_.low;
}

void OrbitBranchSteps::measure(const Vector& z) {
  double greatest = 0;
  for (std::size_t j = 0; j + 2 < unknowns_; ++j) {
    sizes_[j % n_] = std::max(sizes_[j % n_], std::abs(z[j]));
    greatest = std::max(greatest, sizes_[j % n_]);
  }
  component_sizes_ = sizes_;
  for (double& size : component_sizes_) size = size > no_size * greatest ? size : greatest > 0 ? greatest : 1;
  set_scales(z);
}

void OrbitBranchSteps::measure(OrbitPlace& place) {
  use_for(place);
  for (std::size_t j = 0; j < unknowns_; ++j) place.tangent[j] *= scale_[j];
  measure(place.z);
  const auto errors = equations_->errors(place.z, component_sizes_);
  const auto mesh = equations_->better_mesh(errors, error_wanted_ / 10, most_intervals);
  const double worst = *std::ranges::max_element(errors);
  if (worst > error_wanted_ / 2 || 2 * mesh->size() < place.mesh->size()) exchange_mesh(place, mesh);
  for (std::size_t j = 0; j < unknowns_; ++j) place.tangent[j] /= scale_[j];
  normalize(place.tangent);
  place.shift = shift_at(place.z);
}

/// The tangent as it is, not in sizes.
void OrbitBranchSteps::exchange_mesh(OrbitPlace& place, const std::shared_ptr<const OrbitMesh>& mesh) {
  Vector z = on_mesh(place.z, *mesh), tangent = on_mesh(place.tangent, *mesh);
  place.z = std::move(z);
  place.tangent = std::move(tangent);
  place.mesh = mesh;
  use(mesh);
  set_scales(place.z);
}

/// Unknowns on the mesh that is used, read off on another.
Vector OrbitBranchSteps::on_mesh(const Vector& z, const OrbitMesh& mesh) const {
  constexpr std::size_t nodes = OrbitCollocation::degree;
  Vector result((mesh.size() - 1) * nodes * n_);
  for (std::size_t k = 0; k + 1 < mesh.size(); ++k)
    for (std::size_t j = 0; j < nodes; ++j)
      equations_->state(z, mesh[k] + OrbitCollocation::table().nodes[j] * (mesh[k + 1] - mesh[k]),
                        std::span(result).subspan((k * nodes + j) * n_, n_));
  result.push_back(z[z.size() - 2]);
  result.push_back(z.back());
  return result;
}

bool OrbitBranchSteps::refine(OrbitPlace& here, const OrbitPlace& there) {
  use_for(here);
  const auto mesh =
      equations_->better_mesh(equations_->errors(there.z, component_sizes_), error_wanted_ / 10, most_intervals);
  if (here.mesh->size() > most_intervals && mesh->size() >= here.mesh->size()) return false;
  for (std::size_t j = 0; j < unknowns_; ++j) here.tangent[j] *= scale_[j];
  exchange_mesh(here, mesh);
  for (std::size_t j = 0; j < unknowns_; ++j) here.tangent[j] /= scale_[j];
  normalize(here.tangent);
  auto again = across(here.z, here.tangent);
  if (!again) return false;
  if (alike(*again, here) < 0)
    for (double& part : again->tangent) part = -part;
  again->point.low = here.point.low;
  again->point.high = here.point.high;
  here = std::move(*again);
  return true;
}

Vector OrbitBranchSteps::shift_at(const Vector& z) const {
  Vector shift = equations_->field(z);
  shift.resize(unknowns_);
  for (std::size_t j = 0; j < unknowns_; ++j) shift[j] /= scale_[j];
  normalize(shift);
  return shift;
}

/// In sizes: (d equations / dz; shift; last) y = b at the last evaluation.
std::optional<Vector> OrbitBranchSteps::solved(const Vector& shift, const Vector& last, Vector b) {
  if (!equations_->solve(scale_, component_sizes_, shift, last, b)) return std::nullopt;
  return b;
}

std::optional<Vector> OrbitBranchSteps::corrected(const Vector& guess, const Vector& reference, const Vector& shift,
                                                  const Vector& last) {
  Vector z(guess);
  const auto correct = [&]() -> NewtonCorrection {
    if (options_.interrupt && options_.interrupt->load()) return NewtonEnding::interrupted;
    if (!equations_->evaluate(z, component_sizes_)) return NewtonEnding::not_finite;
    Vector b(equations_->residuals().begin(), equations_->residuals().end());
    b.resize(unknowns_);
    for (std::size_t j = 0; j + 2 < unknowns_; ++j) b[j] /= component_sizes_[j % n_];
    for (std::size_t j = 0; j < unknowns_; ++j) {
      b[unknowns_ - 2] += shift[j] * (z[j] - reference[j]) / scale_[j];
      b[unknowns_ - 1] += last[j] * (z[j] - guess[j]) / scale_[j];
    }
    const auto step = solved(shift, last, std::move(b));
    if (!step) return NewtonEnding::singular;
    for (std::size_t j = 0; j < unknowns_; ++j) z[j] -= (*step)[j] * scale_[j];
    return length(*step);
  };
  const auto is_near = [&] {
    const double period = equations_->period(z) / equations_->period(guess);
    return period > 0.5 && period < 2;
  };
  const NewtonOutcome outcome = newton_iteration(limits_of_branch, correct, is_near);
  iterations_ = outcome.iterations;
  return outcome ? std::optional(z) : std::nullopt;
}

std::optional<OrbitPlace> OrbitBranchSteps::described(Vector z, const Vector& along) {
  OrbitPlace place{.mesh = equations_->mesh(), .z = std::move(z), .tangent = {}, .shift = {}, .point = {}};
  place.shift = shift_at(place.z);
  if (!equations_->evaluate(place.z, component_sizes_)) return std::nullopt;
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
  point.advance = system_.advance;
  point.constant = equations_->constant(place.z);
  point.period = equations_->period(place.z);
  point.x.assign(place.z.begin(), place.z.begin() + static_cast<std::ptrdiff_t>(n_));
  point.multipliers = multipliers_of(system_, *equations_, place.z, component_sizes_);
  if (point.multipliers.empty()) return std::nullopt;
  place.error = std::ranges::max(equations_->errors(place.z, component_sizes_));
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

// Next to a crossing the matrix is nearly singular: what solves it for any right-hand side is nearly the direction that
// it does not see (inverse iteration).
std::optional<Vector> OrbitBranchSteps::other_direction(const Vector& z, const Vector& along) {
  if (!equations_->evaluate(z, component_sizes_)) return std::nullopt;
  const Vector shift = shift_at(z);
  Vector direction(unknowns_);
  for (std::size_t j = 0; j < unknowns_; ++j) direction[j] = std::cos(static_cast<double>(j * j + 1));
  for (int k = 0; k < 2; ++k) {
    normalize(direction);
    // The equations count as many as the unknowns but have other sizes; any right-hand side will do.
    auto solution = solved(shift, along, direction);
    if (!solution) return std::nullopt;
    direction = std::move(*solution);
  }
  normalize(direction);
  return direction;
}

Vector OrbitBranchSteps::halves(const OrbitPlace& place) {
  use_for(place);
  Vector result(unknowns_ - 2), later(n_);
  for (std::size_t k = 0; k < equations_->nodes(); ++k) {
    const double s = equations_->place(k);
    equations_->state(place.z, s < 0.5 ? s + 0.5 : s - 0.5, later);
    for (std::size_t i = 0; i < n_; ++i) {
      const double turned = system_.advance.empty() ? 0 : (s < 0.5 ? 0.5 : -0.5) * system_.advance[i];
      result[k * n_ + i] = (place.z[k * n_ + i] + turned - later[i]) / scale_[k * n_ + i];
    }
  }
  return result;
}

std::optional<OrbitPlace> OrbitBranchSteps::stepped(const OrbitPlace& from, double step) {
  use(from.mesh);
  set_scales(from.z);
  auto z = arclength_step(from.z, from.tangent, step, scale_,
                          [&](const Vector& guess) { return corrected(guess, from.z, from.shift, from.tangent); });
  return z ? described(std::move(*z), from.tangent) : std::nullopt;
}

void OrbitBranchSteps::complete(OrbitPlace& place) {
  use_for(place);
  auto extremes = equations_->extremes(place.z);
  place.point.low = std::move(extremes.low);
  place.point.high = std::move(extremes.high);
}

Vector OrbitBranchSteps::mean(const OrbitPlace& place) {
  use_for(place);
  Vector result(n_);
  for (std::size_t j = 0; j + 2 < unknowns_; ++j) result[j % n_] += place.z[j] * equations_->weight(j / n_);
  return result;
}
Vector OrbitBranchSteps::deviations(const OrbitPlace& place) {
  const Vector middle = mean(place);
  Vector result(unknowns_ - 2);
  for (std::size_t j = 0; j < result.size(); ++j) result[j] = (place.z[j] - middle[j % n_]) / scale_[j];
  return result;
}

double OrbitBranchSteps::alike(const OrbitPlace& a, const OrbitPlace& b) {
  return product(a.tangent, b.tangent);
}

}  // namespace continuo::studies::detail
