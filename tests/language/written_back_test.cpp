// Random expressions, written back as text, are read as the same tree. The referee writes a tree with a bracket round
// every operation and so needs no rule of precedence.
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {
namespace {

std::string bracketed(const ast::Expression& expression);

std::string bracketed(const std::vector<ast::Expression>& items) {
  std::string text;
  for (const ast::Expression& item : items) text += bracketed(item) + ";";
  return text;
}

std::string bracketed_node(const ast::Missing&) {
  return "missing";
}
std::string bracketed_node(const ast::Number& number) {
  return std::to_string(number.value);
}
std::string bracketed_node(const ast::Text& text) {
  return "text " + text.value;
}
std::string bracketed_node(const ast::Name& name) {
  return name.text + "[" + bracketed(name.indices) + "]" + std::to_string(name.primes) + name.member;
}
std::string bracketed_node(const ast::Unary& unary) {
  return (unary.op == ast::UnaryOperator::negate ? "negate(" : "not(") + bracketed(*unary.operand) + ")";
}
std::string bracketed_node(const ast::Binary& binary) {
  return "(" + bracketed(*binary.left) + " #" + std::to_string(static_cast<int>(binary.op)) + " " +
         bracketed(*binary.right) + ")";
}
std::string bracketed_node(const ast::Call& call) {
  return bracketed_node(call.callee) + "(" + bracketed(call.arguments) + ")";
}
std::string bracketed_node(const ast::Conditional& choice) {
  return "if(" + bracketed(*choice.condition) + "," + bracketed(*choice.when_true) + "," +
         bracketed(*choice.when_false) + ")";
}
std::string bracketed_node(const ast::Quantity& quantity) {
  return "quantity(" + bracketed(*quantity.value) + "[" + quantity.unit.text + "])";
}
std::string bracketed_node(const ast::Sum& sum) {
  return "sum(" + sum.index.text + "," + bracketed(*sum.range.first) + "," + bracketed(*sum.range.last) + "," +
         (sum.condition ? bracketed(**sum.condition) : "") + "," + bracketed(*sum.body) + ")";
}
std::string bracketed_node(const ast::List& list) {
  return "list(" + bracketed(list.items) + ")";
}
std::string bracketed(const ast::Expression& expression) {
  return std::visit([](const auto& node) { return bracketed_node(node); }, expression.node);
}

/// Text by the grammar of expressions, with brackets where chance puts them.
class RandomText {
 public:
  explicit RandomText(unsigned seed) : random_(seed) {}

  std::string of_depth(int depth) {
    std::string text = depth == 0 ? leaf() : operation(depth - 1);
    if (one_of(4) == 0) text = "(" + text + ")";
    if (one_of(6) == 0) text += one_of(2) ? " [m]" : " [s]";
    return text;
  }

 private:
  int one_of(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

  std::string leaf() {
    constexpr const char* leaves[] = {"2", "0.5", "3", "pi", "x", "y'", "u[i - 1]", "sin(2)", "x(0)", "1/2"};
    return leaves[one_of(10)];
  }
  std::string operation(int depth) {
    constexpr const char* signs[] = {
        " + ", " - ", "*", "/", "^", " < ", " <= ", " > ", " >= ", " == ", " != ", " and ", " or "};
    switch (one_of(8)) {
      case 0:
        return "-" + of_depth(depth);
      case 1:
        return "not " + of_depth(depth);
      case 2:
        return "if " + of_depth(depth) + " then " + of_depth(depth) + " else " + of_depth(depth);
      case 3:
        return one_of(2) ? "max(" + of_depth(depth) + ", " + of_depth(depth) + ")"
                         : "sum(i in 1..3: " + of_depth(depth) + ")";
      default:
        return of_depth(depth) + signs[one_of(13)] + of_depth(depth);
    }
  }

  std::mt19937 random_;
};

TEST(RandomExpressions, WrittenBackReadAsTheSameTree) {
  int read = 0;
  for (unsigned seed = 1; seed <= 20000; ++seed) {
    const std::string text = RandomText(seed).of_depth(1 + static_cast<int>(seed % 4));
    const ParsedExpression first = parse_expression(Source("expression", text));
    if (!first.diagnostics.empty()) continue;
    ++read;
    const std::string written = to_text(first.expression);
    const ParsedExpression again = parse_expression(Source("expression", written));
    ASSERT_TRUE(again.diagnostics.empty()) << text << " is written as " << written;
    ASSERT_EQ(bracketed(again.expression), bracketed(first.expression)) << text << " is written as " << written;
  }
  EXPECT_GT(read, 5000);
}

}  // namespace
}  // namespace continuo::model
