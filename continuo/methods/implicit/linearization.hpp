// continuo/methods/implicit/linearization.hpp
// What an implicit method needs of a system M x' = f(t, x): J = df/dx at one point, the constant M, and the solution of
// (c M - J) y = b for numbers c, real or complex, that the method chooses. M is the identity where the system has none.
//
//   work.linear.prepare(system, x);                       // once; the only place that allocates
//   evaluations += work.linear.evaluate(system, t, x, fx, least);
//   work.linear.bind(system);                             // in each step
//   if (!work.lu.factor(work.linear, 1 / (gamma * h))) ...;  // singular
//   work.lu.solve(work.linear, b);
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/methods/implicit/constant_mass.hpp>
#include <continuo/methods/implicit/solver_of_shift.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/numerics/band_layout.hpp>
#include <continuo/numerics/banded_lu.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/finite.hpp>
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

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool prepared() const { return prepared_; }
  [[nodiscard]] bool sparse() const { return sparse_; }
  /// Sparse and near the diagonal.
  [[nodiscard]] bool banded() const { return banded_; }

  /// Learns the structure of the system: pattern and mass. To be called before anything else.
  template <class F>
  void prepare(F& f, const X& x) {
    prepared_ = true;
    mass_.read(f, size_);
    if constexpr (has_own && detail::GivesSolver<F, X>) {
      own_ = f.solver_source(x);
      bind(f);
      if (!own_->reads_entries()) return;
    }
    if constexpr (N == run_time_size && std::same_as<Real, double> && HasJacobianPattern<F>) {
      static_assert(klu_is_installed || !HasJacobianPattern<F>,
                    "the pattern of the Jacobian of a system of run-time size needs the sparse solver KLU: install "
                    "libsuitesparse-dev (SuiteSparse)");
      pattern_ = f.jacobian_pattern();
      sparse_ = own() || (!mass_.is_matrix() && size_ >= least_sparse_size && pattern_.size() == size_ &&
                          static_cast<double>(pattern_.entries()) <=
                              greatest_sparse_part * static_cast<double>(size_) * static_cast<double>(size_));
      if (sparse_) {
        solver_ = &klu;
        rows_.assign(pattern_.entries(), 0);
        if (!HasSparseJacobian<F, X> || !gives_jacobian(f)) groups_ = ColumnGroups(pattern_);
        banded_ = !own() && pattern_.is_banded();
        if (banded_) prepare_band();
        diagonal_.resize(size_);
        for (std::size_t i = 0; i < size_; ++i) diagonal_[i] = pattern_.find(i, i);
      }
    }
    if constexpr (N == run_time_size) {
      if (!sparse_) rows_.assign(size_ * size_, Real(0));
    }
  }

  /// For checkpoints: J, as it was evaluated last. The structure is that of the system.
  template <class Archive>
  void transfer(Archive& archive) {
    bool was_prepared = prepared_;
    archive(was_prepared);
    if constexpr (Archive::reads) {
      if (was_prepared && !prepared_) prepare(archive.system(), moved_);
    }
    if (was_prepared) archive(rows_);
  }

  /// Where a step begins: the system may have moved since the last one.
  template <class F>
  void bind(F& f) {
    if constexpr (has_own && detail::GivesSolver<F, X>) {
      if (own_) f.bind(*own_);
    }
  }
  /// The source of the solvers of the user's; null where the matrix is decomposed.
  [[nodiscard]] detail::SolverSource<X>* own() const {
    if constexpr (has_own) {
      return own_ ? &*own_ : nullptr;
    } else {
      return nullptr;
    }
  }

  /// J at (t, x); fx = f(t, x), least(j) the least increment for a difference. Returns the number of evaluations of f.
  template <class F, class Least>
  [[nodiscard]] int evaluate(F& f, const Real& t, const X& x, const X& fx, const Least& least) {
    if constexpr (has_own && detail::GivesSolver<F, X>) {
      bind(f);
      own_->set_point(t, x, fx);
      if (!own_->reads_entries()) return 0;
    }
    if constexpr (N == run_time_size && std::same_as<Real, double> && HasJacobianPattern<F>) {
      if constexpr (HasBandJacobian<F, X>) {
        if (banded_) {
          f.jacobian_band(t, x, std::span<Real>(rows_));
          return 0;
        }
      }
      if (sparse_) {
        const std::span<Real> values(banded_ ? values_ : rows_);
        const int evaluations = evaluate_jacobian(f, t, x, fx, moved_, slope_, least, pattern_, groups_, values);
        for (std::size_t p = 0; p < values_.size(); ++p) rows_[places_[p]] = values_[p];
        return evaluations;
      }
    }
    if constexpr (HasSparseJacobian<F, X> && !HasJacobian<F, X>) {
      scatter_jacobian_values(f, t, x, values_, std::span<Real>(rows_));
      return 0;
    }
    return evaluate_jacobian(f, t, x, fx, moved_, slope_, least, std::span<Real>(rows_));
  }

  /// Two states for whoever needs some between two evaluations.
  struct Scratch {
    X &first, &second;
  };
  [[nodiscard]] Scratch scratch() { return {moved_, slope_}; }

  /// Why c M - J could not be decomposed.
  [[nodiscard]] StepStatus status_of_failure() const {
    return detail::is_finite_state(rows_) ? StepStatus::singular_matrix : StepStatus::not_finite;
  }

  [[nodiscard]] bool has_mass() const { return !mass_.is_identity(); }
  /// Mv = M v.
  void multiply_mass(const X& v, X& product) const { mass_.multiply(v, product); }
  /// Jv = J v.
  void multiply_jacobian(const X& v, X& product) const {
    for (std::size_t i = 0; i < size_; ++i) product.data()[i] = Real(0);
    if (sparse_) {
      for (std::size_t j = 0; j < size_; ++j)
        for (std::size_t p = pattern_.begin(j); p < pattern_.end(j); ++p)
          product.data()[pattern_.row(p)] += rows_[place(p)] * v.data()[j];
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
  /// Its entries in the order of the pattern; sparse, not banded.
  template <class Number>
  void shifted_entries(const Number& c, Number* values) const {
    for (std::size_t p = 0; p < rows_.size(); ++p) values[p] = Number(-rows_[p]);
    for (std::size_t j = 0; j < size_; ++j) values[diagonal_[j]] += mass_.is_identity() ? c : c * Number(mass_[j]);
  }
  [[nodiscard]] const BandLayout& band() const { return band_; }
  /// The diagonal of M; empty where it is the identity.
  [[nodiscard]] std::span<const Real> mass_diagonal() const { return mass_.diagonal(); }
  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }
  /// For matrices of the pattern; sparse only. A system without a pattern does not name one, and its program is linked
  /// without.
  [[nodiscard]] const SparseSolver& sparse_solver() const { return *solver_; }
  /// Of J: row by row, of its pattern or of its band.
  [[nodiscard]] std::span<const Real> entries() const { return rows_; }
  /// Entry p of the pattern.
  [[nodiscard]] const Real& entry(std::size_t p) const { return rows_[place(p)]; }
  /// Whether row and column i of M are zero: of the unknown of an algebraic equation.
  [[nodiscard]] bool is_without_mass(std::size_t i) const { return mass_.is_zero(i, size_); }
  [[nodiscard]] Real mass(std::size_t i, std::size_t j) const {
    if (mass_.is_matrix()) return mass_[i * size_ + j];
    if (i != j) return Real(0);
    return mass_.is_identity() ? Real(1) : mass_[i];
  }

 private:
  void prepare_band() {
    band_ = pattern_.band();
    rows_.assign(band_.numbers(), Real(0));
    values_.assign(pattern_.entries(), Real(0));
    places_ = pattern_.places_in_band();
  }
  [[nodiscard]] std::size_t place(std::size_t p) const { return banded_ ? places_[p] : p; }

  static constexpr bool has_own = N == run_time_size;
  struct None {};

  std::size_t size_;
  X moved_, slope_;
  BlockOf<Real, N, N * N> rows_{};     // of J, or the entries of its pattern, or its band
  std::vector<Real> values_;           // the entries of the pattern, where they have to be brought elsewhere
  std::vector<std::uint32_t> places_;  // where they are there
  BandLayout band_;
  ConstantMass<X> mass_;
  SparsePattern pattern_;
  const SparseSolver* solver_ = nullptr;
  ColumnGroups groups_;
  std::vector<std::size_t> diagonal_;  // where the pattern has it
  bool sparse_ = false, banded_ = false, prepared_ = false;
  [[no_unique_address]] std::conditional_t<has_own, detail::Cloned<detail::SolverSource<X>>, None> own_{};
};

