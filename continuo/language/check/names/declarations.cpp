// continuo/language/check/names/declarations.cpp
// Modes by name, and bases by their states.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/declarations.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

std::size_t Declarations::base_index_of_state(std::size_t state) const {
  const auto after = std::ranges::upper_bound(bases, state, {}, &Base::first);
  return static_cast<std::size_t>(after - bases.begin()) - 1;
}

bool JointText::has_motor() const {
  return std::ranges::find(text->attributes, "motor", [](const auto& one) { return one.name.text; }) !=
         text->attributes.end();
}

std::size_t find_mode(const Declarations& declared, std::string_view name) {
  const auto found = std::ranges::find(declared.modes, name, &ModeText::name);
  return found == declared.modes.end() ? npos : static_cast<std::size_t>(found - declared.modes.begin());
}

std::optional<std::size_t> mode_named(const Declarations& declared, const ast::Identifier& name, Report& report) {
  const std::size_t found = find_mode(declared, name.text);
  if (found != npos) return found;
  std::vector<std::string> names;
  for (const ModeText& mode : declared.modes) {
    if (!mode.name.empty()) names.push_back(mode.name);
  }
  std::string help;
  if (names.empty()) {
    help = fmt::format("the model has no modes; write `mode {} {{ ... }}`", name.text);
  } else {
    const std::string near = did_you_mean(name.text, names);
    help = near.empty() ? "the modes are " + listed(names) : near;
  }
  report.fail("E250", name.span, fmt::format("there is no mode `{}`", name.text), {}, help);
  return std::nullopt;
}

}  // namespace continuo::model::detail
