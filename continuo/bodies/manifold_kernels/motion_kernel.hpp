// The kernel that moves bodies, one in each lane, as `move` (solver_states.hpp) does, to the last bit. It is compiled
// for registers of several widths, and its source is included nowhere else.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <xsimd/xsimd.hpp>

#include <continuo/bodies/manifold_kernels/manifold_kernel.hpp>
#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>

namespace continuo {

/// As for one number. Few bodies turn so far within a step that the series does not hold: these, lane by lane.
template <class L>
[[gnu::always_inline]] inline SineQuotients<L> sine_quotients_of_lanes(const L& square) {
  using Real = typename L::value_type;
  SineQuotients<L> of = series_of_sine<Real>(square);
  if (!xsimd::any(square > L(Real(most_square_of_series)))) return of;
  alignas(64) std::array<Real, L::size> squares, sines, versines;
  square.store_aligned(squares.data());
  for (std::size_t lane = 0; lane < L::size; ++lane) {
    const SineQuotients<Real> of_lane = sine_quotients<Real>(squares[lane]);
    sines[lane] = of_lane.sine, versines[lane] = of_lane.versine;
  }
  return {L::load_aligned(sines.data()), L::load_aligned(versines.data())};
}

/// The bodies of a batch.
template <class L, int Dim>
class MovingBodies {
  using Real = typename L::value_type;
  using Quads = LaneQuads<L>;
  using Task = MotionTask<Real, Dim>;

 public:
  [[gnu::always_inline]] MovingBodies(const Task& task, std::size_t batch)
      : task_(task), numbers_(task.numbers + batch * L::size) {}

  [[gnu::always_inline]] void move() const {
    const L h(task_.h);
    const auto first = load(0);
    auto place = load(Dim == 2 ? 1 : 2);
    for (std::size_t i = 0; i < Dim; ++i) place[i] += first[i] * h;
    if constexpr (Dim == 2) {
      const L angle = turned(first[2] * h);
      const SineQuotients<L> of = sine_quotients_of_lanes(angle * angle);
      place[2] = of.sine * angle, place[3] = of.versine * (angle * angle);
    } else {
      turn();
    }
    store(place, Dim == 2 ? 1 : 2);
  }

 private:
  using Columns = typename Quads::Columns;
  [[gnu::always_inline]] Columns load(std::size_t quad) const {
    return Quads::load([&](std::size_t lane) -> const auto& { return task_.bodies[numbers_[lane]].quad[quad]; });
  }
  [[gnu::always_inline]] void store(const Columns& columns, std::size_t quad) const {
    Quads::store(
        columns, [&](std::size_t lane) -> auto& { return task_.bodies[numbers_[lane]].quad[quad]; },
        [](std::size_t) { return true; });
  }
  /// The angles after a change.
  [[gnu::always_inline]] L turned(const L& change) const {
    alignas(64) std::array<Real, L::size> angles;
    for (std::size_t lane = 0; lane < L::size; ++lane) angles[lane] = task_.angles[numbers_[lane]];
    const L now = L::load_aligned(angles.data()) + change;
    now.store_aligned(angles.data());
    for (std::size_t lane = 0; lane < L::size; ++lane) task_.angles[numbers_[lane]] = angles[lane];
    return now;
  }
  [[gnu::always_inline]] void turn() const {
    const auto spin = load(1), before = load(3);
    const Vector<L, 3> half = Vector<L, 3>{{spin[0], spin[1], spin[2]}} * L(task_.h / 2);
    const SineQuotients<L> of = sine_quotients_of_lanes(squared(half));
    const Vector<L, 3> r = half * of.sine;
    const Vector<L, 4> by{{L(Real(1)) - of.versine * squared(half), r[0], r[1], r[2]}};
    const Vector<L, 4> now = product(by, Vector<L, 4>{{before[3], before[0], before[1], before[2]}});
    store({now[1], now[2], now[3], now[0]}, 3);
  }

  const Task& task_;
  const std::uint32_t* numbers_;
};

/// The kernel for lanes L.
template <class L, int Dim>
[[gnu::flatten]] void move_bodies(const MotionTask<typename L::value_type, Dim>& task, std::size_t from,
                                  std::size_t to) {
  const MotionTask<typename L::value_type, Dim> here = task;  // a copy, which no store to a body can change
  for (std::size_t batch = from; batch < to; ++batch) MovingBodies<L, Dim>(here, batch).move();
}

}  // namespace continuo
