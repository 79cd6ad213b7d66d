// continuo/methods/linearization.hpp
// What an implicit method needs of a system M x' = f(t, x): J = df/dx at one point, the constant M, and the solution of
// (c M - J) y = b for numbers c, real or complex, that the method chooses. M is the identity where the system has none.
//
//   work.linear.prepare(system, x);                       // once; the only place that allocates
//   evaluations += work.linear.evaluate(system, t, x, fx, least);
//   if (!work.lu.factor(work.linear, 1 / (gamma * h))) ...;  // singular
//   work.lu.solve(b);
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/methods/constant_mass.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/numerics/banded_lu.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/sparse_lu.hpp>
#include <continuo/system/jacobian.hpp>

namespace continuo {

/// Systems of run-time size with at least this many components and a pattern with at most this part of all entries are
/// solved by a sparse solver, if their scalar is double.
inline constexpr std::size_t least_sparse_size = 20;
inline constexpr double greatest_sparse_part = 0.3;

template <State X>
class Linearization {
 public:
  using Real = Scalar<X>;
  static constexpr std::size_t N = fixed_size<X>();

  explicit Linearization(const X& x) : size_(dimension(x)), moved_(x), slope_(x) {}

  std::size_t size() const { return size_; }
  bool prepared() const { return prepared_; }
  bool sparse() const { return sparse_; }
  /// Sparse and near the diagonal.
  bool banded() const { return banded_; }

  /// Learns the structure of the system: pattern and mass. To be called before anything else.
  template <class F>
  void prepare(F& f, const X&) {
    prepared_ = true;
    mass_.read(f, size_);
    if constexpr (N == run_time_size && std::same_as<Real, double> && HasJacobianPattern<F>) {
      pattern_ = f.jacobian_pattern();
      sparse_ = !mass_.is_matrix() && size_ >= least_sparse_size &&
                static_cast<double>(pattern_.entries()) <=
                    greatest_sparse_part * static_cast<double>(size_) * static_cast<double>(size_);
      if (sparse_) {
        rows_.assign(pattern_.entries(), 0);
        if constexpr (!HasSparseJacobian<F, X>) groups_ = ColumnGroups(pattern_);
        banded_ = pattern_.is_banded();
        diagonal_.resize(size_);
        for (std::size_t i = 0; i < size_; ++i) diagonal_[i] = pattern_.find(i, i);
      }
    }
    if constexpr (N == run_time_size) {
      if (!sparse_) rows_.assign(size_ * size_, Real(0));
    }
  }

  /// J at (t, x); fx = f(t, x), least(j) the least increment for a difference. Returns the number of evaluations of f.
  template <class F, class Least>
  int evaluate(F& f, const Real& t, const X& x, const X& fx, const Least& least) {
    if constexpr (N == run_time_size && std::same_as<Real, double> && HasJacobianPattern<F>) {
      if (sparse_)
        return evaluate_jacobian(f, t, x, fx, moved_, slope_, least, pattern_, groups_, std::span<Real>(rows_));
    }
    return evaluate_jacobian(f, t, x, fx, moved_, slope_, least, std::span<Real>(rows_));
  }

  bool is_finite() const {
    Real sum(0);
    for (const Real& entry : rows_) sum += Real(0) * entry;
    return sum == Real(0);
  }

  bool has_mass() const { return !mass_.is_identity(); }
  /// Mv = M v.
  void multiply_mass(const X& v, X& product) const { mass_.multiply(v, product); }
  /// Jv = J v.
  void multiply_jacobian(const X& v, X& product) const {
    for (std::size_t i = 0; i < size_; ++i) product.data()[i] = Real(0);
    if (sparse_) {
      for (std::size_t j = 0; j < size_; ++j)
        for (std::size_t p = pattern_.begin(j); p < pattern_.end(j); ++p)
          product.data()[pattern_.row(p)] += rows_[p] * v.data()[j];
      return;
    }
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = 0; j < size_; ++j) product.data()[i] += rows_[i * size_ + j] * v.data()[j];
  }

