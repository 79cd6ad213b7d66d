// continuo/bodies/snapshot.hpp
// A world as bytes, with the internal state of its motion: a restored run continues to the same bits.
//
//   const Bytes bytes = snapshot(world, motion);
//   ...
//   World<double, 3> again;  ExactMotion motion_again(again);
//   if (const Status status = restore(bytes, again, motion_again); !status) std::cerr << describe(status);
//
// The bytes are the same on every machine. They contain neither the options of motions nor force and torque laws, which
// are code: the restored world and motion must have the same ones. For invalid bytes the message gives the position of
// the fault, and world and motion stay unchanged.
#pragma once
#include <cstddef>
#include <span>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/support/bytes.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

inline constexpr std::uint32_t snapshot_version = 12;

/// The world as bytes, without a motion.
template <class Real, int Dim>
[[nodiscard]] Bytes snapshot(const World<Real, Dim>& world);
/// The motion must move this world.
template <class Real, int Dim>
[[nodiscard]] Bytes snapshot(const World<Real, Dim>& world, const ExactMotion<Real, Dim>& motion);
template <class Real, int Dim>
[[nodiscard]] Bytes snapshot(const World<Real, Dim>& world, const FastMotion<Real, Dim>& motion);

/// Accepts a snapshot with or without a motion.
template <class Real, int Dim>
[[nodiscard]] Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world);
/// The motion must move this world, and the snapshot must contain a motion of the same kind.
template <class Real, int Dim>
[[nodiscard]] Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world, ExactMotion<Real, Dim>& motion);
template <class Real, int Dim>
[[nodiscard]] Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world, FastMotion<Real, Dim>& motion);

}  // namespace continuo
