// Writes expressions, names and ranges with as few brackets as their operators need.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/syntax/format.hpp>
#include <continuo/language/text/words.hpp>

namespace continuo::model {

namespace {

using ast::BinaryOperator;
using ast::Expression;

// Binding strengths, weakest first; an operand weaker than its place asks for is put into brackets. A quotient of
// numbers with a unit, 1/2 [m], has its unit as a whole only where no further factor follows.
constexpr int choice_strength = 0, or_strength = 1, and_strength = 2, not_strength = 3, comparison_strength = 4,
              additive_strength = 5, quotient_with_unit_strength = 6, multiplicative_strength = 7,
              negation_strength = 8, power_strength = 9, quantity_strength = 10, primary_strength = 11;

struct Spelling {
  std::string_view sign;
  int strength;
};

Spelling spelling(BinaryOperator op) {
  switch (op) {
    case BinaryOperator::add:
      return {" + ", additive_strength};
    case BinaryOperator::subtract:
      return {" - ", additive_strength};
    case BinaryOperator::multiply:
      return {"*", multiplicative_strength};
    case BinaryOperator::divide:
      return {"/", multiplicative_strength};
    case BinaryOperator::power:
      return {"^", power_strength};
    case BinaryOperator::less:
      return {" < ", comparison_strength};
    case BinaryOperator::less_equal:
      return {" <= ", comparison_strength};
    case BinaryOperator::greater:
      return {" > ", comparison_strength};
    case BinaryOperator::greater_equal:
      return {" >= ", comparison_strength};
    case BinaryOperator::equal:
      return {" == ", comparison_strength};
    case BinaryOperator::not_equal:
      return {" != ", comparison_strength};
    case BinaryOperator::logical_and:
      return {" and ", and_strength};
    case BinaryOperator::logical_or:
      break;
  }
  return {" or ", or_strength};
}

std::string joined(const std::vector<Expression>& items) {
  std::string text;
  for (const Expression& item : items) {
    if (!text.empty()) text += ", ";
    text += to_text(item);
  }
  return text;
}

struct Spelled {
  std::string text;
  int strength;
};

Spelled spell(const Expression& expression);

std::string operand(const Expression& expression, int weakest) {
  Spelled spelled = spell(expression);
  return spelled.strength < weakest ? "(" + spelled.text + ")" : spelled.text;
}

Spelled spell_node(const ast::Missing&) {
  return {"?", primary_strength};
}
Spelled spell_node(const ast::Number& number) {
  return {fmt::format("{}", number.value), primary_strength};
}
Spelled spell_node(const ast::Name& name) {
  return {to_text(name), primary_strength};
}
Spelled spell_node(const ast::List& list) {
  return {"(" + joined(list.items) + ")", primary_strength};
}

Spelled spell_node(const ast::Text& text) {
  std::string spelled = "\"";
  for (const char c : text.value) {
    if (c == '"' || c == '\\') spelled += '\\';
    if (c == '\n') {
      spelled += "\\n";
    } else if (c == '\t') {
      spelled += "\\t";
    } else {
      spelled += c;
    }
  }
  return {spelled + "\"", primary_strength};
}

Spelled spell_node(const ast::Unary& unary) {
  if (unary.op == ast::UnaryOperator::negate) {
    // A quantity keeps its unit to itself by a bracket, -(3 [m]): -3 [m] is read as (-3) [m].
    const bool keeps = std::holds_alternative<ast::Quantity>(unary.operand->node);
    return {"-" + operand(*unary.operand, keeps ? primary_strength : negation_strength), negation_strength};
  }
  return {"not " + operand(*unary.operand, not_strength), not_strength};
}

Spelled spell_node(const ast::Binary& binary) {
  const auto [sign, strength] = spelling(binary.op);
  if (binary.op == BinaryOperator::power) {  // binds to the right; its exponent may be negated
    const std::string base = operand(*binary.left, quantity_strength);
    const auto* negated = std::get_if<ast::Unary>(&binary.right->node);
    const bool sign_first = negated && negated->op == ast::UnaryOperator::negate;
    // An exponent with a unit needs its bracket: 2^(3 [m]).
    const std::string exponent =
        sign_first ? "-" + operand(*negated->operand, primary_strength) : operand(*binary.right, primary_strength);
    return {base + "^" + exponent, strength};
  }
  const bool chains = strength != comparison_strength;
  const std::string left = operand(*binary.left, chains ? strength : strength + 1);
  // After numbers alone a quantity keeps its unit to itself by a bracket: 1/(2 [m]).
  const bool keeps = std::holds_alternative<ast::Quantity>(binary.right->node) && is_plain_number(*binary.left);
  const std::string right = operand(*binary.right, keeps ? primary_strength : strength + 1);
  return {left + std::string(sign) + right, strength};
}

Spelled spell_node(const ast::Call& call) {
  return {to_text(call.callee) + "(" + joined(call.arguments) + ")", primary_strength};
}

Spelled spell_node(const ast::Conditional& choice) {
  return {fmt::format("if {} then {} else {}", to_text(*choice.condition), to_text(*choice.when_true),
                      to_text(*choice.when_false)),
          choice_strength};
}

// Numbers alone need no bracket: 1/2 [m] is read as (1/2) [m].
Spelled spell_node(const ast::Quantity& quantity) {
  const bool plain = is_plain_number(*quantity.value);
  const Spelled value = spell(*quantity.value);
  if (plain) {
    const int strength = value.strength >= power_strength ? std::min(value.strength, quantity_strength)
                                                          : std::min(value.strength, quotient_with_unit_strength);
    return {fmt::format("{} [{}]", value.text, quantity.unit.text), strength};
  }
  return {fmt::format("{} [{}]", operand(*quantity.value, primary_strength), quantity.unit.text), quantity_strength};
}

Spelled spell_node(const ast::Sum& sum) {
  std::string text = fmt::format("sum({} in {}", sum.index.text, to_text(sum.range));
  if (sum.condition) text += " where " + to_text(**sum.condition);
  return {text + ": " + to_text(*sum.body) + ")", primary_strength};
}

Spelled spell(const Expression& expression) {
  return std::visit([](const auto& node) { return spell_node(node); }, expression.node);
}

std::string_view word(Direction direction) {
  switch (direction) {
    case Direction::falls:
      return "falls";
    case Direction::rises:
      return "rises";
    case Direction::crosses:
      break;
  }
  return "crosses";
}

}  // namespace

bool is_plain_number(const ast::Expression& expression) {
  const auto& node = expression.node;
  if (std::holds_alternative<ast::Number>(node)) return true;
  if (const auto* name = std::get_if<ast::Name>(&node)) return name->text == "pi" && name->primes == 0;
  if (const auto* unary = std::get_if<ast::Unary>(&node))
    return unary->op == ast::UnaryOperator::negate && is_plain_number(*unary->operand);
  if (const auto* binary = std::get_if<ast::Binary>(&node))
    return binary->op <= BinaryOperator::power && is_plain_number(*binary->left) && is_plain_number(*binary->right);
  const auto* call = std::get_if<ast::Call>(&node);
  // Not y(0), which is what y is at a time.
  return call && is_function(call->callee.text) && call->callee.primes == 0 && call->callee.indices.empty() &&
         std::all_of(call->arguments.begin(), call->arguments.end(), is_plain_number);
}

std::string to_text(const ast::Expression& expression) {
  return spell(expression).text;
}

std::string to_text(const ast::Name& name) {
  std::string text = name.text;
  if (!name.indices.empty()) text += "[" + joined(name.indices) + "]";
  if (!name.member.empty()) text += "." + name.member;
  return text + std::string(static_cast<std::size_t>(name.primes), '\'');
}

std::string to_text(const ast::Range& range) {
  std::string text = operand(*range.first, additive_strength) + ".." + operand(*range.last, additive_strength);
  if (range.unit) text += " [" + range.unit->text + "]";
  return text;
}

std::string to_text(const ast::Equation& equation) {
  return to_text(equation.left) + " = " + to_text(equation.right);
}

std::string event_name(const ast::When& event) {
  std::string name = to_text(event.subject);
  if (event.direction && event.level)
    name += fmt::format(" {} through {}", word(*event.direction), to_text(*event.level));
  if (event.mode) name += " in " + event.mode->text;
  return name;
}

std::string event_name(const ast::At& event) {
  return "at " + to_text(event.time);
}

std::string event_name(const ast::Every& event) {
  std::string name = "every " + to_text(event.period);
  if (event.from) name += " from " + to_text(*event.from);
  return name;
}

std::string event_name(const ast::Initially&) {
  return "initially";
}

}  // namespace continuo::model
