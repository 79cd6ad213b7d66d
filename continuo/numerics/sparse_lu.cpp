// continuo/numerics/sparse_lu.cpp
// KLU behind SparseLU: analysis, factorization, refactorization with the same pivots, solution.
#include <type_traits>
#include <utility>

#include <suitesparse/klu.h>

#include <continuo/numerics/sparse_lu.hpp>

namespace continuo {

namespace {

// KLU reads and writes complex numbers as pairs of doubles.
static_assert(sizeof(ComplexNumber<double>) == 2 * sizeof(double) && std::is_standard_layout_v<ComplexNumber<double>>);
double* doubles(double* numbers) {
  return numbers;
}
double* doubles(ComplexNumber<double>* numbers) {
  return &numbers->re;
}

template <class Number>
constexpr bool is_real = std::is_same_v<Number, double>;

// A factorization with old pivots is good while no entry grew beyond this against the matrix.
constexpr double least_pivot_growth = 1e-10;

}  // namespace

template <class Number>
struct SparseLU<Number>::Factors {
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  std::vector<std::int32_t> starts, rows;

  explicit Factors(const SparsePattern& pattern)
      : Factors({pattern.starts().begin(), pattern.starts().end()}, {pattern.rows().begin(), pattern.rows().end()}) {}
  Factors(std::vector<std::int32_t> starts_, std::vector<std::int32_t> rows_)
      : starts(std::move(starts_)), rows(std::move(rows_)) {
    klu_defaults(&common);
    symbolic = klu_analyze(size(), starts.data(), rows.data(), &common);
  }
  Factors(const Factors&) = delete;
  ~Factors() {
    forget_pivots();
    klu_free_symbolic(&symbolic, &common);
  }

  int size() const { return static_cast<int>(starts.size()) - 1; }

  void forget_pivots() {
    if (!numeric) return;
    if constexpr (is_real<Number>) {
      klu_free_numeric(&numeric, &common);
    } else {
      klu_z_free_numeric(&numeric, &common);
    }
  }
  bool choose_pivots(Number* values) {
    forget_pivots();
    if (!symbolic) return false;  // singular whatever its entries are
    if constexpr (is_real<Number>) {
      numeric = klu_factor(starts.data(), rows.data(), doubles(values), symbolic, &common);
    } else {
      numeric = klu_z_factor(starts.data(), rows.data(), doubles(values), symbolic, &common);
    }
    if (common.status == KLU_OK) return true;
    forget_pivots();
    return false;
  }
  bool refactor(Number* values) {
    int done;
    if constexpr (is_real<Number>) {
      done = klu_refactor(starts.data(), rows.data(), doubles(values), symbolic, numeric, &common) &&
             klu_rgrowth(starts.data(), rows.data(), doubles(values), symbolic, numeric, &common);
    } else {
      done = klu_z_refactor(starts.data(), rows.data(), doubles(values), symbolic, numeric, &common) &&
             klu_z_rgrowth(starts.data(), rows.data(), doubles(values), symbolic, numeric, &common);
    }
    return done && common.status == KLU_OK && common.rgrowth > least_pivot_growth;
  }
  void solve(Number* b) {
    if constexpr (is_real<Number>) {
      klu_solve(symbolic, numeric, size(), 1, doubles(b), &common);
    } else {
      klu_z_solve(symbolic, numeric, size(), 1, doubles(b), &common);
    }
  }
};

template <class Number>
SparseLU<Number>::SparseLU(const SparsePattern& pattern)
    : values_(pattern.entries()), factors_(std::make_unique<Factors>(pattern)) {}

// The pivots of the original come from the matrix kept in pivot_values_; what it has decomposed since is in values_.
template <class Number>
SparseLU<Number>::SparseLU(const SparseLU& other)
    : values_(other.values_),
      pivot_values_(other.pivot_values_),
      factors_(std::make_unique<Factors>(other.factors_->starts, other.factors_->rows)) {
  if (pivot_values_.empty()) return;
  factors_->choose_pivots(pivot_values_.data());
  factors_->refactor(values_.data());
}

template <class Number>
SparseLU<Number>::SparseLU(SparseLU&&) noexcept = default;
template <class Number>
SparseLU<Number>& SparseLU<Number>::operator=(SparseLU other) noexcept {
  std::swap(values_, other.values_);
  std::swap(pivot_values_, other.pivot_values_);
  std::swap(factors_, other.factors_);
  return *this;
}
template <class Number>
SparseLU<Number>::~SparseLU() = default;

template <class Number>
bool SparseLU<Number>::factor() {
  if (!pivot_values_.empty() && factors_->refactor(values_.data())) return true;
  pivot_values_.clear();
  if (!factors_->choose_pivots(values_.data())) return false;
  pivot_values_ = values_;
  // To the same bits as a copy, which can only refactor.
  return factors_->refactor(values_.data());
}

template <class Number>
void SparseLU<Number>::solve(Number* b) {
  factors_->solve(b);
}

template class SparseLU<double>;
template class SparseLU<ComplexNumber<double>>;

}  // namespace continuo