  /// c M - J, row by row; dense only.
  template <class Number>
  void shifted(const Number& c, Number* matrix) const {
    for (std::size_t i = 0; i < size_ * size_; ++i) matrix[i] = Number(-rows_[i]);
    if (mass_.is_matrix()) {
      for (std::size_t i = 0; i < size_ * size_; ++i) matrix[i] += c * Number(mass_[i]);
    } else {
      for (std::size_t i = 0; i < size_; ++i) matrix[i * size_ + i] += mass_.is_identity() ? c : c * Number(mass_[i]);
    }
  }
  /// The entries of c M - J in the order of the pattern; sparse only. Entry p goes to values[place(p)].
  template <class Number, class Place>
  void shifted(const Number& c, Number* values, const Place& place) const {
    for (std::size_t p = 0; p < rows_.size(); ++p) values[place(p)] = Number(-rows_[p]);
    for (std::size_t j = 0; j < size_; ++j)
      values[place(diagonal_[j])] += mass_.is_identity() ? c : c * Number(mass_[j]);
  }
  const SparsePattern& pattern() const { return pattern_; }
  /// Of J: row by row, or of its pattern.
  std::span<const Real> entries() const { return rows_; }
  Real mass(std::size_t i, std::size_t j) const {
    if (mass_.is_matrix()) return mass_[i * size_ + j];
    if (i != j) return Real(0);
    return mass_.is_identity() ? Real(1) : mass_[i];
  }

 private:
  std::size_t size_;
  X moved_, slope_;
  BlockOf<Real, N, N * N> rows_{};  // of J, or the entries of its pattern
  ConstantMass<X> mass_;
  SparsePattern pattern_;
  ColumnGroups groups_;
  std::vector<std::size_t> diagonal_;  // where the pattern has it
  bool sparse_ = false, banded_ = false, prepared_ = false;
};

/// c M - J, decomposed. Number is the scalar of the state or a ComplexNumber of it.
template <State X, class Number = Scalar<X>>
class Decomposition {
 public:
  static constexpr std::size_t N = fixed_size<X>();

  explicit Decomposition(const X& x) : dense_(N == run_time_size ? 0 : dimension(x)) {}

  /// False where the matrix is singular or not finite.
  bool factor(const Linearization<X>& linear, const Number& c) {
    if constexpr (has_sparse) {
      if (linear.banded()) return factor_band(linear, c);
      if (linear.sparse()) {
        if (!sparse_) sparse_.emplace(linear.pattern());
        linear.shifted(c, sparse_->values().data(), std::identity{});
        return sparse_->factor();
      }
    }
    if constexpr (N == run_time_size) {
      if (dense_.size() != linear.size()) dense_ = DenseLU<Number, N>(linear.size());
    }
    linear.shifted(c, dense_.matrix().data());
    return dense_.factor();
  }

  /// b becomes the solution. Compiled into the caller, as b of a small system is in registers there.
  [[gnu::always_inline]] void solve(Number* b) {
    if constexpr (has_sparse) {
      if (band_.lu.size() > 0) return band_.lu.solve(b);
      if (sparse_) return sparse_->solve(b);
    }
    dense_.solve(b);
  }

 private:
  static constexpr bool has_sparse =
      N == run_time_size && (std::same_as<Number, double> || std::same_as<Number, ComplexNumber<double>>);
  struct None {};
  using Sparse = std::conditional_t<has_sparse, SparseLU<std::conditional_t<has_sparse, Number, double>>, None>;

  struct Banded {
    BandedLU<Number> lu;
    std::vector<std::size_t> places;  // of the entries of the pattern
  };

  bool factor_band(const Linearization<X>& linear, const Number& c) {
    const SparsePattern& pattern = linear.pattern();
    if (band_.lu.size() == 0) {
      const auto [lower, upper] = pattern.bandwidth();
      band_.lu = BandedLU<Number>(linear.size(), lower, upper);
      band_.places.resize(pattern.entries());
      for (std::size_t j = 0; j < linear.size(); ++j)
        for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p)
          band_.places[p] = band_.lu.place(pattern.row(p), j);
    }
    linear.shifted(c, band_.lu.entries(), [this](std::size_t p) { return band_.places[p]; });
    return band_.lu.factor();
  }

  DenseLU<Number, N> dense_;
  std::optional<Sparse> sparse_;
  std::conditional_t<has_sparse, Banded, None> band_;
};

}  // namespace continuo
