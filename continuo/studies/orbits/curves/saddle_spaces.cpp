// Eigenspaces of a saddle by ordered Schur decompositions.
#include <Eigen/Eigenvalues>
#include <Eigen/Jacobi>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include <continuo/studies/orbits/curves/saddle_spaces.hpp>

namespace continuo::studies::detail {

namespace {

using Complex = std::complex<double>;

constexpr double real_to_rounding = 1e-14;  // an imaginary part, of the size of the matrix
constexpr double spaces_apart = 1e-3;       // of the least singular value of reference^T columns

struct OrderedSchur {
  std::vector<Complex> eigenvalues;
  Eigen::MatrixXcd columns;
};

/// Schur's form with the eigenvalues in the order of `before(a, b)`; the first k columns span the space of the first k.
/// Neighbours change places by a rotation (Golub, Van Loan, "Matrix Computations", 7.6.2).
template <class Before>
std::optional<OrderedSchur> ordered_schur(const Eigen::MatrixXd& a, const Before& before) {
  Eigen::ComplexSchur<Eigen::MatrixXcd> schur(a.cast<Complex>());
  if (schur.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXcd t = schur.matrixT(), u = schur.matrixU();
  const Eigen::Index n = a.rows();
  for (Eigen::Index end = n - 1; end > 0; --end)
    for (Eigen::Index k = 0; k < end; ++k) {
      if (!before(t(k + 1, k + 1), t(k, k))) continue;
      Eigen::JacobiRotation<Complex> rotation;
      rotation.makeGivens(t(k, k + 1), t(k + 1, k + 1) - t(k, k));
      t.applyOnTheLeft(k, k + 1, rotation.adjoint());
      t.applyOnTheRight(k, k + 1, rotation);
      u.applyOnTheRight(k, k + 1, rotation);
    }
  OrderedSchur result{.eigenvalues = {}, .columns = std::move(u)};
  for (Eigen::Index k = 0; k < n; ++k) result.eigenvalues.push_back(t(k, k));
  return result;
}

/// The space of `dimension` eigenvalues on the left of `cut` (side = -1) or on its right (1).
std::optional<Eigenspace> space_beyond(const Eigen::MatrixXd& a, double cut, double side, std::size_t dimension) {
  Eigenspace space;
  if (dimension == 0) {
    space.right = space.left = Eigen::MatrixXcd(a.rows(), 0);
    return space;
  }
  const double rounding = real_to_rounding * a.norm();
  // Those on this side first, the nearest to the other side leading.
  const auto before = [&](const Complex& one, const Complex& other) {
    const double at = side * (one.real() - cut), of_other = side * (other.real() - cut);
    return (at > 0) == (of_other > 0) ? at < of_other - rounding : at > 0;
  };
  const auto right = ordered_schur(a, before), left = ordered_schur(a.transpose(), before);
  if (!right || !left) return std::nullopt;
  space.eigenvalues.assign(right->eigenvalues.begin(),
                           right->eigenvalues.begin() + static_cast<std::ptrdiff_t>(dimension));
  for (Complex& value : space.eigenvalues)
    if (std::abs(value.imag()) < rounding) value = value.real();
  space.right = right->columns.leftCols(static_cast<Eigen::Index>(dimension));
  space.left = left->columns.leftCols(static_cast<Eigen::Index>(dimension));
  return space;
}

/// Ascending; empty where a is not finite.
std::vector<double> real_parts_of(const Eigen::MatrixXd& a) {
  if (!a.allFinite()) return {};
  const auto values = a.eigenvalues().eval();
  std::vector<double> real_parts;
  for (const Complex& value : values) real_parts.push_back(value.real());
  std::ranges::sort(real_parts);
  return real_parts;
}

/// The eigenvector of the real eigenvalue that is nearest to this one.
Eigen::VectorXd eigenvector_at(const Eigen::MatrixXd& a, double eigenvalue) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a);
  Eigen::Index nearest = 0;
  for (Eigen::Index k = 1; k < a.rows(); ++k)
    if (std::abs(solver.eigenvalues()(k) - eigenvalue) < std::abs(solver.eigenvalues()(nearest) - eigenvalue))
      nearest = k;
  return real_vector(solver.eigenvectors().col(nearest));
}

}  // namespace

std::optional<SaddleSpaces> saddle_spaces(const Eigen::MatrixXd& a, std::size_t stable) {
  const std::vector<double> real_parts = real_parts_of(a);
  const std::size_t n = real_parts.size();
  if (stable == 0 || stable >= n) return std::nullopt;
  if (!(real_parts[stable] - real_parts[stable - 1] > 100 * real_to_rounding * a.norm())) return std::nullopt;
  const double cut = (real_parts[stable - 1] + real_parts[stable]) / 2;
  auto on_left = space_beyond(a, cut, -1, stable), on_right = space_beyond(a, cut, 1, n - stable);
  if (!on_left || !on_right) return std::nullopt;
  return SaddleSpaces{std::move(*on_left), std::move(*on_right)};
}

std::optional<SaddleSpaces> saddle_node_spaces(const Eigen::MatrixXd& a, std::size_t stable) {
  const std::vector<double> real_parts = real_parts_of(a);
  const std::size_t n = real_parts.size();
  if (n < 2 || stable >= n) return std::nullopt;
  const double centre = real_parts[stable], apart = 100 * real_to_rounding * a.norm();
  const double left_cut = stable == 0 ? centre : (real_parts[stable - 1] + centre) / 2,
               right_cut = stable + 1 == n ? centre : (real_parts[stable + 1] + centre) / 2;
  if (stable > 0 && !(centre - left_cut > apart)) return std::nullopt;
  if (stable + 1 < n && !(right_cut - centre > apart)) return std::nullopt;
  auto on_left = space_beyond(a, left_cut, -1, stable), on_right = space_beyond(a, right_cut, 1, n - stable - 1);
  if (!on_left || !on_right) return std::nullopt;
  const Eigen::VectorXd right = eigenvector_at(a, centre), left = eigenvector_at(a.transpose(), centre);
  const double product = left.dot(right);
  if (!(std::abs(product) > spaces_apart)) return std::nullopt;
  return SaddleSpaces{std::move(*on_left), std::move(*on_right), Centre{centre, right, left / product}};
}

Eigen::MatrixXd real_basis(const Eigen::MatrixXcd& columns) {
  // The orthogonal projector is real; its range are the eigenvectors of 1, which come last.
  const Eigen::MatrixXd projector = (columns * columns.adjoint()).real();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(projector);
  return solver.eigenvectors().rightCols(columns.cols());
}

std::optional<Eigen::MatrixXd> basis_like(const Eigen::MatrixXcd& columns, const Eigen::MatrixXd& reference) {
  if (columns.cols() == 0) return Eigen::MatrixXd(columns.rows(), 0);
  const Eigen::MatrixXcd common = reference.transpose().cast<Complex>() * columns;
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(common);
  if (!(svd.singularValues()(common.cols() - 1) > spaces_apart)) return std::nullopt;
  return (columns * common.inverse()).real();
}

Eigen::VectorXd real_vector(const Eigen::VectorXcd& v) {
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  const Eigen::VectorXd real = (v * (std::abs(v(largest)) / v(largest))).real();
  return real / real.norm();
}

}  // namespace continuo::studies::detail
