// continuo/studies/orbits/curves/critical_orbit.cpp
// The equations of an orbit with a multiplier on the unit circle, by bordering.
#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/studies/orbits/curves/critical_orbit.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;

constexpr std::size_t interval_degree = OrbitCollocation::degree;
constexpr int border_turns = 2;  // of the inverse iteration that finds borders

}  // namespace

CriticalOrbit::CriticalOrbit(const ParametricSystem& system, std::array<std::size_t, 2> constants,
                             OrbitBifurcation kind, std::shared_ptr<const OrbitMesh> mesh,
                             const std::array<double, 2>& sizes_of_constants)
    : system_(system),
      constants_(constants),
      kind_(kind),
      mesh_(std::move(mesh)),
      n_(system.size),
      states_((mesh_->size() - 1) * interval_degree * n_),
      p_(system.constants),
      sizes_of_constants_(system.constants) {
  for (double& size : sizes_of_constants_) size = size == 0 ? 1 : std::abs(size);
  for (std::size_t k = 0; k < 2; ++k) sizes_of_constants_[constants_[k]] = sizes_of_constants[k];
}

void CriticalOrbit::set(double p, double q) {
  p_[constants_[0]] = p;
  p_[constants_[1]] = q;
}

bool CriticalOrbit::evaluate_points(std::span<const double> z) {
  const auto& table = OrbitCollocation::table();
  const std::size_t intervals = mesh_->size() - 1, m = p_.size();
  points_.resize(intervals * interval_degree);
  set(values_[0], values_[1]);
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t g = 0; g < interval_degree; ++g) {
      GaussPoint& point = points_[k * interval_degree + g];
      point.x.assign(n_, 0.0);
      point.residual.assign(n_, 0.0);
      point.f.resize(n_);
      for (std::size_t j = 0; j <= interval_degree; ++j) {
        const auto values = z.subspan((k * interval_degree + j) * n_ % states_, n_);
        const bool turned = (k * interval_degree + j) * n_ == states_ && !system_.advance.empty();
        for (std::size_t i = 0; i < n_; ++i) {
          const double there = values[i] + (turned ? system_.advance[i] : 0);
          point.x[i] += table.value[g][j] * there;
          point.residual[i] += table.slope[g][j] * there;
        }
      }
      system_.derivative(0, point.x, p_, point.f);
      for (std::size_t i = 0; i < n_; ++i) point.residual[i] -= width(k) * period_ * point.f[i];
      point.a = jacobian_of(system_, 0, point.x, p_, sizes_);
      const Vector by_all = constant_jacobian_of(system_, 0, point.x, p_, sizes_of_constants_);
      point.by_constant.resize(2 * n_);
      for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t c = 0; c < 2; ++c) point.by_constant[i * 2 + c] = by_all[i * m + constants_[c]];
      if (!all_finite(point.f) || !all_finite(point.a) || !all_finite(point.by_constant)) return false;
    }
  return true;
}

