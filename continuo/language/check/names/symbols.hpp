// continuo/language/check/names/symbols.hpp
// Every declared name, once.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <continuo/language/check/names/indexed_name.hpp>
#include <continuo/language/check/names/members.hpp>
#include <continuo/language/check/names/report.hpp>

namespace continuo::model::detail {

/// What is written under a name with and without indices, for messages about indices.
struct FamilyShape {
  Symbol::Kind kind{};
  std::size_t dimensions = 0;
  std::vector<long> low{}, high{};
};

class Symbols {
 public:
  /// Names of a mode are found before those of the model. False where the name is taken: that is reported.
  [[nodiscard]] bool declare(std::string_view name, std::span<const long> indices, int mode, const Symbol& symbol,
                             Report& report);
  /// Of the world's own making: of no family, and taken by nobody.
  void add(const std::string& name, const Symbol& symbol) { made_by_world_.try_emplace(name, symbol); }
  /// Null where there is none.
  [[nodiscard]] const Symbol* find(const IndexedName& name, int mode) const;
  /// All members of a name where it is declared in the model or in this mode, and not in both; otherwise null.
  [[nodiscard]] const Members* members(std::string_view name, int mode) const;
  /// Of the world's own making: `ball.x`.
  [[nodiscard]] const Symbol* find_of_world(const std::string& name) const;
  [[nodiscard]] const FamilyShape* family(std::string_view name) const;
  [[nodiscard]] bool is_family_of_bodies(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> all() const;  // in order, with `t` and `pi`

  /// A family that could not be written out: nobody misses its members.
  void lose(const std::string& family) { lost_.insert(family); }
  [[nodiscard]] bool is_lost(std::string_view family) const { return lost_.contains(family); }

 private:
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  using Names = std::unordered_map<std::string, Members, Hash, std::equal_to<>>;

  [[nodiscard]] const Members* members_in(std::size_t place, std::string_view name) const;
  [[nodiscard]] FamilyShape& shape_of(std::string_view name);

  /// The family that was asked for last: the members of a grid ask for theirs one after the other.
  struct Recent {
    std::size_t place = 0;
    std::string_view name{};
    const Members* members = nullptr;
  };
  /// The one that was given a member last.
  struct RecentShape {
    std::string_view name{};
    FamilyShape* shape = nullptr;
  };

  mutable Recent recent_;
  RecentShape recent_shape_;
  std::vector<Names> names_;  // of the model, then of its modes; a name without indices is its family's only member
  std::map<std::string, FamilyShape, std::less<>> families_;
  std::unordered_map<std::string, Symbol> made_by_world_;
  std::set<std::string, std::less<>> lost_;
};

/// "this is time" of t, "3.14159..." of pi, else nothing.
[[nodiscard]] std::string_view meaning_of_its_own(std::string_view name);

}  // namespace continuo::model::detail
