// continuo/studies/orbits/collocation/orbit_collocation.cpp
// The equations of collocation for a closed orbit, and their derivatives.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/finite.hpp>
#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;

constexpr std::size_t least_intervals = 10;
constexpr std::size_t samples_of_interval = 12;  // in which extremes are looked for

}  // namespace

void sort_by_size(std::vector<std::complex<double>>& values) {
  std::ranges::sort(values, [](const auto& a, const auto& b) {
    return std::pair(std::abs(a), a.imag()) > std::pair(std::abs(b), b.imag());
  });
}

ParametricSystem with_one_constant(const ParametricSystem& system, std::size_t constant, double size) {
  const std::size_t n = system.size, m = system.parameters();
  ParametricSystem one{.size = n, .constants = {system.constants[constant]}};
  one.names = system.names;
  one.constant_names = {system.constant_name(constant)};
  one.pattern = system.pattern;
  one.advance = system.advance;
  one.conserved = system.conserved;
  one.conserved_rate = system.conserved_rate;
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

const GaussCollocation<OrbitCollocation::degree>& OrbitCollocation::table() {
  static const auto table = make_gauss_collocation<degree>();
  return table;
}

OrbitCollocation::OrbitCollocation(const ParametricSystem& system, std::shared_ptr<const OrbitMesh> mesh)
    : system_(system),
      mesh_(std::move(mesh)),
      n_(system.size),
      residuals_(nodes() * n_),
      f_(nodes() * n_),
      jacobians_(nodes() * n_ * n_),
      by_constant_(nodes() * n_),
      equations_(n_, (degree - 1) * n_, intervals()) {}

double OrbitCollocation::place(std::size_t node) const {
  const std::size_t k = node / degree;
  return (*mesh_)[k] + table().nodes[node % degree] * ((*mesh_)[k + 1] - (*mesh_)[k]);
}
double OrbitCollocation::weight(std::size_t node) const {
  const auto width = [&](std::size_t k) { return (*mesh_)[k + 1] - (*mesh_)[k]; };
  const std::size_t k = node / degree, j = node % degree;
  if (j > 0) return table().weights[j] * width(k);
  return table().weights[0] * width(k) + table().weights[degree] * width(k > 0 ? k - 1 : intervals() - 1);
}

void OrbitCollocation::state(std::span<const double> z, double s, std::span<double> x) const {
  const auto after = std::upper_bound(mesh_->begin() + 1, mesh_->end() - 1, s);
  const auto k = static_cast<std::size_t>(after - mesh_->begin()) - 1;
  const auto basis = table().basis((s - (*mesh_)[k]) / ((*mesh_)[k + 1] - (*mesh_)[k]));
  std::ranges::fill(x, 0.0);
  for (std::size_t j = 0; j <= degree; ++j) {
    for (std::size_t i = 0; i < n_; ++i) x[i] += basis[j] * value(z, k * degree + j, i);
  }
}

bool OrbitCollocation::evaluate(std::span<const double> z, std::span<const double> sizes) {
  period_ = period(z);
  if (!(period_ > 0) || !std::isfinite(period_)) return false;
  const Vector p{constant(z)};
  Vector x(n_), slope(n_);
  for (std::size_t k = 0; k < intervals(); ++k) {
    const double h = (*mesh_)[k + 1] - (*mesh_)[k];
    for (std::size_t g = 0; g < degree; ++g) {
      const std::size_t at = k * degree + g;
      std::ranges::fill(x, 0.0);
      std::ranges::fill(slope, 0.0);
      for (std::size_t j = 0; j <= degree; ++j) {
        for (std::size_t i = 0; i < n_; ++i) {
          const double there = value(z, k * degree + j, i);
          x[i] += table().value[g][j] * there;
          slope[i] += table().slope[g][j] * there;
        }
      }
      const auto f = std::span(f_).subspan(at * n_, n_);
      system_.derivative(0, x, p, f);
      system_.constant_jacobian(0, x, p, std::span(by_constant_).subspan(at * n_, n_));
      std::ranges::copy(jacobian_of(system_, 0, x, p, sizes),
                        jacobians_.begin() + static_cast<std::ptrdiff_t>(at * n_ * n_));
      for (std::size_t i = 0; i < n_; ++i) residuals_[at * n_ + i] = slope[i] - h * period_ * f[i];
    }
  }
  return all_finite(residuals_) && all_finite(jacobians_) && all_finite(by_constant_);
}

bool OrbitCollocation::solve(std::span<const double> scale, std::span<const double> sizes,
                             std::span<const double> shift, std::span<const double> last, std::span<double> b) {
  const std::size_t states = nodes() * n_, interior = (degree - 1) * n_, width = equations_.width();
  for (std::size_t k = 0; k < intervals(); ++k) {
    const double h = (*mesh_)[k + 1] - (*mesh_)[k];
    const auto link = equations_.link(k);
    for (std::size_t g = 0; g < degree; ++g) {
      const std::size_t at = k * degree + g;
      for (std::size_t i = 0; i < n_; ++i) {
        const auto row = link.subspan((g * n_ + i) * width, width);
        const double* by_state = jacobians_.data() + (at * n_ + i) * n_;
        for (std::size_t j = 0; j <= degree; ++j) {
          // The nodes inside come first, then both ends.
          const std::size_t first = j == 0 ? interior : j == degree ? interior + n_ : (j - 1) * n_;
          const std::size_t column = (k * degree + j) * n_ % states;
          const double factor = h * period_ * table().value[g][j];
          for (std::size_t c = 0; c < n_; ++c)
            row[first + c] = ((i == c ? table().slope[g][j] : 0) - factor * by_state[c]) * scale[column + c] / sizes[i];
        }
        const auto end = row.last(3);
        end[0] = -h * f_[at * n_ + i] * scale[states] / sizes[i];
        end[1] = -h * period_ * by_constant_[at * n_ + i] * scale[states + 1] / sizes[i];
        end[2] = b[at * n_ + i];
      }
    }
  }
  std::ranges::copy(shift, equations_.border(0).begin());
  std::ranges::copy(last, equations_.border(1).begin());
  return equations_.solve(b[states], b[states + 1], b);
}

std::vector<double> OrbitCollocation::field(std::span<const double> z) const {
  Vector result(nodes() * n_);
  const Vector p{constant(z)};
  for (std::size_t k = 0; k < nodes(); ++k) system_.derivative(0, node(z, k), p, std::span(result).subspan(k * n_, n_));
  return result;
}

// The m-th derivatives of neighbouring polynomials give the (m+1)-th between them (de Boor 1973).
std::vector<double> OrbitCollocation::errors(std::span<const double> z, std::span<const double> sizes,
                                             bool is_open) const {
  const std::size_t count = intervals();
  Vector highest(count * n_), result(count, 0.0);
  const auto width = [&](std::size_t k) { return (*mesh_)[k + 1] - (*mesh_)[k]; };
  // Times the m-th power of the interval's width, which may be tiny.
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t j = 0; j <= degree; ++j)
      for (std::size_t i = 0; i < n_; ++i)
        highest[k * n_ + i] += table().highest[j] * value(z, k * degree + j, i) / sizes[i];
  for (std::size_t k = 0; k + (is_open ? 1 : 0) < count; ++k) {
    const std::size_t next = (k + 1) % count;
    const double ratio = width(k) / width(next), middle = (width(k) + width(next)) / 2;
    for (std::size_t i = 0; i < n_; ++i) {
      // h_k^(m+1) x^(m+1), and the same in the widths of the next one.
      const double here =
          std::abs(highest[next * n_ + i] * std::pow(ratio, degree) - highest[k * n_ + i]) * width(k) / middle;
      const double there =
          std::abs(highest[next * n_ + i] - highest[k * n_ + i] * std::pow(1 / ratio, degree)) * width(next) / middle;
      result[k] = std::max(result[k], table().error_constant * here);
      result[next] = std::max(result[next], table().error_constant * there);
    }
  }
  return result;
}

