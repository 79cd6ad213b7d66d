// continuo/language/check/events/actions.hpp
// What an event does: assignments that happen together, choices, modes.
#pragma once
#include <map>
#include <optional>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

class Actions {
 public:
  explicit Actions(Expressions& expressions)
      : expressions_(expressions), report_(expressions.report), declared_(expressions.workspace.declared) {}

  /// Of one event.
  [[nodiscard]] Block actions_of(const std::vector<ast::Action>& actions, Scope& scope) const;

 private:
  struct Taken {
    std::map<std::size_t, Span> states;
    std::optional<Span> go;
  };

  [[nodiscard]] Block block(const std::vector<ast::Action>& actions, Scope& scope) const;
  void add(Block& to, const ast::Action& action, Scope& scope) const;
  [[nodiscard]] std::optional<Assign> assignment(const ast::Assignment& assignment, Scope& scope) const;
  void refuse_without_symbol(const ast::Name& target, const std::string& key) const;
  void note_assignments(const Block& block, Taken& taken) const;

  Expressions& expressions_;
  Report& report_;
  const Declarations& declared_;
};

}  // namespace continuo::model::detail
