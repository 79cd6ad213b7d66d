// The singular value decomposition of the derivatives of residuals.
#include <cmath>

#include <continuo/studies/fit/decomposed_rows.hpp>

namespace continuo::studies::detail {

Decomposed decomposed(const VarianceComponents& noise, std::span<const double> jacobian, double accuracy,
                      std::span<const double> sizes) {
  using Dense = Eigen::MatrixXd;
  using Column = Eigen::VectorXd;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Eigen::Index;
  const auto n = static_cast<Index>(noise.rows.size());
  const Index m = n == 0 ? 0 : static_cast<Index>(jacobian.size()) / n;
  if (m == 0) return {.q = Dense(n, 0), .back = Dense(0, 0), .null = Dense(0, 0), .leverage = Column::Zero(n)};
  Dense rows = Eigen::Map<const RowMajor>(jacobian.data(), n, m);
  for (Index r = 0; r < n; ++r) rows.row(r) /= std::sqrt(noise.variance(static_cast<std::size_t>(r)));
  Column lengths = rows.colwise().norm();
  for (Index c = 0; c < m; ++c) {
    const double size = sizes.empty() ? 0 : std::abs(sizes[static_cast<std::size_t>(c)]);
    if (size > 0 && lengths[c] * size < accuracy) rows.col(c).setZero(), lengths[c] = 0;
    if (lengths[c] > 0) rows.col(c) /= lengths[c];
    if (!(lengths[c] > 0)) lengths[c] = 1;
  }
  const Eigen::JacobiSVD<Dense, Eigen::HouseholderQRPreconditioner> svd(rows,
                                                                        Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Column& s = svd.singularValues();
  Index rank = 0;
  while (rank < s.size() && s[rank] > accuracy * s[0]) ++rank;
  Decomposed result;
  result.q = svd.matrixU().leftCols(rank);
  result.back = lengths.cwiseInverse().asDiagonal() *
                Dense(svd.matrixV().leftCols(rank) * s.head(rank).cwiseInverse().asDiagonal());
  // Fewer rows than unknowns leave the thin V without part of the rest: its complement has it.
  const Dense full = Dense(svd.matrixV().leftCols(rank)).fullPivHouseholderQr().matrixQ();
  result.null = lengths.cwiseInverse().asDiagonal() * Dense(full.rightCols(m - rank));
  result.leverage = result.q.rowwise().squaredNorm();
  return result;
}

}  // namespace continuo::studies::detail
