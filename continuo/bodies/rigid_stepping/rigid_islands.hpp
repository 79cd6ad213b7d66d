// Islands: bodies that contacts and joints connect, without the fixed ones. The motions of different islands do not
// depend on each other within a step.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/constraint_rows.hpp>

namespace continuo {

class RigidIslands {
 public:
  /// Groups the blocks of rows, where `moves(body)` tells which bodies move. In a heap at rest blocks connect the same
  /// bodies in step after step: then the islands stay as they are.
  template <class Moves>
  void find(std::size_t bodies, std::span<const RowBlock> blocks, Moves&& moves) {
    movers_before_.swap(movers_);
    movers_.resize(blocks.size());
    for (std::size_t k = 0; k < blocks.size(); ++k)
      movers_[k] = {moves(blocks[k].a) ? blocks[k].a : none, moves(blocks[k].b) ? blocks[k].b : none};
    if (place_.size() == bodies && movers_ == movers_before_) return;
    leader_.resize(bodies);
    std::iota(leader_.begin(), leader_.end(), 0u);
    for (const Movers& both : movers_)
      if (both.a != none && both.b != none) join(both.a, both.b);
    number(bodies);
  }
  [[nodiscard]] std::size_t size() const { return first_body_.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> bodies(std::size_t island) const {
    return std::span(bodies_).subspan(first_body_[island], first_body_[island + 1] - first_body_[island]);
  }
  [[nodiscard]] std::span<const std::uint32_t> blocks(std::size_t island) const {
    return std::span(blocks_).subspan(first_block_[island], first_block_[island + 1] - first_block_[island]);
  }
  /// The place of a body within its island.
  [[nodiscard]] std::uint32_t place(std::size_t body) const { return place_[body]; }

 private:
  [[nodiscard]] std::uint32_t leader(std::uint32_t i) {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    i = leader(i), j = leader(j);
    leader_[std::max(i, j)] = std::min(i, j);
  }
  /// Islands are numbered by the lowest numbers of their bodies; bodies without blocks have none.
  void number(std::size_t bodies) {
    const auto mover = [](const Movers& both) { return both.a != none ? both.a : both.b; };
    // The leader of a body has the lowest number: those of lower ones are known before.
    for (std::uint32_t& first : leader_) first = leader_[first];
    island_.assign(bodies, none);
    for (const Movers& both : movers_) island_[leader_[mover(both)]] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < bodies; ++i)
      if (leader_[i] != i) {
        island_[i] = island_[leader_[i]];
      } else if (island_[i] != none) {
        island_[i] = count++;
      }
    first_body_.assign(count + 1, 0), first_block_.assign(count + 1, 0);
    for (std::uint32_t i = 0; i < bodies; ++i)
      if (island_[i] != none) ++first_body_[island_[i] + 1];
    for (const Movers& both : movers_) ++first_block_[island_[mover(both)] + 1];
    std::partial_sum(first_body_.begin(), first_body_.end(), first_body_.begin());
    std::partial_sum(first_block_.begin(), first_block_.end(), first_block_.begin());
    next_body_ = first_body_, next_block_ = first_block_;
    bodies_.resize(first_body_.back()), blocks_.resize(first_block_.back()), place_.resize(bodies);
    for (std::uint32_t i = 0; i < bodies; ++i) {
      const std::uint32_t island = island_[i];
      if (island == none) continue;
      place_[i] = next_body_[island] - first_body_[island];
      bodies_[next_body_[island]++] = i;
    }
    for (std::uint32_t k = 0; k < movers_.size(); ++k) blocks_[next_block_[island_[mover(movers_[k])]]++] = k;
  }

  static constexpr std::uint32_t none = 0xffffffff;
  /// Those bodies of a block that move.
  struct Movers {
    std::uint32_t a = none, b = none;
    friend bool operator==(const Movers&, const Movers&) = default;
  };
  std::vector<Movers> movers_, movers_before_;  // of each block, in this step and the one before
  std::vector<std::uint32_t> leader_, island_, place_, bodies_, blocks_, first_body_{0}, first_block_{0};
  std::vector<std::uint32_t> next_body_, next_block_;  // while they are filled
};

}  // namespace continuo