bool CriticalOrbit::solve_bordered(const CriticalVectors& borders) {
  const auto& table = OrbitCollocation::table();
  const std::size_t intervals = mesh_->size() - 1, size = bordered_size();
  const Complex turn = std::polar(1.0, angle_);
  std::vector<Eigen::Triplet<Complex>> entries;
  const auto put = [&](std::size_t row, std::size_t column, const Complex& value) {
    if (value != 0.0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t g = 0; g < interval_degree; ++g) {
      const GaussPoint& point = points_[k * interval_degree + g];
      for (std::size_t i = 0; i < n_; ++i) {
        const std::size_t row = (k * interval_degree + g) * n_ + i;
        for (std::size_t j = 0; j <= interval_degree; ++j) {
          const std::size_t node = (k * interval_degree + j) * n_, column = node % states_;
          const Complex factor = node == states_ ? turn : 1.0;
          const double times = width(k) * period_ * table.value[g][j];
          for (std::size_t c = 0; c < n_; ++c)
            put(row, column + c,
                factor * ((i == c ? table.slope[g][j] : 0) - times * point.a[i * n_ + c]) * scale_[column + c] /
                    sizes_[i]);
        }
        if (is_fold()) put(row, states_, -width(k) * point.f[i] * scale_[states_] / sizes_[i]);
      }
    }
  if (is_fold())
    for (std::size_t j = 0; j < states_; ++j) put(states_, j, shift_[j]);
  CriticalVectors next(borders);
  const bool known = next.right.size() + 1 == size;
  if (!known) {  // any will do to begin with
    next.right.resize(size - 1);
    next.left.resize(size - 1);
    for (std::size_t j = 0; j + 1 < size; ++j) {
      const auto number = static_cast<double>(j + 1);
      next.right[j] = std::cos(number * number) / std::sqrt(static_cast<double>(size));
      next.left[j] = std::sin(number * number + 1) / std::sqrt(static_cast<double>(size));
    }
  }
  const std::size_t inner = entries.size();
  for (int iteration = 0; iteration < (known ? 1 : border_turns + 1); ++iteration) {
    entries.resize(inner);
    for (std::size_t j = 0; j + 1 < size; ++j) {
      put(j, size - 1, next.left[j]);
      put(size - 1, j, std::conj(next.right[j]));
    }
    Eigen::SparseMatrix<Complex> matrix(static_cast<int>(size), static_cast<int>(size));
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<Complex>> lu(matrix);
    if (lu.info() != Eigen::Success) return false;
    ComplexVector b = ComplexVector::Zero(static_cast<int>(size));
    b(static_cast<int>(size) - 1) = 1;
    const ComplexVector right = lu.solve(b), left = lu.adjoint().solve(b);
    test_ = right(static_cast<int>(size) - 1);
    right_.assign(right.data(), right.data() + size - 1);
    left_.assign(left.data(), left.data() + size - 1);
    const auto of_length_one = [](std::vector<Complex> v) {
      double square = 0;
      for (const Complex& part : v) square += std::norm(part);
      for (Complex& part : v) part /= std::sqrt(square);
      return v;
    };
    vectors_ = {of_length_one(right_), of_length_one(left_)};
    if (!std::isfinite(std::abs(test_)) || !std::isfinite(std::abs(vectors_.right[0]))) return false;
    next = vectors_;
  }
  return true;
}

// -w* dM v, Gauss point by Gauss point: M v has there -h T A(x) V with V the vector at that point, and of a fold also
// -h f(x) V_T.
void CriticalOrbit::differentiate() {
  const auto& table = OrbitCollocation::table();
  const std::size_t intervals = mesh_->size() - 1;
  gradient_.assign(unknowns(), 0.0);
  const Complex turn = std::polar(1.0, angle_);
  const Complex stretch = is_fold() ? right_[states_] * scale_[states_] : 0.0;
  std::vector<Complex> v(n_), slope(n_), w(n_), by_place(n_);
  Vector moved(n_);
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t g = 0; g < interval_degree; ++g) {
      const GaussPoint& point = points_[k * interval_degree + g];
      const double h = width(k);
      std::ranges::fill(v, 0.0);
      std::ranges::fill(slope, 0.0);
      for (std::size_t j = 0; j <= interval_degree; ++j) {
        const std::size_t node = (k * interval_degree + j) * n_, column = node % states_;
        const Complex factor = node == states_ ? turn : 1.0;
        for (std::size_t i = 0; i < n_; ++i)
          v[i] += factor * table.value[g][j] * right_[column + i] * scale_[column + i];
      }
      for (std::size_t i = 0; i < n_; ++i) w[i] = std::conj(left_[(k * interval_degree + g) * n_ + i]) / sizes_[i];
      // w . A v, for a matrix of this point or of a neighbour.
      const auto seen = [&](const Vector& a) {
        Complex sum = 0;
        for (std::size_t i = 0; i < n_; ++i)
          for (std::size_t c = 0; c < n_; ++c) sum += w[i] * a[i * n_ + c] * v[c];
        return sum;
      };
      set(values_[0], values_[1]);
      moved = point.x;
      for (std::size_t l = 0; l < n_; ++l) {
        const double step = increment_for_jacobians * sizes_[l];
        const auto [above, below] =
            on_both_sides(moved[l], step, [&] { return seen(jacobian_of(system_, 0, moved, p_, sizes_)); });
        by_place[l] = h * period_ * (above - below) / (2 * step);
        for (std::size_t i = 0; i < n_; ++i) by_place[l] += h * stretch * w[i] * point.a[i * n_ + l];
      }
      for (std::size_t j = 0; j <= interval_degree; ++j) {
        const std::size_t column = (k * interval_degree + j) * n_ % states_;
        for (std::size_t l = 0; l < n_; ++l) gradient_[column + l] += table.value[g][j] * by_place[l];
      }
      gradient_[states_] += h * seen(point.a);
      for (std::size_t c = 0; c < 2; ++c) {
        const double step = increment_for_jacobians * 100 * sizes_of_constants_[constants_[c]];
        set(values_[0], values_[1]);
        const auto [above, below] =
            on_both_sides(p_[constants_[c]], step, [&] { return seen(jacobian_of(system_, 0, point.x, p_, sizes_)); });
        Complex sum = h * period_ * (above - below) / (2 * step);
        for (std::size_t i = 0; i < n_; ++i) sum += h * stretch * w[i] * point.by_constant[i * 2 + c];
        gradient_[states_ + 1 + c] += sum;
      }
      if (k + 1 == intervals) {  // what the last node has of the first
        const Complex turned = Complex(0, 1) * turn;
        for (std::size_t i = 0; i < n_; ++i) {
          Complex row = table.slope[g][interval_degree] * right_[i] * scale_[i];
          for (std::size_t c = 0; c < n_; ++c)
            row -= h * period_ * table.value[g][interval_degree] * point.a[i * n_ + c] * right_[c] * scale_[c];
          gradient_[states_ + 3] -= w[i] * turned * row;
        }
      }
    }
  for (std::size_t j = 0; j < unknowns(); ++j) gradient_[j] *= scale_[j];
}

