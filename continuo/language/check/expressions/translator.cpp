// continuo/language/check/expressions/translator.cpp
// Walks an expression of the text and makes its node.
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/expressions/repair.hpp>

namespace continuo::model::detail {

namespace {

/// The parser allows expressions 500 operations tall; the stack holds a few of these on top of each other.
constexpr std::size_t deepest = 1200;

bool swaps(ast::BinaryOperator op) {
  return op == ast::BinaryOperator::greater || op == ast::BinaryOperator::greater_equal;
}

}  // namespace

Op operation_of(ast::BinaryOperator op) {
  switch (op) {
    case ast::BinaryOperator::add:
      return Op::add;
    case ast::BinaryOperator::subtract:
      return Op::subtract;
    case ast::BinaryOperator::multiply:
      return Op::multiply;
    case ast::BinaryOperator::divide:
      return Op::divide;
    case ast::BinaryOperator::power:
      return Op::power;
    case ast::BinaryOperator::less:
    case ast::BinaryOperator::greater:
      return Op::less;
    case ast::BinaryOperator::less_equal:
    case ast::BinaryOperator::greater_equal:
      return Op::less_equal;
    case ast::BinaryOperator::equal:
      return Op::equal;
    case ast::BinaryOperator::not_equal:
      return Op::not_equal;
    case ast::BinaryOperator::logical_and:
      return Op::logical_and;
    case ast::BinaryOperator::logical_or:
      return Op::logical_or;
  }
  return Op::add;
}

Translator::Translator(Expressions& expressions)
    : expressions_(expressions),
      workspace_(expressions.workspace),
      report_(expressions.report),
      operations_(expressions.operations) {}

Value Translator::translate(const ast::Expression& expression, Scope& scope) const {
  if (scope.depth >= deepest) {
    report_.fail("E221", expression.span, "definitions lean on each other too deeply", {},
                 "define names above their use");
    return operations_.bad();
  }
  ++scope.depth;
  Value value = translate_node(expression, scope);
  --scope.depth;
  return value;
}

Value Translator::translate_node(const ast::Expression& expression, Scope& scope) const {
  return std::visit(
      [&](const auto& node) -> Value {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Number>) {
          return operations_.of_number(node.value);
        } else if constexpr (std::is_same_v<T, ast::Name>) {
          return expressions_.lookup.lookup(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          return unary(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          return binary(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          return expressions_.calls.call(node, expression.span, scope);
        } else if constexpr (std::is_same_v<T, ast::Conditional>) {
          return conditional(node, expression.span, scope);
        } else if constexpr (std::is_same_v<T, ast::Quantity>) {
          return quantity(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Sum>) {
          return sum(node, scope);
        } else if constexpr (std::is_same_v<T, ast::Missing>) {
          return expressions_.operations
              .bad();  // the parser has reported it, and no model is made of a text with errors
        } else {
          report_.fail("E217", expression.span, "a number is wanted here",
                       std::is_same_v<T, ast::Text> ? "this is a text" : "this is a list");
          return operations_.bad();
        }
      },
      expression.node);
}

bool Translator::align(const Term& a, Term& b, Span span, Scope& scope) const {
  return operations_.align(
      a, b, span, [&](const Term& term, const Measured& wanted) { return repair(expressions_, term, wanted, scope); });
}

Value Translator::unary(const ast::Unary& node, Scope& scope) const {
  Value value = translate(*node.operand, scope);
  if (node.op == ast::UnaryOperator::negate) {
    if (operations_.want_number(*node.operand, value)) value.node = workspace_.graph.negate(value.node);
  } else if (operations_.want_condition(*node.operand, value)) {
    value.node = workspace_.graph.apply(Op::logical_not, value.node);
  }
  return value;
}

Value Translator::binary(const ast::Binary& node, Scope& scope) const {
  Term a{*node.left, translate(*node.left, scope)}, b{*node.right, translate(*node.right, scope)};
  const Span sides = cover(a.text.span, b.text.span);  // without the brackets round them
  const Op op = operation_of(node.op);
  Graph& g = workspace_.graph;
  if (op == Op::logical_and || op == Op::logical_or) return operations_.logical(op, a, b);
  if (!operations_.want_numbers(a, b)) return operations_.bad();
  switch (op) {
    case Op::multiply:
      return {g.multiply(a.value.node, b.value.node), product(a.value.measured, b.value.measured)};
    case Op::divide:
      return {g.divide(a.value.node, b.value.node), quotient(a.value.measured, b.value.measured)};
    case Op::power:
      return operations_.raise(a, b, sides);
    default:
      break;
  }
  if (!align(a, b, sides, scope)) return operations_.bad();
  if (op == Op::add || op == Op::subtract) {
    return {g.apply(op, a.value.node, b.value.node), common(a.value.measured, b.value.measured)};
  }
  const bool swap = swaps(node.op);
  const NodeId left = swap ? b.value.node : a.value.node, right = swap ? a.value.node : b.value.node;
  return {.node = g.apply(op, left, right), .condition = true};
}

std::optional<double> Translator::structural_number(NodeId node) const {
  Graph& g = workspace_.graph;
  const Layout& layout = workspace_.layout;
  const auto value_of = [&](std::uint32_t variable) -> std::optional<NodeId> {
    if (variable < layout.parameters || variable >= layout.inputs) return std::nullopt;
    return workspace_.definitions.structural_value(workspace_.declared.parameters[variable - layout.parameters]);
  };
  for (const std::uint32_t variable : variables_of(g, node)) {
    if (!value_of(variable)) return std::nullopt;
  }
  return g.value(substitute(g, node, value_of));
}

/// Of a condition on indices and structural parameters.
Choice Translator::known_choice(NodeId condition) const {
  Graph& g = workspace_.graph;
  if (g[condition].op == Op::constant) return g.is(condition, 0) ? Choice::no : Choice::yes;
  const auto [found, is_new] = workspace_.choices.try_emplace(condition.index, Choice::open);
  if (!is_new) return found->second;
  if (const auto value = structural_number(condition)) found->second = *value == 0 ? Choice::no : Choice::yes;
  return found->second;
}

Value Translator::conditional(const ast::Conditional& node, Span span, Scope& scope) const {
  Value condition = translate(*node.condition, scope);
  const Choice choice = condition.bad ? Choice::open : known_choice(condition.node);
  const auto branch = [&](const ast::Expression& text, bool is_taken) {
    Scope inner = scope;
    inner.ruled_out = scope.ruled_out || !is_taken;
    return Term{text, translate(text, inner)};
  };
  Term yes = branch(*node.when_true, choice != Choice::no), no = branch(*node.when_false, choice != Choice::yes);
  if (!operations_.want_condition(*node.condition, condition)) return operations_.bad();
  if (yes.value.bad || no.value.bad) return operations_.bad();
  const bool conditions = yes.value.condition && no.value.condition;
  if (!conditions && !operations_.want_numbers(yes, no)) return operations_.bad();
  if (!align(yes, no, span, scope)) return operations_.bad();
  if (choice != Choice::open) condition.node = workspace_.graph.truth(choice == Choice::yes);
  return {.node = workspace_.graph.select(condition.node, yes.value.node, no.value.node),
          .measured = common(yes.value.measured, no.value.measured),
          .condition = conditions};
}

/// `3 [m]` states a unit, `a*b [m]` also converts to it.
Value Translator::quantity(const ast::Quantity& node, Scope& scope) const {
  Value value = translate(*node.value, scope);
  const auto unit = unit_of(node.unit, report_);
  if (!unit || !operations_.want_number(*node.value, value)) return operations_.bad();
  return operations_.in_stated_unit(*node.value, std::move(value), *unit, cover(node.value->span, node.unit.span));
}

Value Translator::sum(const ast::Sum& node, Scope& scope) const {
  Value total = operations_.of_number(0);
  bool first = true;
  expressions_.indices.for_each_term(node, scope, [&] {
    if (total.bad) return;
    Term term{*node.body, translate(*node.body, scope)};
    if (!operations_.want_number(term.text, term.value)) {
      total = operations_.bad();
    } else if (first) {
      total = term.value;
      first = false;
    } else if (align({*node.body, total}, term, node.body->span, scope)) {
      total = {workspace_.graph.add(total.node, term.value.node), common(total.measured, term.value.measured)};
    } else {
      total = operations_.bad();
    }
  });
  return total;
}

}  // namespace continuo::model::detail
