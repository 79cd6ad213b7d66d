// The kernel that solves contact manifolds, one in each lane, point by point: sequential impulses with soft contacts,
// as in constraint_rows.hpp. It is compiled for registers of several widths, and its source is included nowhere else.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <xsimd/xsimd.hpp>

#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>

namespace continuo {

/// Several quads of numbers, one of each lane's body, as lanes: column c has number c of all.
template <class L>
class LaneQuads {
 public:
  using Real = typename L::value_type;
  static constexpr std::size_t width = L::size;
  using Columns = std::array<L, 4>;
  using Quad = std::array<Real, 4>;

  template <class QuadOf>
  [[gnu::always_inline]] static Columns load(const QuadOf& quad_of) {
    if constexpr (width == 2) {
      const L a0 = L::load_aligned(quad_of(0).data()), a1 = L::load_aligned(quad_of(0).data() + 2);
      const L b0 = L::load_aligned(quad_of(1).data()), b1 = L::load_aligned(quad_of(1).data() + 2);
      return {xsimd::zip_lo(a0, b0), xsimd::zip_hi(a0, b0), xsimd::zip_lo(a1, b1), xsimd::zip_hi(a1, b1)};
    } else {
      Rows rows;
      for (std::size_t i = 0; i < 4; ++i) rows.of[i] = joined(quad_of, i);
      return bit_cast_all(transposed(rows));
    }
  }
  /// Writes those lanes for which is_written(lane).
  template <class QuadOf, class IsWritten>
  [[gnu::always_inline]] static void store(const Columns& columns, const QuadOf& quad_of, const IsWritten& is_written) {
    if constexpr (width == 2) {
      const L a0 = xsimd::zip_lo(columns[0], columns[1]), b0 = xsimd::zip_hi(columns[0], columns[1]);
      const L a1 = xsimd::zip_lo(columns[2], columns[3]), b1 = xsimd::zip_hi(columns[2], columns[3]);
      if (is_written(0)) a0.store_aligned(quad_of(0).data()), a1.store_aligned(quad_of(0).data() + 2);
      if (is_written(1)) b0.store_aligned(quad_of(1).data()), b1.store_aligned(quad_of(1).data() + 2);
    } else {
      Rows wide;
      for (std::size_t i = 0; i < 4; ++i) wide.of[i] = std::bit_cast<Wide>(columns[i]);
      const Rows rows = transposed(wide);
      for (std::size_t i = 0; i < 4; ++i) split(rows.of[i], i, quad_of, is_written);
    }
  }

 private:
  using Wide [[gnu::vector_size(width * sizeof(Real))]] = Real;
  using Narrow [[gnu::vector_size(4 * sizeof(Real))]] = Real;
  static constexpr std::size_t blocks = width / 4;
  struct Rows {
    Wide of[4];  // an array of the library would drop the attribute
  };
  struct Parts {
    Narrow of[blocks == 0 ? 1 : blocks];
  };

