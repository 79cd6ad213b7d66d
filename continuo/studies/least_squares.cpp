// The only file that includes Ceres.
#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include <ceres/ceres.h>

#include <continuo/studies/least_squares.hpp>

namespace continuo::studies {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

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
    good = good && std::ranges::all_of(r, [](double value) { return std::isfinite(value); });
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

std::unique_ptr<ceres::LossFunction> loss_function(Loss loss, double scale) {
  switch (loss) {
    case Loss::squares:
      break;
    case Loss::huber:
      return std::make_unique<ceres::HuberLoss>(1.345 * scale);
    case Loss::soft_l1:
      return std::make_unique<ceres::SoftLOneLoss>(1.345 * scale);
    case Loss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(2.3849 * scale);
    case Loss::tukey:
      return std::make_unique<ceres::TukeyLoss>(4.6851 * scale);
  }
  return nullptr;
}

/// The deviation of normal noise with this median, whatever a minority of outliers does.
double robust_deviation(std::vector<double> residuals) {
  for (double& r : residuals) r = std::abs(r);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::ranges::nth_element(residuals, middle);
  return 1.4826 * *middle;
}

struct Found {
  std::vector<double> p;
  double cost = std::numeric_limits<double>::infinity();
  std::string message;
  std::size_t iterations = 0, evaluations = 0;
};

Found search(const LeastSquares& problem, const LeastSquaresOptions& options, std::vector<double> p, std::size_t start,
             ceres::LossFunction* loss) {
  Evaluations evaluations(problem, p);
  evaluations.PrepareForEvaluation(true, true);
  if (!evaluations.good) return {.p = std::move(p), .message = "there are no residuals at the start", .evaluations = 1};
  ceres::Problem::Options ownership;
  ownership.evaluation_callback = &evaluations;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem least(ownership);
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
  solver.max_num_iterations = 200;
  solver.function_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-10;
  solver.gradient_tolerance = 0;
  Watch watch(options, start);
  solver.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &least, &summary);
  Found found{.p = std::move(p), .cost = summary.final_cost, .message = {}};
  found.iterations = summary.iterations.size();
  found.evaluations = evaluations.count;
  if (!summary.IsSolutionUsable()) {
    found.cost = std::numeric_limits<double>::infinity();
    found.message = summary.message;
  }
  return found;
}

std::vector<double> another_start(const LeastSquares& problem, std::mt19937_64& random) {
  std::vector<double> p = problem.start;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double u = std::uniform_real_distribution<double>(0, 1)(random);
    const double low = problem.low.empty() ? -INFINITY : problem.low[i];
    const double high = problem.high.empty() ? INFINITY : problem.high[i];
    if (std::isfinite(low) && std::isfinite(high)) {
      p[i] = low + u * (high - low);
    } else {
      p[i] = std::clamp(p[i] == 0 ? 2 * u - 1 : p[i] * std::pow(10, 2 * u - 1), low, high);
    }
  }
  return p;
}

bool is_at(double value, double bound) {
  return std::isfinite(bound) && std::abs(value - bound) <= 1e-9 * std::max(1.0, std::abs(bound));
}

/// What the residuals say of the unknowns' uncertainty: C = s^2 (J^T W J)^-1 of those that are free.
void judge(const LeastSquares& problem, const LeastSquaresOptions& options, const ceres::LossFunction* loss,
           LeastSquaresResult& result) {
  const std::size_t m = result.p.size(), n = problem.residuals;
  result.residuals.resize(n);
  std::vector<double> rows(n * m);
  result.found = problem.evaluate(result.p, result.residuals, rows);
  result.at_bound.assign(m, 0);
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < m; ++i) {
    const bool bound =
        !problem.low.empty() && (is_at(result.p[i], problem.low[i]) || is_at(result.p[i], problem.high[i]));
    result.at_bound[i] = bound ? 1 : 0;
    if (!bound) free.push_back(i);
  }
  result.weights.assign(n, 1);
  double sum = 0;
  for (std::size_t r = 0; r < n; ++r) {
    double rho[3] = {0, 1, 0};
    if (loss != nullptr) loss->Evaluate(result.residuals[r] * result.residuals[r], rho);
    result.weights[r] = rho[1];
    sum += rho[1] * result.residuals[r] * result.residuals[r];
  }
  result.cost = sum / 2;
  result.degrees = n > free.size() ? n - free.size() : 0;
  result.residual_deviation = options.known_deviation ? 1
                              : result.degrees > 0    ? std::sqrt(sum / static_cast<double>(result.degrees))
                                                      : std::numeric_limits<double>::infinity();
  Rows jacobian(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(free.size()));
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < free.size(); ++c)
      jacobian(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          std::sqrt(result.weights[r]) * rows[r * m + free[c]];
  result.covariance.assign(m * m, 0);
  if (free.empty()) return;
  const Eigen::VectorXd scale = jacobian.colwise().norm();
  for (Eigen::Index c = 0; c < scale.size(); ++c)
    if (scale[c] > 0) jacobian.col(c) /= scale[c];
  const Eigen::ColPivHouseholderQR<Rows> qr(jacobian);
  if (qr.rank() < jacobian.cols()) {
    for (const std::size_t i : free) result.covariance[i * m + i] = std::numeric_limits<double>::infinity();
    return;
  }
  const Rows inverse = (jacobian.transpose() * jacobian).inverse();
  const double variance = result.residual_deviation * result.residual_deviation;
  for (std::size_t a = 0; a < free.size(); ++a)
    for (std::size_t b = 0; b < free.size(); ++b) {
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      result.covariance[free[a] * m + free[b]] = variance * inverse(i, j) / (scale[i] * scale[j]);
    }
}

}  // namespace

LeastSquaresResult least_squares(const LeastSquares& problem, const LeastSquaresOptions& options) {
  LeastSquaresResult result;
  std::mt19937_64 random(options.seed);
  const auto stopped = [&] { return options.interrupt != nullptr && options.interrupt->load(); };
  std::vector<Found> all;
  for (std::size_t start = 0; start < std::max<std::size_t>(1, options.starts) && !stopped(); ++start) {
    all.push_back(
        search(problem, options, start == 0 ? problem.start : another_start(problem, random), start, nullptr));
    result.iterations += all.back().iterations;
    result.evaluations += all.back().evaluations;
  }
  result.starts_done = all.size();
  result.interrupted = stopped();
  if (all.empty()) return result;
  Found best = *std::ranges::min_element(all, {}, &Found::cost);
  if (!std::isfinite(best.cost)) {
    result.message = all.front().message;
    return result;
  }
  for (const Found& found : all) result.starts_agreeing += found.cost <= best.cost * (1 + 1e-6) + 1e-300 ? 1 : 0;

  // A robust loss needs to know what is far: estimated from the fit before it, and once more from its own.
  std::unique_ptr<ceres::LossFunction> loss;
  for (int round = 0; round < 3 && options.loss != Loss::squares && !stopped(); ++round) {
    std::vector<double> residuals(problem.residuals);
    if (!problem.evaluate(best.p, residuals, {})) break;
    const double scale = options.known_deviation ? 1 : robust_deviation(residuals);
    if (!(scale > 0)) break;
    loss = loss_function(options.loss, scale);
    const Found found = search(problem, options, best.p, 0, loss.get());
    result.iterations += found.iterations;
    result.evaluations += found.evaluations;
    if (std::isfinite(found.cost)) best = found;
  }
  result.p = best.p;
  judge(problem, options, loss.get(), result);
  result.interrupted = stopped();
  return result;
}

}  // namespace continuo::studies