// An interval's error is (width * density)^(m+1), so that the density's integral is to be the same over each.
std::shared_ptr<const OrbitMesh> OrbitCollocation::better_mesh(std::span<const double> errors, double wanted,
                                                               std::size_t most) const {
  constexpr double safety = 1.4, evenness = 0.15;
  const std::size_t count = intervals();
  Vector parts(count);
  for (std::size_t k = 0; k < count; ++k) parts[k] = std::pow(errors[k] / wanted, 1.0 / (degree + 1));
  double sum = 0;
  for (const double part : parts) sum += part;
  // No interval is much wider than if all were of one width, and none much wider than its neighbours' densities say.
  Vector smooth(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double width = (*mesh_)[k + 1] - (*mesh_)[k];
    const std::size_t before = k > 0 ? k - 1 : count - 1, next = (k + 1) % count;
    smooth[k] = (parts[before] + 2 * parts[k] + parts[next]) / 4 + evenness * std::max(sum, 1.0) * width;
  }
  double whole = 0;
  for (const double part : smooth) whole += part;
  const auto wished = static_cast<std::size_t>(std::min(std::ceil(safety * whole), 1e9));
  const std::size_t chosen = std::clamp(wished, least_intervals, most);
  auto mesh = std::make_shared<OrbitMesh>();
  mesh->push_back(0);
  double passed = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double begin = (*mesh_)[k], width = (*mesh_)[k + 1] - begin;
    for (;;) {
      const double goal = whole * static_cast<double>(mesh->size()) / static_cast<double>(chosen);
      if (mesh->size() >= chosen || goal > passed + smooth[k]) break;
      mesh->push_back(begin + width * (goal - passed) / smooth[k]);
    }
    passed += smooth[k];
  }
  mesh->push_back(1);
  return mesh;
}