  // Stage of a transposition: of each block of four of x and y, the lower or the higher halves, interleaved.
  template <std::size_t first, std::size_t... lane>
  [[gnu::always_inline]] static Wide interleaved(const Wide& x, const Wide& y, std::index_sequence<lane...>) {
    return __builtin_shufflevector(
        x, y, static_cast<int>(lane / 4 * 4 + first + lane % 4 / 2 + (lane % 2 == 0 ? 0 : width))...);
  }
  [[gnu::always_inline]] static Rows transposed(const Rows& rows) {
    const Wide* const r = rows.of;
    constexpr auto all = std::make_index_sequence<width>();
    const Wide p = interleaved<0>(r[0], r[2], all), q = interleaved<2>(r[0], r[2], all);
    const Wide s = interleaved<0>(r[1], r[3], all), t = interleaved<2>(r[1], r[3], all);
    return {interleaved<0>(p, s, all), interleaved<2>(p, s, all), interleaved<0>(q, t, all), interleaved<2>(q, t, all)};
  }
  [[gnu::always_inline]] static Columns bit_cast_all(const Rows& rows) {
    return {std::bit_cast<L>(rows.of[0]), std::bit_cast<L>(rows.of[1]), std::bit_cast<L>(rows.of[2]),
            std::bit_cast<L>(rows.of[3])};
  }
  /// The quads of lanes i, i + 4, i + 8, ...
  template <class QuadOf>
  [[gnu::always_inline]] static Wide joined(const QuadOf& quad_of, std::size_t i) {
    if constexpr (blocks == 1) {
      return std::bit_cast<Wide>(L::load_aligned(quad_of(i).data()));
    } else {
      Parts parts;
      for (std::size_t k = 0; k < blocks; ++k)
        __builtin_memcpy(&parts.of[k], __builtin_assume_aligned(quad_of(i + 4 * k).data(), sizeof(Narrow)),
                         sizeof(Narrow));
      return concatenated(parts);
    }
  }
  [[gnu::always_inline]] static Wide concatenated(const Parts& all) {
    const Narrow* const parts = all.of;
    if constexpr (blocks == 2) {
      return __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
      const auto low = __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
      const auto high = __builtin_shufflevector(parts[2], parts[3], 0, 1, 2, 3, 4, 5, 6, 7);
      return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
  }
  template <class QuadOf, class IsWritten>
  [[gnu::always_inline]] static void split(const Wide& row, std::size_t i, const QuadOf& quad_of,
                                           const IsWritten& is_written) {
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (
          [&] {
            if (!is_written(i + 4 * k)) return;
            const Narrow part = __builtin_shufflevector(row, row, static_cast<int>(4 * k), static_cast<int>(4 * k + 1),
                                                        static_cast<int>(4 * k + 2), static_cast<int>(4 * k + 3));
            __builtin_memcpy(__builtin_assume_aligned(quad_of(i + 4 * k).data(), sizeof(Narrow)), &part,
                             sizeof(Narrow));
          }(),
          ...);
    }(std::make_index_sequence<blocks>());
  }
};

/// The bodies a, or b, of the manifolds of a batch.
template <class L, int Dim>
struct LaneBodies {
  using Real = typename L::value_type;
  using V = Vector<L, Dim>;
  using S = Spin<L, Dim>;
  using Quads = LaneQuads<L>;
  V v;
  L inverse_mass;
  S spin;
  std::array<L, ManifoldLayout<Dim>::of_inertia> inertia;  // the inverse

  [[gnu::always_inline]] static LaneBodies load(const SolverState<Real, Dim>* bodies, const std::uint32_t* numbers,
                                                const L* inertia_rows) {
    LaneBodies all;
    const auto first = Quads::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[0]; });
    for (std::size_t i = 0; i < Dim; ++i) all.v[i] = first[i];
    all.inverse_mass = first[3];
    if constexpr (Dim == 2) {
      all.spin[0] = first[2];
    } else {
      const auto spin = Quads::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[1]; });
      for (std::size_t i = 0; i < 3; ++i) all.spin[i] = spin[i];
    }
    for (std::size_t i = 0; i < all.inertia.size(); ++i) all.inertia[i] = inertia_rows[i];
    return all;
  }
  [[gnu::always_inline]] void store(SolverState<Real, Dim>* bodies, const std::uint32_t* numbers,
                                    bool has_fixed) const {
    typename Quads::Columns first;
    for (std::size_t i = 0; i < Dim; ++i) first[i] = v[i];
    first[3] = inverse_mass;
    if constexpr (Dim == 2) first[2] = spin[0];
    const auto write = [&](const auto& is_written) {
      Quads::store(first, [&](std::size_t lane) -> auto& { return bodies[numbers[lane]].quad[0]; }, is_written);
      if constexpr (Dim == 3)
        Quads::store(
            {spin[0], spin[1], spin[2], L(Real(0))},
            [&](std::size_t lane) -> auto& { return bodies[numbers[lane]].quad[1]; }, is_written);
    };
    if (!has_fixed) return write([](std::size_t) { return true; });
    write([&](std::size_t lane) { return bodies[numbers[lane]].quad[0][3] != Real(0); });
  }
  [[gnu::always_inline]] V velocity_at(const V& arm) const { return v + turning(spin, arm); }
  /// The change of spin by a moment.
  [[gnu::always_inline]] S turned(const S& moment) const {
    if constexpr (Dim == 2) {
      return {{inertia[0] * moment[0]}};
    } else {
      return {{inertia[0] * moment[0] + inertia[3] * moment[1] + inertia[5] * moment[2],
               inertia[3] * moment[0] + inertia[1] * moment[1] + inertia[4] * moment[2],
               inertia[5] * moment[0] + inertia[4] * moment[1] + inertia[2] * moment[2]}};
    }
  }
  [[gnu::always_inline]] void push(const V& impulse, const S& moment) {
    v += impulse * inverse_mass;
    spin += turned(moment);
  }
};

