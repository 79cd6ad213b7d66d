// continuo/numerics/eigenvalues.cpp
// Eigenvalues and eigenvectors of a real matrix, by Eigen.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include <continuo/numerics/eigenvalues.hpp>

namespace continuo {

Eigenvalues eigenvalues(std::span<const double> rows, std::size_t n) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigenvalues result;
  const auto size = static_cast<Eigen::Index>(n);
  const Matrix matrix = Eigen::Map<const Matrix>(rows.data(), size, size);
  if (!matrix.allFinite()) return result;
  const Eigen::EigenSolver<Matrix> solver(matrix);
  if (solver.info() != Eigen::Success) return result;
  result.found = true;
  const auto vectors = solver.eigenvectors();
  std::vector<Eigen::Index> order(n);
  std::iota(order.begin(), order.end(), Eigen::Index(0));
  std::ranges::sort(order, [&](Eigen::Index a, Eigen::Index b) {
    const auto x = solver.eigenvalues()[a], y = solver.eigenvalues()[b];
    return x.real() != y.real() ? x.real() > y.real() : x.imag() != y.imag() ? x.imag() > y.imag() : a < b;
  });
  for (const Eigen::Index k : order) {
    result.values.push_back(solver.eigenvalues()[k]);
    auto& vector = result.vectors.emplace_back(n);
    for (std::size_t i = 0; i < n; ++i) vector[i] = vectors(static_cast<Eigen::Index>(i), k);
  }
  return result;
}

}  // namespace continuo
