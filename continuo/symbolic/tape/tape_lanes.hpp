// Tapes evaluated for several runs at once: a register holds the number of each run, one after the other in memory, so
// that finding the next instruction is paid once for all of them.
//
//   std::vector<TapeLanes> registers(tape.register_count()), out(tape.output_count());
//   ... registers[0..)[lane] = t, the state, the parameters of each run ...
//   tape.prepare<TapeLanes>(registers);
//   tape.evaluate<TapeLanes>(registers, out);
//
// Each lane has the bits that the tape gives for its numbers alone, elementary functions included.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

namespace tape {

/// A register of eight runs. `wide`: the machine has vectors of 256 bits.
template <bool wide>
struct alignas(32) LaneRegister {
  static constexpr std::size_t width = 8;
  std::array<double, width> numbers{};

  LaneRegister() = default;
  /// The same number for each run.
  explicit LaneRegister(double value) { numbers.fill(value); }

  [[nodiscard]] double operator[](std::size_t lane) const { return numbers[lane]; }
  void set(std::size_t lane, double value) { numbers[lane] = value; }
};

}  // namespace tape

/// Registers for the machine that this is compiled for, and for machines with wide vectors (wide_vectors.hpp).
using TapeLanes = tape::LaneRegister<false>;
using WideTapeLanes = tape::LaneRegister<true>;

extern template void Tape::prepare(std::span<TapeLanes>) const;
extern template void Tape::prepare(std::span<WideTapeLanes>) const;
extern template void Tape::evaluate(std::span<TapeLanes>, std::span<TapeLanes>) const;
extern template void Tape::evaluate(std::span<WideTapeLanes>, std::span<WideTapeLanes>) const;

}  // namespace continuo::model
