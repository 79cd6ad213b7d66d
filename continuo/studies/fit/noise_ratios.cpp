// Evaluates the restricted likelihood over the ratios of unknown variances.
#include <algorithm>
#include <cmath>

#include <continuo/studies/fit/decomposed_rows.hpp>
#include <continuo/studies/fit/noise_ratios.hpp>

namespace continuo::studies::detail {

namespace {

using Dense = Eigen::MatrixXd;
using Column = Eigen::VectorXd;
using Eigen::Index;

/// Ratios at which one row's two parts are as large. Beyond the last to either side one kind of noise has no say and
/// the likelihood changes no more, unless the variance of the smaller is known: then the other may be larger by any
/// number, and about its estimate is where to look.
std::vector<double> centers_of(std::vector<double> logarithms, const TwoKinds& column,
                               const VarianceComponents& noise) {
  constexpr double apart = 4, most = 12;
  const auto [least, greatest] = std::ranges::minmax(logarithms);
  const double middle = std::log(column.unit), span = greatest - least;
  const double count = std::min(1 + std::floor(span / apart), most);
  std::vector<double> centers;
  for (double c = 0; c < count; ++c) centers.push_back(count == 1 ? 0 : least - middle + (c + 0.5) / count * span);
  const bool first_known = noise.components[column.first].known, second_known = noise.components[column.second].known;
  if ((first_known && column.estimated > centers.back() + apart) ||
      (second_known && column.estimated < centers.front() - apart))
    centers.push_back(column.estimated);
  return centers;
}

/// The parts of the first and of the second of a ratio's logarithm.
std::pair<double, double> parts_of(double ratio) {
  return {1 / (1 + std::exp(ratio)), 1 / (1 + std::exp(-ratio))};
}

/// The logarithm of the root of a determinant that is positive, or zero but for rounding.
double logarithm_of_root(const Dense& information) {
  // Rows that are all alike do not tell two components apart: the prior is proportional to their parts then.
  constexpr double alike = 1e-10;
  const Column sizes = information.diagonal().cwiseSqrt();
  Dense scaled = sizes.cwiseInverse().asDiagonal() * information * sizes.cwiseInverse().asDiagonal();
  scaled.diagonal().array() += alike;
  const Dense root = scaled.llt().matrixL();
  return sizes.array().log().sum() + root.diagonal().array().log().sum();
}

}  // namespace

std::vector<TwoKinds> columns_of_two_kinds(const VarianceComponents& noise) {
  std::vector<TwoKinds> columns;
  for (std::size_t g = 0; g < noise.groups; ++g) {
    std::vector<double> logarithms;
    TwoKinds column{.group = g, .first = 0, .second = 0, .unit = 1, .estimated = 0, .centers = {}};
    double sum = 0;
    for (const VarianceRow& row : noise.rows) {
      const auto& [one, other] = row.shares;
      if (row.group != g || !row.counts || one.component == other.component || !(one.factor * other.factor > 0))
        continue;
      logarithms.push_back(std::log(one.factor / other.factor));
      sum += logarithms.back();
      column.first = one.component, column.second = other.component;
    }
    if (logarithms.empty()) continue;
    const VarianceComponent &first = noise.components[column.first], &second = noise.components[column.second];
    if (first.known && second.known) continue;
    column.unit = std::exp(sum / static_cast<double>(logarithms.size()));
    constexpr double farthest = 650;  // a number, where one of them is none
    const double ratio = std::log(second.variance) - std::log(first.variance) - std::log(column.unit);
    column.estimated = std::isnan(ratio) ? 0 : std::clamp(ratio, -farthest, farthest);
    column.centers = centers_of(std::move(logarithms), column, noise);
    columns.push_back(std::move(column));
  }
  return columns;
}

NoiseRatios::NoiseRatios(const VarianceComponents& noise, const Uncertainty& sure, std::span<const double> residuals,
                         std::span<const double> jacobian, std::span<const double> sizes, double accuracy,
                         std::vector<TwoKinds> columns)
    : noise_(noise), columns_(std::move(columns)), back_(decomposed(noise, jacobian, accuracy, sizes).back) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto all = static_cast<Index>(noise.rows.size());
  const Dense along = Eigen::Map<const RowMajor>(jacobian.data(), all, static_cast<Index>(sizes.size())) * back_;
  augmented_.resize(all, back_.cols() + 1);
  Index count = 0;
  for (Index r = 0; r < all; ++r) {
    const VarianceRow& row = noise.rows[static_cast<std::size_t>(r)];
    if (!row.counts) continue;
    rows_.push_back(row);
    augmented_.row(count++) << along.row(r), residuals[static_cast<std::size_t>(r)];
  }
  augmented_.conservativeResize(count, Eigen::NoChange);
  find_sources(sure);
  find_axes();
}

