// continuo/numerics/sparse_lu.cpp
// KLU behind SparseLU: analysis, factorization, refactorization with the same pivots, solution. Where the elimination
// is short, KLU chooses the pivots, and the rest follows a list. Nothing else is here, so that a program without sparse
// matrices is linked without it.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
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

/// The analysis of a pattern, and the plan of its elimination with the pivots that were chosen last. All who have
/// matrices of the pattern share it, one after the other or on several threads.
class KluAnalysis final : public PatternAnalysis {
 public:
  explicit KluAnalysis(const SparsePattern& pattern)
      : starts_(pattern.starts().begin(), pattern.starts().end()), rows_(pattern.rows().begin(), pattern.rows().end()) {
    klu_common common;
    klu_defaults(&common);
    symbolic_ = klu_analyze(size(), starts_.data(), rows_.data(), &common);
  }
  KluAnalysis(const KluAnalysis&) = delete;
  KluAnalysis& operator=(const KluAnalysis&) = delete;
  ~KluAnalysis() override {
    klu_common common;
    klu_defaults(&common);
    klu_free_symbolic(&symbolic_, &common);
  }

  [[nodiscard]] static std::shared_ptr<const KluAnalysis> of(const SparsePattern& pattern) {
    if (auto kept = std::dynamic_pointer_cast<const KluAnalysis>(pattern.analysis())) return kept;
    auto made = std::make_shared<const KluAnalysis>(pattern);
    pattern.keep(made);
    return made;
  }

  [[nodiscard]] int size() const { return static_cast<int>(starts_.size()) - 1; }
  // KLU does not change what it is given; it does not say so.
  [[nodiscard]] std::int32_t* starts() const { return const_cast<std::int32_t*>(starts_.data()); }
  [[nodiscard]] std::int32_t* rows() const { return const_cast<std::int32_t*>(rows_.data()); }
  /// Null where the pattern is singular whatever its entries are.
  [[nodiscard]] klu_symbolic* symbolic() const { return symbolic_; }

  /// A run often has two or three orders of pivots in turn.
  [[nodiscard]] std::shared_ptr<const detail::EliminationPlan> plan_for(const detail::PivotOrder& pivots) const {
    constexpr std::size_t most_plans = 4;
    const auto fits = [&](const auto& plan) { return plan->is_for(pivots); };
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (const auto plan = std::ranges::find_if(plans_, fits); plan != plans_.end()) return *plan;
    }
    auto made = std::make_shared<const detail::EliminationPlan>(starts_, rows_, pivots);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (plans_.size() == most_plans) plans_.erase(plans_.begin());
    plans_.push_back(made);
    return made;
  }

 private:
  std::vector<std::int32_t> starts_, rows_;
  klu_symbolic* symbolic_ = nullptr;
  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const detail::EliminationPlan>> plans_;  // those of the last pivots
};

template <class Number>
class KluFactors final : public SparseFactors<Number> {
 public:
  explicit KluFactors(std::shared_ptr<const KluAnalysis> analysis) : analysis_(std::move(analysis)) {
    klu_defaults(&common_);
  }
  KluFactors(const KluFactors&) = delete;
  KluFactors& operator=(const KluFactors&) = delete;
  ~KluFactors() override { forget_pivots(); }

  [[nodiscard]] std::unique_ptr<SparseFactors<Number>> for_same_pattern() const override {
    return std::make_unique<KluFactors>(analysis_);
  }

  [[nodiscard]] bool choose_pivots(Number* values) override {
    forget_pivots();
    if (!symbolic()) return false;  // singular whatever its entries are
    if constexpr (is_real<Number>) {
      numeric_ = klu_factor(analysis_->starts(), analysis_->rows(), doubles(values), symbolic(), &common_);
    } else {
      numeric_ = klu_z_factor(analysis_->starts(), analysis_->rows(), doubles(values), symbolic(), &common_);
    }
    if (common_.status != KLU_OK) {
      forget_pivots();
      return false;
    }
    const std::shared_ptr<const detail::EliminationPlan> plan = analysis_->plan_for(pivots());
    is_listed_ = plan->is_listed();
    if (is_listed_) {
      elimination_.follow(plan);
      elimination_.scale_by(values);
    }
    return true;
  }
  [[nodiscard]] bool refactor(Number* values) override {
    if (is_listed_) return elimination_.factor(values);
    int done;
    if constexpr (is_real<Number>) {
      done = klu_refactor(analysis_->starts(), analysis_->rows(), doubles(values), symbolic(), numeric_, &common_) &&
             klu_rgrowth(analysis_->starts(), analysis_->rows(), doubles(values), symbolic(), numeric_, &common_);
    } else {
      done = klu_z_refactor(analysis_->starts(), analysis_->rows(), doubles(values), symbolic(), numeric_, &common_) &&
             klu_z_rgrowth(analysis_->starts(), analysis_->rows(), doubles(values), symbolic(), numeric_, &common_);
    }
    return done && common_.status == KLU_OK && common_.rgrowth > least_pivot_growth;
  }
  void solve(Number* b) override {
    if (is_listed_) return elimination_.solve(b);
    if constexpr (is_real<Number>) {
      klu_solve(symbolic(), numeric_, size(), 1, doubles(b), &common_);
    } else {
      klu_z_solve(symbolic(), numeric_, size(), 1, doubles(b), &common_);
    }
  }

 private:
  [[nodiscard]] int size() const { return analysis_->size(); }
  [[nodiscard]] klu_symbolic* symbolic() const { return analysis_->symbolic(); }
  /// Those of `numeric_`.
  [[nodiscard]] detail::PivotOrder pivots() const {
    const auto count = static_cast<std::size_t>(size()), blocks = static_cast<std::size_t>(symbolic()->nblocks);
    return {{numeric_->Pnum, count}, {symbolic()->Q, count}, {symbolic()->R, blocks + 1}};
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
  klu_numeric* numeric_ = nullptr;
  std::shared_ptr<const KluAnalysis> analysis_;
  detail::SparseElimination<Number> elimination_;
  bool is_listed_ = false;
};

template <class Number>
std::unique_ptr<SparseFactors<Number>> analyse_by_klu(const SparsePattern& pattern) {
  return std::make_unique<KluFactors<Number>>(KluAnalysis::of(pattern));
}

}  // namespace

constinit const SparseSolver klu{analyse_by_klu<double>, analyse_by_klu<ComplexNumber<double>>};

}  // namespace continuo
