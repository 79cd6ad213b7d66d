// continuo/studies/orbit_shooting.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/flow.hpp>
#include <continuo/studies/orbit_shooting.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr std::size_t most_points = 8, least_points = 4;
constexpr std::size_t unknowns_wanted = 400;  // so many at most, where that leaves the least number of points
constexpr std::size_t samples_of_step = 8;    // of the integration, in which extremes are looked for

/// The same system of one of its constants, whose derivative is always given.
ParametricSystem with_one_constant(const ParametricSystem& system, std::size_t constant, double size) {
  const std::size_t n = system.size, m = system.parameters();
  ParametricSystem one{.size = n, .constants = {system.constants[constant]}};
  one.names = system.names;
  one.constant_names = {system.constant_name(constant)};
  one.pattern = system.pattern;
  const auto all = [p = std::make_shared<Vector>(system.constants), constant](Values q) -> Values {
    (*p)[constant] = q[0];
    return *p;
  };
  one.derivative = [system, all](double t, Values x, Values q, std::span<double> dxdt) {
    system.derivative(t, x, all(q), dxdt);
  };
  if (system.jacobian)
    one.jacobian = [system, all](double t, Values x, Values q, std::span<double> entries) {
      system.jacobian(t, x, all(q), entries);
    };
  if (system.constant_jacobian) {
    one.constant_jacobian = [=](double t, Values x, Values q, std::span<double> column) {
      Vector rows(n * m);
      system.constant_jacobian(t, x, all(q), rows);
      for (std::size_t i = 0; i < n; ++i) column[i] = rows[i * m + constant];
    };
  } else {
    one.constant_jacobian = [plain = one, size](double t, Values x, Values q, std::span<double> column) {
      std::ranges::copy(constant_jacobian_of(plain, t, x, q, std::array{size}), column.begin());
    };
  }
  return one;
}

/// b = a b, both n * n row by row.
void multiply_from_left(const Vector& a, Vector& b, std::size_t n) {
  Vector product(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j) product[i * n + j] += a[i * n + k] * b[k * n + j];
  b = std::move(product);
}

/// Of even samples of a smooth curve: the greatest value of the parabolas through three neighbours each.
double greatest(std::span<const double> samples) {
  double result = std::max(samples.front(), samples.back());
  for (std::size_t s = 1; s + 1 < samples.size(); ++s) {
    result = std::max(result, samples[s]);
    const double curvature = samples[s - 1] - 2 * samples[s] + samples[s + 1];
    const double slope = (samples[s + 1] - samples[s - 1]) / 2;
    if (curvature < 0 && std::abs(slope) <= -curvature)  // the top lies between the three
      result = std::max(result, samples[s] - slope * slope / (2 * curvature));
  }
  return result;
}

}  // namespace

void sort_by_size(std::vector<std::complex<double>>& values) {
  std::ranges::sort(values, [](const auto& a, const auto& b) {
    return std::pair(std::abs(a), a.imag()) > std::pair(std::abs(b), b.imag());
  });
}

OrbitShooting::OrbitShooting(const ParametricSystem& system, std::size_t constant, double constant_size, double rtol,
                             const std::atomic<bool>* interrupt)
    : system_(with_one_constant(system, constant, constant_size)),
      varied_(with_variations(system_, true)),
      n_(system.size),
      points_(std::clamp(unknowns_wanted / system.size, least_points, most_points)),
      constant_size_(constant_size),
      rtol_(rtol),
      residuals_(equations()) {
  plain_run_.rtol = run_.rtol = rtol;
  plain_run_.interrupt = run_.interrupt = interrupt;
  plain_run_.save = run_.save = Save<Vector>::only_end();
  set_sizes(Vector(n_, 1.0));
}

void OrbitShooting::set_sizes(std::vector<double> sizes) {
  sizes_ = std::move(sizes);
  plain_run_.atol_each.resize(n_);
  run_.atol_each.resize(varied_.size);
  for (std::size_t i = 0; i < n_; ++i) {
    plain_run_.atol_each[i] = run_.atol_each[i] = 1e-3 * rtol_ * sizes_[i];
    for (std::size_t j = 0; j < n_; ++j) run_.atol_each[n_ * (1 + j) + i] = rtol_ * sizes_[i] / sizes_[j];
    run_.atol_each[n_ * (1 + n_) + i] = rtol_ * sizes_[i] / constant_size_;
  }
}

