// continuo/language/check/expressions/lookup.cpp
// What a name stands for.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/names/checker.hpp>
#include <continuo/language/check/names/functions.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

const char* word(Definition::Kind kind) {
  switch (kind) {
    case Definition::Kind::parameter:
      return "param";
    case Definition::Kind::input:
      return "input";
    case Definition::Kind::let:
      return "let";
    case Definition::Kind::output:
      return "output";
    case Definition::Kind::energy:
      return "energy";
  }
  return "";
}

}  // namespace

std::string_view meaning_of_its_own(std::string_view name) {
  return name == "t" ? "this is time" : name == "pi" ? "3.14159..." : "";
}

Value Checker::lookup(const ast::Name& name, Scope& scope) {
  if (name.indices.empty() && name.primes == 0) {
    for (std::size_t i = scope.indices.size(); i-- > 0;) {
      if (scope.indices[i].name == name.text) return of_number(static_cast<double>(scope.indices[i].value));
    }
  }
  if (!name.member.empty()) return scope.moment ? without_time(name, scope) : member(name, scope);
  const auto key = key_of(name, scope);
  if (!key) return bad();
  const Symbol* symbol = find(*key, scope.mode);
  if (!symbol) return builtin(name, *key, scope);
  if (symbol->kind == Symbol::Kind::body) {
    fail("E224", name.span, fmt::format("`{}` is a body, not a number", *key), {},
         fmt::format("say what of it: {0}.x, {0}.x', {0}.radius, ...", *key));
    return bad();
  }
  if (symbol->kind == Symbol::Kind::definition) {
    const Definition& definition = definitions_[symbol->index];
    if (name.primes > 0) {
      fail("E218", name.span, fmt::format("`{}` has no derivative", *key),
           fmt::format("it is a {}", word(definition.kind)), "only what has an equation of its own has primes");
      return bad();
    }
    return scope.is_constant() ? constant_defined(symbol->index, name, scope) : defined(symbol->index, name, scope);
  }
  if (symbol->kind == Symbol::Kind::table) {
    fail("E271", name.span, fmt::format("`{}` is a table", name.text), {},
         fmt::format("read it: interp({}, x)", name.text));
    return bad();
  }
  if (scope.is_constant()) return not_constant(name.span, *key, scope);
  if (scope.moment) return without_time(name, scope);
  if (symbol->kind == Symbol::Kind::base) return derivative(name, symbol->index, scope);
  if (name.primes > 0) {
    fail("E218", name.span, fmt::format("`{}` has no derivative", *key), "it is an unknown of an algebraic equation",
         fmt::format("give it an equation with {}' and an initial value instead of `unknown`", *key));
    return bad();
  }
  const UnknownText& unknown = unknowns_[symbol->index];
  return {model_.graph.variable(unknown.variable), unknown.measured};
}

Value Checker::not_constant(Span span, const std::string& name, const Scope& scope) {
  fail("E222", span, fmt::format("{} must be constant", scope.constant), fmt::format("`{}` changes with time", name),
       "use numbers and parameters only");
  return bad();
}

/// In a condition `y(0) = x + 1` x is none of the numbers known at the start.
Value Checker::without_time(const ast::Name& name, const Scope& scope) {
  const std::string_view text = source_.slice(name.span);
  fail("E222", name.span, "a condition names other states with their time", fmt::format("`{}` changes with time", text),
       fmt::format("write {}({})", text, source_.slice(scope.moment->span)));
  return bad();
}

/// t, pi and the sum of all energies; a model may define `energy` itself.
Value Checker::builtin(const ast::Name& name, const std::string& key, Scope& scope) {
  if (name.primes == 0 && name.text == "pi" && name.indices.empty()) return of_number(3.14159265358979323846);
  if (name.primes == 0 && name.text == "t" && name.indices.empty()) {
    if (scope.is_constant()) return not_constant(name.span, "t", scope);
    return {model_.graph.variable(Layout::time), time_measure()};
  }
  if (key == "energy" && name.primes == 0 && !scope.is_constant()) {
    const Value total = total_energy(name.span, scope);
    if (total.node.valid()) return total;
  }
  return unknown_name(name, key);
}

