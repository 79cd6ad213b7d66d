// Parses `sweep { ... }`. Its words are no reserved words: they mean something here and are names elsewhere.
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/language/syntax/parser_core.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

using ast::Expression;

constexpr std::array<std::string_view, 4> distribution_words = {"uniform", "normal", "lognormal", "triangular"};
constexpr std::array<std::string_view, 5> sampling_words = {"sobol", "latin_hypercube", "monte_carlo", "indices",
                                                            "morris"};

constexpr std::string_view help_for_axis =
    "write k from 1 to 10 count 50, k in (1, 2, 5), k normal(5, 0.5), uniform(1, 10), lognormal(5, 0.1), "
    "triangular(1, 5, 10), or k from \"samples.csv\"";

bool is_distribution(std::string_view word) {
  return std::ranges::find(distribution_words, word) != distribution_words.end();
}

}  // namespace

/// `sweep` before a brace.
bool Parser::at_sweep() {
  if (!at_word("sweep")) return false;
  const Token& next = look(1);
  return next.kind == TokenKind::open_brace ||
         (next.kind == TokenKind::line_end && look_past_line_ends().kind == TokenKind::open_brace);
}

ast::Sweep Parser::parse_sweep() {
  advance();
  ast::Sweep sweep;
  read_block("`{` with what is varied", [&] { sweep.items.push_back(parse_sweep_item()); });
  expect_statement_end();
  return sweep;
}

ast::SweepItem Parser::parse_sweep_item() {
  const Nesting nesting(*this);
  const std::uint32_t begin = current().span.begin;
  if (!at(TokenKind::name)) unexpected("what is varied, `runs` or `keep`", std::string(help_for_axis));
  const auto read = [this]() -> decltype(ast::SweepItem::node) {
    if (at_sweep_axis()) return parse_sweep_axis();
    if (accept_word("runs")) return parse_sweep_runs();
    advance();  // keep
    return parse_sweep_keeps();
  };
  auto node = read();
  return {std::move(node), since(begin)};
}

/// A parameter may be called `runs` or `keep`: behind what is varied its values begin.
bool Parser::at_sweep_axis() {
  if (!at_word("runs") && !at_word("keep")) return true;
  const Token& next = look(1);
  if (next.kind != TokenKind::name) return false;
  const std::string_view word = spelled(next);
  return word == "from" || word == "in" || (is_distribution(word) && look(2).kind == TokenKind::open_round);
}

ast::SweepAxis Parser::parse_sweep_axis() {
  const std::string word(spelled(current()));
  ast::SweepAxis axis{parse_name_or_call().expression, ast::SweepFile{}};
  if (accept_word("from")) {
    if (at(TokenKind::text)) {
      const Span span = current().span;
      axis.values = ast::SweepFile{parse_text("the name of a file"), span};
    } else {
      axis.values = parse_sweep_grid();
    }
  } else if (accept_word("in")) {
    axis.values = ast::SweepList{parse_tree(Level::additive).expression};
  } else if (at(TokenKind::name) && look(1).kind == TokenKind::open_round) {
    const std::string_view called = spelled(current());
    if (!is_distribution(called)) {
      const std::string near = did_you_mean(called, distribution_words);
      fail(error("E125", current().span, fmt::format("no distribution is called `{}`", called), "",
                 near.empty() ? fmt::format("there are {}", fmt::join(distribution_words, ", ")) : near));
    }
    axis.values = ast::SweepDistribution{parse_sum_of_terms()};
  } else {
    const std::array<std::string_view, 2> items = {"runs", "keep"};
    const std::string near = at_statement_end() ? std::string() : did_you_mean(word, items);
    unexpected("the values of what is varied", near.empty() ? std::string(help_for_axis) : near);
  }
  expect_statement_end();
  return axis;
}

ast::SweepGrid Parser::parse_sweep_grid() {
  constexpr std::string_view example = "write k from 1 to 10 [N/m] count 50, with `log` behind it for equal ratios";
  Expression first = parse_sum_of_terms();
  if (!accept_word("to")) unexpected("`to` and the last value", std::string(example));
  ast::Range range = range_between(std::move(first), parse_sum_of_terms());
  if (!accept_word("count")) unexpected("`count` and how many values there are", std::string(example));
  ast::SweepGrid grid{std::move(range), parse_sum_of_terms()};
  grid.is_logarithmic = accept_word("log");
  return grid;
}

ast::SweepRuns Parser::parse_sweep_runs() {
  ast::SweepRuns runs{parse_sum_of_terms(), {}, {}};
  while (at(TokenKind::name)) {
    const std::string word(spelled(current()));
    const bool is_seed = word == "seed";
    if (is_seed ? runs.seed.has_value() : runs.sampling.has_value())
      fail(error("E124", current().span, is_seed ? "`seed` is given twice" : "the sampling is given twice", "",
                 "keep one of them"));
    if (is_seed) {
      advance();
      runs.seed = parse_sum_of_terms();
      continue;
    }
    if (std::ranges::find(sampling_words, word) == sampling_words.end()) {
      const std::string near = did_you_mean(word, sampling_words);
      fail(error("E125", current().span, fmt::format("no sampling is called `{}`", word), "",
                 near.empty() ? fmt::format("there are {}; then `seed` and a number", fmt::join(sampling_words, ", "))
                              : near));
    }
    runs.sampling = ast::Identifier{word, advance().span};
  }
  expect_statement_end({"sobol", "latin_hypercube", "monte_carlo", "indices", "morris", "seed"});
  return runs;
}

ast::SweepKeeps Parser::parse_sweep_keeps() {
  ast::SweepKeeps keeps;
  do {
    keeps.items.push_back(parse_sweep_keep());
  } while (accept(TokenKind::comma));
  expect_statement_end({"at", "before", "after", "as"});
  return keeps;
}

ast::SweepKeep Parser::parse_sweep_keep() {
  const std::uint32_t begin = current().span.begin;
  ast::SweepKeep keep{parse_measure(), {}, {}, {}};
  auto* value = std::get_if<ast::ValueOf>(&keep.measure);
  auto* time = value ? std::get_if<ast::AtTime>(&value->moment) : nullptr;
  if (time && at(TokenKind::dots)) {
    ast::Range range = parse_range_from(std::move(time->time));
    if (!accept_word("by")) unexpected("`by` and the time between two values", "write x at 0..10 by 0.1");
    keep.times = ast::SweepKeep::Times{std::move(range), parse_sum_of_terms()};
    value->moment = ast::AtEnd{};
  }
  keep.span = since(begin);
  if (accept_word("as")) keep.name = parse_identifier("a name for what is kept, as in max(x) as peak");
  return keep;
}

}  // namespace continuo::model::detail
