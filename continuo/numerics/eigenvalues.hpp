// Eigenvalues and eigenvectors of a real square matrix, by Eigen (Hessenberg form and the QR algorithm).
//
//   const Eigenvalues e = eigenvalues(rows, n);
//   e.values[0];  // the one with the greatest real part
#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace continuo {

/// The eigenvalues of a matrix with their eigenvectors.
struct Eigenvalues {
  bool found = false;  // false where the matrix is not finite, or the algorithm did not converge
  /// By descending real part; of a pair of conjugates the one with positive imaginary part first.
  std::vector<std::complex<double>> values;
  /// vectors[k]: of values[k], of length 1.
  std::vector<std::vector<std::complex<double>>> vectors;
};

/// `rows`: n * n, row by row.
[[nodiscard]] Eigenvalues eigenvalues(std::span<const double> rows, std::size_t n);

}  // namespace continuo