/// How far bodies have moved since the step began, and R^T n - n: an arm r that turns with the body has moved along n
/// by (R r - r) . n = r . (R^T n - n).
template <class L, int Dim>
struct LaneMotion {
  using Real = typename L::value_type;
  Vector<L, Dim> moved, turned_normal;

  [[gnu::always_inline]] static LaneMotion load(const SolverState<Real, Dim>* bodies, const std::uint32_t* numbers,
                                                const Vector<L, Dim>& n) {
    constexpr std::size_t at = Dim == 2 ? 1 : 2;
    const auto place =
        LaneQuads<L>::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[at]; });
    LaneMotion motion;
    for (std::size_t i = 0; i < Dim; ++i) motion.moved[i] = place[i];
    if constexpr (Dim == 2) {
      const L sine = place[2], versine = place[3];
      motion.turned_normal = {{sine * n[1] - versine * n[0], L(Real(0)) - (sine * n[0] + versine * n[1])}};
    } else {
      const auto turn =
          LaneQuads<L>::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[3]; });
      const Vector<L, 3> u{{turn[0], turn[1], turn[2]}}, across = turning(u, n);
      const L two(Real(2));
      motion.turned_normal = (turning(u, across) - across * turn[3]) * two;
    }
    return motion;
  }
};

/// Constraints of lanes with their bodies, taken from the states of the bodies and put back there.
template <class L, int Dim, class Layout>
class BatchOfConstraints {
 protected:
  using Real = typename L::value_type;
  using V = Vector<L, Dim>;
  using At = Layout;
  using Task = ManifoldTask<Real, Dim>;

  [[gnu::always_inline]] BatchOfConstraints(const Task& task, std::size_t batch)
      : task_(task),
        head_(task.heads[batch]),
        rows_(reinterpret_cast<L*>(task.values) + batch * At::rows),
        numbers_a_(task.a + batch * L::size),
        numbers_b_(task.b + batch * L::size),
        a_(LaneBodies<L, Dim>::load(task.bodies, numbers_a_, rows_ + At::inertia_a)),
        b_(LaneBodies<L, Dim>::load(task.bodies, numbers_b_, rows_ + At::inertia_b)) {}

  [[gnu::always_inline]] V vector(std::size_t row) const { return vector(rows_ + row); }
  [[gnu::always_inline]] static V vector(const L* row) {
    V x;
    for (std::size_t i = 0; i < Dim; ++i) x[i] = row[i];
    return x;
  }
  [[gnu::always_inline]] void push(const V& impulse, const V& arm_a, const V& arm_b) {
    const V opposite = impulse * L(Real(-1));
    a_.push(opposite, moment(arm_a, opposite));
    b_.push(impulse, moment(arm_b, impulse));
  }
  [[gnu::always_inline]] void store() const {
    a_.store(task_.bodies, numbers_a_, head_.is_a_fixed);
    b_.store(task_.bodies, numbers_b_, head_.is_b_fixed);
  }

  static constexpr Real least = Real(1e-30);  // keeps 0 / 0 out
  const Task& task_;
  const BatchHead& head_;
  L* rows_;
  const std::uint32_t *numbers_a_, *numbers_b_;
  LaneBodies<L, Dim> a_, b_;
};

