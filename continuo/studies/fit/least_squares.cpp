// The only file that includes Ceres.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <ceres/ceres.h>

#include <continuo/numerics/finite.hpp>
#include <continuo/studies/least_squares.hpp>

namespace continuo::studies {

namespace {

/// All residuals at once, since one run gives them all; the terms below read what it left.
class Evaluations : public ceres::EvaluationCallback {
 public:
  Evaluations(const LeastSquares& problem, const std::vector<double>& p)
      : problem_(problem), p_(p), r(problem.residuals), rows(problem.residuals * p.size()) {}

  void PrepareForEvaluation(bool derivatives, bool is_new) override {
    if (!is_new && (!derivatives || has_rows_)) return;
    good = problem_.evaluate(p_, r, derivatives ? std::span(rows) : std::span<double>());
    has_rows_ = derivatives;
    ++count;
    good = good && all_finite(r);
  }

 private:
  const LeastSquares& problem_;
  const std::vector<double>& p_;
  bool has_rows_ = false;

 public:
  std::vector<double> r, rows;
  bool good = false;
  std::size_t count = 0;
};

class Term : public ceres::CostFunction {
 public:
  Term(const Evaluations& evaluations, std::size_t row, std::size_t unknowns) : evaluations_(evaluations), row_(row) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns));
  }
  bool Evaluate(double const* const*, double* residual, double** jacobian) const override {
    if (!evaluations_.good) return false;
    *residual = evaluations_.r[row_];
    const auto unknowns = static_cast<std::size_t>(parameter_block_sizes().front());
    if (jacobian != nullptr && jacobian[0] != nullptr)
      std::copy_n(evaluations_.rows.begin() + static_cast<std::ptrdiff_t>(row_ * unknowns), unknowns, jacobian[0]);
    return true;
  }

 private:
  const Evaluations& evaluations_;
  std::size_t row_;
};

class Watch : public ceres::IterationCallback {
 public:
  Watch(const LeastSquaresOptions& options, std::size_t start) : options_(options), start_(start) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (options_.progress) options_.progress(start_, summary.cost);
    const bool stop = options_.interrupt != nullptr && options_.interrupt->load();
    return stop ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const LeastSquaresOptions& options_;
  std::size_t start_;
};

/// A loss as Ceres asks for it: rho, rho' and rho'' by s = u^2. With w = psi/u they are rho' = w, rho'' = (psi' -
/// w)/2s.
class RobustLoss : public ceres::LossFunction {
 public:
  explicit RobustLoss(Loss loss) : loss_(loss) {}
  void Evaluate(double s, double rho[3]) const override {
    const double u = std::sqrt(s);
    rho[0] = loss_of(loss_, u);
    rho[1] = weight_of(loss_, u);
    rho[2] = s > 0 ? (slope_of(loss_, u) - rho[1]) / (2 * s) : 0;
  }

 private:
  Loss loss_;
};

struct Found {
  std::vector<double> p;
  double cost = std::numeric_limits<double>::infinity();
  std::string message;
  bool is_usable = false, converged = false, stopped = false;
  std::size_t iterations = 0, evaluations = 0;
};

bool is_at(double value, double bound) {
  return std::isfinite(bound) && std::abs(value - bound) <= 1e-9 * std::abs(bound);
}

/// Unknowns at a bound of theirs.
std::vector<int> held_by_bounds(const LeastSquares& problem, const std::vector<double>& p) {
  std::vector<int> held;
  for (std::size_t i = 0; i < p.size() && !problem.low.empty(); ++i)
    if (is_at(p[i], problem.low[i]) || is_at(p[i], problem.high[i])) held.push_back(static_cast<int>(i));
  return held;
}

void solve(ceres::Problem& least, ceres::Solver::Options& solver, Found& found) {
  // Along a narrow bent valley Levenberg and Marquardt's steps stay short; Powell's go on from there.
  for (const auto strategy : {ceres::LEVENBERG_MARQUARDT, ceres::DOGLEG}) {
    solver.trust_region_strategy_type = strategy;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &least, &summary);
    found.cost = summary.final_cost;
    found.message = summary.message;
    found.is_usable = summary.IsSolutionUsable();
    found.converged = summary.termination_type == ceres::CONVERGENCE;
    found.stopped = summary.termination_type == ceres::USER_SUCCESS;
    found.iterations += summary.iterations.size();
    if (found.converged || found.stopped) break;
  }
}

