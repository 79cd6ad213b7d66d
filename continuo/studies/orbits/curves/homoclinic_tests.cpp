// Test functions whose zeros mark degenerate homoclinic orbits.
#include <algorithm>
#include <cmath>
#include <complex>

#include <continuo/studies/orbits/curves/homoclinic_steps.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Complex = std::complex<double>;

constexpr double turns_clearly = 0.5;  // the cosine between leading eigenvectors of neighbours
constexpr double clear_of_rounding = 1e-10;
constexpr double near_along_centre = 1e-5;  // a part of the size of the orbit

bool is_pair(const Complex& a, const Complex& b) {
  return a.imag() != 0 && b.imag() != 0 && a.imag() * b.imag() < 0;
}

/// The square of the difference of the leading two: negative of a pair, and smooth where two real ones become one.
double double_test(const std::vector<Complex>& values) {
  if (values.size() < 2) return std::nan("");
  const Complex &a = values[0], &b = values[1];
  if (!is_pair(a, b) && (a.imag() != 0 || b.imag() != 0)) return std::nan("");
  return ((a - b) * (a - b)).real() / std::pow(std::abs(a) + std::abs(b), 2);
}
/// By how much a real one lies to the right of a pair, where these are the leading three.
double triple_test(const std::vector<Complex>& values) {
  if (values.size() < 3) return std::nan("");
  const double size = std::abs(values[0]) + std::abs(values[2]);
  if (is_pair(values[0], values[1]) && values[2].imag() == 0) return (values[2] - values[0]).real() / size;
  if (is_pair(values[1], values[2]) && values[0].imag() == 0) return (values[0] - values[1]).real() / size;
  return std::nan("");
}
double divergent_test(const std::vector<Complex>& values, const Complex& other) {
  if (values.size() < 2) return std::nan("");
  return (values[0] + values[1] + other).real() / (std::abs(values[0]) + std::abs(values[1]) + std::abs(other));
}

}  // namespace

void HomoclinicSteps::set_eigenvalue_tests(HomoclinicPlace& place) const {
  using enum HomoclinicTest;
  const auto set = [&](HomoclinicTest kind, double value) { place.tests[static_cast<std::size_t>(kind)] = value; };
  const auto &s = place.spaces.stable.eigenvalues, &u = place.spaces.unstable.eigenvalues;
  double greatest = 0;
  for (const Complex& value : place.point.eigenvalues) greatest = std::max(greatest, std::abs(value));
  set(neutral, (s[0] + u[0]).real() / (std::abs(s[0]) + std::abs(u[0])));
  set(divergent_stable, divergent_test(s, u[0]));
  set(divergent_unstable, divergent_test(u, s[0]));
  set(double_stable, double_test(s));
  set(double_unstable, double_test(u));
  set(triple_stable, triple_test(s));
  set(triple_unstable, triple_test(u));
  set(rest_stable, s[0].real() / greatest);
  set(rest_unstable, u[0].real() / greatest);
}

