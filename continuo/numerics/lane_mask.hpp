// continuo/numerics/lane_mask.hpp
// What a comparison of Lanes gives: a yes or no per lane.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <xsimd/xsimd.hpp>

namespace continuo {

namespace detail {

/// How W numbers are cut into registers: one register of W, or several of the machine's own width, or plain numbers.
template <class Real, std::size_t W>
struct LaneParts {
  using Part = Real;
  using Bits = std::uint32_t;  // of a float
  using MaskPart = bool;
  static constexpr std::size_t count = W;
  [[nodiscard]] static Part select(bool mask, const Part& yes, const Part& no) { return mask ? yes : no; }
};
template <class Batch, std::size_t W>
struct BatchParts {
  using Part = Batch;
  using Bits = xsimd::batch<std::uint32_t, typename Batch::arch_type>;
  using MaskPart = typename Batch::batch_bool_type;
  static constexpr std::size_t count = W / Batch::size;
  [[nodiscard]] static Part select(const MaskPart& mask, const Part& yes, const Part& no) {
    return xsimd::select(mask, yes, no);
  }
};
template <class Real>
concept HasRegisters = std::same_as<Real, float> || std::same_as<Real, double>;
template <HasRegisters Real, std::size_t W>
  requires(!std::is_void_v<xsimd::make_sized_batch_t<Real, W>>)
struct LaneParts<Real, W> : BatchParts<xsimd::make_sized_batch_t<Real, W>, W> {};
template <HasRegisters Real, std::size_t W>
  requires(std::is_void_v<xsimd::make_sized_batch_t<Real, W>> && W % xsimd::batch<Real>::size == 0)
struct LaneParts<Real, W> : BatchParts<xsimd::batch<Real>, W> {};

}  // namespace detail

/// A truth value for each of W lanes.
template <std::floating_point Real, std::size_t W>
class LaneMask {
 public:
  /// False in every lane.
  LaneMask() : LaneMask(false) {}
  /// The same answer for every lane.
  LaneMask(bool value) {
    for (Part& part : part_) part = Part(value);
  }

  /// The truth value of one lane, from 0 to W - 1.
  bool operator[](std::size_t lane) const {
    if constexpr (std::same_as<Part, bool>) {
      return part_[lane];
    } else {
      return bit(part_[lane / Part::size], lane % Part::size);
    }
  }

  /// Logic, lane by lane.
  /// @{
  friend LaneMask operator&(const LaneMask& a, const LaneMask& b) {
    return map([](const Part& x, const Part& y) { return Part(x & y); }, a, b);
  }
  friend LaneMask operator|(const LaneMask& a, const LaneMask& b) {
    return map([](const Part& x, const Part& y) { return Part(x | y); }, a, b);
  }
  friend LaneMask operator!(const LaneMask& a) {
    return map(
        [](const Part& x) {
          if constexpr (std::same_as<Part, bool>) {
            return !x;
          } else {
            return Part(~x);
          }
        },
        a);
  }
  /// @}

  /// Whether it is true in any lane.
  friend bool any(const LaneMask& mask) {
    for (const Part& part : mask.part_) {
      if (any_in(part)) return true;
    }
    return false;
  }
  /// Whether it is true in every lane.
  friend bool all(const LaneMask& mask) { return !any(!mask); }
  /// Whether it is true in no lane.
  friend bool none(const LaneMask& mask) { return !any(mask); }

  // For Lanes, which are cut the same way.
  using Part = typename detail::LaneParts<Real, W>::MaskPart;
  /// Register i of the mask.
  [[nodiscard]] Part& part(std::size_t i) { return part_[i]; }
  [[nodiscard]] const Part& part(std::size_t i) const { return part_[i]; }

 private:
  static constexpr std::size_t parts = detail::LaneParts<Real, W>::count;
  std::array<Part, parts> part_;

  // xsimd's would write all truth values to memory. A register of them has a bit for each, or all bits of a number.
  [[nodiscard]] static bool bit(const Part& part, std::size_t i) {
    if constexpr (sizeof(Part) < Part::size * sizeof(Real)) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &part, sizeof part);
      return (bits >> i & 1U) != 0;
    } else {
      std::array<unsigned char, sizeof(Real)> number;
      std::memcpy(&number, reinterpret_cast<const char*>(&part) + i * sizeof(Real), sizeof number);
      return number[0] != 0;
    }
  }
  [[nodiscard]] static bool any_in(const Part& part) {
    if constexpr (std::same_as<Part, bool>) {
      return part;
    } else {
      return xsimd::any(part);
    }
  }
  template <class F, class... A>
  [[nodiscard]] static LaneMask map(F f, const A&... a) {
    LaneMask result;
    for (std::size_t i = 0; i < parts; ++i) result.part_[i] = f(a.part_[i]...);
    return result;
  }
};

}  // namespace continuo
