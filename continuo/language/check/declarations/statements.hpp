// continuo/language/check/declarations/statements.hpp
// The walk through the text: every statement is put into its list, families written out.
#pragma once
#include <span>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/states/orders.hpp>

namespace continuo::model::detail {

/// Fills the lists of Declarations but for those of the world.
class Statements {
 public:
  Statements(const ast::Model& tree, Declarations& declared, Expressions& expressions)
      : tree_(tree),
        declared_(declared),
        expressions_(expressions),
        report_(expressions.report),
        orders_(declared, expressions) {}

  void declare_modes();
  /// Parameters and lets outside families may be used above their definition, also in the bounds of families.
  void declare_top_level();
  /// All else, in the order of the text.
  void walk();

 private:
  void walk(const std::vector<ast::Statement>& statements, Scope& scope, bool inside);
  void walk_statement(const ast::Statement& statement, Scope& scope, bool inside);
  void walk_family(const ast::Family& family, Scope& scope, bool inside);
  void walk_mode(const ast::Mode& mode, Scope& scope);
  void walk_other(const ast::Table& table, Scope& scope, Span span);
  void walk_other(const ast::Unknown& unknown, Scope& scope, Span span);
  void walk_other(const ast::Start& start, Scope& scope, Span span);
  void walk_other(const ast::Run& run, Scope& scope, Span span);
  void walk_other(const ast::Sweep& sweep, Scope& scope, Span span);
  void walk_other(const ast::Guess& node, Scope& scope, Span span) {
    declared_.guesses.push_back({&node, scope, span});
  }
  void walk_other(const ast::World&, Scope&, Span) {}  // WorldDeclarations has read it
  void walk_other(const ast::Force& node, Scope& scope, Span span) {
    declared_.world.forces.push_back({&node, scope, span});
  }
  void walk_other(const ast::Check& node, Scope& scope, Span span) { declared_.checks.push_back({&node, scope, span}); }
  void walk_other(const ast::Plot& node, Scope& scope, Span span) { declared_.plots.push_back({&node, scope, span}); }
  void walk_other(const ast::Draw& node, Scope& scope, Span span) { declared_.draws.push_back({&node, scope, span}); }
  void walk_other(const ast::When& node, Scope& scope, Span) { declared_.events.push_back({&node, scope, node.head}); }
  void walk_other(const ast::At& node, Scope& scope, Span) { declared_.events.push_back({&node, scope, node.head}); }
  void walk_other(const ast::Every& node, Scope& scope, Span) { declared_.events.push_back({&node, scope, node.head}); }
  void walk_other(const ast::Initially& node, Scope& scope, Span span) {
    declared_.events.push_back({&node, scope, span});
  }
  void define_all(Definition::Kind kind, const std::vector<ast::Definition>& items, Scope& scope, bool inside);
  void define_member(Definition::Kind kind, const ast::Definition& item, std::span<const long> indices,
                     const ast::Expression& value, const Scope& scope, const ast::Input* input);
  void define_elements(Definition::Kind kind, const ast::Definition& item, Scope& scope);
  void lose(const std::vector<ast::Statement>& body);

  const ast::Model& tree_;
  Declarations& declared_;
  Expressions& expressions_;
  Report& report_;
  StateOrders orders_;
};

}  // namespace continuo::model::detail