bool OrbitShooting::evaluate(std::span<const double> z) {
  const std::size_t width = unknowns();
  const double duration = period(z) / static_cast<double>(points_);
  if (!(duration > 0) || !std::isfinite(duration)) return false;
  const Vector p{constant(z)};
  rows_.assign(equations() * width, 0.0);
  monodromy_.assign(n_ * n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i) monodromy_[i * n_ + i] = 1;
  Vector field(n_), part(n_ * n_);
  for (std::size_t k = 0; k < points_; ++k) {
    const std::span<const double> from = z.subspan(k * n_, n_), to = z.subspan((k + 1) % points_ * n_, n_);
    const auto run = run_flow(varied_, p, variational_start(system_, from, true), {0, duration}, run_);
    if (!run.outcome) return false;
    const Vector& end = run.final_state();
    system_.derivative(0, std::span(end).first(n_), p, field);
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t row = k * n_ + i;
      residuals_[row] = end[i] - to[i];
      for (std::size_t j = 0; j < n_; ++j) rows_[row * width + k * n_ + j] = part[i * n_ + j] = end[n_ * (1 + j) + i];
      rows_[row * width + (k + 1) % points_ * n_ + i] -= 1;
      rows_[row * width + width - 2] = field[i] / static_cast<double>(points_);
      rows_[row * width + width - 1] = end[n_ * (1 + n_) + i];
    }
    multiply_from_left(part, monodromy_, n_);
  }
  return std::ranges::all_of(rows_, [](double entry) { return std::isfinite(entry); });
}

std::vector<double> OrbitShooting::field(std::span<const double> z) const {
  Vector result(equations());
  const Vector p{constant(z)};
  for (std::size_t k = 0; k < points_; ++k)
    system_.derivative(0, z.subspan(k * n_, n_), p, std::span(result).subspan(k * n_, n_));
  return result;
}

// In sizes of the components let f be the first column of an orthogonal matrix Q, a Householder reflection. M f = f, so
// the first column of Q M Q is that of the identity, and the block below and to the right of it has the other
// eigenvalues of M, exactly: nothing has to be told from the eigenvalue 1.
std::vector<std::complex<double>> OrbitShooting::multipliers(std::span<const double> field_at_first) const {
  Vector mirror(n_), b(monodromy_);
  double length = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    mirror[i] = field_at_first[i] / sizes_[i];
    length += mirror[i] * mirror[i];
    for (std::size_t j = 0; j < n_; ++j) b[i * n_ + j] *= sizes_[j] / sizes_[i];
  }
  length = std::sqrt(length);
  if (!(length > 0)) return {};
  for (double& part : mirror) part /= length;
  mirror[0] += mirror[0] < 0 ? -1 : 1;
  double square = 0;
  for (const double part : mirror) square += part * part;
  const auto reflect = [&](std::size_t first, std::size_t stride) {  // v - 2 (m . v) m / m^2
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) sum += mirror[i] * b[first + i * stride];
    for (std::size_t i = 0; i < n_; ++i) b[first + i * stride] -= 2 * sum / square * mirror[i];
  };
  for (std::size_t j = 0; j < n_; ++j) reflect(j, n_);
  for (std::size_t i = 0; i < n_; ++i) reflect(i * n_, 1);
  Vector others((n_ - 1) * (n_ - 1));
  for (std::size_t i = 1; i < n_; ++i)
    for (std::size_t j = 1; j < n_; ++j) others[(i - 1) * (n_ - 1) + j - 1] = b[i * n_ + j];
  auto values = eigenvalues(others, n_ - 1).values;
  // What the errors of the integration leave of one that is small beside the largest says nothing.
  double largest = 1;
  for (const auto& value : values) largest = std::max(largest, std::abs(value));
  for (auto& value : values)
    if (std::abs(value) < 10 * rtol_ * largest) value = 0;
  sort_by_size(values);
  return values;
}

OrbitShooting::Extremes OrbitShooting::extremes(std::span<const double> z) const {
  const double infinity = std::numeric_limits<double>::infinity();
  Extremes found{Vector(n_, infinity), Vector(n_, -infinity)};
  const Vector p{constant(z)};
  Options<Vector> run = plain_run_;
  run.save = Save<Vector>::dense();
  Vector samples(samples_of_step + 1);
  std::vector<Vector> states(samples_of_step + 1, Vector(n_));
  for (std::size_t k = 0; k < points_; ++k) {
    const auto from = z.subspan(k * n_, n_);
    const auto motion =
        run_flow(system_, p, Vector(from.begin(), from.end()), {0, period(z) / static_cast<double>(points_)}, run);
    for (const auto& step : motion.segments) {
      for (std::size_t s = 0; s <= samples_of_step; ++s)
        step(step.begin + (step.end - step.begin) * static_cast<double>(s) / samples_of_step, states[s]);
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t s = 0; s <= samples_of_step; ++s) samples[s] = states[s][i];
        found.high[i] = std::max(found.high[i], greatest(samples));
        for (double& value : samples) value = -value;
        found.low[i] = std::min(found.low[i], -greatest(samples));
      }
    }
  }
  return found;
}

}  // namespace continuo::studies::detail
