// The equations of a homoclinic orbit, with projections at both ends.
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/studies/orbits/curves/homoclinic_orbit.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Index = Eigen::Index;

constexpr std::size_t points_of_interval = OrbitCollocation::degree;

Index index(std::size_t k) {
  return static_cast<Index>(k);
}

}  // namespace

HomoclinicOrbit::HomoclinicOrbit(const ParametricSystem& system, std::array<std::size_t, 2> constants,
                                 HomoclinicRest kind, std::shared_ptr<const OrbitMesh> mesh, double length,
                                 const std::array<double, 2>& sizes_of_constants)
    : system_(system),
      constants_(constants),
      kind_(kind),
      n_(system.size),
      mesh_(std::move(mesh)),
      length_(length),
      sizes_of_constants_(system.constants) {
  for (double& size : sizes_of_constants_) size = size == 0 ? 1 : std::abs(size);
  for (std::size_t k = 0; k < 2; ++k) sizes_of_constants_[constants_[k]] = sizes_of_constants[k];
}

Vector HomoclinicOrbit::constants_at(std::span<const double> values) const {
  Vector p(system_.constants);
  for (std::size_t k = 0; k < 2; ++k) p[constants_[k]] = values[k];
  return p;
}

Eigen::MatrixXd HomoclinicOrbit::matrix_at(std::span<const double> x0, std::span<const double> constants) const {
  const Vector a = jacobian_of(system_, 0, x0, constants_at(constants), sizes_);
  Eigen::MatrixXd matrix(index(n_), index(n_));
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j) matrix(index(i), index(j)) = a[i * n_ + j] * sizes_[j] / sizes_[i];
  return matrix;
}

std::optional<SaddleSpaces> HomoclinicOrbit::spaces_at(const Eigen::MatrixXd& a) const {
  return kind_.is_saddle_node ? saddle_node_spaces(a, kind_.stable) : saddle_spaces(a, kind_.stable);
}

void HomoclinicOrbit::measure_in(const Vector& sizes, const Vector& scale) {
  sizes_ = sizes;
  scale_ = scale;
}

bool HomoclinicOrbit::refer_to(std::span<const double> z) {
  const Eigen::MatrixXd a = matrix_at(z.subspan(rest(), n_), z.last(2));
  const auto spaces = spaces_at(a);
  if (!spaces) return false;
  rate_of_reference_ = a.norm();
  like_stable_ = real_basis(spaces->stable.left);
  like_unstable_ = real_basis(spaces->unstable.left);
  return true;
}

Eigen::VectorXd HomoclinicOrbit::from_rest(std::span<const double> z, bool at_end) const {
  Eigen::VectorXd y(index(n_));
  const std::size_t node = at_end ? rest() - n_ : 0;
  for (std::size_t i = 0; i < n_; ++i)
    y(index(i)) = (z[node + i] - z[rest() + i] - (at_end ? advance(i) : 0)) / sizes_[i];
  return y;
}

std::optional<Eigen::VectorXd> HomoclinicOrbit::ends_at(std::span<const double> z, const Vector& other) const {
  Vector moved(z.begin(), z.end());
  std::ranges::copy(other, moved.begin() + static_cast<std::ptrdiff_t>(rest()));
  const std::span<const double> there(other);
  const auto spaces = spaces_at(matrix_at(there.first(n_), there.last(2)));
  if (!spaces) return std::nullopt;
  const auto of_stable = basis_like(spaces->stable.left, like_stable_),
             of_unstable = basis_like(spaces->unstable.left, like_unstable_);
  if (!of_stable || !of_unstable) return std::nullopt;
  Eigen::VectorXd ends(index(n_));
  ends.head(index(kind_.stable)) = of_stable->transpose() * from_rest(moved, false);
  ends.segment(index(kind_.stable), index(unstable())) = of_unstable->transpose() * from_rest(moved, true);
  if (kind_.is_saddle_node) ends(index(n_ - 1)) = spaces->centre->eigenvalue / rate_of_reference_;
  return ends;
}

bool HomoclinicOrbit::evaluate_points(std::span<const double> z) {
  const auto& table = OrbitCollocation::table();
  const std::size_t intervals = mesh_->size() - 1, m = system_.parameters();
  const Vector p = constants_at(z.last(2));
  Vector x(n_);
  points_.resize(intervals * points_of_interval);
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t g = 0; g < points_of_interval; ++g) {
      GaussPoint& point = points_[k * points_of_interval + g];
      std::ranges::fill(x, 0.0);
      point.residual.assign(n_, 0.0);
      point.f.resize(n_);
      for (std::size_t j = 0; j <= points_of_interval; ++j) {
        const auto values = z.subspan((k * points_of_interval + j) * n_, n_);
        for (std::size_t i = 0; i < n_; ++i) {
          x[i] += table.value[g][j] * values[i];
          point.residual[i] += table.slope[g][j] * values[i];
        }
      }
      system_.derivative(0, x, p, point.f);
      for (std::size_t i = 0; i < n_; ++i) point.residual[i] -= width(k) * length_ * point.f[i];
      point.a = jacobian_of(system_, 0, x, p, sizes_);
      const Vector by_all = constant_jacobian_of(system_, 0, x, p, sizes_of_constants_);
      point.by_constant.resize(2 * n_);
      for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t c = 0; c < 2; ++c) point.by_constant[i * 2 + c] = by_all[i * m + constants_[c]];
      if (!all_finite(point.f) || !all_finite(point.a) || !all_finite(point.by_constant)) return false;
      for (std::size_t i = 0; i < n_; ++i) residuals_.push_back(point.residual[i] / sizes_[i]);
    }
  return true;
}

