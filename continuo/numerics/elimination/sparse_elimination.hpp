// continuo/numerics/elimination/sparse_elimination.hpp
// The elimination of sparse matrices of one pattern with pivots that are known, as a list of what there is to do: for
// matrices of some dozen to some hundred rows this takes a fraction of the time of a general sparse solver, which is
// spent on columns of three entries.
//
//   const auto plan = std::make_shared<const EliminationPlan>(starts, rows, PivotOrder{rows, columns, blocks});
//   SparseElimination<double> elimination;
//   if (plan->is_listed()) elimination.follow(plan), elimination.scale_by(values);
//   if (elimination.factor(values)) elimination.solve(b);
//
// The matrix, its rows and columns in the order of the pivots, is block upper triangular: D L U with unit diagonals in
// each block, and above the blocks the entries divided by the pivot of their row. So a solution divides the right side
// by the pivots, and all that is left are products of one kind, which are listed for the whole matrix: those that do
// not wait for each other come together, so that the processor has several at once at work.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/elimination/elimination_plan.hpp>

namespace continuo::detail {

template <class Number>
class SparseElimination {
 public:
  /// For matrices with the pivots of this plan, which has a list.
  void follow(std::shared_ptr<const EliminationPlan> plan) {
    plan_ = std::move(plan);
    value_.resize(plan_->values());
    factors_.resize(plan_->products().size());
    start_.resize(plan_->size()), y_.resize(plan_->size());
  }

  /// Rows are scaled from now on by the powers of two that bring the greatest entry of each in this matrix near one.
  void scale_by(const Number* values) {
    std::vector<double> greatest(plan_->size(), 0.0);
    for (std::size_t p = 0; p < plan_->entries(); ++p) {
      double& most = greatest[plan_->turn_of_entry(p)];
      most = std::max(most, magnitude(values[p]));
    }
    scale_.resize(plan_->size());
    for (std::size_t k = 0; k < plan_->size(); ++k) {
      const double size = greatest[k];
      scale_[k] = size > 0 && std::isfinite(size) ? std::ldexp(1.0, std::clamp(-std::ilogb(size), -1000, 1000)) : 1.0;
    }
  }

  /// False where a pivot is zero, not finite, or much smaller than what it divides.
  [[nodiscard]] bool factor(const Number* values) {
    const EliminationPlan& plan = *plan_;
    std::ranges::fill(value_, Number{});
    for (std::size_t p = 0; p < plan.entries(); ++p)
      value_[plan.place(p)] = scaled(values[p], scale_[plan.turn_of_entry(p)]);
    bool good = true;
    const std::uint32_t* target = plan.targets();
    for (std::size_t k = 0; k < plan.size(); ++k) {
      const std::size_t below = plan.below(k), right = plan.right(k), end = plan.first(k + 1);
      Number& pivot = value_[plan.first(k)];
      const double size_of_pivot = magnitude(pivot);
      good = good && size_of_pivot > 0 && std::isfinite(size_of_pivot);
      const Number inverse = pivot = reciprocal(pivot);
      for (std::size_t p = below; p < right; ++p) {
        const Number factor = value_[p] * inverse;
        good = good && magnitude(factor) <= greatest_multiplier;
        for (std::size_t q = right; q < end; ++q) value_[*target++] -= factor * value_[q];
      }
      for (std::size_t q = right; q < end; ++q) value_[q] = value_[q] * inverse;
    }
    divide_by_pivots();
    for (std::size_t i = 0; i < factors_.size(); ++i) factors_[i] = value_[plan.values_of_products()[i]];
    return good;
  }

  /// b becomes the solution. `factor` must have succeeded.
  void solve(Number* b) {
    const std::size_t size = plan_->size();
    for (std::size_t k = 0; k < size; ++k) y_[k] = start_[k] * b[plan_->row(k)];
    const Number* factor = factors_.data();
    Number* y = y_.data();
    for (const auto& one : plan_->products()) y[one.target] -= *factor++ * y[one.source];
    for (std::size_t k = 0; k < size; ++k) b[plan_->column(k)] = y_[k];
  }

 private:
  // Pivots that were chosen for a matrix have multipliers up to some thousand (KLU prefers the diagonal down to a
  // thousandth). Kept ones cost at most a digit more.
  static constexpr double greatest_multiplier = 1e4;

  [[nodiscard]] static double scaled(double x, double scale) { return x * scale; }
  [[nodiscard]] static ComplexNumber<double> scaled(const ComplexNumber<double>& z, double scale) {
    return {z.re * scale, z.im * scale};
  }

  /// The entries below the pivots and above the blocks are those of L and of what lies beside it in the same rows.
  void divide_by_pivots() {
    const EliminationPlan& plan = *plan_;
    const auto divide = [&](std::size_t from, std::size_t to) {
      for (std::size_t p = from; p < to; ++p) value_[p] = value_[p] * value_[plan.first(plan.unknown(p))];
    };
    for (std::size_t k = 0; k < plan.size(); ++k) {
      start_[k] = scaled(value_[plan.first(k)], scale_[k]);
      divide(plan.below(k), plan.right(k));
      divide(plan.above(k), plan.above(k + 1));
    }
  }

  std::shared_ptr<const EliminationPlan> plan_;
  std::vector<double> scale_;    // of each row, by its turn
  std::vector<Number> value_;    // as the plan has them
  std::vector<Number> factors_;  // those of the products, one after the other
  std::vector<Number> y_;
  std::vector<Number> start_;  // of each row, by its turn: its scale divided by its pivot
};

}  // namespace continuo::detail
