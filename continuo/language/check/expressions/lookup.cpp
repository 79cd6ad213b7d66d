// continuo/language/check/expressions/lookup.cpp
// A name is an index, a definition, a state, an unknown, of a body, or a mistake.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/names/functions.hpp>
#include <continuo/language/syntax/blackboard.hpp>
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

Lookup::Lookup(Expressions& expressions)
    : expressions_(expressions),
      workspace_(expressions.workspace),
      report_(expressions.report),
      operations_(expressions.operations) {}

Value Lookup::lookup(const ast::Name& name, Scope& scope) const {
  if (name.indices.empty() && name.primes == 0) {
    if (const Index* index = scope.find_index(name.text))
      return operations_.of_number(static_cast<double>(index->value));
  }
  if (!name.member.empty())
    return scope.moment ? without_time(name, scope) : workspace_.world->member(name, scope, expressions_);
  const auto indexed_name = expressions_.indices.name_of(name, scope);
  if (!indexed_name) return operations_.bad();
  const Symbol* symbol = workspace_.declared.symbols.find(*indexed_name, scope.mode);
  if (!symbol && scope.ruled_out && is_outside_of_family(name)) return operations_.of_number(0);
  if (symbol && symbol->kind == Symbol::Kind::base && !scope.is_constant() && !scope.moment)
    return derivative(name, symbol->index, scope);
  return of_symbol(name, symbol, indexed_name->text(), scope);
}

/// It has as many indices as its family, and no member has these.
bool Lookup::is_outside_of_family(const ast::Name& name) const {
  const FamilyShape* family = workspace_.declared.symbols.family(name.text);
  return family && family->dimensions > 0 && name.indices.size() == family->dimensions;
}

Value Lookup::of_symbol(const ast::Name& name, const Symbol* symbol, const std::string& key, Scope& scope) const {
  if (!symbol) return builtin(name, key, scope);
  if (symbol->kind == Symbol::Kind::body) {
    report_.fail("E224", name.span, fmt::format("`{}` is a body, not a number", key), {},
                 fmt::format("say what of it: {0}.x, {0}.x', {0}.radius, ...", key));
    return operations_.bad();
  }
  if (symbol->kind == Symbol::Kind::joint) {
    report_.fail("E224", name.span, fmt::format("`{}` is a joint, not a number", key), {},
                 fmt::format("say what of it: {0}.force_x, {0}.torque, ...", key));
    return operations_.bad();
  }
  if (symbol->kind == Symbol::Kind::definition) {
    const Definition& definition = workspace_.declared.definitions[symbol->index];
    if (name.primes > 0) {
      report_.fail("E218", name.span, fmt::format("`{}` has no derivative", key),
                   fmt::format("it is a {}", word(definition.kind)), "only what has an equation of its own has primes");
      return operations_.bad();
    }
    return scope.is_constant() ? workspace_.definitions.constant(symbol->index, name, scope)
                               : workspace_.definitions.value(symbol->index, name, scope);
  }
  if (symbol->kind == Symbol::Kind::table) {
    report_.fail("E271", name.span, fmt::format("`{}` is a table", name.text), {},
                 fmt::format("read it: interp({}, x)", name.text));
    return operations_.bad();
  }
  if (scope.is_constant()) return not_constant(name.span, key, scope);
  if (scope.moment) return without_time(name, scope);
  if (name.primes > 0) {
    report_.fail("E218", name.span, fmt::format("`{}` has no derivative", key),
                 "it is an unknown of an algebraic equation",
                 fmt::format("give it an equation with {}' and an initial value instead of `unknown`", key));
    return operations_.bad();
  }
  const UnknownText& unknown = workspace_.declared.unknowns[symbol->index];
  return {workspace_.graph.variable(unknown.variable), workspace_.unknown_units[symbol->index]};
}

Value Lookup::not_constant(Span span, const std::string& name, const Scope& scope) const {
  report_.fail("E222", span, fmt::format("{} must be constant", scope.constant),
               fmt::format("`{}` changes with time", name), "use numbers and parameters only");
  return operations_.bad();
}

/// In a condition `y(0) = x + 1` x is none of the numbers known at the start.
Value Lookup::without_time(const ast::Name& name, const Scope& scope) const {
  const std::string_view text = report_.slice(name.span);
  report_.fail("E222", name.span, "a condition names other states with their time",
               fmt::format("`{}` changes with time", text),
               fmt::format("write {}({})", text, report_.slice(scope.moment->span)));
  return operations_.bad();
}

