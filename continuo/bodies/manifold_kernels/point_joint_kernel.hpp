// The kernel that solves point joints, one in each lane: all directions of a joint at once, softly while positions are
// corrected, and rigidly when the velocity that this gave is removed (E. Catto, "Solver2D", 2024). It is compiled for
// registers of several widths, and its source is included nowhere else.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/manifold_kernels/manifold_kernel.hpp>
#include <continuo/bodies/manifold_kernels/point_joint_layout.hpp>

namespace continuo {

/// How far bodies have moved since the step began, and by how much that has turned an arm.
template <class L, int Dim>
struct LaneTurn {
  using Real = typename L::value_type;
  using V = Vector<L, Dim>;
  V moved;
  std::array<L, Dim == 2 ? 2 : 4> turn;  // as in SolverState

  [[gnu::always_inline]] static LaneTurn load(const SolverState<Real, Dim>* bodies, const std::uint32_t* numbers) {
    constexpr std::size_t at = Dim == 2 ? 1 : 2;
    const auto place =
        LaneQuads<L>::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[at]; });
    LaneTurn all;
    for (std::size_t i = 0; i < Dim; ++i) all.moved[i] = place[i];
    if constexpr (Dim == 2) {
      all.turn = {place[2], place[3]};
    } else {
      all.turn = LaneQuads<L>::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[3]; });
    }
    return all;
  }
  /// R r - r.
  [[gnu::always_inline]] V change_of(const V& arm) const {
    if constexpr (Dim == 2) {
      const L sine = turn[0], versine = turn[1];
      return {{L(Real(0)) - (versine * arm[0] + sine * arm[1]), sine * arm[0] - versine * arm[1]}};
    } else {
      const V u{{turn[0], turn[1], turn[2]}}, across = turning(u, arm);
      return (turning(u, across) + across * turn[3]) * L(Real(2));
    }
  }
};

template <class L, int Dim>
class PointJointBatch : BatchOfConstraints<L, Dim, PointJointLayout<Dim>> {
  using Base = BatchOfConstraints<L, Dim, PointJointLayout<Dim>>;
  using Base::a_, Base::b_, Base::head_, Base::least, Base::numbers_a_, Base::numbers_b_, Base::push, Base::rows_;
  using Base::store, Base::task_, Base::vector;
  using typename Base::At, typename Base::Real, typename Base::Task, typename Base::V;

 public:
  [[gnu::always_inline]] PointJointBatch(const Task& task, std::size_t batch) : Base(task, batch) {}

  /// Takes where the bodies are now: what follows needs it, until they move.
  [[gnu::always_inline]] void prepare() {
    const auto of_a = LaneTurn<L, Dim>::load(task_.bodies, numbers_a_);
    const auto of_b = LaneTurn<L, Dim>::load(task_.bodies, numbers_b_);
    const V first_a = vector(At::first_arm_a), first_b = vector(At::first_arm_b);
    const V change_a = of_a.change_of(first_a), change_b = of_b.change_of(first_b);
    const V apart = vector(At::first_apart) + ((of_b.moved - of_a.moved) + (change_b - change_a));
    put(At::apart, apart);
    put(At::arm_a, first_a + change_a + apart);
    put(At::arm_b, first_b + change_b);
    factorize();
  }
  [[gnu::always_inline]] void begin() {
    push(vector(At::impulse), vector(At::arm_a), vector(At::arm_b));
    store();
  }
  template <bool is_pushing>
  [[gnu::always_inline]] void solve() {
    const V arm_a = vector(At::arm_a), arm_b = vector(At::arm_b);
    V residual = b_.velocity_at(arm_b) - a_.velocity_at(arm_a);
    if constexpr (is_pushing) residual += bias(arm_a, arm_b);
    const V so_far = vector(At::impulse);
    const V rigid = change_for(residual) * L(Real(-1));
    V change = rigid;
    if constexpr (is_pushing) change = rigid * L(task_.soft.of_mass) - so_far * L(task_.soft.of_impulse);
    put(At::impulse, so_far + change);
    push(change, arm_a, arm_b);
    store();
  }