Value Checker::total_energy(Span span, Scope& scope) {
  Value total;
  if (world_.text) {  // kinetic and potential
    const std::size_t first = bases_[find("world.kinetic", Scope::no_mode)->index].first;
    const NodeId kinetic = model_.graph.variable(model_.layout.states + static_cast<std::uint32_t>(first));
    const NodeId potential = model_.graph.variable(model_.layout.states + static_cast<std::uint32_t>(first + 1));
    total = {model_.graph.add(kinetic, potential), measures_[first]};
  }
  for (std::size_t i = 0; i < definitions_.size(); ++i) {
    if (definitions_[i].kind != Definition::Kind::energy) continue;
    const ast::Name& name = definitions_[i].text->name;
    Term term{*definitions_[i].value, defined(i, name, scope)};
    if (term.value.bad) return bad();
    if (!total.node.valid()) {
      total = term.value;
    } else if (align({*definitions_[i].value, total}, term, span, scope)) {
      total = {model_.graph.add(total.node, term.value.node), common(total.measured, term.value.measured)};
    } else {
      return bad();
    }
  }
  return total;
}

/// t and pi with a prime or an index, sin without its argument.
Value Checker::not_a_value(const ast::Name& name) {
  if (was_reported("E214", name.span)) return bad();
  if (is_function(name.text)) {
    const Function* function = find_function(name.text);
    fail("E216", name.span,
         fmt::format("`{}` takes {}", name.text, function ? arguments_of(*function) : "a table and a number"),
         "here is none", "write " + example_of_call(name.text));
    return bad();
  }
  const std::string meaning(meaning_of_its_own(name.text));
  if (name.primes > 0) {
    fail("E218", name.span, fmt::format("`{}` has no derivative", name.text), meaning,
         "only what has an equation of its own has primes");
  } else {
    fail("E219", name.span, fmt::format("`{}` has no index", name.text), meaning, fmt::format("write {}", name.text));
  }
  return bad();
}

/// `undeclared`: what to do about it where the name is not like any other.
Value Checker::unknown_name(const ast::Name& name, const std::string& key, std::string undeclared) {
  if (was_reported("E210", name.span) || was_reported("E220", name.span) || silent_) return bad();
  if (!name.indices.empty() && lost_.contains(name.text)) return bad();
  if (!meaning_of_its_own(name.text).empty() || is_function(name.text)) return not_a_value(name);
  const auto family = families_.find(name.text);
  if (family == families_.end()) {
    std::string near = did_you_mean(name.text, all_names());
    if (const auto here = name_from_elsewhere(name.text); !here.empty()) near = here;
    if (undeclared.empty()) undeclared = fmt::format("declare it: param {} = ..., or give it an equation", name.text);
    fail("E210", name.span, fmt::format("there is no `{}`", key), {}, near.empty() ? undeclared : near);
    return bad();
  }
  const FamilyShape& shape = family->second;
  const std::string first = indexed(name.text, shape.low), last = indexed(name.text, shape.high);
  if (name.indices.size() == shape.dimensions) {
    fail("E220", name.span, fmt::format("`{}` is out of range", key),
         fmt::format("`{}` goes from `{}` to `{}`", name.text, first, last));
  } else if (shape.dimensions == 0) {
    fail("E219", name.span, fmt::format("`{}` has no index", name.text), {}, fmt::format("write {}", name.text));
  } else {
    fail("E219", name.span,
         fmt::format("`{}` needs {}", name.text,
                     shape.dimensions == 1 ? "one index" : fmt::format("{} indices", shape.dimensions)),
         fmt::format("`{}` goes from `{}` to `{}`", name.text, first, last), fmt::format("write {}", first));
  }
  return bad();
}

