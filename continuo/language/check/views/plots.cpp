// continuo/language/check/views/plots.cpp
// Each curve has its text as label, and its unit.
#include <continuo/language/check/views/plots.hpp>

namespace continuo::model::detail {

namespace {

Series series(Expressions& expressions, const ast::Expression& expression, Scope& scope) {
  const Value value = expressions.values.number_of(expression, scope);
  std::string label = expressions.report.quote(expression.span);
  label = label.substr(1, label.size() - 2);
  return {label, value.node, unit_or_nothing(value.measured)};
}

}  // namespace

std::vector<Plot> make_plots(Expressions& expressions) {
  std::vector<Plot> made;
  for (const Placed<ast::Plot>& text : expressions.workspace.declared.plots) {
    Scope scope = text.scope;
    const NodeId time = expressions.workspace.graph.variable(Layout::time);
    Plot plot{{}, {"t", time, expressions.workspace.time.text()}, text.span};
    for (const ast::Expression& curve : text.text->curves) plot.curves.push_back(series(expressions, curve, scope));
    if (text.text->against) plot.against = series(expressions, *text.text->against, scope);
    made.push_back(std::move(plot));
  }
  return made;
}

}  // namespace continuo::model::detail