// How the spaces turn with x0 and the constants is small beside the rest, being times the distance of an end from x0:
// central differences know it well enough.
bool HomoclinicOrbit::evaluate_ends(std::span<const double> z) {
  Vector moved(z.begin() + static_cast<std::ptrdiff_t>(rest()), z.end());
  const auto spaces = spaces_at(matrix_at(z.subspan(rest(), n_), z.last(2)));
  if (!spaces) return false;
  const auto of_stable = basis_like(spaces->stable.left, like_stable_),
             of_unstable = basis_like(spaces->unstable.left, like_unstable_);
  if (!of_stable || !of_unstable) return false;
  spaces_ = *spaces;
  left_stable_ = *of_stable;
  left_unstable_ = *of_unstable;
  const Eigen::VectorXd first = left_stable_.transpose() * from_rest(z, false),
                        last = left_unstable_.transpose() * from_rest(z, true);
  residuals_.insert(residuals_.end(), first.begin(), first.end());
  residuals_.insert(residuals_.end(), last.begin(), last.end());
  if (kind_.is_saddle_node) residuals_.push_back(spaces_.centre->eigenvalue / rate_of_reference_);
  ends_by_.resize(index(n_), index(n_ + 2));
  for (std::size_t j = 0; j < n_ + 2; ++j) {
    const double size = j < n_ ? sizes_[j] : sizes_of_constants_[constants_[j - n_]];
    const double step = central_increment(0.0, size);
    const auto [above, below] = on_both_sides(moved[j], step, [&] { return ends_at(z, moved); });
    if (!above || !below) return false;
    ends_by_.col(index(j)) = (*above - *below) / (2 * step);
  }
  return ends_by_.allFinite();
}

bool HomoclinicOrbit::evaluate_rest(std::span<const double> z) {
  const auto x0 = z.subspan(rest(), n_);
  const Vector p = constants_at(z.last(2));
  Vector f(n_);
  system_.derivative(0, x0, p, f);
  rest_matrix_ = jacobian_of(system_, 0, x0, p, sizes_);
  const Vector by_all = constant_jacobian_of(system_, 0, x0, p, sizes_of_constants_);
  rest_by_constant_.resize(2 * n_);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t c = 0; c < 2; ++c) rest_by_constant_[i * 2 + c] = by_all[i * system_.parameters() + constants_[c]];
  rate_ = matrix_at(x0, z.last(2)).norm();
  if (!all_finite(f) || !all_finite(rest_matrix_) || !all_finite(rest_by_constant_) || !(rate_ > 0)) return false;
  for (std::size_t i = 0; i < n_; ++i) residuals_.push_back(f[i] / (sizes_[i] * rate_));
  return true;
}

bool HomoclinicOrbit::evaluate(std::span<const double> z) {
  residuals_.clear();
  if (!evaluate_points(z) || !evaluate_ends(z) || !evaluate_rest(z)) return false;
  residuals_.resize(unknowns());
  return all_finite(residuals_);
}

bool HomoclinicOrbit::decompose(std::span<const double> shift, std::span<const double> last) {
  const auto& table = OrbitCollocation::table();
  const std::size_t intervals = mesh_->size() - 1, size = unknowns(), at_rest = rest();
  std::vector<Eigen::Triplet<double>> entries;
  const auto put = [&](std::size_t row, std::size_t column, double value) {
    if (value != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value * scale_[column]);
  };
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t g = 0; g < points_of_interval; ++g) {
      const GaussPoint& point = points_[k * points_of_interval + g];
      for (std::size_t i = 0; i < n_; ++i) {
        const std::size_t row = (k * points_of_interval + g) * n_ + i;
        for (std::size_t j = 0; j <= points_of_interval; ++j)
          for (std::size_t c = 0; c < n_; ++c)
            put(row, (k * points_of_interval + j) * n_ + c,
                ((i == c ? table.slope[g][j] : 0) - width(k) * length_ * table.value[g][j] * point.a[i * n_ + c]) /
                    sizes_[i]);
        for (std::size_t c = 0; c < 2; ++c)
          put(row, at_rest + n_ + c, -width(k) * length_ * point.by_constant[i * 2 + c] / sizes_[i]);
      }
    }
  const std::size_t ends = intervals * points_of_interval * n_;
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t c = 0; c < n_; ++c) {
      if (i < kind_.stable) put(ends + i, c, left_stable_(index(c), index(i)) / sizes_[c]);
      if (i < unstable())
        put(ends + kind_.stable + i, at_rest - n_ + c, left_unstable_(index(c), index(i)) / sizes_[c]);
      put(ends + n_ + i, at_rest + c, rest_matrix_[i * n_ + c] / (sizes_[i] * rate_));
    }
    for (std::size_t c = 0; c < n_ + 2; ++c) put(ends + i, at_rest + c, ends_by_(index(i), index(c)));
    for (std::size_t c = 0; c < 2; ++c)
      put(ends + n_ + i, at_rest + n_ + c, rest_by_constant_[i * 2 + c] / (sizes_[i] * rate_));
  }
  for (std::size_t j = 0; j < size; ++j) {
    put(size - 2, j, shift[j] / scale_[j]);
    put(size - 1, j, last[j] / scale_[j]);
  }
  Eigen::SparseMatrix<double> matrix(static_cast<int>(size), static_cast<int>(size));
  matrix.setFromTriplets(entries.begin(), entries.end());
  lu_ = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>(matrix);
  return lu_->info() == Eigen::Success;
}

