// continuo/bodies/snapshot.hpp
// A world as bytes, with what a motion remembers of it: restored, it goes on to the same bits.
//
//   const Bytes bytes = snapshot(world, motion);
//   ...
//   World<double, 3> again;  ExactMotion motion_again(again);
//   if (const Status status = restore(bytes, again, motion_again); !status) std::cerr << describe(status);
//
// The bytes are the same on every machine. Not in them: options of motions and forces of the user's own, which are
// code; the world and the motion that are restored must have been given the same. What is wrong with bytes is said with
// the place where it is, and leaves world and motion as they were.
#pragma once
#include <cstddef>
#include <span>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/support/bytes.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

inline constexpr std::uint32_t snapshot_version = 8;

template <class Real, int Dim>
[[nodiscard]] Bytes snapshot(const World<Real, Dim>& world);
/// The motion must be of this world.
template <class Real, int Dim>
[[nodiscard]] Bytes snapshot(const World<Real, Dim>& world, const ExactMotion<Real, Dim>& motion);
template <class Real, int Dim>
[[nodiscard]] Bytes snapshot(const World<Real, Dim>& world, const FastMotion<Real, Dim>& motion);

/// Of a snapshot with a motion or without.
template <class Real, int Dim>
[[nodiscard]] Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world);
/// The motion must be of this world, and the snapshot of such a motion.
template <class Real, int Dim>
[[nodiscard]] Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world, ExactMotion<Real, Dim>& motion);
template <class Real, int Dim>
[[nodiscard]] Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world, FastMotion<Real, Dim>& motion);

}  // namespace continuo