void NoiseRatios::add_source(std::vector<std::size_t> components, const Uncertainty& sure) {
  Source source{.components = std::move(components)};
  std::vector<char> groups(noise_.groups, 0);
  for (const VarianceRow& row : rows_) {
    if (row.group == prior_group || row.shares[0].component != source.components[0]) continue;
    groups[row.group] = 1;
    source.rows += 1;
  }
  for (std::size_t g = 0; g < groups.size(); ++g) source.degrees += groups[g] ? sure.group_degrees[g] : 0;
  // A column that the unknowns take up whole says nothing of its noise.
  constexpr double nothing = 1e-6;
  if (!(source.degrees > nothing)) return;
  for (const std::size_t k : source.components) source_of_[k] = sources_.size();
  sources_.push_back(std::move(source));
}

void NoiseRatios::find_sources(const Uncertainty& sure) {
  source_of_.assign(noise_.components.size(), no_source);
  std::vector<char> to_add(noise_.components.size(), 0);
  for (const VarianceRow& row : rows_) {
    for (const auto& share : row.shares) {
      if (share.factor == 0) continue;
      to_add[share.component] = !noise_.components[share.component].known;
      absolute_ = absolute_ || noise_.components[share.component].known;
    }
  }
  std::erase_if(columns_, [&](const TwoKinds& column) {
    to_add[column.first] = to_add[column.second] = 0;
    add_source({column.first, column.second}, sure);
    return source_of_[column.first] == no_source;
  });
  for (std::size_t k = 0; k < to_add.size(); ++k)
    if (to_add[k]) add_source({k}, sure);
}

void NoiseRatios::find_axes() {
  for (const TwoKinds& column : columns_) {
    RatioAxis axis{.centers = {}, .estimated = column.estimated};
    for (const double center : column.centers) axis.centers.push_back({center, 1});
    axes_.push_back(std::move(axis));
  }
  for (std::size_t s = 0; s < sources_.size(); ++s)
    if (std::ranges::none_of(sources_[s].components, [&](std::size_t k) { return noise_.components[k].known; }))
      sizes_.push_back(s);
  const auto degrees_of = [&](std::size_t s) { return sources_[s].degrees; };
  if (!absolute_ && !sizes_.empty()) sizes_.erase(std::ranges::max_element(sizes_, {}, degrees_of));
  // The logarithm of a variance of d degrees has a deviation of about (2/d)^(1/2), and tails that are longer.
  for (const std::size_t s : sizes_)
    axes_.push_back({.centers = {{0, 1}, {0, std::min(1.0, std::sqrt(2 / degrees_of(s)) / 2)}}, .estimated = 0});
}

/// The mean square of a column's residuals over the shape that its noise has at a ratio, in units in which it is the
/// estimated size at the estimated ratio.
double NoiseRatios::size_of(const TwoKinds& column, double ratio) const {
  const auto [part, other_part] = parts_of(ratio);
  const double first = noise_.components[column.first].variance, second = noise_.components[column.second].variance;
  double here = 0, estimated = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].group != column.group) continue;
    const auto& [one, other] = rows_[i].shares;
    const double off = augmented_(static_cast<Index>(i), back_.cols());
    here += off * off / (part * one.factor + other_part * column.unit * other.factor);
    estimated += off * off / (first * one.factor + second * other.factor);
  }
  const double size = here / estimated;
  return size > 0 && std::isfinite(size) ? size : first + second / column.unit;
}

std::vector<double> NoiseRatios::variances_at(std::span<const double> point) const {
  std::vector<double> result;
  for (const VarianceComponent& component : noise_.components) result.push_back(component.variance);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const TwoKinds& column = columns_[c];
    const VarianceComponent& first = noise_.components[column.first];
    const VarianceComponent& second = noise_.components[column.second];
    const auto [part, other_part] = parts_of(point[c]);
    const double size = first.known    ? first.variance / part
                        : second.known ? second.variance / (column.unit * other_part)
                                       : size_of(column, point[c]);
    if (!first.known) result[column.first] = size * part;
    if (!second.known) result[column.second] = size * other_part * column.unit;
  }
  for (std::size_t s = 0; s < sizes_.size(); ++s)
    for (const std::size_t k : sources_[sizes_[s]].components) result[k] *= std::exp(point[columns_.size() + s]);
  return result;
}

NoiseRatios::Solved NoiseRatios::solved_at(std::span<const double> point) const {
  Solved result{.variances = variances_at(point),
                .of_rows = {},
                .inverse = {},
                .q = {},
                .step = {},
                .squares = 0,
                .logarithm = 0};
  const Index n = augmented_.rows(), rank = back_.cols();
  result.of_rows.resize(n);
  for (Index i = 0; i < n; ++i) {
    double variance = 0, least = 0;
    for (const auto& share : rows_[static_cast<std::size_t>(i)].shares) {
      variance += result.variances[share.component] * share.factor;
      least += noise_.components[share.component].known ? 0 : noise_.components[share.component].least * share.factor;
    }
    result.of_rows[i] = variance;
    result.squares += least / variance;  // residuals are not known to more digits
  }
  const Dense weighted = result.of_rows.cwiseSqrt().cwiseInverse().asDiagonal() * augmented_;
  const Dense r = Eigen::HouseholderQR<Dense>(weighted).matrixQR().topRows(std::min(n, rank + 1));
  result.inverse = r.topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solve(Dense::Identity(rank, rank));
  result.q = weighted.leftCols(rank) * result.inverse;
  result.step = r.col(rank).head(rank);
  if (n > rank) result.squares += r(rank, rank) * r(rank, rank);
  result.logarithm = r.diagonal().head(rank).cwiseAbs().array().log().sum();
  return result;
}

