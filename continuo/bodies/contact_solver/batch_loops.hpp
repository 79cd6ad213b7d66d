// The kernels over all batches of a group. Everything is inlined into these loops, for a call would send registers full
// of lanes through memory.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/prepare.hpp>
#include <continuo/bodies/contact_solver/solve.hpp>
#include <continuo/bodies/contact_solver/warm_start.hpp>

namespace continuo {

/// Prefetches a batch that comes soon; the next function prefetches its bodies, which are scattered in memory.
template <class Batch>
void prefetch_lines(const Batch& batch) {
  constexpr std::size_t line = 64;
  const auto* bytes = reinterpret_cast<const std::byte*>(&batch);
  for (std::size_t at = 0; at < sizeof(Batch); at += line) __builtin_prefetch(bytes + at);
}
template <class Real, int Dim>
void prefetch_bodies(const ContactBatch<Real, Dim>& batch, const SolverBodies<Real, Dim>& bodies) {
  for (std::size_t lane = 0; lane < lanes_at_once<Real>; ++lane) {
    __builtin_prefetch(&bodies.motion[batch.a[lane]]);
    __builtin_prefetch(&bodies.motion[batch.b[lane]]);
    __builtin_prefetch(&bodies.place[batch.a[lane]]);
    __builtin_prefetch(&bodies.place[batch.b[lane]]);
  }
}
/// Calls `act` for the batches number(0) ... number(count - 1), and prefetches the coming ones.
template <class Real, int Dim, class Number, class Act>
void for_each_ahead(const ColouredBatches<Real, Dim>& batches, const SolverBodies<Real, Dim>& bodies, std::size_t count,
                    const Number& number, const Act& act) {
  constexpr std::size_t ahead = 3;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 2 * ahead < count) {
      prefetch_lines(batches.batches[number(i + 2 * ahead)]);
      prefetch_lines(batches.impulses[number(i + 2 * ahead)]);
    }
    if (i + ahead < count) prefetch_bodies(batches.batches[number(i + ahead)], bodies);
    act(number(i));
  }
}
/// Calls `act` for the batches of a group in which the last sweep or this one has disturbed a body. Batches of a colour
/// share no body, so that they can be selected before the first of them is solved; the shared colour has few batches.
template <class Real, int Dim, class Act>
void for_each_disturbed(const ColouredBatches<Real, Dim>& batches, std::size_t group,
                        const SolverBodies<Real, Dim>& bodies, const Act& act) {
  if (bodies.disturbances.bins(group) == 0) return;
  const auto& first = batches.groups[group].first;
  std::array<std::uint32_t, 256> meant;
  for (std::size_t c = 0; c < batches.most_colours && first[c] < first.back(); ++c)
    for (std::size_t from = first[c]; from < first[c + 1]; from += meant.size()) {
      const std::uint64_t bins = batches.is_shared(c) ? ~std::uint64_t{0} : bodies.disturbances.bins(group);
      const std::size_t to = std::min<std::size_t>(from + meant.size(), first[c + 1]);
      std::size_t count = 0;
      for (std::size_t p = from; p < to; ++p) {
        meant[count] = static_cast<std::uint32_t>(p);
        count += (batches.bins[p] & bins) != 0;  // no branch: it would be unpredictable
      }
      for_each_ahead(batches, bodies, count, [&](std::size_t i) { return meant[i]; }, act);
    }
}

template <ContactKind kind, class Real, int Dim>
[[gnu::flatten]] void start_batches(ColouredBatches<Real, Dim>& batches, std::size_t group,
                                    SolverBodies<Real, Dim>& bodies) {
  const std::size_t from = batches.groups[group].first.front(), to = batches.groups[group].first.back();
  for_each_ahead(
      batches, bodies, to - from, [&](std::size_t i) { return from + i; },
      [&](std::size_t p) { warm_start<kind>(batches, p, prepare<kind>(batches.batches[p], bodies), bodies); });
}
template <ContactKind kind, ContactPass pass, class Real, int Dim>
[[gnu::flatten]] void solve_batches(ColouredBatches<Real, Dim>& batches, std::size_t group,
                                    SolverBodies<Real, Dim>& bodies, const ContactStep<Real>& of_all) {
  const ContactStep<Real> step = of_all;  // a copy, which no store to a body can change: it stays in registers
  const auto for_each = [&](const auto& act) {
    const std::size_t from = batches.groups[group].first.front(), to = batches.groups[group].first.back();
    if constexpr (pass == ContactPass::push_again) {
      for_each_disturbed(batches, group, bodies, act);
    } else {
      for_each_ahead(batches, bodies, to - from, [&](std::size_t i) { return from + i; }, act);
    }
  };
  if (batches.special.empty() && !step.may_strike) {
    for_each([&](std::size_t p) { solve<kind, pass, true>(batches, p, bodies, step); });
  } else {
    for_each([&](std::size_t p) { solve<kind, pass, false>(batches, p, bodies, step); });
  }
}

}  // namespace continuo