template <class L, int Dim>
class ManifoldBatch : BatchOfConstraints<L, Dim, ManifoldLayout<Dim>> {
  using Base = BatchOfConstraints<L, Dim, ManifoldLayout<Dim>>;
  using Base::a_, Base::b_, Base::head_, Base::least, Base::numbers_a_, Base::numbers_b_, Base::push, Base::rows_;
  using Base::store, Base::task_, Base::vector;
  using typename Base::At, typename Base::Real, typename Base::Task, typename Base::V;

 public:
  [[gnu::always_inline]] ManifoldBatch(const Task& task, std::size_t batch)
      : Base(task, batch), normal_(vector(At::normal)) {
    if constexpr (Dim == 2) {
      across_[0] = {{L(Real(0)) - normal_[1], normal_[0]}};
    } else {
      across_[0] = vector(At::across);
      across_[1] = turning(normal_, across_[0]);
    }
  }

  [[gnu::always_inline]] void prepare() {
    for (std::size_t p = 0; p < head_.points; ++p) {
      L* const point = rows_of(p);
      const V arm_a = vector(point + At::arm_a), arm_b = vector(point + At::arm_b);
      const L exists = point[At::mass];
      point[At::mass] = exists / compliance(normal_, arm_a, arm_b);
      for (std::size_t k = 0; k < across_.size(); ++k)
        point[At::mass_across + k] = exists / compliance(across_[k], arm_a, arm_b);
    }
  }
  [[gnu::always_inline]] void begin() {
    for (std::size_t p = 0; p < head_.points; ++p) {
      const L* const point = rows_of(p);
      V impulse = normal_ * point[At::impulse];
      for (std::size_t k = 0; k < across_.size(); ++k) impulse += across_[k] * point[At::impulse_across + k];
      push(impulse, vector(point + At::arm_a), vector(point + At::arm_b));
    }
    store();
  }
  template <ManifoldPass pass>
  [[gnu::always_inline]] void solve() {
    if constexpr (pass != ManifoldPass::relax_deep)
      for (std::size_t p = 0; p < head_.points; ++p) resist_sliding(rows_of(p));
    LaneMotion<L, Dim> of_a, of_b;
    if constexpr (pass != ManifoldPass::rebound) {
      of_a = LaneMotion<L, Dim>::load(task_.bodies, numbers_a_, normal_);
      of_b = LaneMotion<L, Dim>::load(task_.bodies, numbers_b_, normal_);
    }
    for (std::size_t p = 0; p < head_.points; ++p) hold_apart<pass>(rows_of(p), of_a, of_b);
    store();
  }

