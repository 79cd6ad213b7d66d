// continuo/language/check/declarations/statements.cpp
// Every declared name, once: families are written out, what is declared twice or under a taken name is reported.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <continuo/language/check/expressions/indices.hpp>
#include <continuo/language/check/names/functions.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

/// Names in a mode are found before those of the model.
std::string in_mode(int mode, const std::string& name) {
  return mode == Scope::no_mode ? name : std::to_string(mode) + ":" + name;
}

bool is_simple(const ast::Definition& item) {
  return item.name.indices.empty() && !item.elements;
}

}  // namespace

void Checker::declare_modes() {
  for (const ast::Statement& statement : tree_.statements) {
    const auto* mode = std::get_if<ast::Mode>(&statement.node);
    if (!mode) continue;
    const std::size_t before = find_mode(model_, mode->name.text);
    if (before == npos) {
      model_.modes.push_back({mode->name.text, {}, mode->name.span});
    } else if (auto* said = fail("E211", mode->name.span, fmt::format("mode `{}` is written twice", mode->name.text))) {
      said->related.push_back({model_.modes[before].span, "first here"});
    }
  }
  if (model_.modes.empty()) model_.modes.push_back({"", {}, {}});
}

/// Parameters and lets outside families may be used above their definition, also in the bounds of families.
void Checker::declare_top_level() {
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

bool Checker::is_free_name(const std::string& name, Span span) {
  if (const std::string_view meaning = meaning_of_its_own(name); !meaning.empty()) {
    fail("E214", span, fmt::format("`{}` has a meaning of its own", name), std::string(meaning), "take another name");
    return false;
  }
  if (!is_function(name)) return true;
  fail("E214", span, fmt::format("`{}` is a function", name), {}, "take another name");
  return false;
}

bool Checker::declare(const std::string& key, const std::string& name, Symbol symbol, std::string_view family,
                      const std::vector<long>& indices) {
  if (!is_free_name(std::string(family), symbol.span)) return false;
  const auto [place, is_new] = symbols_.try_emplace(key, symbol);
  if (!is_new) {
    if (auto* said = fail("E211", symbol.span, fmt::format("`{}` is defined twice", name), "again here")) {
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

void Checker::define_member(Definition::Kind kind, const ast::Definition& item, const std::vector<long>& indices,
                            const ast::Expression& value, const Scope& scope, const ast::Input* input) {
  const std::string name = indexed(item.name.text, indices);
  const Symbol symbol{Symbol::Kind::definition, definitions_.size(), item.name.span};
  if (item.name.primes > 0) {
    fail("E218", item.name.span, "a definition has no primes", {},
         fmt::format("as an equation of its own line: {} = ...", quote(item.name.span)));
    return;
  }
  if (!declare(in_mode(scope.mode, name), name, symbol, item.name.text, indices)) return;
  definitions_.push_back({kind, name, &value, &item, input, scope});
}

void Checker::define_all(Definition::Kind kind, const std::vector<ast::Definition>& items, Scope& scope, bool inside,
                         const ast::Input* input) {
  const bool declared = !inside && (kind == Definition::Kind::parameter || kind == Definition::Kind::let);
  for (const ast::Definition& item : items) {
    if (item.elements) {
      define_elements(kind, item, scope, input);
    } else if (!declared || !is_simple(item)) {
      if (const auto indices = indices_of(item.name, scope)) {
        define_member(kind, item, *indices, item.value, scope, input);
      }
    }
  }
}

/// `param m[1..3] = (3, 4, 5)`; one value stands for all members.
void Checker::define_elements(Definition::Kind kind, const ast::Definition& item, Scope& scope,
                              const ast::Input* input) {
  const auto ends = bounds(*item.elements, scope);
  if (!ends) lost_.insert(item.name.text);
  if (!ends) return;
  const auto* list = std::get_if<ast::List>(&item.value.node);
  const long count = ends->second - ends->first + 1;
  if (list && static_cast<long>(list->items.size()) != count) {
    fail("E220", item.value.span, fmt::format("`{}` needs {} values", item.name.text, std::max(count, 0L)),
         fmt::format("here {} {}", list->items.size() == 1 ? "is" : "are", list->items.size()));
    lost_.insert(item.name.text);
    return;
  }
  for (long i = ends->first; i <= ends->second && count_written_out(item.elements->span); ++i) {
    const auto& value = list ? list->items[static_cast<std::size_t>(i - ends->first)] : item.value;
    define_member(kind, item, {i}, value, scope, input);
  }
}

const Symbol* Checker::find(const std::string& key, int mode) const {
  if (mode != Scope::no_mode) {
    const auto local = symbols_.find(in_mode(mode, key));
    if (local != symbols_.end()) return &local->second;
  }
  const auto found = symbols_.find(key);
  return found == symbols_.end() ? nullptr : &found->second;
}

std::optional<std::size_t> Checker::mode_named(const ast::Identifier& name) {
  const std::size_t found = find_mode(model_, name.text);
  if (found != npos) return found;
  std::vector<std::string> names;
  for (const Mode& mode : model_.modes) {
    if (!mode.name.empty()) names.push_back(mode.name);
  }
  fail(
      "E250", name.span, fmt::format("there is no mode `{}`", name.text), {},
      names.empty() ? fmt::format("the model has no modes; write `mode {} {{ ... }}`", name.text) : [&] {
        const std::string near = did_you_mean(name.text, names);
        return near.empty() ? "the modes are " + listed(names) : near;
      }());
  return std::nullopt;
}

// ---- the walk through the text --------------------------------------------------------------------------------------

void Checker::walk(const std::vector<ast::Statement>& statements, Scope& scope, bool inside) {
  for (const ast::Statement& statement : statements) walk_statement(statement, scope, inside);
}

void Checker::walk_mode(const ast::Mode& mode, Scope& scope) {
  const std::size_t index = find_mode(model_, mode.name.text);
  scope.mode = static_cast<int>(index);
  walk(mode.body, scope, true);
  scope.mode = Scope::no_mode;
}

/// The names that a family would have declared.
void Checker::lose(const std::vector<ast::Statement>& body) {
  for (const ast::Statement& statement : body) {
    std::visit(
        [&](const auto& node) {
          if constexpr (requires { node.items.front().name.text; }) {
            for (const auto& item : node.items) lost_.insert(item.name.text);
          } else if constexpr (requires { node.name.text; }) {
            lost_.insert(node.name.text);
          } else if constexpr (requires { node.left.node; }) {
            if (const auto* name = std::get_if<ast::Name>(&node.left.node)) lost_.insert(name->text);
          } else if constexpr (requires { node.range; }) {
            lose(node.body);
          }
        },
        statement.node);
  }
}

void Checker::walk_statement(const ast::Statement& statement, Scope& scope, bool inside) {
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
          if (const auto indices = indices_of(node.definition.name, scope)) {
            define_member(Definition::Kind::input, node.definition, *indices, node.definition.value, scope, &node);
          }
        } else if constexpr (std::is_same_v<T, ast::Equation>) {
          equations_.push_back({&node, scope, span});
          see_equation(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Condition>) {
          see_condition(node, scope, span);
        } else if constexpr (std::is_same_v<T, ast::Family>) {
          const auto member = [&] { walk(node.body, scope, true); };
          if (!for_each_index(node.index, node.range, scope, member)) lose(node.body);
        } else if constexpr (std::is_same_v<T, ast::Mode>) {
          walk_mode(node, scope);
        } else {
          walk_other(node, scope, span);
        }
      },
      statement.node);
}

void Checker::walk_other(const ast::Table& table, Scope&, Span) {
  const Symbol symbol{Symbol::Kind::table, model_.tables.size(), table.name.span};
  if (!declare(table.name.text, table.name.text, symbol, table.name.text, {})) return;
  const std::string file = file_of(table.file, table.file_span);
  model_.tables.push_back(
      {table.name.text, file, points_of(file, table.file_span, Table::Between::linear, {}), table.name.span});
}

void Checker::walk_other(const ast::Unknown& unknown, Scope& scope, Span span) {
  const auto indices = indices_of(unknown.name, scope);
  if (!indices) return;
  const std::string name = indexed(unknown.name.text, *indices);
  const Symbol symbol{Symbol::Kind::unknown, unknowns_.size(), unknown.name.span};
  if (declare(name, name, symbol, unknown.name.text, *indices)) unknowns_.push_back({&unknown, scope, span, name});
}

void Checker::walk_other(const ast::Start& start, Scope&, Span span) {
  if (start_) {
    auto* said = fail("E262", span, "the start mode is said twice", "only one `start in` can stand");
    if (said) said->related.push_back({start_->mode.span, "first here"});
    return;
  }
  start_ = &start;
}

void Checker::walk_other(const ast::Run& run, Scope&, Span span) {
  if (run_) {
    if (auto* said = fail("E262", span, "`run` stands twice")) said->related.push_back({run_span_, "first here"});
    return;
  }
  run_ = &run;
  run_span_ = span;
}

}  // namespace continuo::model::detail
