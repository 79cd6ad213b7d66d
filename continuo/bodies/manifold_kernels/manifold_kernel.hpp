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

/// The frame of a contact: axis 0 is the normal, the others are across it. What acts along an axis alone has few
/// numbers there that are not 0.
template <class L, int Dim>
struct ContactFrame {
  using V = Vector<L, Dim>;
  std::array<V, Dim> axes;

  [[gnu::always_inline]] V local(const V& x) const {
    V in_frame;
    for (std::size_t k = 0; k < Dim; ++k) in_frame[k] = dot(axes[k], x);
    return in_frame;
  }
  [[gnu::always_inline]] V world(const V& x) const {
    V sum = axes[0] * x[0];
    for (std::size_t k = 1; k < Dim; ++k) sum += axes[k] * x[k];
    return sum;
  }
};

/// The velocity along axis k of an arm that turns at a spin, all in the frame.
template <std::size_t k, class L>
[[gnu::always_inline]] inline L speed_of_arm(const Vector<L, 1>& spin, const Vector<L, 2>& arm) {
  if constexpr (k == 0) {
    return L(typename L::value_type(0)) - spin[0] * arm[1];
  } else {
    return spin[0] * arm[0];
  }
}
template <std::size_t k, class L>
[[gnu::always_inline]] inline L speed_of_arm(const Vector<L, 3>& spin, const Vector<L, 3>& arm) {
  constexpr std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  return spin[i] * arm[j] - spin[j] * arm[i];
}

/// How far bodies have moved since the step began, and in the frame of the contact R^T n - n: an arm r that turns with
/// the body has moved along n by (R r - r) . n = r . (R^T n - n).
template <class L, int Dim>
struct LaneMotion {
  using Real = typename L::value_type;
  Vector<L, Dim> moved, turned_normal;

