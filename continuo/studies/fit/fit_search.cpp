// Repeats least squares until the deviations of the noise stay.
#include <utility>
#include <vector>

#include <continuo/studies/fit/fit_search.hpp>

namespace continuo::studies::detail {

LeastSquaresResult FitSearch::from(std::span<const double> start, std::size_t starts) {
  settled_ = false;
  options_ = request_.options;
  options_.starts = starts;
  // A robust loss must know what is far, and so begins where squares, or one without false minima, have ended.
  options_.loss = Loss::squares;
  LeastSquaresResult all = searched(start, {});
  options_.starts = 1;
  const Loss loss = request_.options.loss;
  std::vector<Loss> stages{loss};
  if (redescends(loss)) stages.insert(stages.begin(), Loss::huber);
  for (const Loss stage : stages) settle(stage, all);
  return all;
}

LeastSquaresResult FitSearch::searched(std::span<const double> start, const LeastSquaresResult& before) {
  LeastSquaresResult result = least_squares(problem_.least_squares(start), options_);
  result.iterations += before.iterations;
  result.evaluations += before.evaluations;
  if (before.found) {
    result.best_start = before.best_start;
    result.starts_done = before.starts_done;
    result.starts_agreeing = before.starts_agreeing;
  }
  return result;
}

void FitSearch::settle(Loss loss, LeastSquaresResult& all) {
  constexpr int most_rounds = 30;
  constexpr double same = 1e-3;  // of deviations: of the intervals, too
  const bool other_loss = options_.loss != loss;
  options_.loss = loss;
  for (int round = 0; round < most_rounds && all.found && !all.interrupted; ++round) {
    const double change = problem_.update_noise(all.residuals, all.rows, loss);
    settled_ = change < same && (round > 0 || !other_loss);
    LeastSquaresResult next = settled_ ? evaluated(all) : searched(all.p, all);
    if (!next.found && next.interrupted) {  // before its first iteration
      all.interrupted = true;
      return;
    }
    all = std::move(next);
    if (settled_) return;
  }
}

/// The same place with the deviations that have come since.
LeastSquaresResult FitSearch::evaluated(LeastSquaresResult all) {
  all.found = problem_.evaluate(all.p, all.residuals, all.rows);
  all.cost = 0;
  for (const double r : all.residuals) all.cost += loss_of(options_.loss, r) / 2;
  return all;
}

}  // namespace continuo::studies::detail
