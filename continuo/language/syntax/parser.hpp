// continuo/language/syntax/parser.hpp
// Text to syntax tree, by recursive descent; docs/grammar.md is the grammar.
//
//   ParseResult result = parse(source);
//   if (has_errors(result.diagnostics)) std::cerr << render(result.diagnostics, source);
//
// Never throws on any bytes; goes on after an error at the next statement, so the tree of a wrong text is what could
// be read of it.
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include <continuo/language/syntax/ast.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/text/source.hpp>

namespace continuo::model {

struct ParseResult {
  ast::Model model;
  std::vector<Diagnostic> diagnostics;  // in order of place
  std::size_t tokens = 0, looks = 0;    // the work: tokens read, and how often the parser looked at one
};

[[nodiscard]] ParseResult parse(const Source& source);

struct ParsedExpression {
  ast::Expression expression;
  std::vector<Diagnostic> diagnostics;
};

/// A text that is one expression and nothing else, as in `--set k=2*pi`.
[[nodiscard]] ParsedExpression parse_expression(const Source& source);

}  // namespace continuo::model
