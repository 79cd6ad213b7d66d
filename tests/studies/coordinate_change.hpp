// tests/studies/coordinate_change.hpp
// Systems in other coordinates: x = o + S(A y), S adding to each component a square of the one before, and constants m
// = R (p - p0). Their bifurcations are those of the system in y and m; their equations look different.
#pragma once
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

template <std::size_t N>
class CoordinateChange {
 public:
  template <class T>
  using State = std::array<T, N>;

  explicit CoordinateChange(unsigned seed) {
    std::mt19937 random(seed);
    const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    for (std::size_t i = 0; i < N; ++i) {
      origin_[i] = 2 * number();
      shear_[i] = 0.5 * number();
      for (std::size_t j = 0; j < N; ++j) a_[i][j] = (i == j ? 1.5 : 0) + 0.5 * number();
    }
    invert();
    const double turn = 3 * number(), size = 1 + 0.4 * number(), skew = 0.3 * number();
    r_ = {{{size * std::cos(turn), -std::sin(turn)}, {std::sin(turn) + skew * std::cos(turn), std::cos(turn)}}};
    for (double& value : centre_) value = number();
  }

  /// The constants m of the normal form.
  std::array<double, 2> constants(const std::array<double, 2>& p) const {
    const double u = p[0] - centre_[0], v = p[1] - centre_[1];
    return {r_[0][0] * u + r_[0][1] * v, r_[1][0] * u + r_[1][1] * v};
  }
  std::array<double, 2> outside(const std::array<double, 2>& m) const {
    const double whole = r_[0][0] * r_[1][1] - r_[0][1] * r_[1][0];
    return {centre_[0] + (r_[1][1] * m[0] - r_[0][1] * m[1]) / whole,
            centre_[1] + (-r_[1][0] * m[0] + r_[0][0] * m[1]) / whole};
  }
  template <class T>
  State<T> back(const State<T>& x) const {
    State<T> z{}, y{};
    for (std::size_t i = 0; i < N; ++i) {
      z[i] = x[i] - origin_[i];
      if (i > 0) z[i] -= shear_[i] * z[i - 1] * z[i - 1];
    }
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j) y[i] += inverse_[i][j] * z[j];
    return y;
  }
  template <class T>
  State<T> place(const State<T>& y) const {
    State<T> z{}, x{};
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j) z[i] += a_[i][j] * y[j];
    for (std::size_t i = 0; i < N; ++i) x[i] = origin_[i] + z[i] + (i > 0 ? shear_[i] * z[i - 1] * z[i - 1] : T(0));
    return x;
  }
  /// dx/dt of dy/dt = g at y.
  template <class T>
  State<T> forth(const State<T>& y, const State<T>& g) const {
    State<T> z{}, dz{}, out{};
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j) z[i] += a_[i][j] * y[j], dz[i] += a_[i][j] * g[j];
    for (std::size_t i = 0; i < N; ++i) out[i] = dz[i] + (i > 0 ? 2 * shear_[i] * z[i - 1] * dz[i - 1] : T(0));
    return out;
  }
  /// The length of the image of the k-th axis of y at the origin.
  double length(std::size_t k) const {
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) sum += a_[i][k] * a_[i][k];
    return std::sqrt(sum);
  }

  /// dy/dt = g(y, m), g for any number; df/dx by a step along the imaginary axis, exact to rounding.
  template <class G>
  ParametricSystem system(G g) const {
    const auto of = [change = *this, g](const auto& x, Values p) {
      const auto y = change.back(x);
      return change.forth(y, g(y, change.constants({p[0], p[1]})));
    };
    auto result = parametric_system(N,
                                    [of](double, Values x, Values p, std::span<double> out) {
                                      State<double> at{};
                                      std::copy_n(x.begin(), N, at.begin());
                                      const auto f = of(at, p);
                                      std::copy(f.begin(), f.end(), out.begin());
                                    },
                                    {0, 0});
    result.jacobian = [of](double, Values x, Values p, std::span<double> rows) {
      for (std::size_t j = 0; j < N; ++j) {
        State<std::complex<double>> moved{};
        std::copy_n(x.begin(), N, moved.begin());
        moved[j] += std::complex<double>(0, 1e-40);
        const auto f = of(moved, p);
        for (std::size_t i = 0; i < N; ++i) rows[i * N + j] = f[i].imag() / 1e-40;
      }
    };
    return result;
  }

 private:
  void invert() {  // Gauss and Jordan; A is well conditioned
    auto a = a_;
    for (std::size_t i = 0; i < N; ++i) inverse_[i][i] = 1;
    for (std::size_t k = 0; k < N; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k; i < N; ++i)
        if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
      std::swap(a[k], a[pivot]);
      std::swap(inverse_[k], inverse_[pivot]);
      const double size = a[k][k];
      for (std::size_t j = 0; j < N; ++j) a[k][j] /= size, inverse_[k][j] /= size;
      for (std::size_t i = 0; i < N; ++i) {
        if (i == k) continue;
        const double factor = a[i][k];
        for (std::size_t j = 0; j < N; ++j) a[i][j] -= factor * a[k][j], inverse_[i][j] -= factor * inverse_[k][j];
      }
    }
  }

  std::array<double, N> origin_{}, shear_{};
  std::array<std::array<double, N>, N> a_{}, inverse_{};
  std::array<std::array<double, 2>, 2> r_{};
  std::array<double, 2> centre_{};
};

}  // namespace continuo::studies
