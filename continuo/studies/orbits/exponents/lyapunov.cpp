// continuo/studies/orbits/exponents/lyapunov.cpp
// Integrates the variational equations and averages the growth of their columns.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <continuo/studies/lyapunov.hpp>
#include <continuo/studies/orbits/exponents/orthonormal_columns.hpp>
#include <continuo/studies/support/flow.hpp>

namespace continuo::studies {

namespace {

// Between two orthogonalisations no direction may shrink against another by more than exp of this: else rounding of the
// long one covers the short one.
constexpr double most_apart = 8;

}  // namespace

LyapunovExponents lyapunov_exponents(const ParametricSystem& system, std::vector<double> x0,
                                     const LyapunovOptions& options) {
  LyapunovExponents result;
  const std::size_t n = system.size;
  Options<std::vector<double>> run{.rtol = options.rtol, .atol = options.atol};
  run.save = Save<std::vector<double>>::only_end();
  run.interrupt = options.interrupt;
  const auto settled = run_flow(system, system.constants, std::move(x0), {0, options.settle}, run);
  result.outcome = settled.outcome;
  if (!settled.outcome) return result;
  const ParametricSystem varied = with_variations(system);
  std::vector<double> z = variational_start(system, settled.final_state());
  std::vector<Stretch> stretches;
  double interval = options.interval / 64;
  for (double done = 0; done < options.duration;) {
    const double from = options.settle + done, length = std::min(interval, options.duration - done);
    const auto step = run_flow(varied, system.constants, z, {from, from + length}, run);
    result.outcome = step.outcome;
    if (!step.outcome) break;
    std::vector<double> after = step.final_state();
    std::vector<double> logarithms = orthonormalise(std::span(after).subspan(n), n);
    const auto [least, most] = std::ranges::minmax(logarithms);
    if (most - least > 2 * most_apart && interval > 1e-9 * options.interval) {  // too far apart to be measured: again
      interval /= 4;
      continue;
    }
    if (most - least > most_apart) interval /= 1.5;
    if (most - least < most_apart / 2) interval = std::min(1.5 * interval, options.interval);
    z = std::move(after);
    stretches.push_back({length, std::move(logarithms)});
    done += length;
    if (options.progress) options.progress(from + length);
  }
  average(result, stretches);
  return result;
}

}  // namespace continuo::studies