  [[gnu::always_inline]] static LaneMotion load(const SolverState<Real, Dim>* bodies, const std::uint32_t* numbers,
                                                const ContactFrame<L, Dim>& frame) {
    constexpr std::size_t at = Dim == 2 ? 1 : 2;
    const auto place =
        LaneQuads<L>::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[at]; });
    const L zero(Real(0));
    LaneMotion motion;
    for (std::size_t i = 0; i < Dim; ++i) motion.moved[i] = place[i];
    if constexpr (Dim == 2) {
      motion.turned_normal = {{zero - place[3], zero - place[2]}};
    } else {
      // 2 (u x (u x n) - w u x n), where u and w are the vector and the scalar of the turn.
      const auto turn =
          LaneQuads<L>::load([&](std::size_t lane) -> const auto& { return bodies[numbers[lane]].quad[3]; });
      const Vector<L, 3> u = frame.local({{turn[0], turn[1], turn[2]}});
      const L w = turn[3], two(Real(2));
      motion.turned_normal = {
          {(zero - (u[1] * u[1] + u[2] * u[2])) * two, (u[0] * u[1] - w * u[2]) * two, (u[0] * u[2] + w * u[1]) * two}};
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

/// Manifolds, whose arms and moments of inertia are in the frames of the contacts from `prepare` on.
template <class L, int Dim>
class ManifoldBatch : BatchOfConstraints<L, Dim, ManifoldLayout<Dim>> {
  using Base = BatchOfConstraints<L, Dim, ManifoldLayout<Dim>>;
  using Base::a_, Base::b_, Base::head_, Base::least, Base::numbers_a_, Base::numbers_b_, Base::rows_;
  using Base::store, Base::task_, Base::vector;
  using typename Base::At, typename Base::Real, typename Base::Task, typename Base::V;
  using S = Spin<L, Dim>;

 public:
  [[gnu::always_inline]] ManifoldBatch(const Task& task, std::size_t batch) : Base(task, batch) {
    frame_.axes[0] = vector(At::normal);
    if constexpr (Dim == 2) {
      frame_.axes[1] = {{L(Real(0)) - frame_.axes[0][1], frame_.axes[0][0]}};
    } else {
      frame_.axes[1] = vector(At::across);
      frame_.axes[2] = turning(frame_.axes[0], frame_.axes[1]);
    }
  }

  [[gnu::always_inline]] void prepare() {
    if constexpr (Dim == 3) {
      turn_inertia(At::inertia_a, a_), turn_inertia(At::inertia_b, b_);
    }
    for (std::size_t p = 0; p < head_.points; ++p) {
      L* const point = rows_of(p);
      const V arm_a = frame_.local(vector(point + At::arm_a)), arm_b = frame_.local(vector(point + At::arm_b));
      put(point + At::arm_a, arm_a), put(point + At::arm_b, arm_b);
      const L exists = point[At::mass];
      point[At::mass] = exists / compliance<0>(arm_a, arm_b);
      point[At::mass_across] = exists / compliance<1>(arm_a, arm_b);
      if constexpr (Dim == 3) point[At::mass_across + 1] = exists / compliance<2>(arm_a, arm_b);
    }
  }
  [[gnu::always_inline]] void begin() {
    V sum;
    S moment_a, moment_b;
    for (std::size_t p = 0; p < head_.points; ++p) {
      const L* const point = rows_of(p);
      V impulse;
      impulse[0] = point[At::impulse];
      for (std::size_t k = 1; k < Dim; ++k) impulse[k] = point[At::impulse_across + k - 1];
      sum += impulse;
      moment_a += moment(vector(point + At::arm_a), impulse), moment_b += moment(vector(point + At::arm_b), impulse);
    }
    a_.v -= frame_.world(sum) * a_.inverse_mass, b_.v += frame_.world(sum) * b_.inverse_mass;
    a_.spin -= world_spin(a_.turned(moment_a)), b_.spin += world_spin(b_.turned(moment_b));
    store();
  }
  /// Those of several batches at once: each waits for its own sums, one after the other.
  template <ManifoldPass pass, class... Others>
  [[gnu::always_inline]] void solve(Others&... others) {
    (take_velocities(), ..., others.take_velocities());
    if constexpr (pass != ManifoldPass::relax_deep)
      for (std::size_t p = 0; p < At::most_points; ++p)
        (resist_sliding<pass>(p), ..., others.template resist_sliding<pass>(p));
    (take_motions<pass>(), ..., others.template take_motions<pass>());
    for (std::size_t p = 0; p < At::most_points; ++p) (hold_apart<pass>(p), ..., others.template hold_apart<pass>(p));
    (give_velocities(), ..., others.give_velocities());
  }

 private:
  template <ManifoldPass pass>
  [[gnu::always_inline]] void take_motions() {
    moved_apart_ = L(Real(0));
    if constexpr (pass == ManifoldPass::push || pass == ManifoldPass::push_pressed) {
      const auto is_fixed = xsimd::min(a_.inverse_mass, b_.inverse_mass) == L(Real(0));
      const auto choose = [&](Real Softness<Real>::* part) {
        return xsimd::select(is_fixed, L(task_.soft_at_fixed.*part), L(task_.soft.*part));
      };
      soft_ = {choose(&Softness<Real>::rate), choose(&Softness<Real>::of_mass), choose(&Softness<Real>::of_impulse)};
    }
    if constexpr (pass != ManifoldPass::rebound) {
      const auto of_a = LaneMotion<L, Dim>::load(task_.bodies, numbers_a_, frame_);
      const auto of_b = LaneMotion<L, Dim>::load(task_.bodies, numbers_b_, frame_);
      turned_a_ = of_a.turned_normal, turned_b_ = of_b.turned_normal;
      moved_apart_ = dot(frame_.axes[0], of_b.moved - of_a.moved);
      // The core alone turns with its body: a ball that rolls is as far from the floor as before.
      if (head_.is_round)
        moved_apart_ += rows_[At::rounding_a] * of_a.turned_normal[0] + rows_[At::rounding_b] * of_b.turned_normal[0];
    }
  }
  template <ManifoldPass pass>
  [[gnu::always_inline]] void resist_sliding(std::size_t p) {
    if (p < head_.points) resist_sliding<pass>(rows_of(p));
  }
  template <ManifoldPass pass>
  [[gnu::always_inline]] void hold_apart(std::size_t p) {
    if (p < head_.points) hold_apart<pass>(rows_of(p), moved_apart_, turned_a_, turned_b_);
  }
  [[gnu::always_inline]] L* rows_of(std::size_t point) const { return rows_ + At::points + point * At::of_point; }
  [[gnu::always_inline]] static void put(L* row, const V& x) {
    for (std::size_t i = 0; i < Dim; ++i) row[i] = x[i];
  }
  /// The inverse moment of inertia in the frame, R^T I R, where the columns of R are its axes.
  [[gnu::always_inline]] void turn_inertia(std::size_t row, LaneBodies<L, Dim>& body) const {
    std::array<V, 3> half;  // I R
    for (std::size_t k = 0; k < 3; ++k) half[k] = body.turned(frame_.axes[k]);
    const auto entry = [&](std::size_t i, std::size_t j) { return dot(frame_.axes[i], half[j]); };
    body.inertia = {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
    for (std::size_t i = 0; i < body.inertia.size(); ++i) rows_[row + i] = body.inertia[i];
  }
  [[gnu::always_inline]] S world_spin(const S& spin) const {
    if constexpr (Dim == 2) {
      return spin;
    } else {
      return frame_.world(spin);
    }
  }
  /// Velocities in the frame: that of b against a, and both spins.
  [[gnu::always_inline]] void take_velocities() {
    mass_ = a_.inverse_mass + b_.inverse_mass;
    velocity_ = frame_.local(b_.v - a_.v);
    if constexpr (Dim == 2) {
      spin_a_ = a_.spin, spin_b_ = b_.spin;
    } else {
      spin_a_ = first_spin_a_ = frame_.local(a_.spin), spin_b_ = first_spin_b_ = frame_.local(b_.spin);
    }
    for (std::size_t k = 0; k < Dim; ++k) impulse_[k] = L(Real(0));
  }
  /// What has changed of them: what no impulse acts on stays the same to the last bit.
  [[gnu::always_inline]] void give_velocities() {
    const V impulse = frame_.world(impulse_);
    a_.v -= impulse * a_.inverse_mass, b_.v += impulse * b_.inverse_mass;
    if constexpr (Dim == 2) {
      a_.spin = spin_a_, b_.spin = spin_b_;
    } else {
      a_.spin += world_spin(spin_a_ - first_spin_a_), b_.spin += world_spin(spin_b_ - first_spin_b_);
    }
    store();
  }
  /// The change of spin by an impulse along axis k at the end of an arm.
  template <std::size_t k>
  [[gnu::always_inline]] static S change_of_spin(const LaneBodies<L, Dim>& body, const V& arm, const L& impulse) {
    if constexpr (Dim == 2) {
      const L turned = body.inertia[0] * impulse;
      return {{k == 0 ? L(Real(0)) - turned * arm[1] : turned * arm[0]}};
    } else {
      constexpr std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      S moment;
      moment[i] = arm[j] * impulse, moment[j] = L(Real(0)) - arm[i] * impulse;
      const auto& of = body.inertia;
      const auto entry = [&](std::size_t row, std::size_t column) -> const L& {
        return row == column ? of[row] : of[(row + column) == 1 ? 3 : (row + column) == 3 ? 4 : 5];
      };
      S change;
      for (std::size_t row = 0; row < 3; ++row) change[row] = entry(row, i) * moment[i] + entry(row, j) * moment[j];
      return change;
    }
  }
  /// The change of velocity along axis k by an impulse of 1.
  template <std::size_t k>
  [[gnu::always_inline]] L compliance(const V& arm_a, const V& arm_b) const {
    const L one(Real(1));
    const L of_a = speed_of_arm<k>(change_of_spin<k>(a_, arm_a, one), arm_a);
    const L of_b = speed_of_arm<k>(change_of_spin<k>(b_, arm_b, one), arm_b);
    return xsimd::max((a_.inverse_mass + b_.inverse_mass) + (of_a + of_b),
                      L(least));  // lanes without a contact
  }
  /// The velocity of b against a at a point, along axis k.
  template <std::size_t k>
  [[gnu::always_inline]] L speed(const V& arm_a, const V& arm_b) const {
    return velocity_[k] + (speed_of_arm<k>(spin_b_, arm_b) - speed_of_arm<k>(spin_a_, arm_a));
  }
  template <std::size_t k>
  [[gnu::always_inline]] void push(const L& impulse, const V& arm_a, const V& arm_b) {
    velocity_[k] += impulse * mass_;
    impulse_[k] += impulse;
    spin_a_ -= change_of_spin<k>(a_, arm_a, impulse);
    spin_b_ += change_of_spin<k>(b_, arm_b, impulse);
  }
  template <ManifoldPass pass>
  [[gnu::always_inline]] void resist_sliding(L* point) {
    const V arm_a = vector(point + At::arm_a), arm_b = vector(point + At::arm_b);
    const L most = rows_[At::friction] * point[At::impulse];
    // Of those that the pass is for.
    const auto from = [&](const L& so_far, const L& now) {
      if constexpr (pass == ManifoldPass::push_pressed)
        return xsimd::select(point[At::separation] < L(-task_.pressed), now, so_far);
      return now;
    };
    std::array<L, Dim - 1> wanted;
    wanted[0] = point[At::impulse_across] - point[At::mass_across] * speed<1>(arm_a, arm_b);
    if constexpr (Dim == 2) {
      wanted[0] = xsimd::max(xsimd::min(wanted[0], most), L(Real(0)) - most);
    } else {
      wanted[1] = point[At::impulse_across + 1] - point[At::mass_across + 1] * speed<2>(arm_a, arm_b);
      const L square = wanted[0] * wanted[0] + wanted[1] * wanted[1], most2 = most * most;
      // At most 1: what is within the circle stays as it is.
      const L factor =
          xsimd::select(square > most2, xsimd::sqrt(most2 / xsimd::max(square, most2 + L(least))), L(Real(1)));
      wanted[0] *= factor, wanted[1] = from(point[At::impulse_across + 1], wanted[1] * factor);
      push<2>(wanted[1] - point[At::impulse_across + 1], arm_a, arm_b);
      point[At::impulse_across + 1] = wanted[1];
    }
    wanted[0] = from(point[At::impulse_across], wanted[0]);
    push<1>(wanted[0] - point[At::impulse_across], arm_a, arm_b);
    point[At::impulse_across] = wanted[0];
  }
  /// `moved_apart` is by how much the bodies have moved apart without what their arms have.
  template <ManifoldPass pass>
  [[gnu::always_inline]] void hold_apart(L* point, const L& moved_apart, const V& turned_a, const V& turned_b) {
    const L zero(Real(0)), one(Real(1));
    const V arm_a = vector(point + At::arm_a), arm_b = vector(point + At::arm_b);
    L bias = point[At::separation], of_mass = one, of_impulse = zero;
    if constexpr (pass != ManifoldPass::rebound) {
      const L apart = (point[At::separation] + moved_apart) + (dot(arm_b, turned_b) - dot(arm_a, turned_a));
      const auto is_apart = apart > zero;  // then it may close within the substep
      const L closing = apart * L(1 / task_.h);
      if constexpr (pass == ManifoldPass::push || pass == ManifoldPass::push_pressed) {
        bias = xsimd::select(is_apart, closing, xsimd::max(apart * soft_.rate, L(-task_.fastest_push)));
        of_mass = xsimd::select(is_apart, one, soft_.of_mass);
        of_impulse = xsimd::select(is_apart, zero, soft_.of_impulse);
      } else {
        bias = xsimd::select(is_apart, closing, zero);
      }
      if constexpr (pass == ManifoldPass::relax_deep)
        of_mass = xsimd::select(point[At::separation] < L(-task_.deep), one, zero);
      if constexpr (pass == ManifoldPass::push_pressed) {
        const auto is_pressed = point[At::separation] < L(-task_.pressed);
        of_mass = xsimd::select(is_pressed, of_mass, zero), of_impulse = xsimd::select(is_pressed, of_impulse, zero);
      }
    }
    const L so_far = point[At::impulse];
    const L wanted = so_far - point[At::mass] * of_mass * (speed<0>(arm_a, arm_b) + bias) - of_impulse * so_far;
    const L now = xsimd::max(wanted, zero);
    point[At::impulse] = now;
    point[At::greatest_impulse] = xsimd::max(point[At::greatest_impulse], now);
    push<0>(now - so_far, arm_a, arm_b);
  }
  ContactFrame<L, Dim> frame_;
  L mass_;  // the sum of the inverse ones
  V velocity_, impulse_, turned_a_, turned_b_;
  L moved_apart_;
  Softness<L> soft_;
  S spin_a_, spin_b_, first_spin_a_, first_spin_b_;
};

/// Applies one pass to batches from ... to - 1. Each is a function of its own, so that the compiler keeps what it needs
/// in registers.
template <class L, int Dim, ManifoldPass pass>
[[gnu::flatten, gnu::noinline]] void apply_pass(const ManifoldTask<typename L::value_type, Dim>& task, std::size_t from,
                                                std::size_t to) {
  const ManifoldTask<typename L::value_type, Dim> here = task;  // a copy, which no store to a body can change
  using Batch = ManifoldBatch<L, Dim>;
  if constexpr (pass == ManifoldPass::prepare) {
    for (std::size_t batch = from; batch < to; ++batch) Batch(here, batch).prepare();
  } else if constexpr (pass == ManifoldPass::begin) {
    for (std::size_t batch = from; batch < to; ++batch) Batch(here, batch).begin();
  } else if constexpr (pass == ManifoldPass::push || pass == ManifoldPass::relax) {
    std::size_t batch = from;
    for (; batch + 1 < to; batch += 2) {
      Batch one(here, batch), other(here, batch + 1);
      one.template solve<pass>(other);
    }
    if (batch < to) Batch(here, batch).template solve<pass>();
  } else {
    const auto acts = [](const BatchHead& head) {
      return pass == ManifoldPass::rebound        ? head.is_meant
             : pass == ManifoldPass::push_pressed ? head.is_pressed
                                                  : head.is_deep;
    };
    for (std::size_t batch = from; batch < to; ++batch)
      if (acts(here.heads[batch])) Batch(here, batch).template solve<pass>();
  }
}

/// The kernel for lanes L.
template <class L, int Dim>
void solve_manifolds(const ManifoldTask<typename L::value_type, Dim>& task, ManifoldPass pass, std::size_t from,
                     std::size_t to) {
  switch (pass) {
    case ManifoldPass::prepare:
      return apply_pass<L, Dim, ManifoldPass::prepare>(task, from, to);
    case ManifoldPass::begin:
      return apply_pass<L, Dim, ManifoldPass::begin>(task, from, to);
    case ManifoldPass::push:
      return apply_pass<L, Dim, ManifoldPass::push>(task, from, to);
    case ManifoldPass::push_pressed:
      return apply_pass<L, Dim, ManifoldPass::push_pressed>(task, from, to);
    case ManifoldPass::relax:
      return apply_pass<L, Dim, ManifoldPass::relax>(task, from, to);
    case ManifoldPass::relax_deep:
      return apply_pass<L, Dim, ManifoldPass::relax_deep>(task, from, to);
    case ManifoldPass::rebound:
      return apply_pass<L, Dim, ManifoldPass::rebound>(task, from, to);
  }
}

}  // namespace continuo
