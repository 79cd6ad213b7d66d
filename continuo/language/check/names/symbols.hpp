// continuo/language/check/names/symbols.hpp
// Every declared name, once.
#pragma once
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <continuo/language/check/names/report.hpp>
#include <continuo/language/text/source.hpp>

namespace continuo::model::detail {

struct Symbol {
  enum class Kind : unsigned char { definition, base, unknown, table, body };
  Kind kind;
  std::size_t index;  // in the list of its kind: Declarations
  Span span;
};

/// What is written under a name with and without indices, for messages about indices.
struct FamilyShape {
  Symbol::Kind kind{};
  std::size_t dimensions = 0;
  std::vector<long> low{}, high{};
};

class Symbols {
 public:
  /// Names of a mode are found before those of the model. False where the name is taken: that is reported.
  [[nodiscard]] bool declare(const std::string& name, int mode, Symbol symbol, std::string_view family,
                             const std::vector<long>& indices, Report& report);
  /// Of the world's own making: of no family, and taken by nobody.
  void add(const std::string& name, Symbol symbol) { symbols_.try_emplace(name, symbol); }
  /// Null where there is none.
  [[nodiscard]] const Symbol* find(const std::string& name, int mode) const;
  [[nodiscard]] const FamilyShape* family(std::string_view name) const;
  [[nodiscard]] bool is_family_of_bodies(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> all() const;  // in order, with `t` and `pi`

  /// A family that could not be written out: nobody misses its members.
  void lose(const std::string& family) { lost_.insert(family); }
  [[nodiscard]] bool is_lost(std::string_view family) const { return lost_.contains(family); }

 private:
  std::unordered_map<std::string, Symbol> symbols_;
  std::map<std::string, FamilyShape, std::less<>> families_;
  std::set<std::string, std::less<>> lost_;
};

/// "u[3]", "a[1,2]".
[[nodiscard]] std::string indexed(std::string_view name, const std::vector<long>& indices);
/// "this is time" of t, "3.14159..." of pi, else nothing.
[[nodiscard]] std::string_view meaning_of_its_own(std::string_view name);

}  // namespace continuo::model::detail
