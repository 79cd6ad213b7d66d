// The search of a fit: least squares again and again, each with the deviations that the one before has left, until
// these stay. Internal to fit.
#pragma once
#include <cstddef>
#include <span>

#include <continuo/studies/fit/fit_problem.hpp>

namespace continuo::studies::detail {

class FitSearch {
 public:
  FitSearch(const FitRequest& request, FitProblem& problem) : request_(request), problem_(problem) {}

  [[nodiscard]] LeastSquaresResult from(std::span<const double> start, std::size_t starts);
  /// Whether the deviations stayed at last.
  [[nodiscard]] bool settled() const { return settled_; }

 private:
  [[nodiscard]] LeastSquaresResult searched(std::span<const double> start, const LeastSquaresResult& before);
  void settle(Loss loss, LeastSquaresResult& all);
  [[nodiscard]] LeastSquaresResult evaluated(LeastSquaresResult all);

  const FitRequest& request_;
  FitProblem& problem_;
  LeastSquaresOptions options_;
  bool settled_ = false;
};

}  // namespace continuo::studies::detail