Value Checker::derivative(const ast::Name& name, std::size_t index, Scope& scope) {
  const Base& base = bases_[index];
  if (name.primes < base.order) {
    const std::size_t state = base.first + static_cast<std::size_t>(name.primes);
    return {model_.graph.variable(model_.layout.states + static_cast<std::uint32_t>(state)),
            state_measure(index, name.primes, scope.depth)};
  }
  if (base.in_world) {
    refuse_equation_of_body(name);
    return bad();
  }
  if (name.primes == base.order) {
    if (scope.highest) scope.highest->push_back(static_cast<std::uint32_t>(index));
    return {model_.graph.variable(highest_begin + static_cast<std::uint32_t>(index)),
            per_time(state_measure(index, base.order - 1, scope.depth))};
  }
  fail("E218", name.span, fmt::format("`{}` is not to be had", with_primes(base.name, name.primes)),
       fmt::format("the highest derivative in the equations is `{}`", with_primes(base.name, base.order)));
  return bad();
}

/// The names of the circle, from the first that leans on itself.
Value Checker::circular(std::size_t index, Span span) {
  std::string circle;
  for (auto at = std::ranges::find(busy_, index); at != busy_.end(); ++at) circle += definitions_[*at].name + " -> ";
  fail("E212", span, fmt::format("`{}` is defined by itself", definitions_[index].name),
       circle + definitions_[index].name, "break the circle, or give one of them an equation with a derivative");
  return bad();
}

Value Checker::defined(std::size_t index, const ast::Name& name, const Scope& outer) {
  Definition& definition = definitions_[index];
  if (definition.progress == Progress::busy) return circular(index, name.span);
  if (definition.progress == Progress::untouched) {
    definition.progress = Progress::busy;
    busy_.push_back(index);
    std::vector<std::uint32_t> highest;
    Scope scope = definition.scope;
    scope.highest = &highest;
    scope.depth = outer.depth;
    Value value = elaborate(*definition.value, scope);
    if (definition.kind != Definition::Kind::let) want_number(*definition.value, value);
    finish_definition(index, std::move(value));
    definition.highest = std::move(highest);
    busy_.pop_back();
    definition.progress = Progress::done;
  }
  if (outer.highest) outer.highest->insert(outer.highest->end(), definition.highest.begin(), definition.highest.end());
  Value value = definition.result;
  const bool variable = definition.kind == Definition::Kind::parameter || definition.kind == Definition::Kind::input;
  if (variable && !value.bad) value.node = model_.graph.variable(definition.variable);
  return value;
}

void Checker::finish_definition(std::size_t index, Value value) {
  Definition& definition = definitions_[index];
  const bool declared = definition.kind == Definition::Kind::parameter || definition.kind == Definition::Kind::input;
  if (declared && value.measured.is_number() && !definition.structural) value.measured = Measured::unknown();
  if (declared && !value.bad) {
    const auto set = overrides_.find(definition.name);
    if (set != overrides_.end()) value.node = model_.graph.constant(set->second);
    const bool parameter = definition.kind == Definition::Kind::parameter;
    if (!only_parameters(value.node, definition.value->span,
                         parameter ? "the value of a parameter" : "the value of an input",
                         fmt::format("to name what changes, write let {} = ...", definition.name))) {
      value = bad();
    }
  }
  if (definition.kind == Definition::Kind::parameter) evaluation_order_.push_back(index);
  definition.result = std::move(value);
}

Value Checker::constant_defined(std::size_t index, const ast::Name& name, const Scope& outer) {
  Definition& definition = definitions_[index];
  if (definition.kind != Definition::Kind::parameter && definition.kind != Definition::Kind::let) {
    return not_constant(name.span, definition.name, outer);
  }
  definition.structural = true;
  if (definition.constant_progress == Progress::busy) return circular(index, name.span);
  if (definition.constant_progress == Progress::untouched) {
    definition.constant_progress = Progress::busy;
    busy_.push_back(index);
    Scope scope = definition.scope;
    scope.constant = outer.constant;
    scope.depth = outer.depth;
    Value value = elaborate(*definition.value, scope);
    const auto set = overrides_.find(definition.name);
    if (definition.kind == Definition::Kind::parameter && !value.bad) {
      if (set != overrides_.end()) value.node = model_.graph.constant(set->second);
      if (value.measured.is_number()) value.measured = Measured::unknown();
    }
    busy_.pop_back();
    Definition& again = definitions_[index];
    again.constant_result = std::move(value);
    again.constant_progress = Progress::done;
  }
  return definitions_[index].constant_result;
}

}  // namespace continuo::model::detail
