// continuo/language/check/world/world_settings.cpp
// The settings of a world one by one, each at most once.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/materials.hpp>
#include <continuo/language/check/world/world_settings.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/language/world_methods.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

void WorldSettings::make() {
  const NodeId zero = graph_.constant(0);
  work_.material = {zero, graph_.constant(0.5), zero};
  for (NodeId& component : work_.made.gravity) component = zero;
  for (const auto& item : text_.items) {
    Scope scope = item.scope;
    if (const auto* setting = std::get_if<ast::WorldSetting>(&item.text->node)) read(*setting, scope);
    if (const auto* ignore = std::get_if<ast::WorldIgnore>(&item.text->node)) read_ignore(*ignore);
  }
}

bool WorldSettings::stands_twice(const ast::WorldSetting& setting) {
  for (const auto& other : text_.items) {
    const auto* before = std::get_if<ast::WorldSetting>(&other.text->node);
    if (before == &setting) return false;
    if (!before || before->word.text != setting.word.text) continue;
    if (auto* said =
            report_.fail("E262", setting.word.span, fmt::format("`{}` stands twice in the world", setting.word.text)))
      said->related.push_back({before->word.span, "first here"});
    return true;
  }
  return false;
}

void WorldSettings::read(const ast::WorldSetting& setting, Scope& scope) {
  const std::string& word = setting.word.text;
  if (stands_twice(setting)) return;
  if (word == "gravity") {
    work_.made.gravity =
        numbers_.point(*setting.value, scope, expressions_.workspace.time.per_time(work_.length, 2), "gravity");
  } else if (word == "material") {
    work_.material = material_of(setting.attributes, scope, work_, numbers_);
  } else if (word == "attraction") {
    read_attraction(setting, scope);
  } else if (word == "drag") {
    read_drag(setting, scope);
  } else if (word == "combine") {
    read_combinations(setting);
  } else if (word == "mode") {
    read_mode(setting, scope);
  }
}

void WorldSettings::read_attraction(const ast::WorldSetting& setting, Scope& scope) {
  WorldDescription& made = work_.made;
  const auto given = [&](std::string_view name) { return attribute(setting.attributes, name); };
  const Measured area = product(work_.length, work_.length);
  const Measured constant = quotient(product(expressions_.workspace.time.per_time(work_.length, 2), area), work_.mass);
  made.attraction = numbers_.number(*setting.value, scope, constant, "the constant of attraction", Sort::any);
  const NodeId zero = graph_.constant(0);
  const auto *softening = given("softening"), *opening = given("opening");
  made.softening = softening ? numbers_.number(*softening, scope, work_.length, "softening", Sort::not_negative) : zero;
  made.opening =
      opening ? numbers_.number(*opening, scope, Measured::unknown(), "the opening angle", Sort::not_negative) : zero;
}

void WorldSettings::read_drag(const ast::WorldSetting& setting, Scope& scope) {
  WorldDescription& made = work_.made;
  const auto given = [&](std::string_view name) { return attribute(setting.attributes, name); };
  const Measured per_mass_time = expressions_.workspace.time.per_time(work_.mass);
  const auto *linear = given("linear"), *quadratic = given("quadratic");
  const NodeId zero = graph_.constant(0);
  made.drag_linear = linear ? numbers_.number(*linear, scope, per_mass_time, "linear drag", Sort::not_negative) : zero;
  made.drag_quadratic = quadratic ? numbers_.number(*quadratic, scope, quotient(work_.mass, work_.length),
                                                    "quadratic drag", Sort::not_negative)
                                  : zero;
  if (!linear && !quadratic)
    report_.fail("E225", setting.word.span, "drag of what kind?", {}, "write drag linear 0.1, or drag quadratic 0.02");
}

void WorldSettings::read_combinations(const ast::WorldSetting& setting) {
  CombineRuleDescription& combine_rule = work_.made.combine_rule;
  if (setting.attributes.empty())
    report_.fail("E225", setting.word.span, "combine what?", {},
                 "write combine restitution minimum, or combine friction average");
  for (const ast::WorldAttribute& text : setting.attributes) {
    const std::string& name = std::get<ast::Name>(text.value.node).text;
    if (std::ranges::find(combinations, name) == combinations.end()) {
      report_.fail("E225", text.value.span, fmt::format("surfaces do not combine by `{}`", name), {},
                   fmt::format("they combine by {}", fmt::join(combinations, ", ")));
      continue;
    }
    const std::string& word = text.name.text;
    (word == "restitution" ? combine_rule.restitution
     : word == "friction"  ? combine_rule.friction
                           : combine_rule.rolling) = name;
  }
}

