// continuo/language/check/names/symbols.cpp
// What is declared twice or under a taken name is reported.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/check/names/scope.hpp>
#include <continuo/language/check/names/symbols.hpp>

namespace continuo::model::detail {

namespace {

/// The names of the model come before those of its modes.
std::size_t place_of(int mode) {
  return mode == Scope::no_mode ? 0 : 1 + static_cast<std::size_t>(mode);
}

bool is_free_name(std::string_view name, Span span, Report& report) {
  if (const std::string_view meaning = meaning_of_its_own(name); !meaning.empty()) {
    report.fail("E214", span, fmt::format("`{}` has a meaning of its own", name), std::string(meaning),
                "take another name");
    return false;
  }
  if (!is_function(name)) return true;
  report.fail("E214", span, fmt::format("`{}` is a function", name), {}, "take another name");
  return false;
}

void widen(FamilyShape& shape, std::span<const long> indices, Symbol::Kind kind) {
  if (shape.low.empty()) {
    shape.low.assign(indices.begin(), indices.end());
    shape.high = shape.low;
    shape.kind = kind;
    shape.dimensions = indices.size();
  }
  for (std::size_t i = 0; i < std::min(indices.size(), shape.low.size()); ++i) {
    shape.low[i] = std::min(shape.low[i], indices[i]);
    shape.high[i] = std::max(shape.high[i], indices[i]);
  }
}

}  // namespace

std::string_view meaning_of_its_own(std::string_view name) {
  return name == "t" ? "this is time" : name == "pi" ? "3.14159..." : "";
}

bool Symbols::declare(std::string_view name, std::span<const long> indices, int mode, const Symbol& symbol,
                      Report& report) {
  const std::size_t place = place_of(mode);
  if (names_.size() <= place) {
    names_.resize(place + 1);
    recent_ = {};
  }
  auto* family = const_cast<Members*>(members_in(place, name));  // which are those of this
  if (!family) {
    if (!is_free_name(name, symbol.span, report)) return false;
    family = &names_[place][std::string(name)];
  }
  const auto [known, is_new] = family->add(indices, symbol);
  if (!is_new) {
    if (auto* said = report.fail("E211", symbol.span, fmt::format("`{}` is defined twice", indexed(name, indices)),
                                 "again here")) {
      said->related.push_back({known->span, "first here"});
    }
    return false;
  }
  widen(shape_of(name), indices, symbol.kind);
  return true;
}

FamilyShape& Symbols::shape_of(std::string_view name) {
  if (recent_shape_.shape && recent_shape_.name == name) return *recent_shape_.shape;
  auto found = families_.find(name);
  if (found == families_.end()) found = families_.try_emplace(std::string(name)).first;
  recent_shape_ = {found->first, &found->second};
  return found->second;
}

const Members* Symbols::members_in(std::size_t place, std::string_view name) const {
  if (recent_.members && recent_.place == place && recent_.name == name) return recent_.members;
  if (place >= names_.size()) return nullptr;
  const auto family = names_[place].find(name);
  if (family == names_[place].end()) return nullptr;
  recent_ = {place, family->first, &family->second};
  return recent_.members;
}

const Members* Symbols::members(std::string_view name, int mode) const {
  const Members* const of_model = members_in(0, name);
  const Members* const of_mode = mode == Scope::no_mode ? nullptr : members_in(place_of(mode), name);
  return of_model && of_mode ? nullptr : of_model ? of_model : of_mode;
}

const Symbol* Symbols::find(const IndexedName& name, int mode) const {
  if (!name.member.empty()) return find_of_world(name.text());
  const auto find_in = [&](std::size_t place) {
    const Members* const family = members_in(place, name.name);
    return family ? family->find(name.indices) : nullptr;
  };
  const Symbol* local = mode == Scope::no_mode ? nullptr : find_in(place_of(mode));
  return local ? local : find_in(0);
}

const Symbol* Symbols::find_of_world(const std::string& name) const {
  const auto found = made_by_world_.find(name);
  return found == made_by_world_.end() ? nullptr : &found->second;
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
  for (const auto& [name, symbol] : made_by_world_) names.push_back(name);
  for (const Names& of_mode : names_) {
    for (const auto& [name, members] : of_mode) {
      for (const std::vector<long>& indices : members.all()) names.push_back(indexed(name, indices));
    }
  }
  std::ranges::sort(names);
  for (const char* builtin : {"t", "pi"}) names.emplace_back(builtin);
  return names;
}

}  // namespace continuo::model::detail
