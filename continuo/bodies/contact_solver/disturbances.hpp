// Which bodies the sweeps over contacts have disturbed: those whose velocity a contact has just changed by a lot, so
// that their other contacts have to be solved again (contact_passes.hpp; docs/contact_solver.md has an example).
//
// A sweep has a number. A contact is solved again in sweep s where one of its two bodies was disturbed in sweep s - 1,
// or already in s. To find these contacts without looking at all others, the places in each half of a block
// (contact_blocks.hpp) fall into up to 32 bins, a bit each, and a half has two sets of bits: the bins with a body that
// the last sweep disturbed, and those with one that this sweep has. A batch of contacts has the bits of its own bodies;
// where the two have no bit in common, no contact in it has to be solved again.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_solver/contact_blocks.hpp>

namespace continuo {

class Disturbances {
 public:
  /// For so many bodies, walls and stand-ins.
  void resize(std::size_t places, const ContactBlocks& blocks) {
    blocks_ = blocks;
    sweep_.assign(places, 0);
    halves_.assign(2 * blocks.count + 1, {});
  }

  void mark(std::uint32_t body, std::uint8_t sweep) {
    sweep_[body] = sweep;
    halves_[body / blocks_.half].now |= 1u << blocks_.bin_of(body % blocks_.half);
  }
  /// The last sweep that disturbed it; 0: none in this substep.
  [[nodiscard]] std::uint8_t sweep_of(std::uint32_t body) const { return sweep_[body]; }
  /// The bins with bodies of a group that the last sweep or this one has disturbed, in the bits of
  /// `ContactBlocks::bit_of`.
  [[nodiscard]] std::uint64_t bins(std::size_t group) const {
    if (group == blocks_.rest()) return ~std::uint64_t{0};
    const Half* half = &halves_[blocks_.first_half(group)];
    return half[0].any() | std::uint64_t{half[1].any()} << 32;
  }

  /// Clears the bodies of a block, at the start of a substep.
  void forget(std::size_t block, std::size_t bodies) {
    std::fill(sweep_.begin() + blocks_.first(block), sweep_.begin() + blocks_.last(block, bodies), std::uint8_t{0});
    for (std::size_t half = 2 * block; half < 2 * block + 2; ++half) halves_[half] = {};
  }
  /// Begins the next sweep in a block: the bins of the present sweep become those of the last one.
  void begin_sweep(std::size_t block) {
    for (std::size_t half = 2 * block; half < 2 * block + 2; ++half) halves_[half] = {halves_[half].now, 0};
  }
  /// Whether this sweep disturbed anything.
  [[nodiscard]] bool any_now() const {
    return std::ranges::any_of(halves_, [](const Half& half) { return half.now != 0; });
  }
  /// Whether there are disturbed bodies in a half of a block, or in the half after it.
  [[nodiscard]] bool any_from(std::size_t half) const {
    return halves_[half].any() != 0 || halves_[half + 1].any() != 0;
  }

  [[nodiscard]] std::size_t memory() const { return sweep_.capacity(); }

 private:
  struct Half {
    std::uint32_t last = 0, now = 0;  // bins

    [[nodiscard]] std::uint32_t any() const { return last | now; }
  };

  ContactBlocks blocks_{};
  std::vector<std::uint8_t> sweep_{};  // of each body
  std::vector<Half> halves_{};         // two of every block, and one more after the last
};

}  // namespace continuo
