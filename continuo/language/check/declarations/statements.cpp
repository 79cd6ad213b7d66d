// continuo/language/check/declarations/statements.cpp
// Every declared name, once; the walk keeps to the order of the text.
#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/declarations/files.hpp>
#include <continuo/language/check/declarations/statements.hpp>

namespace continuo::model::detail {

namespace {

bool is_simple(const ast::Definition& item) {
  return item.name.indices.empty() && !item.elements;
}

}  // namespace

void Statements::declare_modes() {
  for (const ast::Statement& statement : tree_.statements) {
    const auto* mode = std::get_if<ast::Mode>(&statement.node);
    if (!mode) continue;
    const std::size_t before = find_mode(declared_, mode->name.text);
    if (before == npos) {
      declared_.modes.push_back({mode->name.text, mode->name.span});
    } else if (auto* said =
                   report_.fail("E211", mode->name.span, fmt::format("mode `{}` is written twice", mode->name.text))) {
      said->related.push_back({declared_.modes[before].span, "first here"});
    }
  }
  if (declared_.modes.empty()) declared_.modes.push_back({"", {}});
}

void Statements::declare_top_level() {
  Scope scope;
  for (const ast::Statement& statement : tree_.statements) {
    const auto define_simple = [&](Definition::Kind kind, const std::vector<ast::Definition>& items) {
      for (const ast::Definition& item : items) {
        if (is_simple(item)) define_member(kind, item, {}, item.value, scope, nullptr);
      }
    };
    if (const auto* parameters = std::get_if<ast::Parameters>(&statement.node)) {
      define_simple(Definition::Kind::parameter, parameters->items);
    } else if (const auto* lets = std::get_if<ast::Lets>(&statement.node)) {
      define_simple(Definition::Kind::let, lets->items);
    }
  }
}

void Statements::define_member(Definition::Kind kind, const ast::Definition& item, std::span<const long> indices,
                               const ast::Expression& value, const Scope& scope, const ast::Input* input) {
  const std::string name = indexed(item.name.text, indices);
  const Symbol symbol{Symbol::Kind::definition, declared_.definitions.size(), item.name.span};
  if (item.name.primes > 0) {
    report_.fail("E218", item.name.span, "a definition has no primes", {},
                 fmt::format("as an equation of its own line: {} = ...", report_.quote(item.name.span)));
    return;
  }
  if (!declared_.symbols.declare(item.name.text, indices, scope.mode, symbol, report_)) return;
  declared_.definitions.push_back({kind, name, &value, &item, input, scope});
}

void Statements::define_all(Definition::Kind kind, const std::vector<ast::Definition>& items, Scope& scope,
                            bool inside) {
  const bool declared = !inside && (kind == Definition::Kind::parameter || kind == Definition::Kind::let);
  for (const ast::Definition& item : items) {
    if (item.elements) {
      define_elements(kind, item, scope);
    } else if (!declared || !is_simple(item)) {
      if (const auto indices = expressions_.indices.indices_of(item.name, scope)) {
        define_member(kind, item, *indices, item.value, scope, nullptr);
      }
    }
  }
}

/// `param m[1..3] = (3, 4, 5)`; one value stands for all members.
void Statements::define_elements(Definition::Kind kind, const ast::Definition& item, Scope& scope) {
  const auto ends = expressions_.indices.bounds(*item.elements, scope);
  if (!ends) declared_.symbols.lose(item.name.text);
  if (!ends) return;
  const auto* list = std::get_if<ast::List>(&item.value.node);
  const long count = ends->second - ends->first + 1;
  if (list && static_cast<long>(list->items.size()) != count) {
    report_.fail("E220", item.value.span, fmt::format("`{}` needs {} values", item.name.text, std::max(count, 0L)),
                 fmt::format("here {} {}", list->items.size() == 1 ? "is" : "are", list->items.size()));
    declared_.symbols.lose(item.name.text);
    return;
  }
  for (long i = ends->first; i <= ends->second && expressions_.indices.count_written_out(item.elements->span); ++i) {
    const auto& value = list ? list->items[static_cast<std::size_t>(i - ends->first)] : item.value;
    define_member(kind, item, std::array{i}, value, scope, nullptr);
  }
}

void Statements::walk() {
  Scope scope;
  walk(tree_.statements, scope, false);
  orders_.finish();
}

void Statements::walk(const std::vector<ast::Statement>& statements, Scope& scope, bool inside) {
  for (const ast::Statement& statement : statements) walk_statement(statement, scope, inside);
}

/// Of a large family the first member, with the families in it, tells how much room the others take.
void Statements::walk_family(const ast::Family& family, Scope& scope, bool inside) {
  bool is_first_of_all = !inside;
  const auto member = [&](std::size_t left) {
    const std::size_t bases = declared_.bases.size(), conditions = declared_.conditions.size(),
                      equations = declared_.equations.size();
    walk(family.body, scope, true);
    if (!std::exchange(is_first_of_all, false)) return;
    const auto make_room = [&](auto& list, std::size_t before) {
      list.reserve(list.size() + std::min(most_written_out, left * (list.size() - before)));
    };
    make_room(declared_.bases, bases);
    make_room(declared_.conditions, conditions);
    make_room(declared_.equations, equations);
  };
  if (!expressions_.indices.for_each_kept_index(family.index, family.range, scope, member)) lose(family.body);
}

void Statements::walk_mode(const ast::Mode& mode, Scope& scope) {
  const std::size_t index = find_mode(declared_, mode.name.text);
  scope.mode = static_cast<int>(index);
  walk(mode.body, scope, true);
  scope.mode = Scope::no_mode;
}

/// The names that a family would have declared.
void Statements::lose(const std::vector<ast::Statement>& body) {
  for (const ast::Statement& statement : body) {
    std::visit(
        [&](const auto& node) {
          if constexpr (requires { node.items.front().name.text; }) {
            for (const auto& item : node.items) declared_.symbols.lose(item.name.text);
          } else if constexpr (requires { node.name.text; }) {
            declared_.symbols.lose(node.name.text);
          } else if constexpr (requires { node.left.node; }) {
            if (const auto* name = std::get_if<ast::Name>(&node.left.node)) declared_.symbols.lose(name->text);
          } else if constexpr (requires { node.range; }) {
            lose(node.body);
          }
        },
        statement.node);
  }
}

void Statements::walk_statement(const ast::Statement& statement, Scope& scope, bool inside) {
  const Span span = statement.span;
  std::visit(
      [&](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Parameters>) {
          define_all(Definition::Kind::parameter, node.items, scope, inside);
        } else if constexpr (std::is_same_v<T, ast::Lets>) {
          define_all(Definition::Kind::let, node.items, scope, inside);
        } else if constexpr (std::is_same_v<T, ast::Outputs>) {
          define_all(Definition::Kind::output, node.items, scope, inside);
        } else if constexpr (std::is_same_v<T, ast::Energies>) {
          define_all(Definition::Kind::energy, node.items, scope, inside);
        } else if constexpr (std::is_same_v<T, ast::Input>) {
          if (const auto indices = expressions_.indices.indices_of(node.definition.name, scope)) {
            define_member(Definition::Kind::input, node.definition, *indices, node.definition.value, scope, &node);
          }
        } else if constexpr (std::is_same_v<T, ast::Equation>) {
          orders_.see_equation(node, scope, span);
        } else if constexpr (std::is_same_v<T, ast::Condition>) {
          orders_.see_condition(node, scope, span);
        } else if constexpr (std::is_same_v<T, ast::Family>) {
          walk_family(node, scope, inside);
        } else if constexpr (std::is_same_v<T, ast::Mode>) {
          walk_mode(node, scope);
        } else {
          walk_other(node, scope, span);
        }
      },
      statement.node);
}

