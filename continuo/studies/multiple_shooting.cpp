// continuo/studies/multiple_shooting.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <continuo/numerics/sparse_lu.hpp>
#include <continuo/studies/flow.hpp>
#include <continuo/studies/multiple_shooting.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;

class MultipleShooting {
 public:
  MultipleShooting(const BoundaryValueProblem& problem, const ShootingOptions& options)
      : problem_(problem),
        options_(options),
        varied_(with_variations(problem.system, true)),
        n_(problem.system.size),
        m_(problem.system.parameters()) {
    for (std::size_t i = 0; i + 1 < problem.times.size(); ++i) {
      joints_.push_back(times_.size());
      const double from = problem.times[i], length = problem.times[i + 1] - from;
      for (std::size_t k = 0; k < options.segments; ++k)
        times_.push_back(from + length * static_cast<double>(k) / static_cast<double>(options.segments));
    }
    joints_.push_back(times_.size());
    times_.push_back(problem.times.back());
    read_.resize(problem.times.size() * n_);
  }

  ShootingSolution operator()(const BoundaryValueGuess& guess) {
    Vector z(times_.size() * n_ + m_);
    for (std::size_t k = 0; guess && k < times_.size(); ++k) guess(times_[k], std::span(z).subspan(k * n_, n_));
    std::ranges::copy(problem_.system.constants, z.end() - static_cast<std::ptrdiff_t>(m_));
    SparseLU<double> lu{pattern()};
    Vector residuals(z.size()), trial(z.size());
    double damping = 1;
    if (!shoot(z, residuals, &lu)) return ended(z, {});
    for (solution_.iterations = 1; solution_.iterations <= options_.most_iterations; ++solution_.iterations) {
      if (!lu.factor())
        return ended(z, "the conditions do not determine a motion near the guess (their matrix is singular)");
      Vector correction(residuals);
      lu.solve(correction.data());
      const double size = size_of(correction, z);
      if (!std::isfinite(size)) return ended(z, "a correction is not finite");
      for (;; damping /= 2) {
        if (damping < 1e-4) return ended(z, "no motion was found near the guess; give another one");
        for (std::size_t i = 0; i < z.size(); ++i) trial[i] = z[i] - damping * correction[i];
        if (!shoot(trial, residuals, nullptr)) {
          if (solution_.outcome.ending == Ending::interrupted) return ended(z, {});
          continue;
        }
        Vector next(residuals);
        lu.solve(next.data());
        if (size <= options_.tolerance || size_of(next, z) <= (1 - damping / 4) * size) break;
      }
      z.swap(trial);
      if (size <= options_.tolerance && damping == 1) {
        solution_.outcome = {};
        solution_.outcome.t = times_.back();
        return filled(z);
      }
      damping = std::min(1.0, 4 * damping);
      if (!shoot(z, residuals, &lu)) return ended(z, {});
    }
    return ended(z, "too many iterations; a better guess may do");
  }