 private:
  [[gnu::always_inline]] void put(std::size_t row, const V& x) const {
    for (std::size_t i = 0; i < Dim; ++i) rows_[row + i] = x[i];
  }
  template <int Size>
  [[gnu::always_inline]] static L norm(const Vector<L, Size>& x) {
    return xsimd::sqrt(dot(x, x));
  }
  /// The velocity that undoes the error, limited as in JointRows::correct. But what the load of a large island pulls
  /// apart by less than the arms is always undone as the softness says: more slowly, it would add up and tear.
  [[gnu::always_inline]] V bias(const V& arm_a, const V& arm_b) const {
    const V apart = vector(At::apart);
    const L error = norm(apart);
    const L speed = norm(a_.v) + norm(b_.v) + norm(arm_a) * norm(a_.spin) + norm(arm_b) * norm(b_.spin);
    const L fastest = xsimd::select(error <= speed * L(task_.h / 2), speed, L(task_.fastest_push));
    const L arms = norm(vector(At::first_arm_a)) + norm(vector(At::first_arm_b));
    return apart *
           xsimd::min(L(task_.soft.rate), xsimd::max(fastest, arms * L(task_.soft.rate)) / xsimd::max(error, L(least)));
  }
  /// What an impulse of 1 along each axis changes of the velocity of b against a is (1 / mass_a + 1 / mass_b) I plus
  /// what it turns, which is positive semidefinite. So no pivot is below the first part, whatever is rounded.
  [[gnu::always_inline]] void factorize() const {
    const L along = a_.inverse_mass + b_.inverse_mass, floor = xsimd::max(along, L(least));
    std::array<V, Dim> k = compliance(a_, vector(At::arm_a));
    const std::array<V, Dim> of_b = compliance(b_, vector(At::arm_b));
    for (std::size_t i = 0; i < Dim; ++i) k[i] += of_b[i], k[i][i] += along;
    std::array<L, Dim> inverse;
    std::size_t row = At::factor + Dim;
    for (std::size_t j = 0; j < Dim; ++j) {
      inverse[j] = L(Real(1)) / xsimd::max(k[j][j], floor);
      rows_[At::factor + j] = inverse[j];
      for (std::size_t i = j + 1; i < Dim; ++i) {
        const L factor = k[j][i] * inverse[j];
        for (std::size_t m = i; m < Dim; ++m) k[i][m] -= factor * k[j][m];
        rows_[row++] = factor;
      }
    }
  }
  /// Of one body, the part by turning.
  [[gnu::always_inline]] static std::array<V, Dim> compliance(const LaneBodies<L, Dim>& body, const V& arm) {
    std::array<Spin<L, Dim>, Dim> moments;
    for (std::size_t i = 0; i < Dim; ++i) {
      V axis;
      for (std::size_t m = 0; m < Dim; ++m) axis[m] = L(Real(m == i ? 1 : 0));
      moments[i] = moment(arm, axis);
    }
    std::array<V, Dim> k;
    for (std::size_t i = 0; i < Dim; ++i) {
      const Spin<L, Dim> turned = body.turned(moments[i]);
      for (std::size_t m = 0; m < Dim; ++m) k[i][m] = dot(moments[m], turned);
    }
    return k;
  }
  /// The impulse that changes the velocity of b against a by so much.
  [[gnu::always_inline]] V change_for(V x) const {
    std::size_t row = At::factor + Dim;
    for (std::size_t j = 0; j < Dim; ++j)
      for (std::size_t i = j + 1; i < Dim; ++i) x[i] -= rows_[row++] * x[j];
    for (std::size_t j = 0; j < Dim; ++j) x[j] *= rows_[At::factor + j];
    for (std::size_t j = Dim; j-- > 0;)
      for (std::size_t i = Dim; i-- > j + 1;) x[j] -= rows_[--row] * x[i];
    return x;
  }
};

/// The kernel for lanes L.
template <class L, int Dim>
[[gnu::flatten]] void solve_point_joints(const ManifoldTask<typename L::value_type, Dim>& task, ManifoldPass pass,
                                         std::size_t from, std::size_t to) {
  const ManifoldTask<typename L::value_type, Dim> here = task;  // a copy, which no store to a body can change
  const auto for_each = [&](const auto& act) {
    for (std::size_t number = from; number < to; ++number) act(PointJointBatch<L, Dim>(here, number));
  };
  switch (pass) {
    case ManifoldPass::prepare:
      return for_each([](auto batch) { batch.prepare(); });
    case ManifoldPass::begin:
      return for_each([](auto batch) { batch.begin(); });
    case ManifoldPass::push:
      return for_each([](auto batch) { batch.template solve<true>(); });
    case ManifoldPass::push_pressed:
      return;
    case ManifoldPass::relax:
    case ManifoldPass::relax_deep:
      return for_each([](auto batch) {
        batch.prepare();
        batch.template solve<false>();
      });
    case ManifoldPass::rebound:
      return for_each([](auto batch) { batch.template solve<false>(); });
  }
}

}  // namespace continuo
