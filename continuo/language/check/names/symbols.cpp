// continuo/language/check/names/symbols.cpp
// What is declared twice or under a taken name is reported.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/check/names/scope.hpp>
#include <continuo/language/check/names/symbols.hpp>

namespace continuo::model::detail {

namespace {

std::string in_mode(int mode, const std::string& name) {
  return mode == Scope::no_mode ? name : std::to_string(mode) + ":" + name;
}

bool is_free_name(const std::string& name, Span span, Report& report) {
  if (const std::string_view meaning = meaning_of_its_own(name); !meaning.empty()) {
    report.fail("E214", span, fmt::format("`{}` has a meaning of its own", name), std::string(meaning),
                "take another name");
    return false;
  }
  if (!is_function(name)) return true;
  report.fail("E214", span, fmt::format("`{}` is a function", name), {}, "take another name");
  return false;
}

}  // namespace

std::string_view meaning_of_its_own(std::string_view name) {
  return name == "t" ? "this is time" : name == "pi" ? "3.14159..." : "";
}

std::string indexed(std::string_view name, const std::vector<long>& indices) {
  std::string text(name);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    text += i == 0 ? '[' : ',';
    text += std::to_string(indices[i]);
  }
  if (!indices.empty()) text += ']';
  return text;
}

bool Symbols::declare(const std::string& name, int mode, Symbol symbol, std::string_view family,
                      const std::vector<long>& indices, Report& report) {
  if (!is_free_name(std::string(family), symbol.span, report)) return false;
  const auto [place, is_new] = symbols_.try_emplace(in_mode(mode, name), symbol);
  if (!is_new) {
    if (auto* said = report.fail("E211", symbol.span, fmt::format("`{}` is defined twice", name), "again here")) {
      said->related.push_back({place->second.span, "first here"});
    }
    return false;
  }
  FamilyShape& shape = families_[std::string(family)];
  if (shape.low.empty()) {
    shape.low = shape.high = indices;
    shape.kind = symbol.kind;
    shape.dimensions = indices.size();
  }
  for (std::size_t i = 0; i < std::min(indices.size(), shape.low.size()); ++i) {
    shape.low[i] = std::min(shape.low[i], indices[i]);
    shape.high[i] = std::max(shape.high[i], indices[i]);
  }
  return true;
}

const Symbol* Symbols::find(const std::string& name, int mode) const {
  if (mode != Scope::no_mode) {
    const auto local = symbols_.find(in_mode(mode, name));
    if (local != symbols_.end()) return &local->second;
  }
  const auto found = symbols_.find(name);
  return found == symbols_.end() ? nullptr : &found->second;
}

const FamilyShape* Symbols::family(std::string_view name) const {
  const auto found = families_.find(name);
  return found == families_.end() ? nullptr : &found->second;
}

bool Symbols::is_family_of_bodies(std::string_view name) const {
  const FamilyShape* shape = family(name);
  return shape && shape->kind == Symbol::Kind::body;
}

std::vector<std::string> Symbols::all() const {
  std::vector<std::string> names;
  for (const auto& [key, symbol] : symbols_) {
    const std::size_t colon = key.find(':');  // names in a mode are `mode:name`
    names.push_back(colon == std::string::npos ? key : key.substr(colon + 1));
  }
  std::ranges::sort(names);
  for (const char* builtin : {"t", "pi"}) names.emplace_back(builtin);
  return names;
}

}  // namespace continuo::model::detail
