// Groups of islands that are so small that what is known of one group is in the cache of one thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/rigid_islands.hpp>

namespace continuo {

/// Groups 1, 2, ... of islands, in their order. Bodies of other islands, and bodies without one, are of group 0.
class IslandGroups {
 public:
  /// A group ends once it has so many blocks; an island that has more is in none.
  static constexpr std::size_t blocks_of_group = 400, most_blocks = 1000;

  /// Groups those islands of a world of so many bodies for which may_join(island). Returns whether these are the groups
  /// of the last call.
  template <class MayJoin>
  [[nodiscard]] bool find(const RigidIslands& islands, std::size_t bodies, MayJoin&& may_join) {
    of_body_before_.swap(of_body_);
    of_body_.assign(bodies, 0);
    bodies_.clear();
    first_.assign(2, 0);
    std::size_t blocks = blocks_of_group;
    for (std::size_t k = 0; k < islands.size(); ++k) {
      if (islands.blocks(k).size() > most_blocks || !may_join(k)) continue;
      if (blocks >= blocks_of_group) {
        first_.push_back(bodies_.size());
        blocks = 0;
      }
      blocks += islands.blocks(k).size();
      for (const std::uint32_t i : islands.bodies(k)) {
        bodies_.push_back(i);
        of_body_[i] = static_cast<std::uint32_t>(first_.size() - 2);
      }
      first_.back() = bodies_.size();
    }
    return of_body_ == of_body_before_;
  }
  /// The number of groups with group 0.
  [[nodiscard]] std::size_t size() const { return first_.size() - 1; }
  /// Of group 0 none are listed.
  [[nodiscard]] std::span<const std::uint32_t> bodies(std::size_t group) const {
    return std::span(bodies_).subspan(first_[group], first_[group + 1] - first_[group]);
  }
  [[nodiscard]] std::uint32_t of(std::size_t body) const { return body < of_body_.size() ? of_body_[body] : 0; }

 private:
  std::vector<std::uint32_t> of_body_, of_body_before_;
  std::vector<std::uint32_t> bodies_;
  std::vector<std::size_t> first_{0, 0};  // of the bodies of each group
};

}  // namespace continuo