// -1/2 [log det V + log det J^T V^-1 J + r^T V^-1 r] with the overall size at 1; integrated over an unknown one, whose
// logarithm is as likely to be anywhere, the last of these is N - m times the logarithm of the squares.
double NoiseRatios::logarithm_at(std::span<const double> point) const {
  const Solved solved = solved_at(point);
  const double squares = absolute_ ? solved.squares : degrees() * std::log(solved.squares);
  return logarithm_of_prior(solved) - solved.logarithm - (solved.of_rows.array().log().sum() + squares) / 2;
}

// The information on the logarithms of the unknown variances is (1/2) [sum_i u_ik u_il (1 - 2 h_i) + tr(M_k M_l)], as
// in variance_components.cpp. Its determinant does not change where they are replaced by ratios and sizes.
double NoiseRatios::logarithm_of_prior(const Solved& solved) const {
  std::vector<Index> place(solved.variances.size(), -1);
  Index count = 0;
  for (const Source& source : sources_)
    for (const std::size_t k : source.components)
      if (!noise_.components[k].known) place[k] = count++;
  const Index rank = solved.q.cols();
  Dense information = Dense::Zero(count, count);
  std::vector<Dense> moments(static_cast<std::size_t>(count), Dense::Zero(rank, rank));
  for (Index i = 0; i < solved.q.rows(); ++i) {
    const Dense outer = solved.q.row(i).transpose() * solved.q.row(i);
    const auto& shares = rows_[static_cast<std::size_t>(i)].shares;
    const auto part = [&](const VarianceRow::Share& share) {
      return solved.variances[share.component] * share.factor / solved.of_rows[i];
    };
    for (const auto& a : shares) {
      const Index k = place[a.component];
      if (k < 0 || a.factor == 0) continue;
      moments[static_cast<std::size_t>(k)] += part(a) * outer;
      for (const auto& b : shares)
        if (place[b.component] >= 0 && b.factor != 0)
          information(k, place[b.component]) += part(a) * part(b) * (1 - 2 * outer.trace());
    }
  }
  for (Index k = 0; k < count; ++k)
    for (Index l = 0; l < count; ++l)
      information(k, l) +=
          moments[static_cast<std::size_t>(k)].cwiseProduct(moments[static_cast<std::size_t>(l)]).sum();
  return logarithm_of_root(information);
}

GivenRatios NoiseRatios::given_at(std::span<const double> point) const {
  const Solved solved = solved_at(point);
  const double size = absolute_ ? 1 : solved.squares / degrees();
  const Dense root = back_ * solved.inverse;
  const auto listed = [](const Dense& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  GivenRatios result{.shift = listed(-(root * solved.step)),
                     .covariance = listed(size * root * root.transpose()),
                     .parts = {},
                     .variances_of_components = solved.variances};
  std::vector<Dense> moments(sources_.size(), Dense::Zero(solved.q.cols(), solved.q.cols()));
  for (Index i = 0; i < solved.q.rows(); ++i) {
    const std::size_t source = source_of_[rows_[static_cast<std::size_t>(i)].shares[0].component];
    if (source != no_source) moments[source] += solved.q.row(i).transpose() * solved.q.row(i);
  }
  for (const Dense& moment : moments) result.parts.push_back(listed(size * root * moment * root.transpose()));
  for (std::size_t k = 0; k < source_of_.size(); ++k)
    if (!noise_.components[k].known && source_of_[k] != no_source) result.variances_of_components[k] *= size;
  return result;
}

MixedRatios NoiseRatios::frame() const {
  MixedRatios result{.given = {},
                     .degrees = absolute_ ? std::numeric_limits<double>::infinity() : degrees(),
                     .powers = {},
                     .source_of = std::vector<std::size_t>(noise_.groups, no_source)};
  for (const VarianceRow& row : rows_)
    if (row.group != prior_group) result.source_of[row.group] = source_of_[row.shares[0].component];
  for (const Source& source : sources_) {
    const double free = source.rows * degrees() / static_cast<double>(rows_.size());
    // The tail of a size that is large has the power of the rows: with less to spare it is no distribution.
    const double most = std::max((source.rows - 1) / 2, 0.0);
    result.powers.push_back(std::min(1 + 2 / free, most));
  }
  return result;
}

}  // namespace continuo::studies::detail