/// t, pi and the sum of all energies; a model may define `energy` itself.
Value Lookup::builtin(const ast::Name& name, const std::string& key, Scope& scope) const {
  if (name.primes == 0 && name.text == "pi" && name.indices.empty())
    return operations_.of_number(3.14159265358979323846);
  if (name.primes == 0 && name.text == "t" && name.indices.empty()) {
    if (scope.is_constant()) return not_constant(name.span, "t", scope);
    return {workspace_.graph.variable(Layout::time), workspace_.time.in_expressions()};
  }
  if (key == "energy" && name.primes == 0 && !scope.is_constant()) {
    const Value total = total_energy(name.span, scope);
    if (total.node.valid()) return total;
  }
  return unknown_name(name, key);
}

std::vector<NodeId> Lookup::world_energies() const {
  if (!workspace_.declared.world.text) return {};
  const auto first = static_cast<std::uint32_t>(first_world_measure());
  return {workspace_.graph.variable(workspace_.layout.states + first),
          workspace_.graph.variable(workspace_.layout.states + first + 1)};
}

std::size_t Lookup::first_world_measure() const {
  const Symbol* measures = workspace_.declared.symbols.find_of_world("world.kinetic");
  return workspace_.declared.bases[measures->index].first;
}

Value Lookup::total_energy(Span span, Scope& scope) const {
  Value total;
  if (const std::vector<NodeId> parts = world_energies(); !parts.empty())
    total = {workspace_.graph.add(parts[0], parts[1]), workspace_.units.of_state(first_world_measure())};
  for (std::size_t i = 0; i < workspace_.declared.definitions.size(); ++i) {
    if (workspace_.declared.definitions[i].kind != Definition::Kind::energy) continue;
    const ast::Name& name = workspace_.declared.definitions[i].text->name;
    Term term{*workspace_.declared.definitions[i].value, workspace_.definitions.value(i, name, scope)};
    if (term.value.bad) return operations_.bad();
    if (!total.node.valid()) {
      total = term.value;
    } else if (expressions_.translator.align({*workspace_.declared.definitions[i].value, total}, term, span, scope)) {
      total = {workspace_.graph.add(total.node, term.value.node), common(total.measured, term.value.measured)};
    } else {
      return operations_.bad();
    }
  }
  return total;
}

/// t and pi with a prime or an index, sin without its argument.
Value Lookup::not_a_value(const ast::Name& name) const {
  if (report_.was_reported("E214", name.span)) return operations_.bad();
  if (is_function(name.text)) {
    const Function* function = find_function(name.text);
    report_.fail("E216", name.span,
                 fmt::format("`{}` takes {}", name.text, function ? arguments_of(*function) : "a table and a number"),
                 "here is none", "write " + example_of_call(name.text));
    return operations_.bad();
  }
  const std::string meaning(meaning_of_its_own(name.text));
  if (name.primes > 0) {
    report_.fail("E218", name.span, fmt::format("`{}` has no derivative", name.text), meaning,
                 "only what has an equation of its own has primes");
  } else {
    report_.fail("E219", name.span, fmt::format("`{}` has no index", name.text), meaning,
                 fmt::format("write {}", name.text));
  }
  return operations_.bad();
}

/// What a name that is not declared stands for: a derivative (dx/dt, x_dot), an initial value (x0, x_0), a power of
/// Euler's number. Empty where it is none of these.
std::string Lookup::blackboard_help(const ast::Name& name) const {
  const Source& source = report_.source();
  const auto is_state = [&](std::string_view base) {
    return std::ranges::any_of(workspace_.declared.bases, [&](const Base& known) { return known.name == base; });
  };
  const auto base_of = [](const std::string& primed) { return primed.substr(0, primed.find('\'')); };
  const std::string_view text = std::string_view(source.text()).substr(name.span.begin);
  if (const auto whole = derivative_by_time(text); whole && is_state(base_of(whole->primed)))
    return with_corrected_line("a derivative is written with a prime", source,
                               {name.span.begin, name.span.begin + static_cast<std::uint32_t>(whole->size)},
                               whole->primed);
  if (const auto primed = derivative_in_name(name.text); primed && is_state(base_of(*primed)))
    return with_corrected_line("a derivative is written with a prime", source, name.span, *primed);
  for (const std::string_view zero : {"_0", "0"}) {
    if (!name.text.ends_with(zero)) continue;
    const std::string base = name.text.substr(0, name.text.size() - zero.size());
    if (is_state(base)) return with_corrected_line("an initial value is written", source, name.span, base + "(0)");
  }
  if (name.text != "e" || !text.starts_with("e^")) return {};
  const std::size_t end = text[2] == '(' ? text.find(')') : std::min(text.find_first_of(" +*/,;)\r\n"), text.size());
  if (end == std::string_view::npos) return {};
  const std::string_view exponent = text[2] == '(' ? text.substr(3, end - 3) : text.substr(2, end - 2);
  if (exponent.find('(') != std::string_view::npos) return {};
  const auto size = static_cast<std::uint32_t>(text[2] == '(' ? end + 1 : end);
  return with_corrected_line("powers of Euler's number are exp(x)", source, {name.span.begin, name.span.begin + size},
                             fmt::format("exp({})", exponent));
}

