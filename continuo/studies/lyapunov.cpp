// continuo/studies/lyapunov.cpp
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <continuo/studies/flow.hpp>
#include <continuo/studies/lyapunov.hpp>

namespace continuo::studies {

namespace {

constexpr std::size_t parts = 20;
// Between two orthogonalisations no direction may shrink against another by more than exp of this: else rounding of the
// long one covers the short one.
constexpr double most_apart = 8;

/// The logarithms of one interval, and how long it was.
struct Stretch {
  double duration;
  std::vector<double> logarithms;
};

/// The columns of z behind the state become orthonormal (Gram, Schmidt, modified); the logarithms of what each was
/// long.
std::vector<double> orthonormalise(std::vector<double>& z, std::size_t n) {
  std::vector<double> logarithms(n);
  const auto column = [&](std::size_t k) { return std::span(z).subspan(n * (1 + k), n); };
  const auto product = [](Values a, Values b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); };
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      const double share = product(column(j), column(k));
      for (std::size_t i = 0; i < n; ++i) column(k)[i] -= share * column(j)[i];
    }
    const double length = std::sqrt(product(column(k), column(k)));
    logarithms[k] = std::log(length);
    for (double& entry : column(k)) entry /= length;
  }
  return logarithms;
}

/// Mean of each exponent over the parts of the run, and the standard error of that mean.
void average(LyapunovExponents& result, const std::vector<Stretch>& stretches) {
  const std::size_t count = stretches.size();
  if (count == 0) return;
  const std::size_t n = stretches.front().logarithms.size(), groups = std::min(parts, count);
  for (const Stretch& stretch : stretches) result.averaged += stretch.duration;
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0, square = 0;
    for (const Stretch& stretch : stretches) sum += stretch.logarithms[k];
    const double mean = sum / result.averaged;
    for (std::size_t g = 0; g < groups; ++g) {
      double part = 0, duration = 0;
      for (std::size_t s = g * count / groups; s < (g + 1) * count / groups; ++s) {
        part += stretches[s].logarithms[k];
        duration += stretches[s].duration;
      }
      square += std::pow(part / duration - mean, 2);
    }
    result.exponents.push_back(mean);
    const auto of = static_cast<double>(groups);
    result.spread.push_back(groups > 1 ? std::sqrt(square / (of * (of - 1))) : std::abs(mean));
  }
}

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
    std::vector<double> after = step.final_state(), logarithms = orthonormalise(after, n);
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