/// c M - J, decomposed. Number is the scalar of the state or a ComplexNumber of it.
template <State X, class Number = Scalar<X>>
class Factorization {
 public:
  static constexpr std::size_t N = fixed_size<X>();

  explicit Factorization(const X& x) : dense_(N == run_time_size ? 0 : dimension(x)) {}

  /// For checkpoints: the matrix is decomposed again, with the same pivots and so to the same bits.
  template <class Archive>
  void transfer(Archive& archive, const Linearization<X>& linear)
    requires(N == run_time_size)
  {
    Number c = shift_;
    archive(c);
    if constexpr (has_sparse) {
      bool is_sparse = sparse_.has_value();
      archive(is_sparse);
      if (Archive::reads && is_sparse && !sparse_) {
        if (!linear.sparse() || linear.banded()) return archive.fail("the factors of another matrix");
        sparse_.emplace(linear.pattern(), linear.sparse_solver());
      }
      if (is_sparse) sparse_->transfer(archive);
    }
    if constexpr (Archive::reads) {
      shift_ = c;
      if (magnitude(c) == Scalar<X>(0) || !linear.prepared()) return;
      if constexpr (has_sparse) {
        if (sparse_) {
          linear.shifted_entries(c, sparse_->values().data());
          return sparse_->factor_with_known_pivots();
        }
      }
      static_cast<void>(factor(linear, c));
    }
  }