// Of each component the samples next to a greatest or least one, then the top of the polynomial between them.
OrbitCollocation::Extremes OrbitCollocation::extremes(std::span<const double> z) const {
  const double infinity = std::numeric_limits<double>::infinity();
  Extremes found{Vector(n_, infinity), Vector(n_, -infinity)};
  static const auto bases = [] {
    std::array<std::array<double, degree + 1>, samples_of_interval + 1> all{};
    for (std::size_t s = 0; s <= samples_of_interval; ++s)
      all[s] = table().basis(static_cast<double>(s) / samples_of_interval);
    return all;
  }();
  for (std::size_t k = 0; k < intervals(); ++k) {
    for (std::size_t i = 0; i < n_; ++i) {
      const auto value_by = [&](const std::array<double, degree + 1>& basis) {
        double sum = 0;
        for (std::size_t j = 0; j <= degree; ++j) sum += basis[j] * value(z, k * degree + j, i);
        return sum;
      };
      std::array<double, samples_of_interval + 1> samples{};
      for (std::size_t s = 0; s <= samples_of_interval; ++s) {
        samples[s] = value_by(bases[s]);
        found.low[i] = std::min(found.low[i], samples[s]);
        found.high[i] = std::max(found.high[i], samples[s]);
      }
      for (std::size_t s = 1; s < samples_of_interval; ++s) {
        const double left = samples[s - 1] - samples[s], right = samples[s + 1] - samples[s];
        if (left * right < 0 || left + right == 0) continue;
        // The top of the parabola; where a function is flat an error of the place says nothing of the value.
        double theta = static_cast<double>(s) + (left - right) / (2 * (left + right));
        const double top = value_by(table().basis(theta / samples_of_interval));
        found.low[i] = std::min(found.low[i], top);
        found.high[i] = std::max(found.high[i], top);
      }
    }
  }
  return found;
}

}  // namespace continuo::studies::detail