// Where the orbit comes to the saddle it does so along the leading eigenvector v of the stable side, unless its part of
// it, seen by the left eigenvector, vanishes: an orbit flip. Far back the adjoint solution grows along that left
// eigenvector, unless its part, seen by v, vanishes: an inclination flip, where the stable manifold comes back turned
// the other way. Likewise on the unstable side with time reversed.
void HomoclinicSteps::set_flip_tests(HomoclinicPlace& place, const Vector& adjoint,
                                     const HomoclinicPlace* before) const {
  using enum HomoclinicTest;
  // The multipliers of the saddle's own equations, which come last, grow without bound as it becomes a saddle-node.
  double greatest = 0;
  for (std::size_t j = 0; j + n_ + 2 < adjoint.size(); ++j) greatest = std::max(greatest, std::abs(adjoint[j]));
  const auto set = [&](HomoclinicTest kind, std::size_t which, const Eigenspace& space, bool of_left,
                       const Eigen::VectorXd& seen, double least) {
    if (space.dimension() < 2 || !space.leading_is_real()) return;
    Eigen::VectorXd& vector = place.leading[which];
    vector = real_vector((of_left ? space.left : space.right).col(0));
    bool is_clear = true;
    if (before && before->leading[which].size() == vector.size()) {
      const double cosine = vector.dot(before->leading[which]);
      if (cosine < 0) vector = -vector;
      is_clear = std::abs(cosine) > turns_clearly;
    }
    if (!is_clear) return;
    const double part = vector.dot(seen);
    if (seen.norm() > least) place.tests[static_cast<std::size_t>(kind)] = part / seen.norm();
    place.flips[which] = of_left ? part : part / greatest;
  };
  const SaddleSpaces& spaces = place.spaces;
  set(orbit_flip_stable, 0, spaces.stable, true, equations_->from_rest(place.z, true), 0);
  set(orbit_flip_unstable, 1, spaces.unstable, true, equations_->from_rest(place.z, false), 0);
  set(inclination_flip_stable, 2, spaces.stable, false, equations_->adjoint_at(adjoint, false),
      clear_of_rounding * greatest);
  set(inclination_flip_unstable, 3, spaces.unstable, false, equations_->adjoint_at(adjoint, true),
      clear_of_rounding * greatest);
}

HomoclinicSteps::Vector HomoclinicSteps::centre_part(bool at_end) const {
  const std::size_t rest = equations_->rest(), node = at_end ? rest - n_ : 0;
  const Eigen::VectorXd& left = equations_->spaces().centre->left;
  Vector row(equations_->unknowns());
  for (std::size_t i = 0; i < n_; ++i) {
    const double part = left(static_cast<Eigen::Index>(i)) / sizes_[i];
    row[node + i] = part * scale_[node + i];
    row[rest + i] = -part * scale_[rest + i];
  }
  normalize(row);
  return row;
}

// Along the centre y' = c y^2: an orbit leaves to the side on which y has the sign of c, and comes from the other one.
// Where a part is zero the orbit leaves, or comes, in a strong direction instead. As a test it is given the size of 1.
// What the ends miss moves the orbit, and by its centre's parts the place on the curve where these are zero.
void HomoclinicSteps::set_centre_tests(HomoclinicPlace& place) const {
  using enum HomoclinicTest;
  const auto set = [&](HomoclinicTest kind, double value) { place.tests[static_cast<std::size_t>(kind)] = value; };
  const Centre& centre = *place.spaces.centre;
  const double turned = equations_->spaces().centre->right.dot(centre.right) < 0 ? -1 : 1;
  place.curvature = turned * equations_->centre_curvature(place.z);
  const double rate =
      equations_->matrix_at(Values(place.z).subspan(equations_->rest(), n_), Values(place.z).last(2)).norm();
  set(curvature, place.curvature / rate);
  if (!place.spaces.stable.eigenvalues.empty()) set(rest_stable, place.spaces.stable.eigenvalues[0].real() / rate);
  if (!place.spaces.unstable.eigenvalues.empty())
    set(rest_unstable, place.spaces.unstable.eigenvalues[0].real() / rate);
  const Vector moved = equations_->solve(equations_->missed(place.z));
  place.point.truncation = length(moved);
  const double speed = std::hypot(place.tangent[moved.size() - 2], place.tangent.back());
  for (const bool at_end : {false, true}) {
    const double part =
        centre.left.dot(equations_->from_rest(place.z, at_end)) * (at_end == (place.curvature > 0) ? -1 : 1);
    set(at_end ? comes_by_centre : leaves_centre, part / (std::abs(part) + near_along_centre));
    const Vector row = centre_part(at_end);
    place.truncation_of_ends[at_end ? 1 : 0] = speed * std::abs(product(row, moved) / product(row, place.tangent));
  }
}

}  // namespace continuo::studies::detail