bool CriticalOrbit::evaluate(std::span<const double> z, std::span<const double> sizes, std::span<const double> scale,
                             std::span<const double> shift, const CriticalVectors& borders) {
  period_ = z[states_];
  values_ = {z[states_ + 1], z[states_ + 2]};
  angle_ = z[states_ + 3];
  sizes_.assign(sizes.begin(), sizes.end());
  scale_.assign(scale.begin(), scale.end());
  shift_.assign(shift.begin(), shift.end());
  if (!(period_ > 0) || !std::isfinite(period_)) return false;
  if (!evaluate_points(z)) return false;
  if (!solve_bordered(borders)) return false;
  differentiate();
  return all_finite(gradient_);
}

std::array<double, 2> CriticalOrbit::normal() const {
  std::array<double, 2> sum{};
  for (std::size_t at = 0; at < points_.size(); ++at)
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t c = 0; c < 2; ++c)
        sum[c] -= vectors_.left[at * n_ + i].real() * width(at / interval_degree) * period_ *
                  points_[at].by_constant[i * 2 + c] * scale_[states_ + 1 + c] / sizes_[i];
  const double size = std::hypot(sum[0], sum[1]);
  return {sum[0] / size, sum[1] / size};
}

Vector CriticalOrbit::residuals(std::span<const double> z, std::span<const double> reference,
                                std::span<const double> shift) const {
  Vector b;
  for (const GaussPoint& point : points_)
    for (std::size_t i = 0; i < n_; ++i) b.push_back(point.residual[i] / sizes_[i]);
  double along = 0;
  for (std::size_t j = 0; j < states_; ++j) along += shift[j] * (z[j] - reference[j]) / scale_[j];
  b.push_back(along);
  b.push_back(test_.real());
  b.push_back(kind_ == OrbitBifurcation::torus ? test_.imag() : 0);
  b.push_back(0);
  return b;
}

bool CriticalOrbit::solve(std::span<const double> last, Vector& b) const {
  const auto& table = OrbitCollocation::table();
  const std::size_t intervals = mesh_->size() - 1, size = unknowns();
  std::vector<Eigen::Triplet<double>> entries;
  const auto put = [&](std::size_t row, std::size_t column, double value) {
    if (value != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t g = 0; g < interval_degree; ++g) {
      const GaussPoint& point = points_[k * interval_degree + g];
      for (std::size_t i = 0; i < n_; ++i) {
        const std::size_t row = (k * interval_degree + g) * n_ + i;
        for (std::size_t j = 0; j <= interval_degree; ++j) {
          const std::size_t column = (k * interval_degree + j) * n_ % states_;
          const double times = width(k) * period_ * table.value[g][j];
          for (std::size_t c = 0; c < n_; ++c)
            put(row, column + c,
                ((i == c ? table.slope[g][j] : 0) - times * point.a[i * n_ + c]) * scale_[column + c] / sizes_[i]);
        }
        put(row, states_, -width(k) * point.f[i] * scale_[states_] / sizes_[i]);
        for (std::size_t c = 0; c < 2; ++c)
          put(row, states_ + 1 + c,
              -width(k) * period_ * point.by_constant[i * 2 + c] * scale_[states_ + 1 + c] / sizes_[i]);
      }
    }
  const bool torus = kind_ == OrbitBifurcation::torus;
  for (std::size_t j = 0; j < size; ++j) {
    if (j < states_) put(states_, j, shift_[j]);
    // The angle of a fold and of a doubling stays.
    if (j + 1 < size || torus) put(states_ + 1, j, gradient_[j].real());
    if (torus) put(states_ + 2, j, gradient_[j].imag());
    put(states_ + 3, j, last[j]);
  }
  if (!torus) put(states_ + 2, size - 1, 1);
  Eigen::SparseMatrix<double> matrix(static_cast<int>(size), static_cast<int>(size));
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
  if (lu.info() != Eigen::Success) return false;
  const Eigen::VectorXd y = lu.solve(Eigen::Map<Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(size)));
  std::copy_n(y.data(), size, b.begin());
  return all_finite(b);
}

}  // namespace continuo::studies::detail