Vector HomoclinicOrbit::solve(const Vector& b) const {
  const Eigen::VectorXd y = lu_->solve(Eigen::Map<const Eigen::VectorXd>(b.data(), index(b.size())));
  return {y.begin(), y.end()};
}

Vector HomoclinicOrbit::solve_transposed(const Vector& b) const {
  const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(b.data(), index(b.size()));
  const Eigen::VectorXd y = lu_->transpose().solve(right);
  return {y.begin(), y.end()};
}

Eigen::VectorXd HomoclinicOrbit::adjoint_at(const Vector& solution, bool at_end) const {
  const Eigen::MatrixXd& left = at_end ? left_unstable_ : left_stable_;
  const double* multipliers = solution.data() + (rest() - n_) + (at_end ? kind_.stable : 0);
  return left * Eigen::Map<const Eigen::VectorXd>(multipliers, left.cols());
}

// On the manifold itself the other part w of y obeys w' = B w + r(y), r being what f has beyond its linear part, so
// that w = -int exp(-B s) r ds: about r over the rates, of B and twice that at which y itself dies away, which is 0
// along a centre.
Eigen::VectorXd HomoclinicOrbit::missed_at(std::span<const double> z, bool at_end) const {
  const Eigen::MatrixXd& left = at_end ? left_unstable_ : left_stable_;
  const Eigenspace &own = at_end ? spaces_.stable : spaces_.unstable,
                   &other = at_end ? spaces_.unstable : spaces_.stable;
  if (other.eigenvalues.empty()) return {};
  const Eigen::VectorXd y = from_rest(z, at_end);
  Vector f(n_);
  system_.derivative(0, z.subspan(at_end ? rest() - n_ : 0, n_), constants_at(z.last(2)), f);
  Eigen::VectorXd beyond = -matrix_at(z.subspan(rest(), n_), z.last(2)) * y;
  for (std::size_t i = 0; i < n_; ++i) beyond(index(i)) += f[i] / sizes_[i];
  const double own_rate = kind_.is_saddle_node ? 0 : std::abs(own.eigenvalues.front().real());
  return left.transpose() * beyond / (std::abs(other.eigenvalues.front().real()) + 2 * own_rate);
}

Vector HomoclinicOrbit::missed(std::span<const double> z) const {
  Vector result(unknowns());
  const std::size_t ends = rest() - n_;
  const Eigen::VectorXd first = missed_at(z, false), last = missed_at(z, true);
  std::ranges::copy(first, result.begin() + static_cast<std::ptrdiff_t>(ends));
  std::ranges::copy(last, result.begin() + static_cast<std::ptrdiff_t>(ends + kind_.stable));
  return result;
}

double HomoclinicOrbit::unfolding() const {
  std::array<double, 2> speed{};
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t i = 0; i < n_; ++i)
      speed[c] += spaces_.centre->left(index(i)) * rest_by_constant_[i * 2 + c] * scale_[rest() + n_ + c] / sizes_[i];
  return std::hypot(speed[0], speed[1]) / rate_;
}

// By a second difference of f along the centre: (f(x0 + e v) + f(x0 - e v) - 2 f(x0)) / 2 e^2, seen by the left
// eigenvector. Its error is of order e^2 and of rounding / e^2, alike at the fourth root of epsilon.
double HomoclinicOrbit::centre_curvature(std::span<const double> z) const {
  const double step = std::pow(std::numeric_limits<double>::epsilon(), 0.25);
  const Centre& centre = *spaces_.centre;
  const Vector p = constants_at(z.last(2));
  Eigen::VectorXd second = Eigen::VectorXd::Zero(index(n_));
  Vector x(n_), f(n_);
  for (const double side : {-1.0, 0.0, 1.0}) {
    for (std::size_t i = 0; i < n_; ++i) x[i] = z[rest() + i] + side * step * centre.right(index(i)) * sizes_[i];
    system_.derivative(0, x, p, f);
    for (std::size_t i = 0; i < n_; ++i) second(index(i)) += (side == 0 ? -2 : 1) * f[i] / sizes_[i];
  }
  return centre.left.dot(second) / (2 * step * step);
}

}  // namespace continuo::studies::detail
