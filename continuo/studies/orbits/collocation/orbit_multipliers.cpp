// continuo/studies/orbits/collocation/orbit_multipliers.cpp
//
// Neighbours go over an interval as D' = h T J(s) D says, solved by the same collocation as the orbit, in parts short
// enough for its polynomials. At each end of an interval let f be the first column of an orthogonal matrix (a
// Householder reflection): what is carried along from f to f is then the first column of each interval's matrix, and
// the block below and to the right of it is what the others do. These blocks are never multiplied as they are, for
// along a canard a product is first 1e200 and then 1e-300: orthonormal columns are carried round until they point where
// they did (orthogonal iteration), and what remains are triangular matrices, whose product keeps the digits of small
// multipliers beside large ones. A. Bojanczyk, G. Golub, P. Van Dooren, "The periodic Schur factorization", Proc. SPIE
// 1770 (1992); T. F. Fairgrieve, A. D. Jepson, "O.K. Floquet multipliers", SIAM J. Numer. Anal. 28 (1991).
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/conservation_laws.hpp>
#include <continuo/studies/orbits/collocation/orbit_multipliers.hpp>
#include <continuo/studies/orbits/exponents/orthonormal_columns.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Columns = std::vector<double>;  // n by n, column by column

constexpr std::size_t degree = OrbitCollocation::degree;
constexpr double stretch_of_part = 2;    // |h T J| of a part; there the collocation's error is below 1e-8
constexpr std::size_t most_parts = 64;   // of an interval
constexpr std::size_t small_system = 8;  // components; for more of them an interval is one part
constexpr std::size_t most_turns = 12;   // of the orthogonal iteration
constexpr double no_cosine = 1e-9;       // what rounding leaves between directions
constexpr double greatest_exponent = 690;

/// h T J in sizes at one place, row by row.
class Stretching {
 public:
  Stretching(const ParametricSystem& system, const OrbitCollocation& orbit, std::span<const double> z,
             std::span<const double> sizes)
      : system_(system), orbit_(orbit), z_(z), sizes_(sizes), p_{orbit.constant(z)}, x_(system.size) {}

  Vector operator()(double s, double width) {
    orbit_.state(z_, s, x_);
    Vector rows = jacobian_of(system_, 0, x_, p_, sizes_);
    const std::size_t n = x_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) rows[i * n + j] *= width * orbit_.period(z_) * sizes_[j] / sizes_[i];
    return rows;
  }

 private:
  const ParametricSystem& system_;
  const OrbitCollocation& orbit_;
  std::span<const double> z_, sizes_;
  Vector p_, x_;
};

/// How the columns of D go over a part from s on.
bool carry(Stretching& stretching, double s, double width, std::size_t n, Columns& d) {
  const auto& table = OrbitCollocation::table();
  const std::size_t unknowns = degree * n;
  DenseLU<double, run_time_size> lu(unknowns);
  auto&& matrix = lu.matrix();
  Vector at_begin(unknowns * n);  // what the equations have of D at the beginning
  for (std::size_t g = 0; g < degree; ++g) {
    const Vector rows = stretching(s + table.points[g] * width, width);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < n; ++c) {
        at_begin[(g * n + i) * n + c] = (i == c ? table.slope[g][0] : 0) - table.value[g][0] * rows[i * n + c];
        for (std::size_t j = 1; j <= degree; ++j)
          matrix[(g * n + i) * unknowns + (j - 1) * n + c] =
              (i == c ? table.slope[g][j] : 0) - table.value[g][j] * rows[i * n + c];
      }
    }
  }
  if (!lu.factor()) return false;
  Vector b(unknowns);
  for (std::size_t column = 0; column < n; ++column) {
    for (std::size_t row = 0; row < unknowns; ++row) {
      b[row] = 0;
      for (std::size_t c = 0; c < n; ++c) b[row] -= at_begin[row * n + c] * d[column * n + c];
    }
    lu.solve(b.data());
    std::copy_n(b.end() - static_cast<std::ptrdiff_t>(n), n, d.begin() + static_cast<std::ptrdiff_t>(column * n));
  }
  return true;
}

/// The mirror that takes the first axis to the line of f; empty where f vanishes.
Vector mirror_of(std::span<const double> f, std::span<const double> sizes) {
  Vector mirror(f.size());
  double length = 0;
  for (std::size_t i = 0; i < f.size(); ++i) mirror[i] = f[i] / sizes[i], length += mirror[i] * mirror[i];
  length = std::sqrt(length);
  if (!(length > 0)) return {};
  for (double& part : mirror) part /= length;
  mirror[0] += mirror[0] < 0 ? -1 : 1;  // to f or -f, whichever is farther; signs are gone after a whole turn
  double square = 0;
  for (const double part : mirror) square += part * part;
  const double size = std::sqrt(square);
  for (double& part : mirror) part /= size;
  return mirror;
}
void reflect(const Vector& mirror, std::span<double> v) {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += mirror[i] * v[i];
  for (std::size_t i = 0; i < v.size(); ++i) v[i] -= 2 * sum * mirror[i];
}