 private:
  [[gnu::always_inline]] L* rows_of(std::size_t point) const { return rows_ + At::points + point * At::of_point; }
  /// The change of velocity along a direction by an impulse of 1.
  [[gnu::always_inline]] L compliance(const V& direction, const V& arm_a, const V& arm_b) const {
    const Spin<L, Dim> of_a = moment(arm_a, direction), of_b = moment(arm_b, direction);
    const L sum = (a_.inverse_mass + b_.inverse_mass) + (dot(of_a, a_.turned(of_a)) + dot(of_b, b_.turned(of_b)));
    return xsimd::max(sum, L(least));  // lanes without a contact
  }
  [[gnu::always_inline]] void resist_sliding(L* point) {
    const V arm_a = vector(point + At::arm_a), arm_b = vector(point + At::arm_b);
    const V slip = b_.velocity_at(arm_b) - a_.velocity_at(arm_a);
    const L most = rows_[At::friction] * point[At::impulse];
    std::array<L, Dim - 1> wanted;
    for (std::size_t k = 0; k < wanted.size(); ++k)
      wanted[k] = point[At::impulse_across + k] - point[At::mass_across + k] * dot(across_[k], slip);
    if constexpr (Dim == 2) {
      wanted[0] = xsimd::max(xsimd::min(wanted[0], most), L(Real(0)) - most);
    } else {
      const L square = wanted[0] * wanted[0] + wanted[1] * wanted[1], most2 = most * most;
      // At most 1: what is within the circle stays as it is.
      const L factor =
          xsimd::select(square > most2, xsimd::sqrt(most2 / xsimd::max(square, most2 + L(least))), L(Real(1)));
      wanted[0] *= factor, wanted[1] *= factor;
    }
    V impulse = across_[0] * (wanted[0] - point[At::impulse_across]);
    for (std::size_t k = 1; k < wanted.size(); ++k) impulse += across_[k] * (wanted[k] - point[At::impulse_across + k]);
    for (std::size_t k = 0; k < wanted.size(); ++k) point[At::impulse_across + k] = wanted[k];
    push(impulse, arm_a, arm_b);
  }
  template <ManifoldPass pass>
  [[gnu::always_inline]] void hold_apart(L* point, const LaneMotion<L, Dim>& of_a, const LaneMotion<L, Dim>& of_b) {
    const L zero(Real(0)), one(Real(1));
    const V arm_a = vector(point + At::arm_a), arm_b = vector(point + At::arm_b);
    L bias = point[At::separation], of_mass = one, of_impulse = zero;
    if constexpr (pass != ManifoldPass::rebound) {
      L apart = point[At::separation] + dot(normal_, of_b.moved - of_a.moved) +
                (dot(arm_b, of_b.turned_normal) - dot(arm_a, of_a.turned_normal));
      // The core alone turns with its body: a ball that rolls is as far from the floor as before.
      if (head_.is_round)
        apart += rows_[At::rounding_a] * dot(normal_, of_a.turned_normal) +
                 rows_[At::rounding_b] * dot(normal_, of_b.turned_normal);
      const auto is_apart = apart > zero;  // then it may close within the substep
      const L closing = apart * L(1 / task_.h);
      if constexpr (pass == ManifoldPass::push) {
        bias = xsimd::select(is_apart, closing, xsimd::max(apart * L(task_.rate), L(-task_.fastest_push)));
        of_mass = xsimd::select(is_apart, one, L(task_.of_mass));
        of_impulse = xsimd::select(is_apart, zero, L(task_.of_impulse));
      } else {
        bias = xsimd::select(is_apart, closing, zero);
      }
      if constexpr (pass == ManifoldPass::relax_deep)
        of_mass = xsimd::select(point[At::separation] < L(-task_.deep), one, zero);
    }
    const L speed = dot(normal_, b_.velocity_at(arm_b) - a_.velocity_at(arm_a));
    const L so_far = point[At::impulse];
    const L now = xsimd::max(so_far - point[At::mass] * of_mass * (speed + bias) - of_impulse * so_far, zero);
    point[At::impulse] = now;
    point[At::greatest_impulse] = xsimd::max(point[At::greatest_impulse], now);
    push(normal_ * (now - so_far), arm_a, arm_b);
  }
  V normal_;
  std::array<V, Dim - 1> across_;
};

/// The kernel for lanes L.
template <class L, int Dim>
[[gnu::flatten]] void solve_manifolds(const ManifoldTask<typename L::value_type, Dim>& task, ManifoldPass pass,
                                      std::size_t from, std::size_t to) {
  const ManifoldTask<typename L::value_type, Dim> here = task;  // a copy, which no store to a body can change
  const auto for_each = [&](const auto& act) {
    for (std::size_t batch = from; batch < to; ++batch) act(ManifoldBatch<L, Dim>(here, batch));
  };
  switch (pass) {
    case ManifoldPass::prepare:
      return for_each([](auto batch) { batch.prepare(); });
    case ManifoldPass::begin:
      return for_each([](auto batch) { batch.begin(); });
    case ManifoldPass::push:
      return for_each([](auto batch) { batch.template solve<ManifoldPass::push>(); });
    case ManifoldPass::relax:
      return for_each([](auto batch) { batch.template solve<ManifoldPass::relax>(); });
    case ManifoldPass::relax_deep:
      for (std::size_t batch = from; batch < to; ++batch)
        if (here.heads[batch].is_deep) ManifoldBatch<L, Dim>(here, batch).template solve<ManifoldPass::relax_deep>();
      return;
    case ManifoldPass::rebound:
      for (std::size_t batch = from; batch < to; ++batch)
        if (here.heads[batch].is_meant) ManifoldBatch<L, Dim>(here, batch).template solve<ManifoldPass::rebound>();
  }
}

}  // namespace continuo
