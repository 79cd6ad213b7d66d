// Eigenvalues of the derivative of a return, without those that are known to be 1.
#include <Eigen/SVD>
#include <algorithm>
#include <complex>
#include <functional>
#include <span>
#include <tuple>
#include <vector>

#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/orbits/hybrid/return_multipliers.hpp>

namespace continuo::studies::detail {

namespace {

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& m) {
  if (m.rows() == 0) return {};
  const auto n = static_cast<std::size_t>(m.rows());
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = m;
  return eigenvalues(std::span(rows.data(), n * n), n).values;
}

/// Where w^T M = w^T, what is orthogonal to w stays so: there M has its other eigenvalues. Those that are known to be 1
/// are so exactly, and do not disturb the others, with which they may share an eigenvector.
std::vector<std::complex<double>> beside_conserved(const Eigen::MatrixXd& m) {
  const Eigen::Index n = m.rows();
  if (n == 0) return {};
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(m - Eigen::MatrixXd::Identity(n, n), Eigen::ComputeFullU);
  const Eigen::VectorXd& sizes = svd.singularValues();
  constexpr double none = 1e-7, noise = 1e-9;
  Eigen::Index conserved = 1;
  while (conserved < n && sizes[n - 1 - conserved] < none + noise * sizes[0]) ++conserved;
  const Eigen::MatrixXd others = svd.matrixU().leftCols(n - conserved);
  auto values = eigenvalues_of(others.transpose() * m * others);
  values.insert(values.end(), static_cast<std::size_t>(conserved), 1.0);
  return values;
}

void by_size(std::vector<std::complex<double>>& values) {
  const auto key = [](const std::complex<double>& value) {
    return std::tuple(std::abs(value), value.imag(), value.real());
  };
  std::ranges::sort(values, std::ranges::greater(), key);
}

}  // namespace

std::vector<std::complex<double>> multipliers_of_flow(const Eigen::MatrixXd& m, bool family) {
  auto values = family ? beside_conserved(m) : eigenvalues_of(m);
  by_size(values);
  return values;
}

std::vector<std::complex<double>> multipliers_of_flow(const Eigen::MatrixXd& m, const Eigen::VectorXd& f, bool family) {
  const Eigen::Index n = m.rows();
  Eigen::Index s = 0;
  f.cwiseAbs().maxCoeff(&s);
  std::vector<Eigen::Index> rest;
  for (Eigen::Index i = 0; i < n; ++i)
    if (i != s) rest.push_back(i);
  const Eigen::MatrixXd on_plane = m - f * m.row(s) / f[s];
  auto values = multipliers_of_flow(on_plane(rest, rest), family);
  values.emplace_back(1);
  by_size(values);
  return values;
}

}  // namespace continuo::studies::detail
