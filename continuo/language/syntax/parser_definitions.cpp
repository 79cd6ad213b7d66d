// Parses definitions: parameters, lets, outputs, inputs, tables, unknowns.
#include <fmt/format.h>

#include <continuo/language/syntax/blackboard.hpp>
#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/language/text/words.hpp>

namespace continuo::model::detail {

using ast::Expression;

std::vector<ast::Definition> Parser::parse_definitions(bool with_range) {
  std::vector<ast::Definition> items;
  do {
    if (!items.empty() && at(TokenKind::number)) {
      const bool is_list = items.back().elements.has_value();
      const std::string help = is_list ? "a list stands in brackets, (9, 8); the decimal sign is a point: 9.8"
                                       : help_with_commas(source_, current().span.begin);
      fail(error("E110", current().span, "expected a name after the comma, found " + describe(current(), source_), "",
                 help.empty() ? "the decimal sign is a point: 9.8, not 9,8" : help));
    }
    items.push_back(parse_definition(with_range));
  } while (accept(TokenKind::comma));
  if (!with_range && at_word("in"))
    fail(error("E123", current().span, "a range cannot stand here", "", "only `param` and `input` have one"));
  if (with_range)
    expect_statement_end({"in"});
  else
    expect_statement_end();
  return items;
}

ast::Definition Parser::parse_definition(bool with_range) {
  const std::uint32_t begin = current().span.begin;
  ast::Definition definition;
  if (at(TokenKind::name) && is_reserved(spelled(current()))) parse_identifier("a name");  // says what is wrong
  if (!at(TokenKind::name)) unexpected("a name");
  if (look(1).kind == TokenKind::open_index) {
    parse_element_range(definition);
  } else {
    definition.name = parse_name("a name");
  }
  if (definition.name.primes > 0) {
    fail(error(
        "E129", definition.name.span, "a derivative cannot be defined here", "",
        fmt::format("write the equation without a word before it: {} = ...", source_.slice(definition.name.span))));
  }
  if (at(TokenKind::assign)) {
    fail(error("E118", current().span, "`:=` assigns in an event", "", "write `=` to define"));
  }
  if (at(TokenKind::colon))
    unexpected(fmt::format("`=` and the value of `{}`", definition.name.text),
               with_corrected_line("write `=`", source_, {definition.name.span.end, current().span.end}, " ="));
  expect(TokenKind::define, fmt::format("`=` and the value of `{}`", definition.name.text));
  definition.value = parse_value_or_list();
  if (const auto* list = std::get_if<ast::List>(&definition.value.node); list && !definition.elements) {
    fail(error("E121", definition.value.span, fmt::format("`{}` is one value, this is a list", definition.name.text),
               "",
               fmt::format("write {}[1..{}] = (...); the decimal sign is a point: 9.8, not 9,8", definition.name.text,
                           list->items.size())));
  }
  if (with_range && accept_word("in")) definition.range = parse_range();
  definition.span = since(begin);
  return definition;
}

/// `m[i]` of a family, or the elements `m[1..7]` of a list.
void Parser::parse_element_range(ast::Definition& definition) {
  const Token name = advance();
  const Token open = advance();
  definition.name.text = spelled(name);
  Expression first = parse_sum_of_terms();
  if (at(TokenKind::dots)) {
    definition.elements = parse_range_from(std::move(first));
  } else {
    definition.name.indices.push_back(std::move(first));
    while (accept(TokenKind::comma)) definition.name.indices.push_back(parse_sum_of_terms());
  }
  close_index(open);
  definition.name.span = since(name.span.begin);
}

ast::Input Parser::parse_input() {
  ast::Input input;
  input.definition = parse_definition(true);
  while (at(TokenKind::name)) {
    if (accept_word("key")) {
      input.key = parse_text("the key, as in key \"w\"");
    } else if (accept_word("from")) {
      input.file_span = current().span;
      input.file = parse_text("the name of a file, as in from \"force.csv\"");
      if (accept_word("step")) input.interpolation = ast::Interpolation::step;
      accept_word("linear");
    } else {
      break;
    }
  }
  expect_statement_end({"in", "key", "from", "step", "linear"});
  return input;
}

ast::Table Parser::parse_table() {
  ast::Table table;
  table.name = parse_identifier("the name of the table");
  expect_word("from", "`from` and a file, as in table drag from \"drag.csv\"");
  table.file_span = current().span;
  table.file = parse_text("the name of a file, as in \"drag.csv\"");
  expect_statement_end();
  return table;
}

ast::Unknown Parser::parse_unknown() {
  ast::Unknown unknown;
  unknown.name = parse_name("the name of the unknown");
  expect(TokenKind::define, "`=` and a guess of its value");
  unknown.guess = parse_value();
  expect_statement_end();
  return unknown;
}

ast::Guess Parser::parse_guess() {
  ast::Guess guess;
  guess.name = parse_name("the name of a state");
  expect(TokenKind::define, "`=` and a function of t");
  guess.value = parse_value();
  expect_statement_end();
  return guess;
}

}  // namespace continuo::model::detail
