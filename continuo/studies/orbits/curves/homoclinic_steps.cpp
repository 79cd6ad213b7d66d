// Predictor and corrector on a curve of homoclinic orbits.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/orbits/collocation/closed_view.hpp>
#include <continuo/studies/orbits/curves/homoclinic_steps.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

constexpr NewtonLimits limits_of_homoclinic{
    .most_iterations = 10, .solved_to = 1e-9, .rounding = 1e-6, .farthest = 10, .each_is_smaller = true};  // in sizes
constexpr double unfolds = 1e-6;       // of the rates, over the ranges of the constants
constexpr double error_of_rtol = 100;  // as in orbit_branch

}  // namespace

HomoclinicSteps::HomoclinicSteps(const ParametricSystem& system, const OrbitCurveOptions& options)
    : system_(system), options_(options), n_(system.size), error_wanted_(error_of_rtol * options.rtol) {}

void HomoclinicSteps::use(const std::shared_ptr<const OrbitMesh>& mesh, double length) {
  if (mesh == mesh_ && length == length_) return;
  mesh_ = mesh;
  length_ = length;
  equations_.emplace(
      system_, options_.constants, kind_, mesh, length,
      std::array{(options_.high[0] - options_.low[0]) / 100, (options_.high[1] - options_.low[1]) / 100});
}

double HomoclinicSteps::weight(std::size_t node) const {
  const auto& weights = OrbitCollocation::table().weights;
  const std::size_t degree = OrbitCollocation::degree, k = node / degree, j = node % degree;
  const auto width = [&](std::size_t interval) { return (*mesh_)[interval + 1] - (*mesh_)[interval]; };
  double sum = k + 1 < mesh_->size() ? weights[j] * width(k) : 0;
  if (j == 0 && k > 0) sum += weights[degree] * width(k - 1);
  return sum;
}

/// A component counts in its greatest distance from the saddle.
void HomoclinicSteps::measure(const Vector& z) {
  const std::size_t rest = equations_->rest();
  sizes_.assign(n_, 0.0);
  double greatest = 0;
  for (std::size_t j = 0; j < rest; ++j) {
    const double apart = std::abs(z[j] - z[rest + j % n_]);
    sizes_[j % n_] = std::max(sizes_[j % n_], apart);
    greatest = std::max(greatest, apart);
  }
  for (double& size : sizes_) size = size > 1e-12 * greatest ? size : greatest > 0 ? greatest : 1;
  scale_.resize(z.size());
  for (std::size_t j = 0; j < rest; ++j) scale_[j] = sizes_[j % n_] / std::sqrt(weight(j / n_));
  for (std::size_t i = 0; i < n_; ++i) scale_[rest + i] = sizes_[i];
  for (std::size_t c = 0; c < 2; ++c) scale_[rest + n_ + c] = options_.high[c] - options_.low[c];
  equations_->measure_in(sizes_, scale_);
}

HomoclinicSteps::Vector HomoclinicSteps::shift_at(const Vector& z) const {
  Vector p(system_.constants), shift(z.size());
  for (std::size_t c = 0; c < 2; ++c) p[options_.constants[c]] = z[z.size() - 2 + c];
  for (std::size_t k = 0; k < equations_->nodes(); ++k)
    system_.derivative(0, Values(z).subspan(k * n_, n_), p, std::span(shift).subspan(k * n_, n_));
  for (std::size_t j = 0; j < shift.size(); ++j) shift[j] /= scale_[j];
  normalize(shift);
  return shift;
}

std::optional<HomoclinicPlace> HomoclinicSteps::corrected(const Vector& guess, const Vector& reference,
                                                          const Vector& last, const HomoclinicPlace* before) {
  if (!equations_->refer_to(reference)) return std::nullopt;
  Vector z(guess);
  const Vector shift = shift_at(reference);
  const auto correct = [&]() -> NewtonCorrection {
    if (options_.interrupt && options_.interrupt->load()) return NewtonEnding::interrupted;
    if (!equations_->evaluate(z) || !equations_->decompose(shift, last)) return NewtonEnding::singular;
    Vector b = equations_->residuals();
    for (std::size_t j = 0; j < z.size(); ++j) {
      b[z.size() - 2] += shift[j] * (z[j] - reference[j]) / scale_[j];
      b[z.size() - 1] += last[j] * (z[j] - guess[j]) / scale_[j];
    }
    b = equations_->solve(b);
    for (std::size_t j = 0; j < z.size(); ++j) z[j] -= b[j] * scale_[j];
    return length(b);
  };
  if (!newton_iteration(limits_of_homoclinic, correct)) return std::nullopt;
  return described(std::move(z), last, before);
}

std::optional<HomoclinicSteps::Vector> HomoclinicSteps::tangent_of(const Vector& along) {
  Vector b(along.size());
  b.back() = 1;
  b = equations_->solve(b);
  if (!std::isfinite(length(b))) return std::nullopt;
  return b;
}

// Upright to the curve in the plane of the constants, the solution of the transposed equations has no part in those of
// the shift and of the step: w^T J t = 0 for t the tangent, and for t the motion along the orbit. What is left is the
// adjoint solution, normalised by Melnikov's integral of this direction.
HomoclinicSteps::Vector HomoclinicSteps::adjoint_of(const HomoclinicPlace& place) const {
  const std::size_t constants = place.z.size() - 2;
  Vector upright(place.z.size());
  upright[constants] = -place.tangent[constants + 1];
  upright[constants + 1] = place.tangent[constants];
  normalize(upright);
  return equations_->solve_transposed(upright);
}

