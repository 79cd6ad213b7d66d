// Any bytes as a model: parsed, printed, formatted, and checked where the parser returns a tree.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>

#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace {

using namespace continuo::model;

/// Families, sums over large ranges and patterns of many bodies are legal but slow, so the fuzzer uses only numbers of
/// one digit in them.
bool stays_small(const std::string& text) {
  if (text.find("..") == std::string::npos && text.find("bodies") == std::string::npos) return true;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 1; i < text.size(); ++i)
    if (digit(text[i]) && (digit(text[i - 1]) || text[i - 1] == 'e' || text[i - 1] == '^')) return false;
  return std::count(text.begin(), text.end(), ':') + std::count(text.begin(), text.end(), '{') < 6;
}

/// A text written back must read as the same tree, which is written back as the same text.
void write_back(const ast::Expression& expression) {
  const std::string once = to_text(expression);
  const ParsedExpression again = parse_expression(Source("again", once));
  if (!has_errors(again.diagnostics) && to_text(again.expression) != once) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Source source("fuzz.sim", std::string(reinterpret_cast<const char*>(data), size));
  ParseResult parsed = parse(source);
  for (const ast::Statement& statement : parsed.model.statements) {
    if (const auto* equation = std::get_if<ast::Equation>(&statement.node)) write_back(equation->right);
    if (const auto* event = std::get_if<ast::When>(&statement.node)) (void)event_name(*event);
  }
  std::vector<Diagnostic> diagnostics = std::move(parsed.diagnostics);
  if (!has_errors(diagnostics) && stays_small(source.text())) {
    Checked checked = check(parsed.model, source);
    if (checked.model.has_value() == has_errors(checked.diagnostics)) std::abort();
    std::move(checked.diagnostics.begin(), checked.diagnostics.end(), std::back_inserter(diagnostics));
  }
  for (const Diagnostic& diagnostic : diagnostics)
    if (diagnostic.span.begin > diagnostic.span.end || diagnostic.span.end > size) std::abort();
  (void)render(diagnostics, source);
  (void)to_json(diagnostics, source);
  return 0;
}