void Statements::walk_other(const ast::Table& table, Scope&, Span) {
  const Symbol symbol{Symbol::Kind::table, declared_.tables.size(), table.name.span};
  if (!declared_.symbols.declare(table.name.text, {}, Scope::no_mode, symbol, report_)) return;
  const std::string file = file_of(table.file, table.file_span, report_);
  declared_.tables.push_back(
      {table.name.text, file, points_of(file, table.file_span, Table::Between::linear, {}, report_), table.name.span});
}

void Statements::walk_other(const ast::Unknown& unknown, Scope& scope, Span span) {
  const auto indices = expressions_.indices.indices_of(unknown.name, scope);
  if (!indices) return;
  const std::string name = indexed(unknown.name.text, *indices);
  const Symbol symbol{Symbol::Kind::unknown, declared_.unknowns.size(), unknown.name.span};
  if (declared_.symbols.declare(unknown.name.text, *indices, Scope::no_mode, symbol, report_))
    declared_.unknowns.push_back({&unknown, scope, span, name});
}

void Statements::walk_other(const ast::Start& start, Scope&, Span span) {
  if (declared_.start) {
    auto* said = report_.fail("E262", span, "the start mode is said twice", "only one `start in` can stand");
    if (said) said->related.push_back({declared_.start->mode.span, "first here"});
    return;
  }
  declared_.start = &start;
}

void Statements::walk_other(const ast::Run& run, Scope&, Span span) {
  if (declared_.run) {
    if (auto* said = report_.fail("E262", span, "`run` stands twice"))
      said->related.push_back({declared_.run_span, "first here"});
    return;
  }
  declared_.run = &run;
  declared_.run_span = span;
}

void Statements::walk_other(const ast::Sweep& sweep, Scope&, Span span) {
  if (declared_.sweep) {
    if (auto* said = report_.fail("E262", span, "`sweep` stands twice"))
      said->related.push_back({declared_.sweep_span, "first here"});
    return;
  }
  declared_.sweep = &sweep;
  declared_.sweep_span = span;
}

}  // namespace continuo::model::detail