std::optional<HomoclinicPlace> HomoclinicSteps::described(Vector z, const Vector& along,
                                                          const HomoclinicPlace* before) {
  HomoclinicPlace place{.mesh = mesh_, .length = length_, .z = std::move(z), .rest = kind_};
  if (!equations_->evaluate(place.z) || !equations_->decompose(shift_at(place.z), along)) return std::nullopt;
  auto tangent = tangent_of(along);
  if (!tangent) return std::nullopt;
  normalize(*tangent);
  place.tangent = std::move(*tangent);
  const std::size_t rest = equations_->rest();
  place.spaces = equations_->spaces();
  if (before && before->spaces.centre && place.spaces.centre &&
      before->spaces.centre->right.dot(place.spaces.centre->right) < 0) {
    place.spaces.centre->right *= -1;
    place.spaces.centre->left *= -1;
  }
  OrbitCurvePoint& point = place.point;
  point.constants = {place.z[rest + n_], place.z[rest + n_ + 1]};
  point.period = length_;
  point.x.assign(place.z.begin() + static_cast<std::ptrdiff_t>(rest),
                 place.z.begin() + static_cast<std::ptrdiff_t>(rest + n_));
  point.eigenvalues = place.spaces.unstable.eigenvalues;
  std::ranges::reverse(point.eigenvalues);
  if (place.spaces.centre) point.eigenvalues.emplace_back(place.spaces.centre->eigenvalue);
  const auto& stable = place.spaces.stable.eigenvalues;
  point.eigenvalues.insert(point.eigenvalues.end(), stable.begin(), stable.end());
  place.apart_first = equations_->from_rest(place.z, false).cwiseAbs().maxCoeff();
  place.apart_last = equations_->from_rest(place.z, true).cwiseAbs().maxCoeff();
  const ClosedView closed(n_, Values(place.z).first(rest), mesh_);
  auto extremes = closed.orbit().extremes(closed.unknowns());
  point.low = std::move(extremes.low);
  point.high = std::move(extremes.high);
  place.error = std::ranges::max(closed.errors(sizes_));
  place.tests.fill(std::nan(""));
  place.flips.fill(std::nan(""));
  if (kind_.is_saddle_node) {
    set_centre_tests(place);
    return place;
  }
  const Vector adjoint = adjoint_of(place);
  const Vector missed = equations_->missed(place.z);
  for (std::size_t k = 0; k < missed.size(); ++k) point.truncation += std::abs(adjoint[k] * missed[k]);
  if (!std::isfinite(point.truncation)) return std::nullopt;
  set_eigenvalue_tests(place);
  set_flip_tests(place, adjoint, before);
  return place;
}

void HomoclinicSteps::take_up(const HomoclinicPlace& place, double longest) {
  kind_ = place.rest;
  longest_ = longest;
}

std::optional<HomoclinicPlace> HomoclinicSteps::near(const HomoclinicPlace& from, const Vector& guess,
                                                     const Vector& last) {
  use(from.mesh, from.length);
  measure(from.z);
  return corrected(guess, guess, last, &from);
}

HomoclinicSteps::Vector HomoclinicSteps::in_sizes(const HomoclinicPlace& at, Vector difference) {
  use(at.mesh, at.length);
  measure(at.z);
  for (std::size_t j = 0; j < difference.size(); ++j) difference[j] /= scale_[j];
  return difference;
}

std::optional<HomoclinicPlace> HomoclinicSteps::stepped(const HomoclinicPlace& from, double step) {
  use(from.mesh, from.length);
  measure(from.z);
  return arclength_step(from.z, from.tangent, step, scale_,
                        [&](const Vector& guess) { return corrected(guess, from.z, from.tangent, &from); });
}

std::optional<HomoclinicPlace> HomoclinicSteps::switched(const HomoclinicPlace& from, HomoclinicRest kind) {
  kind_ = kind;
  equations_.reset();
  mesh_.reset();
  longest_ = kind.is_saddle_node ? std::numeric_limits<double>::infinity() : options_.longest_period * from.length;
  return settled(from.mesh, from.length, from.z);
}

std::optional<HomoclinicPlace> HomoclinicSteps::settled(const std::shared_ptr<const OrbitMesh>& mesh, double length,
                                                        const Vector& z) {
  use(mesh, length);
  measure(z);
  // On the curve of saddles a constant moves first, on that of saddle-nodes an end along the centre.
  std::vector<Vector> rows(2, Vector(z.size()));
  rows[0].back() = rows[1][z.size() - 2] = 1;
  if (kind_.is_saddle_node) {
    if (!equations_->refer_to(z) || !equations_->evaluate(z)) return std::nullopt;
    rows.insert(rows.begin(), {centre_part(false), centre_part(true)});
  }
  for (const Vector& row : rows) {
    auto place = corrected(z, z, row, nullptr);
    if (!place) continue;
    if (kind_.is_saddle_node && equations_->unfolding() < unfolds) return std::nullopt;
    return place;
  }
  return std::nullopt;
}

std::optional<HomoclinicPlace> HomoclinicSteps::at_bound(const HomoclinicPlace& a, const HomoclinicPlace& b,
                                                         std::size_t constant, double value) {
  use(a.mesh, a.length);
  measure(a.z);
  const std::size_t unknown = a.z.size() - 2 + constant;
  const double part = (value - a.z[unknown]) / (b.z[unknown] - a.z[unknown]);
  Vector guess = between(a.z, b.z, part), last(a.z.size());
  guess[unknown] = value;
  last[unknown] = 1;
  return corrected(guess, a.z, last, &a);
}

}  // namespace continuo::studies::detail
