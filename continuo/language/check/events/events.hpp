// continuo/language/check/events/events.hpp
// Events: guards, times and actions.
#pragma once
#include <vector>

#include <continuo/language/check/events/actions.hpp>
#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

struct EventList {
  std::vector<When> events;
  std::vector<Scheduled> schedule;
  std::vector<EventOrder> order;  // of the text
};

class Events {
 public:
  /// `model`: its derivatives and inputs, to tell what changes at events only.
  Events(Expressions& expressions, const Model& model)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        model_(model),
        actions_(expressions) {}
  [[nodiscard]] EventList make();

 private:
  void add(const ast::When& text, Scope& scope, Span span);
  void add(const ast::At& text, Scope& scope, Span span);
  void add(const ast::Every& text, Scope& scope, Span span);
  void add(const ast::Initially& text, Scope& scope, Span span);
  void add_scheduled(Scheduled event, const std::vector<ast::Action>& actions, Scope& scope);
  void make_guard(When& event, const ast::When& text, Scope& scope);
  [[nodiscard]] Value guard(const ast::Expression& condition, Scope& scope);
  [[nodiscard]] bool changes_at_events_only(NodeId node) const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const Model& model_;
  Actions actions_;
  EventList made_;
};

}  // namespace continuo::model::detail
