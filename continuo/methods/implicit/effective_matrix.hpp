// continuo/methods/implicit/effective_matrix.hpp
// The matrix of an implicit step of M q'' = f(t, q, v) for the accelerations, half the size of the state:
//
//   E = m M - c df/dv - k df/dq.
//
// Dense, on the stack for states of fixed size; sparse where the Jacobian is (see Linearization).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include <continuo/methods/implicit/linearization.hpp>

namespace continuo {

template <State X>
class EffectiveMatrix {
 public:
  using Real = Scalar<X>;
  static constexpr std::size_t N = fixed_size<X>(), Half = N == run_time_size ? N : N / 2;
  struct Weights {
    Real mass, damping, stiffness;
  };

  explicit EffectiveMatrix(const X& x) : dense_(N == run_time_size ? 0 : dimension(x) / 2) {
    if constexpr (N == run_time_size) part_.resize(dimension(x) / 2);
  }

  /// Allocates; once, after Linearization::prepare.
  template <class System>
  void prepare(const System& system, const Linearization<X>& linear) {
    const std::size_t pairs = system.pair_count(linear.size());
    if constexpr (N == run_time_size) {
      if (!linear.sparse()) {
        dense_ = DenseLU<Real, Half>(pairs);
        return;
      }
    }
    if constexpr (has_sparse) prepare_sparse(system, linear, pairs);
  }

  /// For checkpoints: the matrix is decomposed again, with the same pivots and so to the same bits.
  template <class Archive>
  void transfer(Archive& archive, const Linearization<X>& linear)
    requires(N == run_time_size)
  {
    Weights weights = last_;
    archive(weights.mass, weights.damping, weights.stiffness);
    if constexpr (Archive::reads) {
      if (linear.prepared()) prepare(archive.system(), linear);
    }
    if constexpr (has_sparse) {
      if (sparse_) sparse_->transfer(archive);
    }
    if constexpr (Archive::reads) {
      if (weights.mass == Real(0) || !linear.prepared()) return;
      if (sparse_) {
        fill_sparse(archive.system(), linear, weights, part_.size());
        sparse_->factor_with_known_pivots();
        last_ = weights;
      } else {
        static_cast<void>(factor(archive.system(), linear, weights));
      }
    }
  }

  /// False where E is singular or not finite.
  template <class System>
  [[nodiscard]] bool factor(const System& system, const Linearization<X>& linear, const Weights& weights) {
    const std::size_t size = linear.size(), pairs = system.pair_count(size);
    last_ = weights;
    if constexpr (has_sparse) {
      if (sparse_) {
        fill_sparse(system, linear, weights, pairs);
        return sparse_->factor();
      }
    }
    const auto jacobian = linear.entries();
    for (std::size_t i = 0; i < pairs; ++i) {
      const std::size_t row = system.pair(i, size).velocity;
      for (std::size_t j = 0; j < pairs; ++j) {
        const PositionVelocity column = system.pair(j, size);
        dense_.matrix()[i * pairs + j] = weights.mass * linear.mass(row, column.velocity) -
                                         weights.damping * jacobian[row * size + column.velocity] -
                                         weights.stiffness * jacobian[row * size + column.position];
      }
    }
    return dense_.factor();
  }

  /// b, at the places of the velocities, becomes the solution.
  template <class System>
  void solve(const System& system, X& b) {
    const std::size_t size = dimension(b), pairs = system.pair_count(size);
    for (std::size_t i = 0; i < pairs; ++i) part_[i] = b.data()[system.pair(i, size).velocity];
    if constexpr (has_sparse) {
      if (sparse_) sparse_->solve(part_.data());
    }
    if (!sparse_) dense_.solve(part_.data());
    for (std::size_t i = 0; i < pairs; ++i) b.data()[system.pair(i, size).velocity] = part_[i];
  }

 private:
  static constexpr bool has_sparse = N == run_time_size && std::same_as<Real, double>;

  // Where an entry of the Jacobian goes in E, and whether it is one of df/dv.
  struct Target {
    std::size_t entry;
    bool damping;
  };
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

  template <class System>
  void prepare_sparse(const System& system, const Linearization<X>& linear, std::size_t pairs) {
    const SparsePattern& pattern = linear.pattern();
    std::vector<std::uint32_t> pair_of(linear.size());
    std::vector<char> is_velocity(linear.size(), 0);
    for (std::size_t i = 0; i < pairs; ++i) {
      const auto [position, velocity] = system.pair(i, linear.size());
      pair_of[position] = pair_of[velocity] = static_cast<std::uint32_t>(i);
      is_velocity[velocity] = 1;
    }
    const auto for_each_entry = [&](auto&& visit) {
      for (std::size_t column = 0; column < linear.size(); ++column)
        for (std::size_t p = pattern.begin(column); p < pattern.end(column); ++p)
          if (is_velocity[pattern.row(p)]) visit(p, MatrixPlace{pair_of[pattern.row(p)], pair_of[column]}, column);
    };
    std::vector<MatrixPlace> places;
    for_each_entry([&](std::size_t, MatrixPlace place, std::size_t) { places.push_back(place); });
    pattern_ = SparsePattern(pairs, places);
    sparse_.emplace(pattern_, linear.sparse_solver());
    targets_.assign(pattern.entries(), {nowhere, false});
    for_each_entry([&](std::size_t p, MatrixPlace place, std::size_t column) {
      targets_[p] = {pattern_.find(place.row, place.column), is_velocity[column] != 0};
    });
  }

  template <class System>
  void fill_sparse(const System& system, const Linearization<X>& linear, const Weights& weights, std::size_t pairs) {
    const auto values = sparse_->values();
    for (double& value : values) value = 0;
    for (std::size_t p = 0; p < targets_.size(); ++p) {
      if (targets_[p].entry == nowhere) continue;
      values[targets_[p].entry] -= (targets_[p].damping ? weights.damping : weights.stiffness) * linear.entry(p);
    }
    for (std::size_t i = 0; i < pairs; ++i) {  // a mass matrix beside a sparse Jacobian is diagonal
      const std::size_t row = system.pair(i, linear.size()).velocity;
      values[pattern_.find(i, i)] += weights.mass * linear.mass(row, row);
    }
  }

  struct None {};
  Weights last_{};
  DenseLU<Real, Half> dense_;
  std::optional<std::conditional_t<has_sparse, SparseLU<double>, None>> sparse_;
  SparsePattern pattern_;
  std::vector<Target> targets_;
  BlockOf<Real, Half, Half> part_{};
};

}  // namespace continuo