/// `undeclared`: what to do about it where the name is not like any other.
Value Lookup::unknown_name(const ast::Name& name, const std::string& key, std::string undeclared) const {
  if (report_.was_reported("E210", name.span) || report_.was_reported("E220", name.span) || report_.is_silent())
    return operations_.bad();
  if (!name.indices.empty() && workspace_.declared.symbols.is_lost(name.text)) return operations_.bad();
  if (!meaning_of_its_own(name.text).empty() || is_function(name.text)) return not_a_value(name);
  const FamilyShape* family = workspace_.declared.symbols.family(name.text);
  if (!family) {
    std::string near = did_you_mean(name.text, workspace_.declared.symbols.all());
    if (const auto here = name_from_elsewhere(name.text); !here.empty()) near = here;
    if (const std::string here = blackboard_help(name); !here.empty()) near = here;
    if (undeclared.empty()) undeclared = fmt::format("declare it: param {} = ..., or give it an equation", name.text);
    report_.fail("E210", name.span, fmt::format("there is no `{}`", key), {}, near.empty() ? undeclared : near);
    return operations_.bad();
  }
  const FamilyShape& shape = *family;
  const std::string first = indexed(name.text, shape.low), last = indexed(name.text, shape.high);
  if (name.indices.size() == shape.dimensions) {
    report_.fail("E220", name.span, fmt::format("`{}` is out of range", key),
                 fmt::format("`{}` goes from `{}` to `{}`", name.text, first, last));
  } else if (shape.dimensions == 0) {
    const bool is_start = report_.source().slice(name.span) == name.text + "[0]";
    report_.fail("E219", name.span, fmt::format("`{}` has no index", name.text), {},
                 is_start ? fmt::format("an initial value is written {}(0) = ...", name.text)
                          : fmt::format("write {}", name.text));
  } else {
    report_.fail("E219", name.span,
                 fmt::format("`{}` needs {}", name.text,
                             shape.dimensions == 1 ? "one index" : fmt::format("{} indices", shape.dimensions)),
                 fmt::format("`{}` goes from `{}` to `{}`", name.text, first, last), fmt::format("write {}", first));
  }
  return operations_.bad();
}

Measured Lookup::highest_unit(std::size_t base, const Scope& scope) const {
  return workspace_.time.per_time(workspace_.units.of(base, workspace_.declared.bases[base].order - 1, scope.depth));
}

Value Lookup::derivative(const ast::Name& name, std::size_t index, Scope& scope) const {
  const Base& base = workspace_.declared.bases[index];
  if (name.primes < base.order) {
    const std::size_t state = base.first + static_cast<std::size_t>(name.primes);
    return {workspace_.graph.variable(workspace_.layout.states + static_cast<std::uint32_t>(state)),
            workspace_.units.of(index, name.primes, scope.depth)};
  }
  if (base.is_measure && base.family != "world") {
    report_.fail("E226", name.span, fmt::format("`{}` follows from the bodies", base.name),
                 "it has no derivative and no equation");
    return operations_.bad();
  }
  if (base.in_world) {
    refuse_equation_of_body(name, report_);
    return operations_.bad();
  }
  if (name.primes == base.order) {
    if (scope.highest) scope.highest->push_back(static_cast<std::uint32_t>(index));
    return {workspace_.graph.variable(highest_begin + static_cast<std::uint32_t>(index)), highest_unit(index, scope)};
  }
  report_.fail("E218", name.span, fmt::format("`{}` is not to be had", with_primes(base.name, name.primes)),
               fmt::format("the highest derivative in the equations is `{}`", with_primes(base.name, base.order)));
  return operations_.bad();
}

}  // namespace continuo::model::detail
