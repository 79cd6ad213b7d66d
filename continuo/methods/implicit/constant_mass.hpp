// The constant M of M x' = f(t, x), as implicit methods keep it: the identity, a diagonal or a matrix.
#pragma once
#include <cstddef>
#include <span>
#include <tuple>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// The number of components where the type of state fixes it.
template <State X>
[[nodiscard]] constexpr std::size_t fixed_size() {
  if constexpr (requires { std::tuple_size<X>::value; }) {
    return std::tuple_size<X>::value;
  } else {
    return run_time_size;
  }
}

template <State X>
class ConstantMass {
 public:
  using Real = Scalar<X>;
  static constexpr std::size_t N = fixed_size<X>();

  /// What the system says. Allocates.
  template <class F>
  void read(F& f, std::size_t size) {
    if (!continuo::has_mass<X>(f)) {
      kind_ = Kind::identity;
    } else if constexpr (HasMassMatrix<F, X>) {
      kind_ = Kind::matrix;
      if constexpr (N == run_time_size) entries_.resize(size * size);
      f.mass_matrix(std::span<Real>(entries_));
    } else if constexpr (HasMassDiagonal<F, X>) {
      kind_ = Kind::diagonal;
      if constexpr (N == run_time_size) entries_.resize(size);
      for (std::size_t i = 0; i < size; ++i) entries_[i] = f.mass(i);
    }
  }

  [[nodiscard]] bool is_identity() const { return kind_ == Kind::identity; }
  [[nodiscard]] bool is_matrix() const { return kind_ == Kind::matrix; }
  /// Entry i of the diagonal, where M is one; entry i of the rows, where it is a matrix.
  const Real& operator[](std::size_t i) const { return entries_[i]; }

  /// Whether row and column i are.
  [[nodiscard]] bool is_zero(std::size_t i, std::size_t size) const {
    if (kind_ != Kind::matrix) return kind_ == Kind::diagonal && entries_[i] == Real(0);
    for (std::size_t j = 0; j < size; ++j)
      if (entries_[i * size + j] != Real(0) || entries_[j * size + i] != Real(0)) return false;
    return true;
  }

  /// Empty where M is the identity.
  [[nodiscard]] std::span<const Real> diagonal() const {
    return kind_ == Kind::diagonal ? std::span<const Real>(entries_) : std::span<const Real>();
  }

  /// product = M v.
  void multiply(const X& v, X& product) const {
    const std::size_t n = dimension(v);
    if (kind_ == Kind::identity) {
      product = v;
    } else if (kind_ == Kind::diagonal) {
      for (std::size_t i = 0; i < n; ++i) product.data()[i] = entries_[i] * v.data()[i];
    } else {
      for (std::size_t i = 0; i < n; ++i) {
        Real sum(0);
        for (std::size_t j = 0; j < n; ++j) sum += entries_[i * n + j] * v.data()[j];
        product.data()[i] = sum;
      }
    }
  }

 private:
  enum class Kind { identity, diagonal, matrix };

  BlockOf<Real, N, N * N> entries_{};
  Kind kind_ = Kind::identity;
};

}  // namespace continuo