Found search(const LeastSquares& problem, const LeastSquaresOptions& options, std::vector<double> p,
             std::size_t start) {
  Evaluations evaluations(problem, p);
  evaluations.PrepareForEvaluation(true, true);
  if (!evaluations.good) return {.p = std::move(p), .message = "there are no residuals at the start", .evaluations = 1};
  ceres::Problem::Options ownership;
  ownership.evaluation_callback = &evaluations;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem least(ownership);
  RobustLoss robust(options.loss);
  ceres::LossFunction* loss = options.loss == Loss::squares ? nullptr : &robust;
  least.AddParameterBlock(p.data(), static_cast<int>(p.size()));
  for (std::size_t row = 0; row < problem.residuals; ++row)
    least.AddResidualBlock(new Term(evaluations, row, p.size()), loss, p.data());
  for (std::size_t i = 0; i < p.size() && !problem.low.empty(); ++i) {
    const int place = static_cast<int>(i);
    if (std::isfinite(problem.low[i])) least.SetParameterLowerBound(p.data(), place, problem.low[i]);
    if (std::isfinite(problem.high[i])) least.SetParameterUpperBound(p.data(), place, problem.high[i]);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = static_cast<int>(options.most_iterations);
  solver.function_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-10;
  solver.gradient_tolerance = 0;
  // Where no run is possible steps are cut in half until one is.
  solver.max_num_consecutive_invalid_steps = 100;
  Watch watch(options, start);
  solver.callbacks.push_back(&watch);
  solver.dogleg_type = ceres::SUBSPACE_DOGLEG;
  Found found{};
  solve(least, solver, found);
  // Steps that bounds cut off need not lead downhill, and a search among them may stand still: those at a bound are
  // held while the others go on, and then all are free again.
  constexpr int most_rounds = 5;
  for (int round = 0; round < most_rounds && found.is_usable && !found.stopped; ++round) {
    const std::vector<int> held = held_by_bounds(problem, p);
    if (held.empty() || held.size() == p.size()) break;
    const double before = found.cost;
    least.SetManifold(p.data(), new ceres::SubsetManifold(static_cast<int>(p.size()), held));
    solve(least, solver, found);
    least.SetManifold(p.data(), nullptr);
    if (found.stopped || !(found.cost < before * (1 - 1e-12))) break;
    solve(least, solver, found);
  }
  found.p = std::move(p);
  found.evaluations = evaluations.count;
  if (!found.is_usable) found.cost = std::numeric_limits<double>::infinity();
  return found;
}

/// Where unknown `i` of another search begins, by a number from 0 to 1.
double place_at(const LeastSquares& problem, std::size_t i, double u) {
  const double low = problem.low.empty() ? -INFINITY : problem.low[i];
  const double high = problem.high.empty() ? INFINITY : problem.high[i];
  if (std::isfinite(low) && std::isfinite(high)) {
    constexpr double wide = 100;
    return low > 0 && high >= wide * low ? low * std::pow(high / low, u) : low + u * (high - low);
  }
  const double start = problem.start[i];
  return std::clamp(start == 0 ? 2 * u - 1 : start * std::pow(10, 2 * u - 1), low, high);
}

/// A Latin hypercube: of `count` equal parts of each unknown's range every one is taken by one of the starts.
std::vector<std::vector<double>> other_starts(const LeastSquares& problem, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<double>> starts(count, problem.start);
  std::vector<std::size_t> part(count);
  for (std::size_t i = 0; i < problem.start.size(); ++i) {
    std::iota(part.begin(), part.end(), std::size_t{0});
    // Drawn by hand: what std::shuffle does with the same numbers is each library's own affair.
    for (std::size_t k = count; k > 1; --k) std::swap(part[k - 1], part[random() % k]);
    for (std::size_t k = 0; k < count; ++k) {
      const double within = static_cast<double>(random() >> 11) * 0x1p-53;
      starts[k][i] = place_at(problem, i, (static_cast<double>(part[k]) + within) / static_cast<double>(count));
    }
  }
  return starts;
}

}  // namespace

LeastSquaresResult least_squares(const LeastSquares& problem, const LeastSquaresOptions& options) {
  LeastSquaresResult result;
  const auto stopped = [&] { return options.interrupt != nullptr && options.interrupt->load(); };
  std::vector<std::vector<double>> starts{problem.start};
  if (options.starts > 1)
    std::ranges::copy(other_starts(problem, options.starts - 1, options.seed), std::back_inserter(starts));
  std::vector<Found> all;
  for (std::size_t start = 0; start < starts.size() && !stopped(); ++start) {
    all.push_back(search(problem, options, starts[start], start));
    result.iterations += all.back().iterations;
    result.evaluations += all.back().evaluations;
  }
  result.starts_done = all.size();
  result.interrupted = stopped();
  if (all.empty()) {
    result.status = {.ending = Ending::interrupted, .message = "interrupted before anything was found"};
    return result;
  }
  const auto best = std::ranges::min_element(all, {}, &Found::cost);
  if (!std::isfinite(best->cost)) {
    result.status = {.ending = Ending::cannot_continue, .message = all.front().message};
    return result;
  }
  for (const Found& found : all) result.starts_agreeing += found.cost <= best->cost * (1 + 1e-6) + 1e-300 ? 1 : 0;
  result.best_start = static_cast<std::size_t>(best - all.begin());
  result.p = best->p;
  result.cost = best->cost;
  result.converged = best->converged;
  result.residuals.resize(problem.residuals);
  result.rows.resize(problem.residuals * result.p.size());
  result.found = problem.evaluate(result.p, result.residuals, result.rows);
  if (!result.found)
    result.status = {.ending = Ending::not_finite, .message = "there are no residuals where the search ended"};
  result.at_bound.assign(result.p.size(), 0);
  for (const int i : held_by_bounds(problem, result.p)) result.at_bound[static_cast<std::size_t>(i)] = 1;
  result.interrupted = stopped();
  return result;
}

}  // namespace continuo::studies
