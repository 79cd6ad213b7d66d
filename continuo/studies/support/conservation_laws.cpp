// Conservation laws of a system: found as the left null space of f at many places, and held.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include <fmt/format.h>

#include <continuo/numerics/finite.hpp>
#include <continuo/studies/conservation_laws.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;

constexpr std::size_t most_components = 400;
constexpr double no_singular_value = 1e-11;  // relative: what rounding leaves of a sum that vanishes
constexpr double whole = 1e-9;               // so near to an integer a weight is one
constexpr double nothing_left = 1e-10;       // of the sum of sizes

/// What is usual of each component: where the start says nothing, as much as the others.
Vector sizes_of(std::span<const double> start) {
  double greatest = 0;
  for (const double value : start) greatest = std::max(greatest, std::abs(value));
  if (!(greatest > 0)) greatest = 1;
  Vector sizes(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) sizes[i] = std::max(std::abs(start[i]), 1e-3 * greatest);
  return sizes;
}

/// f at random places; reproducible.
class Samples {
 public:
  Samples(const ParametricSystem& system, std::span<const double> start)
      : system_(system), start_(start), sizes_(sizes_of(start)) {}

  /// Up to 2^spread times the usual size, half of them on its side of zero; the constants likewise where they are to
  /// move. Nothing where f is not finite there.
  bool take(double spread, bool move_constants, Vector& f) {
    std::uniform_real_distribution<double> power(-spread, spread), time(0, 10);
    std::bernoulli_distribution turn(0.25);
    const bool own_side = ++taken_ % 2 == 0;
    Vector x(system_.size), p(system_.constants);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = sizes_[i] * std::exp2(power(random_));
      if (own_side ? start_[i] < 0 : turn(random_)) x[i] = -x[i];
    }
    if (move_constants)
      for (double& value : p) value = (value == 0 ? 1 : value) * std::exp2(power(random_) / spread);
    f.assign(system_.size, 0.0);
    system_.derivative(time(random_), x, p, f);
    return all_finite(f);
  }

 private:
  const ParametricSystem& system_;
  std::span<const double> start_;
  Vector sizes_;
  std::mt19937 random_{20241};
  std::size_t taken_ = 0;
};

/// A basis of all w with w . f = 0 at the samples, row by row.
Eigen::MatrixXd combinations_that_vanish(Samples& samples, std::size_t components) {
  const auto n = static_cast<Eigen::Index>(components);
  const Eigen::Index wanted = n + 8;
  Eigen::MatrixXd rows(wanted, n);
  Eigen::Index found = 0;
  Vector f;
  for (Eigen::Index k = 0; k < 8 * wanted && found < wanted; ++k)
    if (samples.take(3, false, f)) rows.row(found++) = Eigen::Map<const Eigen::RowVectorXd>(f.data(), n);
  if (found < wanted) return Eigen::MatrixXd(0, n);
  // In sizes in which no component and no sample is small beside others.
  Eigen::VectorXd sizes = rows.cwiseAbs().colwise().maxCoeff();
  for (double& size : sizes) size = size > 0 ? size : 1;
  rows = rows * sizes.cwiseInverse().asDiagonal();
  for (Eigen::Index k = 0; k < wanted; ++k) {
    const double length = rows.row(k).norm();
    if (length > 0) rows.row(k) /= length;
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < n && values[rank] > no_singular_value * values[0]) ++rank;
  return (sizes.cwiseInverse().asDiagonal() * svd.matrixV().rightCols(n - rank)).transpose();
}

/// Each row with a one where all others have a zero (Gauss and Jordan, whole pivots).
void solve_for_ones(Eigen::MatrixXd& rows) {
  std::vector<Eigen::Index> ones;
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    for (Eigen::Index i = k; i < rows.rows(); ++i) rows.row(i) /= rows.row(i).cwiseAbs().maxCoeff();
    Eigen::Index row = 0, column = 0;
    rows.bottomRows(rows.rows() - k).cwiseAbs().maxCoeff(&row, &column);
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, column);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      if (i != k) rows.row(i) -= rows(i, column) * rows.row(k);
  }
}

/// Integers as such, zero among them: a weight that rounding left may stand before what is large.
void round_to_integers(Eigen::MatrixXd& rows) {
  for (double& weight : rows.reshaped())
    if (std::abs(weight - std::round(weight)) < whole) weight = std::round(weight);
}

/// Sums rather than differences where another law may be added: of a network these are what its parts are made of.
void prefer_sums(Eigen::MatrixXd& rows) {
  for (Eigen::Index k = 0; k < rows.rows(); ++k)
    for (Eigen::Index other = 0; other < rows.rows() && rows.row(k).minCoeff() < 0; ++other) {
      if (other == k || rows.row(other).minCoeff() < 0) continue;
      double times = 0;
      for (Eigen::Index i = 0; i < rows.cols(); ++i)
        if (rows(k, i) < 0 && rows(other, i) > 0) times = std::max(times, -rows(k, i) / rows(other, i));
      const Eigen::RowVectorXd sum = rows.row(k) + times * rows.row(other);
      if (sum.minCoeff() >= 0) rows.row(k) = sum;
    }
}

