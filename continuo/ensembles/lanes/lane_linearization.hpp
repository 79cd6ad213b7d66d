// J and the decomposed c - J of W runs at once, one per lane, where the stages of a Rosenbrock method look for those of
// one run. There is no mass matrix.
#pragma once
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include <continuo/ensembles/lanes/lane_lu.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/numerics/lanes.hpp>

namespace continuo {

namespace detail {

template <class X>
concept LaneState = State<X> && requires { requires std::same_as<Scalar<X>, Lanes<double, Scalar<X>::width>>; };

}  // namespace detail

/// J of each lane.
template <State X>
  requires detail::LaneState<X>
class Linearization<X> {
 public:
  using Wide = Scalar<X>;
  static constexpr std::size_t N = fixed_size<X>();

  /// For states like this one; J is 0.
  explicit Linearization(const X& x) : size_(dimension(x)) {
    if constexpr (N == run_time_size) rows_.assign(size_ * size_, Wide(0.0));
  }
  /// The number of components.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// J row by row.
  /// @{
  [[nodiscard]] std::span<Wide> entries() { return rows_; }
  [[nodiscard]] std::span<const Wide> entries() const { return rows_; }
  /// @}
  /// What the stages of a method ask for: there is no mass matrix.
  /// @{
  [[nodiscard]] static constexpr bool has_mass() { return false; }
  [[nodiscard]] static constexpr bool is_without_mass(std::size_t) { return false; }
  static void multiply_mass(const X& v, X& product) { product = v; }
  /// @}

 private:
  std::size_t size_;
  BlockOf<Wide, N, N * N> rows_{};
};

/// c - J of each lane, decomposed.
template <State X>
  requires detail::LaneState<X>
class Factorization<X, Scalar<X>> {
 public:
  using Wide = Scalar<X>;
  using Mask = typename Wide::Mask;
  static constexpr std::size_t N = fixed_size<X>();

  /// For states like this one.
  explicit Factorization(const X& x) : lu_(is_plain(x) ? 0 : dimension(x)) {
    if constexpr (N == run_time_size) {
      if (is_plain(x)) plain_.emplace(dimension(x));
    }
  }
  /// A run begins in this lane: nothing is known of its matrices.
  void begin_run(std::size_t lane) {
    if constexpr (N == run_time_size) {
      if (plain_) return;
    }
    lu_.begin_run(lane);
  }

  /// Decomposes c - J. Returns the lanes in which it is regular.
  [[nodiscard]] Mask factor(const Linearization<X>& linear, const Wide& c) {
    if constexpr (N == run_time_size) {
      if (plain_) return factor(linear, c, *plain_);
    }
    return factor(linear, c, lu_);
  }
  /// b becomes the solution, in the lanes that are regular.
  [[gnu::always_inline]] void solve(const Linearization<X>&, Wide* b) {
    if constexpr (N == run_time_size) {
      if (plain_) return plain_->solve(b);
    }
    lu_.solve(b);
  }

 private:
  using Plain = detail::PlainLaneLU<Wide>;
  struct None {};
  [[nodiscard]] static bool is_plain(const X& x) { return N == run_time_size && dimension(x) <= Plain::greatest_size; }
  template <class LU>
  [[nodiscard]] static Mask factor(const Linearization<X>& linear, const Wide& c, LU& lu) {
    const std::size_t n = linear.size();
    Wide* const matrix = lu.matrix();
    for (std::size_t i = 0; i < n * n; ++i) matrix[i] = -linear.entries()[i];
    for (std::size_t i = 0; i < n; ++i) matrix[i * n + i] += c;
    return lu.factor();
  }

  std::conditional_t<N <= greatest_small_size, detail::SmallLaneLU<Wide, N>, detail::ApartLaneLU<Wide, N>> lu_;
  [[no_unique_address]] std::conditional_t<N == run_time_size, std::optional<Plain>, None> plain_;
};

}  // namespace continuo
