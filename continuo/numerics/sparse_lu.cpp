// continuo/numerics/sparse_lu.cpp
// KLU behind SparseLU: analysis, factorization, refactorization with the same pivots, solution. Where the elimination
// is short, KLU chooses the pivots, and the rest follows a list. Nothing else is here, so that a program without sparse
// matrices is linked without it.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <suitesparse/klu.h>

#include <continuo/numerics/elimination/sparse_elimination.hpp>
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

template <class Number>
class KluFactors final : public SparseFactors<Number> {
 public:
  explicit KluFactors(const SparsePattern& pattern)
      : KluFactors({pattern.starts().begin(), pattern.starts().end()}, {pattern.rows().begin(), pattern.rows().end()}) {
  }
  KluFactors(std::vector<std::int32_t> starts, std::vector<std::int32_t> rows)
      : starts_(std::move(starts)), rows_(std::move(rows)) {
    klu_defaults(&common_);
    symbolic_ = klu_analyze(size(), starts_.data(), rows_.data(), &common_);
  }
  KluFactors(const KluFactors&) = delete;
  KluFactors& operator=(const KluFactors&) = delete;
  ~KluFactors() override {
    forget_pivots();
    klu_free_symbolic(&symbolic_, &common_);
  }

  [[nodiscard]] std::unique_ptr<SparseFactors<Number>> for_same_pattern() const override {
    return std::make_unique<KluFactors>(starts_, rows_);
  }

  [[nodiscard]] bool choose_pivots(Number* values) override {
    forget_pivots();
    if (!symbolic_) return false;  // singular whatever its entries are
    if constexpr (is_real<Number>) {
      numeric_ = klu_factor(starts_.data(), rows_.data(), doubles(values), symbolic_, &common_);
    } else {
      numeric_ = klu_z_factor(starts_.data(), rows_.data(), doubles(values), symbolic_, &common_);
    }
    if (common_.status != KLU_OK) {
      forget_pivots();
      return false;
    }
    is_listed_ = elimination_.plan(starts_, rows_, pivots());
    if (is_listed_) elimination_.scale_by(values);
    return true;
  }
  [[nodiscard]] bool refactor(Number* values) override {
    if (is_listed_) return elimination_.factor(values);
    int done;
    if constexpr (is_real<Number>) {
      done = klu_refactor(starts_.data(), rows_.data(), doubles(values), symbolic_, numeric_, &common_) &&
             klu_rgrowth(starts_.data(), rows_.data(), doubles(values), symbolic_, numeric_, &common_);
    } else {
      done = klu_z_refactor(starts_.data(), rows_.data(), doubles(values), symbolic_, numeric_, &common_) &&
             klu_z_rgrowth(starts_.data(), rows_.data(), doubles(values), symbolic_, numeric_, &common_);
    }
    return done && common_.status == KLU_OK && common_.rgrowth > least_pivot_growth;
  }
  void solve(Number* b) override {
    if (is_listed_) return elimination_.solve(b);
    if constexpr (is_real<Number>) {
      klu_solve(symbolic_, numeric_, size(), 1, doubles(b), &common_);
    } else {
      klu_z_solve(symbolic_, numeric_, size(), 1, doubles(b), &common_);
    }
  }

 private:
  [[nodiscard]] int size() const { return static_cast<int>(starts_.size()) - 1; }
  /// Those of `numeric_`.
  [[nodiscard]] detail::PivotOrder pivots() const {
    const auto count = static_cast<std::size_t>(size()), blocks = static_cast<std::size_t>(symbolic_->nblocks);
    return {{numeric_->Pnum, count}, {symbolic_->Q, count}, {symbolic_->R, blocks + 1}};
  }
  void forget_pivots() {
    is_listed_ = false;
    if (!numeric_) return;
    if constexpr (is_real<Number>) {
      klu_free_numeric(&numeric_, &common_);
    } else {
      klu_z_free_numeric(&numeric_, &common_);
    }
  }

  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  std::vector<std::int32_t> starts_, rows_;
  detail::SparseElimination<Number> elimination_;
  bool is_listed_ = false;
};

template <class Number>
std::unique_ptr<SparseFactors<Number>> analyse_by_klu(const SparsePattern& pattern) {
  return std::make_unique<KluFactors<Number>>(pattern);
}

}  // namespace

constinit const SparseSolver klu{analyse_by_klu<double>, analyse_by_klu<ComplexNumber<double>>};

}  // namespace continuo
