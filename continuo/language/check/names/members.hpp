// continuo/language/check/names/members.hpp
// The members of a family by their indices. Where these fill a box, as those of a grid do, a member is found by its
// place in the box, without hashing and without text.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <continuo/language/check/names/symbol.hpp>

namespace continuo::model::detail {

class Members {
 public:
  /// The member with these indices, and whether it is new.
  std::pair<const Symbol*, bool> add(std::span<const long> indices, const Symbol& symbol);
  /// Null where there is none.
  [[nodiscard]] const Symbol* find(std::span<const long> indices) const;
  /// The members are numbered as they were added. `none` where there is none with these indices.
  static constexpr std::uint32_t none = 0xffffffff;
  [[nodiscard]] std::uint32_t number_of(std::span<const long> indices) const;
  [[nodiscard]] const Symbol& operator[](std::uint32_t number) const { return symbols_[number]; }
  /// The indices of all members.
  [[nodiscard]] std::vector<std::vector<long>> all() const;

 private:
  struct Box {
    std::vector<long> low{}, size{};     // of each index
    std::vector<std::uint32_t> cells{};  // the last index runs fastest
  };

  [[nodiscard]] std::size_t place_of(std::span<const long> indices) const;
  [[nodiscard]] std::uint32_t number_at(std::size_t place, std::span<const long> indices) const;
  [[nodiscard]] std::uint32_t& new_cell(std::span<const long> indices);
  [[nodiscard]] bool widen(std::span<const long> indices);

  std::vector<Symbol> symbols_;
  Box box_;
  std::map<std::vector<long>, std::uint32_t> scattered_;  // those that would leave the box nearly empty
};

}  // namespace continuo::model::detail
