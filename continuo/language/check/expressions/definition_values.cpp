// continuo/language/check/expressions/definition_values.cpp
// Definitions are translated when they are first asked for; E212 where one leads back to itself.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

namespace {

/// What a run can change: in expressions it is a variable.
bool is_variable(const Definition& definition) {
  return definition.kind == Definition::Kind::parameter || definition.kind == Definition::Kind::input;
}

}  // namespace

DefinitionValues::Entry& DefinitionValues::entry(std::size_t definition) {
  if (definition >= entries_.size()) entries_.resize(workspace_.declared.definitions.size());
  return entries_[definition];
}

/// The names of the circle, from the first that leans on itself.
Value DefinitionValues::circular(std::size_t definition, Span span) const {
  const auto& definitions = workspace_.declared.definitions;
  std::string circle;
  for (auto at = std::ranges::find(busy_, definition); at != busy_.end(); ++at)
    circle += definitions[*at].name + " -> ";
  workspace_.report.fail("E212", span, fmt::format("`{}` is defined by itself", definitions[definition].name),
                         circle + definitions[definition].name,
                         "break the circle, or give one of them an equation with a derivative");
  return {.node = workspace_.graph.constant(0), .bad = true};
}

Value DefinitionValues::value(std::size_t index, const ast::Name& name, const Scope& outer) {
  const Progress progress = entry(index).progress;
  if (progress == Progress::busy) return circular(index, name.span);
  if (progress == Progress::untouched) find(index, outer);
  const Entry& found = entry(index);
  if (outer.highest) outer.highest->insert(outer.highest->end(), found.highest.begin(), found.highest.end());
  Value value = found.value;
  const Definition& definition = workspace_.declared.definitions[index];
  if (is_variable(definition) && !value.bad) value.node = workspace_.graph.variable(definition.variable);
  return value;
}

/// Reported to the report of the check, whoever asks: nobody finds it again.
void DefinitionValues::find(std::size_t index, const Scope& outer) {
  const Definition& definition = workspace_.declared.definitions[index];
  entry(index).progress = Progress::busy;
  busy_.push_back(index);
  const Expressions expressions(workspace_);
  std::vector<std::uint32_t> highest;
  Scope scope = definition.scope;
  scope.highest = &highest;
  scope.depth = outer.depth;
  Value value = expressions.translator.translate(*definition.value, scope);
  if (definition.kind != Definition::Kind::let) expressions.operations.want_number(*definition.value, value);
  value = finished(index, std::move(value));
  busy_.pop_back();
  Entry& found = entry(index);
  found.value = std::move(value);
  found.highest = std::move(highest);
  found.progress = Progress::done;
}

Value DefinitionValues::finished(std::size_t index, Value value) {
  const Definition& definition = workspace_.declared.definitions[index];
  if (definition.kind == Definition::Kind::parameter) evaluation_order_.push_back(index);
  if (!is_variable(definition)) return value;
  if (value.measured.is_number() && !entry(index).structural) value.measured = Measured::unknown();
  if (value.bad) return value;
  const auto set = workspace_.overrides.find(definition.name);
  if (set != workspace_.overrides.end()) value.node = workspace_.graph.constant(set->second);
  const bool parameter = definition.kind == Definition::Kind::parameter;
  const Expressions expressions(workspace_);
  if (!expressions.values.only_parameters(value.node, definition.value->span,
                                          parameter ? "the value of a parameter" : "the value of an input",
                                          fmt::format("to name what changes, write let {} = ...", definition.name))) {
    return expressions.operations.bad();
  }
  return value;
}

Value DefinitionValues::constant(std::size_t index, const ast::Name& name, const Scope& outer) {
  const Definition& definition = workspace_.declared.definitions[index];
  if (definition.kind != Definition::Kind::parameter && definition.kind != Definition::Kind::let) {
    const Expressions expressions(workspace_);
    return expressions.lookup.not_constant(name.span, definition.name, outer);
  }
  entry(index).structural = true;
  if (entry(index).constant_progress == Progress::busy) return circular(index, name.span);
  if (entry(index).constant_progress == Progress::untouched) find_constant(index, outer);
  return entry(index).constant;
}

std::optional<NodeId> DefinitionValues::structural_value(std::size_t definition) {
  const Entry& found = entry(definition);
  const bool is_known = found.structural && found.constant_progress == Progress::done && !found.constant.bad;
  return is_known ? std::optional(found.constant.node) : std::nullopt;
}

void DefinitionValues::find_constant(std::size_t index, const Scope& outer) {
  const Definition& definition = workspace_.declared.definitions[index];
  entry(index).constant_progress = Progress::busy;
  busy_.push_back(index);
  const Expressions expressions(workspace_);
  Scope scope = definition.scope;
  scope.constant = outer.constant;
  scope.depth = outer.depth;
  Value value = expressions.translator.translate(*definition.value, scope);
  if (definition.kind == Definition::Kind::parameter && !value.bad) {
    const auto set = workspace_.overrides.find(definition.name);
    if (set != workspace_.overrides.end()) value.node = workspace_.graph.constant(set->second);
    if (value.measured.is_number()) value.measured = Measured::unknown();
  }
  busy_.pop_back();
  Entry& found = entry(index);
  found.constant = std::move(value);
  found.constant_progress = Progress::done;
}

}  // namespace continuo::model::detail