  /// False where the matrix is singular or not finite.
  [[nodiscard]] bool factor(const Linearization<X>& linear, const Number& c) {
    if constexpr (N == run_time_size) {
      shift_ = c;
      if (linear.own()) return factor_own(linear, c);
    }
    if constexpr (has_sparse) {
      if (linear.banded()) return factor_band(linear, c);
      if (linear.sparse()) {
        if (!sparse_) sparse_.emplace(linear.pattern(), linear.sparse_solver());
        linear.shifted_entries(c, sparse_->values().data());
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
  [[gnu::always_inline]] void solve([[maybe_unused]] const Linearization<X>& linear, Number* b) {
    if constexpr (N == run_time_size) {
      if (own_) return own_->solve(linear, b);
    }
    if constexpr (has_sparse) {
      if (band_.size() > 0) return band_.solve(b);
      if (sparse_) return sparse_->solve(b);
    }
    dense_.solve(b);
  }

 private:
  static constexpr bool has_sparse =
      N == run_time_size && (std::same_as<Number, double> || std::same_as<Number, ComplexNumber<double>>);
  struct None {};
  using Sparse = std::conditional_t<has_sparse, SparseLU<std::conditional_t<has_sparse, Number, double>>, None>;

  [[nodiscard]] bool factor_own(const Linearization<X>& linear, const Number& c) {
    if (!own_) {
      if constexpr (std::same_as<Number, Scalar<X>>) {
        own_ = linear.own()->real_solver();
      } else {
        own_ = linear.own()->complex_solver();
      }
    }
    return own_->factor(linear, c);
  }
  [[nodiscard]] bool factor_band(const Linearization<X>& linear, const Number& c) {
    if (band_.size() == 0) band_ = BandedLU<Number>(linear.band());
    return band_.factor(linear.entries(), c, linear.mass_diagonal());
  }

  [[no_unique_address]] std::conditional_t<N == run_time_size, Number, None> shift_{};  // the last c
  DenseLU<Number, N> dense_;
  std::optional<Sparse> sparse_;
  std::conditional_t<has_sparse, BandedLU<Number>, None> band_;
  [[no_unique_address]] std::conditional_t<N == run_time_size, detail::Cloned<detail::SolverOfShift<X, Number>>, None>
      own_{};
};

}  // namespace continuo