/// At other places, near and far, with other constants.
bool holds_elsewhere(Samples& samples, std::span<const double> weights) {
  constexpr std::size_t wanted = 64;
  Vector f;
  std::size_t seen = 0;
  for (std::size_t k = 0; k < 8 * wanted && seen < wanted; ++k) {
    if (!samples.take(k % 2 == 0 ? 3 : 20, true, f)) continue;
    ++seen;
    double sum = 0, size = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * f[i], size += std::abs(weights[i] * f[i]);
    if (std::abs(sum) > nothing_left * size) return false;
  }
  return seen >= wanted / 4;
}

/// c(p), as last asked for, and what pulls back to the laws.
struct Holding {
  ParametricSystem system;
  std::function<Vector(Values p)> start;
  Eigen::MatrixXd w, inverse;  // of r rows, of n rows
  double rate = 1;
  Vector constants{};
  Eigen::VectorXd values{};

  void set(Values p) {
    if (values.size() > 0 && std::ranges::equal(p, constants)) return;
    constants.assign(p.begin(), p.end());
    const Vector x = start(p);
    values = w * Eigen::Map<const Eigen::VectorXd>(x.data(), w.cols());
  }
  void derivative(double t, Values x, Values p, std::span<double> dxdt) {
    system.derivative(t, x, p, dxdt);
    set(p);
    const Eigen::VectorXd off = w * Eigen::Map<const Eigen::VectorXd>(x.data(), w.cols()) - values;
    Eigen::Map<Eigen::VectorXd>(dxdt.data(), w.cols()) -= rate * (inverse * off);
  }
  void jacobian(double t, Values x, Values p, std::span<double> rows) const {
    std::ranges::copy(jacobian_of(system, t, x, p), rows.begin());
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Rows>(rows.data(), w.cols(), w.cols()) -= rate * (inverse * w);
  }
};

}  // namespace

std::vector<ConservationLaw> conservation_laws_of(const ParametricSystem& system, std::span<const double> start) {
  const std::size_t n = system.differential();
  if (n == 0 || n > most_components) return {};
  Samples samples(system, start);
  Eigen::MatrixXd rows = combinations_that_vanish(samples, n);
  if (rows.rows() == 0) return {};
  solve_for_ones(rows);
  round_to_integers(rows);
  prefer_sums(rows);
  round_to_integers(rows);
  std::vector<ConservationLaw> laws;
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    ConservationLaw law{.weights = Vector(system.size)};
    for (std::size_t i = 0; i < n; ++i) law.weights[i] = rows(k, static_cast<Eigen::Index>(i));
    if (!holds_elsewhere(samples, law.weights)) continue;
    for (std::size_t i = 0; i < n; ++i) law.value += law.weights[i] * start[i];
    laws.push_back(std::move(law));
  }
  return laws;
}

std::string law_text(const ParametricSystem& system, const ConservationLaw& law) {
  std::string text;
  for (std::size_t i = 0; i < law.weights.size(); ++i) {
    const double weight = law.weights[i];
    if (weight == 0) continue;
    text += text.empty() ? (weight < 0 ? "-" : "") : (weight < 0 ? " - " : " + ");
    if (std::abs(weight) != 1) text += fmt::format("{:.6g}*", std::abs(weight));
    text += system.name(i);
  }
  return text;
}

ParametricSystem holding(const ParametricSystem& system, const std::vector<ConservationLaw>& laws,
                         std::function<std::vector<double>(Values p)> start) {
  const auto n = static_cast<Eigen::Index>(system.size), r = static_cast<Eigen::Index>(laws.size());
  const auto held = std::make_shared<Holding>(
      Holding{.system = system, .start = std::move(start), .w = Eigen::MatrixXd(r, n), .inverse = {}});
  const Vector x = held->start(system.constants), usual = sizes_of(x);
  const Eigen::VectorXd sizes = Eigen::Map<const Eigen::VectorXd>(usual.data(), n);
  for (Eigen::Index k = 0; k < r; ++k)
    held->w.row(k) = Eigen::Map<const Eigen::RowVectorXd>(laws[static_cast<std::size_t>(k)].weights.data(), n);
  // The least change, in sizes, that gives all laws their values.
  const Eigen::MatrixXd scaled = held->w * sizes.asDiagonal();
  held->inverse = sizes.asDiagonal() * scaled.transpose() * (scaled * scaled.transpose()).inverse();
  // As fast as what the system does, that it stays as stiff as it is.
  double rate = 0;
  const Vector slopes = jacobian_of(system, 0, x, system.constants);
  for (std::size_t i = 0; i < system.differential(); ++i) rate = std::max(rate, std::abs(slopes[i * system.size + i]));
  if (rate > 0 && std::isfinite(rate)) held->rate = rate;
  ParametricSystem result(system);
  result.pattern = {};
  result.constant_jacobian = {};  // it would have to know c
  result.derivative = [held](double t, Values at, Values p, std::span<double> dxdt) {
    held->derivative(t, at, p, dxdt);
  };
  result.jacobian = [held](double t, Values at, Values p, std::span<double> rows) { held->jacobian(t, at, p, rows); };
  result.conserved = laws.size();
  result.conserved_rate = held->rate;
  return result;
}

void leave_out_conserved(const ParametricSystem& system, std::complex<double> own,
                         std::vector<std::complex<double>>& eigenvalues) {
  for (std::size_t k = 0; k < system.conserved && !eigenvalues.empty(); ++k)
    eigenvalues.erase(std::ranges::min_element(
        eigenvalues, {}, [&](const std::complex<double>& value) { return std::abs(value - own); }));
}

}  // namespace continuo::studies