 private:
  /// Conditions in the first n and the last m rows, joints between.
  SparsePattern pattern() {
    std::vector<MatrixPlace> places;
    const auto n = static_cast<std::uint32_t>(n_), m = static_cast<std::uint32_t>(m_);
    const auto constants = static_cast<std::uint32_t>(times_.size() * n_);
    for (std::uint32_t i = 0; i < n + m; ++i) {
      const std::uint32_t row = i < n ? i : constants + i - n;
      for (const std::size_t joint : joints_)
        for (std::uint32_t j = 0; j < n; ++j) places.push_back({row, static_cast<std::uint32_t>(joint) * n + j});
      for (std::uint32_t j = 0; j < m; ++j) places.push_back({row, constants + j});
    }
    for (std::uint32_t k = 0; k + 1 < times_.size(); ++k) {
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t row = (k + 1) * n + i;
        places.push_back({row, row});
        for (std::uint32_t j = 0; j < n; ++j) places.push_back({row, k * n + j});
        for (std::uint32_t j = 0; j < m; ++j) places.push_back({row, constants + j});
      }
    }
    pattern_ = SparsePattern(times_.size() * n_ + m_, places);
    return pattern_;
  }

  Values conditions_of(const Vector& z, Values p, Vector& g) {
    for (std::size_t at = 0; at < joints_.size(); ++at)
      for (std::size_t i = 0; i < n_; ++i) read_[at * n_ + i] = z[joints_[at] * n_ + i];
    problem_.conditions(read_, p, g);
    return g;
  }

  /// The residuals at z and, into `lu`, their derivatives. False where a piece cannot be integrated.
  bool shoot(const Vector& z, Vector& residuals, SparseLU<double>* lu) {
    const Values p = std::span(z).last(m_);
    Options<Vector> run{.rtol = options_.rtol, .atol = options_.atol};
    run.save = Save<Vector>::only_end();
    run.interrupt = options_.interrupt;
    if (lu) std::ranges::fill(lu->values(), 0.0);
    for (std::size_t k = 0; k + 1 < times_.size(); ++k) {
      const Values from = std::span(z).subspan(k * n_, n_);
      const auto piece =
          lu ? run_flow(varied_, p, variational_start(problem_.system, from, true), {times_[k], times_[k + 1]}, run)
             : run_flow(problem_.system, p, {from.begin(), from.end()}, {times_[k], times_[k + 1]}, run);
      solution_.outcome = piece.outcome;
      if (!piece.outcome) return false;
      const Vector& end = piece.final_state();
      for (std::size_t i = 0; i < n_; ++i) residuals[(k + 1) * n_ + i] = z[(k + 1) * n_ + i] - end[i];
      if (lu) set_piece(k, end, *lu);
    }
    Vector g(n_ + m_);
    conditions_of(z, p, g);
    for (std::size_t i = 0; i < n_ + m_; ++i) residuals[row_of(i)] = g[i];
    if (lu) set_conditions(z, *lu);
    return true;
  }
  std::size_t row_of(std::size_t condition) const {
    return condition < n_ ? condition : times_.size() * n_ + condition - n_;
  }
  void set_piece(std::size_t k, const Vector& end, SparseLU<double>& lu) const {
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t row = (k + 1) * n_ + i;
      lu.values()[pattern_.find(row, row)] = 1;
      for (std::size_t j = 0; j < n_ + m_; ++j) {
        const std::size_t column = j < n_ ? k * n_ + j : times_.size() * n_ + j - n_;
        lu.values()[pattern_.find(row, column)] = -end[n_ * (1 + j) + i];
      }
    }
  }
  void set_conditions(const Vector& z, SparseLU<double>& lu) {
    Vector moved(z), above(n_ + m_), below(n_ + m_);
    const auto column = [&](std::size_t j) {
      const double here = moved[j], increment = central_increment(here, 1);
      moved[j] = here + increment;
      conditions_of(moved, std::span(moved).last(m_), above);
      moved[j] = here - increment;
      conditions_of(moved, std::span(moved).last(m_), below);
      moved[j] = here;
      for (std::size_t i = 0; i < n_ + m_; ++i)
        lu.values()[pattern_.find(row_of(i), j)] = (above[i] - below[i]) / (2 * increment);
    };
    for (const std::size_t joint : joints_)
      for (std::size_t j = 0; j < n_; ++j) column(joint * n_ + j);
    for (std::size_t j = 0; j < m_; ++j) column(times_.size() * n_ + j);
  }

  double size_of(const Vector& correction, const Vector& z) const {
    Vector sizes(n_, 1e-3);
    for (std::size_t i = 0; i < times_.size() * n_; ++i) sizes[i % n_] = std::max(sizes[i % n_], std::abs(z[i]));
    double sum = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double size = i < times_.size() * n_ ? sizes[i % n_] : std::max(std::abs(z[i]), 1e-3);
      sum += std::pow(correction[i] / size, 2);
    }
    return std::sqrt(sum / static_cast<double>(z.size()));
  }

  ShootingSolution filled(const Vector& z) {
    solution_.times = times_;
    for (std::size_t k = 0; k < times_.size(); ++k)
      solution_.states.emplace_back(z.begin() + static_cast<std::ptrdiff_t>(k * n_),
                                    z.begin() + static_cast<std::ptrdiff_t>((k + 1) * n_));
    solution_.parameters.assign(z.end() - static_cast<std::ptrdiff_t>(m_), z.end());
    return std::move(solution_);
  }
  /// An empty hint: the outcome of an integration stands.
  ShootingSolution ended(const Vector& z, std::string hint) {
    if (!hint.empty()) {
      solution_.outcome.ending = Ending::nonlinear_solve_failed;
      solution_.outcome.hint = std::move(hint);
    }
    return filled(z);
  }

  const BoundaryValueProblem& problem_;
  const ShootingOptions& options_;
  ParametricSystem varied_;
  std::size_t n_, m_;
  Vector times_, read_;
  std::vector<std::size_t> joints_;  // which of times_ the conditions read
  SparsePattern pattern_;
  ShootingSolution solution_;
};

}  // namespace

ShootingSolution solve_by_shooting(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess,
                                   const ShootingOptions& options) {
  if (const std::string wrong = what_is_wrong(problem); !wrong.empty() || options.segments == 0) {
    ShootingSolution none;
    none.outcome.ending = Ending::invalid_input;
    none.outcome.hint = wrong.empty() ? "at least one segment is needed" : wrong;
    return none;
  }
  return MultipleShooting(problem, options)(guess);
}

}  // namespace continuo::studies
