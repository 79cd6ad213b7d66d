// The stable and the unstable eigenspaces of a saddle, or of a saddle-node, as spaces: whole groups of eigenvalues, so
// that they are smooth where eigenvalues within a group meet. Internal to what follows homoclinic orbits.
#pragma once
#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace continuo::studies::detail {

/// Of one group of eigenvalues, the leading one (nearest to the imaginary axis) first; of a pair of conjugates both are
/// in it.
struct Eigenspace {
  std::vector<std::complex<double>> eigenvalues{};
  /// Orthonormal columns that span it. The first is the eigenvector of the leading eigenvalue; together they span a
  /// space of real vectors, each alone may be complex.
  Eigen::MatrixXcd right{}, left{};  // of A, of its transpose

  [[nodiscard]] std::size_t dimension() const { return eigenvalues.size(); }
  [[nodiscard]] bool leading_is_real() const { return eigenvalues.front().imag() == 0; }
};

/// Of a saddle-node: the simple real eigenvalue next to zero, and its eigenvectors, |right| = 1, left . right = 1.
struct Centre {
  double eigenvalue = 0;
  Eigen::VectorXd right{}, left{};
};

/// Of a saddle-node, `stable` and `unstable` are without its centre, and one of them, or both, may be empty.
struct SaddleSpaces {
  Eigenspace stable{}, unstable{};
  std::optional<Centre> centre{};
};

/// `stable` eigenvalues on the left, the others on the right, wherever zero is. Nothing where both sides of a pair
/// would be parted, or one is empty.
[[nodiscard]] std::optional<SaddleSpaces> saddle_spaces(const Eigen::MatrixXd& a, std::size_t stable);
/// `stable` eigenvalues on the left, then the centre, the others on the right. Nothing where the centre is not apart
/// from both.
[[nodiscard]] std::optional<SaddleSpaces> saddle_node_spaces(const Eigen::MatrixXd& a, std::size_t stable);

/// A real orthonormal basis of the same space.
[[nodiscard]] Eigen::MatrixXd real_basis(const Eigen::MatrixXcd& columns);
/// The basis L of the same space with reference^T L = 1: the only one, therefore real, and as smooth as the space is.
/// Nothing where the spaces have nothing to do with each other.
[[nodiscard]] std::optional<Eigen::MatrixXd> basis_like(const Eigen::MatrixXcd& columns,
                                                        const Eigen::MatrixXd& reference);
/// The real vector of length 1 that an eigenvector of a real eigenvalue is a complex multiple of.
[[nodiscard]] Eigen::VectorXd real_vector(const Eigen::VectorXcd& v);

}  // namespace continuo::studies::detail