/// Of each interval the block beside f, n - 1 by n - 1, row by row.
std::vector<Vector> blocks_beside_f(const ParametricSystem& system, const OrbitCollocation& orbit,
                                    std::span<const double> z, std::span<const double> sizes) {
  const std::size_t n = system.size, count = orbit.intervals();
  const Vector field = orbit.field(z);
  Stretching stretching(system, orbit, z, sizes);
  std::vector<Vector> blocks(count);
  const auto mirror_at = [&](std::size_t k) {
    return mirror_of(std::span(field).subspan(k % count * degree * n, n), sizes);
  };
  Vector before = mirror_at(0);
  for (std::size_t k = 0; k < count; ++k) {
    Vector after = mirror_at(k + 1);
    if (before.empty() || after.empty()) return {};
    const double begin = (*orbit.mesh())[k], width = (*orbit.mesh())[k + 1] - begin;
    double stretch = 0;
    for (const double s : {0.0, 0.5, 1.0}) {
      const Vector rows = stretching(begin + s * width, width);
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += std::abs(rows[i * n + j]);
        stretch = std::max(stretch, sum);
      }
    }
    const auto parts =
        n > small_system
            ? std::size_t{1}
            : static_cast<std::size_t>(std::clamp(std::ceil(stretch / stretch_of_part), 1.0, double{most_parts}));
    Columns d(n * n);
    for (std::size_t c = 0; c < n; ++c) {
      d[c * n + c] = 1;
      reflect(before, std::span(d).subspan(c * n, n));
    }
    for (std::size_t part = 0; part < parts; ++part) {
      const double of = width / static_cast<double>(parts);
      if (!carry(stretching, begin + of * static_cast<double>(part), of, n, d)) return {};
    }
    blocks[k].resize((n - 1) * (n - 1));
    for (std::size_t c = 1; c < n; ++c) {
      reflect(after, std::span(d).subspan(c * n, n));
      for (std::size_t i = 1; i < n; ++i) blocks[k][(i - 1) * (n - 1) + c - 1] = d[c * n + i];
    }
    before = std::move(after);
  }
  return blocks;
}

// With two components Liouville's formula says all: exp of the integral of the trace of df/dx.
std::vector<std::complex<double>> by_trace(const ParametricSystem& system, const OrbitCollocation& orbit,
                                           std::span<const double> z, std::span<const double> sizes) {
  Stretching stretching(system, orbit, z, sizes);
  const auto& table = OrbitCollocation::table();
  double sum = 0;
  for (std::size_t k = 0; k < orbit.intervals(); ++k) {
    const double begin = (*orbit.mesh())[k], width = (*orbit.mesh())[k + 1] - begin;
    for (std::size_t g = 0; g < degree; ++g) {
      const Vector rows = stretching(begin + width * table.points[g], width);
      sum += table.point_weights[g] * (rows[0] + rows[3]);
    }
  }
  return {std::exp(std::min(sum, greatest_exponent))};
}

/// Eigenvalues of the product of all blocks.
std::vector<std::complex<double>> of_product(const std::vector<Vector>& blocks, std::size_t n) {
  Columns q(n * n);
  for (std::size_t c = 0; c < n; ++c) q[c * n + c] = 1;
  Vector product(n * n), next(n * n), triangle(n * n);  // row by row; without its scale
  Columns begin, moved(n * n);
  double scale = 0;  // its logarithm
  for (std::size_t turn = 0; turn < most_turns; ++turn) {
    begin = q;
    std::ranges::fill(product, 0.0);
    for (std::size_t c = 0; c < n; ++c) product[c * n + c] = 1;
    scale = 0;
    for (const Vector& block : blocks) {
      for (std::size_t c = 0; c < n; ++c)
        for (std::size_t i = 0; i < n; ++i) {
          double sum = 0;
          for (std::size_t j = 0; j < n; ++j) sum += block[i * n + j] * q[c * n + j];
          moved[c * n + i] = sum;
        }
      q = moved;
      (void)orthonormalise(q, n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = i; c < n; ++c) {
          triangle[i * n + c] = 0;
          for (std::size_t j = 0; j < n; ++j) triangle[i * n + c] += q[i * n + j] * moved[c * n + j];
        }
      double largest = 0;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = i; c < n; ++c) {
          next[i * n + c] = 0;
          for (std::size_t j = i; j <= c; ++j) next[i * n + c] += triangle[i * n + j] * product[j * n + c];
          largest = std::max(largest, std::abs(next[i * n + c]));
        }
      if (!(largest > 0) || !std::isfinite(largest)) return {};
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = i; c < n; ++c) product[i * n + c] = next[i * n + c] / largest;
      scale += std::log(largest);
    }
  }
  Vector rows(n * n);  // begin^T q R: where the columns point as they did, triangular
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      double cosine = 0;
      for (std::size_t k = 0; k < n; ++k) cosine += begin[i * n + k] * q[j * n + k];
      if (i > j && std::abs(cosine) < no_cosine) continue;  // converged: small multipliers keep their digits
      for (std::size_t c = j; c < n; ++c) rows[i * n + c] += cosine * product[j * n + c];
    }
  auto values = eigenvalues(rows, n).values;
  for (auto& value : values) {
    if (value == 0.0) continue;
    const double exponent = std::log(std::abs(value)) + scale;
    value *= std::exp(std::min(exponent, greatest_exponent)) / std::abs(value);
  }
  return values;
}

}  // namespace

std::vector<std::complex<double>> multipliers_of(const ParametricSystem& system, const OrbitCollocation& orbit,
                                                 std::span<const double> z, std::span<const double> sizes) {
  if (system.size == 2 && system.conserved == 0) return by_trace(system, orbit, z, sizes);
  auto values = of_product(blocks_beside_f(system, orbit, z, sizes), system.size - 1);
  leave_out_conserved(system, std::exp(-system.conserved_rate * orbit.period(z)), values);
  sort_by_size(values);
  return values;
}

}  // namespace continuo::studies::detail
