#include <Eigen/Eigenvalues>
#include <Eigen/Jacobi>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include <continuo/studies/saddle_spaces.hpp>

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

}  // namespace

std::optional<SaddleSpaces> saddle_spaces(const Eigen::MatrixXd& a, std::size_t stable) {
  const auto n = static_cast<std::size_t>(a.rows());
  if (!a.allFinite() || stable == 0 || stable >= n) return std::nullopt;
  const double rounding = real_to_rounding * a.norm();
  const auto values = a.eigenvalues().eval();
  std::vector<double> real_parts(n);
  for (std::size_t k = 0; k < n; ++k) real_parts[k] = values(static_cast<Eigen::Index>(k)).real();
  std::ranges::sort(real_parts);
  if (!(real_parts[stable] - real_parts[stable - 1] > 100 * rounding)) return std::nullopt;
  const double cut = (real_parts[stable - 1] + real_parts[stable]) / 2;
  const auto space_of = [&](double side) -> std::optional<Eigenspace> {
    // Those on this side first, the nearest to the other side leading.
    const auto before = [&](const Complex& one, const Complex& other) {
      const double at = side * (one.real() - cut), of_other = side * (other.real() - cut);
      return (at > 0) == (of_other > 0) ? at < of_other - rounding : at > 0;
    };
    const auto right = ordered_schur(a, before), left = ordered_schur(a.transpose(), before);
    if (!right || !left) return std::nullopt;
    const std::size_t dimension = side < 0 ? stable : n - stable;
    Eigenspace space;
    space.eigenvalues.assign(right->eigenvalues.begin(),
                             right->eigenvalues.begin() + static_cast<std::ptrdiff_t>(dimension));
    for (Complex& value : space.eigenvalues)
      if (std::abs(value.imag()) < rounding) value = value.real();
    space.right = right->columns.leftCols(static_cast<Eigen::Index>(dimension));
    space.left = left->columns.leftCols(static_cast<Eigen::Index>(dimension));
    return space;
  };
  auto on_left = space_of(-1), on_right = space_of(1);
  if (!on_left || !on_right) return std::nullopt;
  return SaddleSpaces{std::move(*on_left), std::move(*on_right)};
}

Eigen::MatrixXd real_basis(const Eigen::MatrixXcd& columns) {
  // The orthogonal projector is real; its range are the eigenvectors of 1, which come last.
  const Eigen::MatrixXd projector = (columns * columns.adjoint()).real();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(projector);
  return solver.eigenvectors().rightCols(columns.cols());
}

std::optional<Eigen::MatrixXd> basis_like(const Eigen::MatrixXcd& columns, const Eigen::MatrixXd& reference) {
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
