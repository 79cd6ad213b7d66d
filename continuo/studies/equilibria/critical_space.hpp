// The critical eigenvalues and their invariant subspace of a matrix A of a linear part: a simple zero eigenvalue
// (fold), or a pair of eigenvalues whose sum is zero (Hopf point, or neutral saddle). Internal to bifurcation_curve.
//
// A fold's test is the scalar g of the bordered system A v + g w0 = 0, v0 . v = 1, which is zero where A is singular
// and smooth wherever the zero is of geometric multiplicity one, through a double zero too. A pair's test is the trace
// of A on the invariant plane of the pair, A V = V T, smooth while no third eigenvalue meets the pair: where the pair
// goes from complex to real as well. W. Govaerts, "Numerical Methods for Bifurcations of Dynamical Equilibria" (2000),
// chapters 3 and 4; G. W. Stewart, "Error and perturbation bounds for subspaces associated with certain eigenvalue
// problems", SIAM Review 15 (1973).
#pragma once
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace continuo::studies::detail {

struct CriticalSpace {
  std::size_t dimension = 1;  // 1: of a fold, 2: of a pair
  /// Column by column, orthonormal: the null vectors of A and A^T, or bases of their invariant planes.
  std::vector<double> right{}, left{};
  double test = 0;                // zero where it is critical
  std::vector<double> weights{};  // d test = sum_ij weights_ij dA_ij; row by row
  /// Of a fold left . right, zero where the eigenvalue is a double one. Of a pair the product of both, where their sum
  /// is zero the square of the angular frequency; below zero of a neutral saddle.
  double margin = 0;
  double size = 0;  // of a pair: |A| on its plane
};

/// That of A which continues `near`. Nothing where the equations for it cannot be solved.
[[nodiscard]] std::optional<CriticalSpace> continued_space(const std::vector<double>& a, std::size_t n,
                                                           const CriticalSpace& near);

/// Of the eigenvalue nearest to zero.
[[nodiscard]] std::optional<CriticalSpace> fold_space(const std::vector<double>& a, std::size_t n);
/// Of the eigenvalues nearest to +- i angular_frequency.
[[nodiscard]] std::optional<CriticalSpace> pair_space(const std::vector<double>& a, std::size_t n,
                                                      double angular_frequency);
/// Of the double zero eigenvalue, where `fold` is that of a fold and its margin is zero.
[[nodiscard]] std::optional<CriticalSpace> double_zero_space(const std::vector<double>& a, std::size_t n,
                                                             const CriticalSpace& fold);

/// The eigenvalues without those that are critical.
[[nodiscard]] std::vector<std::complex<double>> other_eigenvalues(const std::vector<std::complex<double>>& eigenvalues,
                                                                  const CriticalSpace& space);

/// Solves `matrix` y = b, row by row; empty where it is singular.
[[nodiscard]] std::vector<double> solution_of(const std::vector<double>& matrix, std::vector<double> b);

}  // namespace continuo::studies::detail