void WorldSettings::read_mode(const ast::WorldSetting& setting, Scope& scope) {
  WorldMode& mode = work_.made.mode;
  mode.fast = std::get<ast::Name>(setting.value->node).text == "fast";
  const auto number = [&](std::string_view name, const Measured& wanted, std::string_view what, Sort sort) {
    const ast::Expression* text = attribute(setting.attributes, name);
    return text ? numbers_.number(*text, scope, wanted, what, sort) : NodeId{};
  };
  const auto count = [&](std::string_view name, int otherwise) {
    const ast::Expression* text = attribute(setting.attributes, name);
    if (!text) return otherwise;
    const auto value = expressions_.indices.whole_number(*text, scope, fmt::format("the number of {}", name));
    if (!value) return otherwise;
    if (*value >= 1 && *value <= 1000) return static_cast<int>(*value);
    report_.fail("E225", text->span, fmt::format("the number of {} goes from 1 to 1000", name),
                 fmt::format("this is {}", *value));
    return otherwise;
  };
  const Measured time = expressions_.workspace.time.in_experiment(), none = Measured::unknown();
  mode.tolerance = number("tolerance", none, "the tolerance", Sort::positive);
  mode.contact_time = number("contact_time", time, "the contact time", Sort::not_negative);
  mode.step = number("step", time, "the step", Sort::positive);
  mode.hertz = number("hertz", none, "the frequency of contacts", Sort::positive);
  mode.sleep_after = number("sleep_after", time, "the time to fall asleep", Sort::not_negative);
  mode.sleep_speed = number("sleep_speed", expressions_.workspace.time.per_time(work_.length), "the speed of sleep",
                            Sort::not_negative);
  mode.substeps = count("substeps", mode.substeps);
  mode.threads = count("threads", mode.threads);
  if (const ast::Expression* text = attribute(setting.attributes, "integrator")) read_integrator(*text);
}

void WorldSettings::settle_mode() {
  WorldDescription& made = work_.made;
  if (!made.is_rigid()) return;
  const ast::WorldSetting* named = nullptr;
  for (const auto& item : text_.items) {
    const auto* setting = std::get_if<ast::WorldSetting>(&item.text->node);
    if (setting && setting->word.text == "mode") named = setting;
  }
  if (named && !made.mode.fast) return;
  const ast::Expression* integrator = named ? attribute(named->attributes, "integrator") : nullptr;
  if (integrator && made.mode.integrator != "semi_implicit_euler")
    report_.fail("E264", integrator->span,
                 fmt::format("`{}` moves balls without joints and meshes", made.mode.integrator),
                 "other bodies, joints and meshes are moved by semi_implicit_euler", "leave `integrator` out");
  made.mode.fast = true;
}

void WorldSettings::read_integrator(const ast::Expression& text) {
  WorldMode& mode = work_.made.mode;
  const std::vector<std::string> names = world_integrators();
  mode.integrator = std::get<ast::Name>(text.node).text;
  if (std::ranges::find(names, mode.integrator) == names.end()) {
    const std::string near = did_you_mean(mode.integrator, names);
    report_.fail("E260", text.span, fmt::format("there is no integrator `{}`", mode.integrator), {},
                 near.empty() ? "there are " + listed(names) : near);
  }
}

void WorldSettings::read_ignore(const ast::WorldIgnore& ignore) {
  std::array<std::uint32_t, 2> numbers{};
  std::size_t k = 0;
  for (const ast::Identifier* name : {&ignore.a, &ignore.b}) {
    const auto known = std::ranges::find(work_.groups, name->text);
    if (known == work_.groups.end()) {
      if (work_.groups.size() == 32) {
        report_.fail("E225", name->span, "there are more than 31 groups");
        return;
      }
      work_.groups.push_back(name->text);
      numbers[k++] = static_cast<std::uint32_t>(work_.groups.size() - 1);
    } else {
      numbers[k++] = static_cast<std::uint32_t>(known - work_.groups.begin());
    }
  }
  work_.made.ignored.emplace_back(numbers[0], numbers[1]);
}

}  // namespace continuo::model::detail
