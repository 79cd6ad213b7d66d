// continuo/language/syntax/parser_core.hpp
// The recursive descent behind parser.hpp, one class over several sources: statements (parser.cpp), definitions
// (parser_definitions.cpp), expressions (parser_expressions.cpp, parser_values.cpp), events and their actions
// (parser_events.cpp), run, plot, draw and check (parser_settings.cpp), sweeps (parser_sweep.cpp), worlds
// (parser_world.cpp) and their joints (parser_joints.cpp). The reading of tokens and what happens after an error is
// parser_core.cpp.
#pragma once
#include <cstddef>
#include <deque>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/language/syntax/lexer.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model::detail {

/// Thrown when a statement cannot be read further, after its diagnostic is recorded; caught where the next begins.
struct StatementFailed {};
/// Thrown when nothing more shall be read.
struct ReadingStopped {};

/// An expression with the height of its tree, which bounds the recursion of all who walk it later.
struct Tree {
  ast::Expression expression;
  int height = 1;
};

/// Where a statement stands.
enum class Context { top, family, mode };

class Parser {
 public:
  explicit Parser(const Source& source) : source_(source), lexer_(source) {}

  [[nodiscard]] ParseResult parse_model();
  [[nodiscard]] ParsedExpression parse_only_expression();

 private:
  // Limits, far above what a person writes and low enough for the stack and the memory of any machine.
  static constexpr int deepest_nesting = 200;
  static constexpr int tallest_tree = 500;
  static constexpr std::size_t most_tokens = 1'000'000;
  static constexpr std::size_t most_errors = 20;
  static constexpr int most_primes = 32;

  /// Counts one level of nesting while it lives.
  class Nesting {
   public:
    explicit Nesting(Parser& parser);
    ~Nesting() { --parser_.nesting_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    Parser& parser_;
  };

  // --- tokens (parser_core.cpp)
  [[nodiscard]] const Token& current() { return look(0); }
  [[nodiscard]] const Token& look(std::size_t ahead);
  /// The first token that is no line end, at or after the current one.
  [[nodiscard]] const Token& look_past_line_ends();
  Token advance();
  [[nodiscard]] bool at(TokenKind kind) { return current().kind == kind; }
  [[nodiscard]] bool at_word(std::string_view word);
  [[nodiscard]] bool at_statement_end();
  bool accept(TokenKind kind);
  bool accept_word(std::string_view word);
  Token expect(TokenKind kind, std::string_view wanted);
  void expect_word(std::string_view word, std::string_view wanted);
  void skip_line_ends();
  [[nodiscard]] std::string_view spelled(const Token& token) const { return source_.slice(token.span); }
  [[nodiscard]] Span since(std::uint32_t begin) const { return {begin, last_end_}; }

  // --- errors (parser_core.cpp)
  void report(Diagnostic diagnostic);
  [[noreturn]] void fail(Diagnostic diagnostic);
  /// At a bad token its own problem, else "expected ..., found ...".
  [[noreturn]] void unexpected(std::string_view wanted, std::string help = {});
  /// The current token stands where the statement should have ended, or gone on with one of the words.
  [[noreturn]] void left_over(std::initializer_list<std::string_view> words);
  void expect_statement_end(std::initializer_list<std::string_view> words = {});
  [[nodiscard]] std::string continuation_help();
  [[nodiscard]] std::string product_help();
  [[nodiscard]] std::string argument_help();
  void recover();
  void recover_to_block();
  [[nodiscard]] bool at_unclosed_block();

  /// `{ item item }`, each item read by `read`, with recovery after each.
  template <class Read>
  void read_block(std::string_view wanted, Read read);
  template <class Read>
  void read_item(Read read);

  // --- expressions (parser_expressions.cpp)
  enum class Level { logical_or = 1, logical_and, comparison, additive, multiplicative };
  struct Operator {
    ast::BinaryOperator op;
    Level level;
  };
  std::optional<Operator> operator_at(const Token& token);
  [[nodiscard]] Tree parse_tree(Level lowest);
  [[nodiscard]] Tree parse_chain(Level lowest);
  [[nodiscard]] Tree parse_prefix();
  [[nodiscard]] Tree parse_power(bool with_unit);
  [[nodiscard]] Tree parse_primary(bool with_unit);
  [[nodiscard]] Tree parse_round();
  [[nodiscard]] Tree parse_conditional();
  [[nodiscard]] Tree parse_sum();
  [[nodiscard]] Tree parse_sum_over(std::uint32_t begin);
  [[nodiscard]] Tree parse_name_or_call();
  [[nodiscard]] Tree parse_arguments(ast::Name callee, int height);
  [[nodiscard]] Tree with_unit_after(Tree value);
  [[nodiscard]] Tree grow(ast::Expression::Node node, Span span, int height);
  static void lift_unit(ast::Expression& expression);
  void require_single(const ast::Expression& expression);
  void go_on_inside_brackets();
  [[noreturn]] void value_missing();

  // The values of a statement (parser_values.cpp). Where `height` is given it is raised to the tree's.

  /// A condition or number, the whole of what stands there, without `=`.
  [[nodiscard]] ast::Expression parse_expression(int* height = nullptr);
  /// The same, where a comparison would be the reader's own (`a..b`, `check a < b`).
  [[nodiscard]] ast::Expression parse_sum_of_terms(int* height = nullptr);
  /// The right side of a definition: an expression whose unit may be the whole's, or a list.
  [[nodiscard]] ast::Expression parse_value();
  [[nodiscard]] ast::Expression parse_value_or_list();
  [[nodiscard]] ast::Expression parse_condition(std::string_view where);
  [[nodiscard]] ast::Name parse_name(std::string_view wanted, int* height = nullptr);
  [[nodiscard]] ast::Name parse_indices_and_primes(const Token& token, int* height);
  void close_index(const Token& open);
  ast::Identifier parse_identifier(std::string_view wanted);
  [[nodiscard]] ast::Range parse_range(int* height = nullptr);
  [[nodiscard]] ast::Range parse_range_from(ast::Expression first, int* height = nullptr);
  /// A unit behind the last value is that of both.
  [[nodiscard]] static ast::Range range_between(ast::Expression first, ast::Expression last);
  [[nodiscard]] std::string parse_text(std::string_view wanted);

  // --- statements (parser.cpp)
  [[nodiscard]] ast::Statement parse_statement(Context context);
  [[nodiscard]] std::optional<ast::Statement::Node> parse_worded(std::string_view word, Context context);
  [[nodiscard]] ast::Statement::Node parse_defining(std::string_view word);
  void parse_model_name();
  [[nodiscard]] std::vector<ast::Definition> parse_definitions(bool with_range);
  [[nodiscard]] ast::Definition parse_definition(bool with_range);
  void parse_element_range(ast::Definition& definition);
  [[nodiscard]] ast::Input parse_input();
  [[nodiscard]] ast::Table parse_table();
  [[nodiscard]] ast::Unknown parse_unknown();
  [[nodiscard]] ast::Guess parse_guess();
  [[nodiscard]] ast::Mode parse_mode();
  [[nodiscard]] ast::Family parse_family(Context context);
  [[nodiscard]] ast::Statement::Node parse_equation();
  [[nodiscard]] ast::Condition as_condition(ast::Expression left, ast::Expression value);
  void explain_left_side(const ast::Expression& left);
  void explain_derivative_by_time();
  void require_allowed(std::string_view word, Context context);
  [[noreturn]] void unknown_statement();
  [[nodiscard]] std::vector<ast::Statement> parse_statements(std::string_view wanted, Context context);
  /// `i in 1..N` of families and sums.
  [[nodiscard]] std::pair<ast::Identifier, ast::Range> parse_index(int* height = nullptr);
  /// The indices of a family and what it repeats, which `read_body` reads; several indices are families inside each
  /// other, the last one innermost.
  template <class Family, class ReadBody>
  [[nodiscard]] Family parse_indices(const ReadBody& read_body) {
    auto [index, range] = parse_index();
    indices_.push_back(index.text);
    decltype(Family::body) body;
    if (accept(TokenKind::comma)) {
      const Nesting nesting(*this);
      const std::uint32_t begin = current().span.begin;
      Family inner = parse_indices<Family>(read_body);
      body.push_back({std::move(inner), since(begin)});
    } else {
      body = read_body();
    }
    indices_.pop_back();
    return {std::move(index), std::move(range), std::move(body)};
  }

  // --- events (parser_events.cpp)
  [[nodiscard]] ast::When parse_when();
  void parse_direction(ast::When& event);
  [[nodiscard]] std::optional<std::vector<ast::Action>> parse_limit_actions();
  [[nodiscard]] ast::At parse_at();
  [[nodiscard]] ast::Every parse_every();
  [[nodiscard]] std::vector<ast::Action> parse_actions(std::string_view wanted);
  [[nodiscard]] ast::Action parse_action();
  [[nodiscard]] ast::If parse_if();
  [[nodiscard]] ast::Stop parse_stop();
  [[nodiscard]] ast::ActionFamily parse_action_family();
  [[nodiscard]] ast::Assignment parse_assignment();

  // --- settings (parser_settings.cpp)
  [[nodiscard]] ast::Run parse_run();
  [[nodiscard]] std::string help_for_run(std::uint32_t begin);
  [[nodiscard]] bool parse_run_part(ast::Run& run);
  void parse_limit_of_steps(ast::Run& run);
  [[nodiscard]] ast::OutputTimes parse_output_times();
  void parse_tolerances(ast::Run& run, bool relative);
  [[nodiscard]] ast::Plot parse_plot();
  [[nodiscard]] ast::Draw parse_draw();
  [[nodiscard]] ast::DrawFamily parse_draw_family();
  [[nodiscard]] ast::DrawItem parse_draw_item();
  [[nodiscard]] ast::Shape parse_shape();
  [[nodiscard]] ast::Expression parse_point();
  [[nodiscard]] ast::Expression parse_point_with_unit();
  void parse_attributes(ast::Shape& shape, std::span<const std::string_view> known);
  [[nodiscard]] ast::Check parse_check();
  [[nodiscard]] ast::Measure parse_measure();
  [[nodiscard]] ast::Moment parse_moment();
  [[nodiscard]] ast::AtEvent parse_event_reference(bool after);

  // --- sweeps (parser_sweep.cpp)
  [[nodiscard]] bool at_sweep();
  [[nodiscard]] ast::Sweep parse_sweep();
  [[nodiscard]] ast::SweepItem parse_sweep_item();
  [[nodiscard]] bool at_sweep_axis();
  [[nodiscard]] ast::SweepAxis parse_sweep_axis();
  [[nodiscard]] ast::SweepGrid parse_sweep_grid();
  [[nodiscard]] ast::SweepRuns parse_sweep_runs();
  [[nodiscard]] ast::SweepKeeps parse_sweep_keeps();
  [[nodiscard]] ast::SweepKeep parse_sweep_keep();

  // --- worlds (parser_world.cpp)
  [[nodiscard]] bool at_world_word(Context context);
  [[nodiscard]] ast::Statement::Node parse_world_or_force();
  [[nodiscard]] ast::World parse_world();
  [[nodiscard]] ast::Force parse_force(bool is_torque);
  [[nodiscard]] ast::WorldItem parse_world_item();
  [[nodiscard]] ast::WorldBody parse_world_body(bool is_character);
  [[nodiscard]] ast::WorldSetting parse_world_setting(ast::Identifier word);
  /// A half-space, a mesh, heights or a chain.
  [[nodiscard]] decltype(ast::WorldItem::node) parse_world_wall();
  [[nodiscard]] ast::WorldWall parse_half_space(std::optional<ast::Identifier> name, ast::Expression normal);
  [[nodiscard]] ast::WorldMesh parse_world_mesh(std::optional<ast::Identifier> name);
  [[nodiscard]] ast::WorldMesh parse_heights(std::optional<ast::Identifier> name);
  template <class Parse>
  [[nodiscard]] ast::Expression parse_for_each(const std::vector<std::pair<ast::Identifier, ast::Range>>& families,
                                               std::string_view what, std::string_view end, Parse&& parse);
  [[nodiscard]] ast::WorldMesh parse_chain(std::optional<ast::Identifier> name, ast::Identifier kind,
                                           std::optional<ast::Expression> first = std::nullopt);
  [[nodiscard]] ast::WorldContainer parse_world_container();
  [[nodiscard]] ast::WorldBodies parse_world_bodies();
  [[nodiscard]] ast::WorldSpring parse_world_spring();
  [[nodiscard]] ast::WorldSprings parse_world_springs();
  [[nodiscard]] ast::WorldJoint parse_world_joint(ast::Identifier kind);
  [[nodiscard]] ast::WorldPart parse_world_part();
  [[nodiscard]] ast::WorldFix parse_world_fix();
  [[nodiscard]] ast::WorldIgnore parse_world_ignore();
  [[nodiscard]] ast::WorldFamily parse_world_family();
  [[nodiscard]] std::optional<ast::Identifier> parse_name_of_wall();
  [[nodiscard]] ast::WorldAttributes parse_world_attributes(std::string_view of,
                                                            std::span<const std::string_view> known,
                                                            bool all_names = false);
  void skip_to_attribute(std::span<const std::string_view> known);
  [[nodiscard]] ast::Expression parse_world_value(std::string_view word);
  [[nodiscard]] ast::Expression parse_world_name(std::string_view word);
  [[nodiscard]] ast::Expression parse_points(std::string_view example,
                                             std::optional<ast::Expression> first = std::nullopt);
  [[nodiscard]] ast::Expression parse_limits();
  [[nodiscard]] ast::Expression parse_most(std::string_view word);

  const Source& source_;
  Lexer lexer_;
  std::deque<Token> ahead_;
  std::uint32_t last_end_ = 0;  // end of the token read last
  TokenKind last_kind_ = TokenKind::line_end;
  Span last_span_;
  std::optional<Span> continuation_;  // what made the current statement go on over a line end, the latest
  std::uint32_t item_begin_ = 0;      // where the current statement, action or shape begins
  int nesting_ = 0;
  int round_brackets_ = 0;  // open round brackets, inside which a line may end before an operator
  std::size_t errors_ = 0;
  std::vector<std::string> indices_;  // of the families and sums around
  ParseResult result_;
};

template <class Read>
void Parser::read_item(Read read) {
  const std::uint32_t begin = current().span.begin;
  const std::size_t indices = indices_.size();
  continuation_.reset();
  item_begin_ = begin;
  round_brackets_ = 0;
  try {
    read();
  } catch (const StatementFailed&) {
    indices_.resize(indices);
    recover();
    // An item that read nothing would be met again for ever.
    if (current().span.begin == begin && !at(TokenKind::end) && !at(TokenKind::close_brace)) advance();
  }
}

template <class Read>
void Parser::read_block(std::string_view wanted, Read read) {
  const Nesting nesting(*this);
  if (at(TokenKind::line_end) && look_past_line_ends().kind == TokenKind::open_brace) skip_line_ends();
  const Token open = expect(TokenKind::open_brace, wanted);
  while (true) {
    while (accept(TokenKind::line_end) || accept(TokenKind::semicolon)) {
    }
    if (accept(TokenKind::close_brace)) return;
    if (at(TokenKind::end) || at_unclosed_block()) {
      Diagnostic diagnostic = error("E114", open.span, "this block has no end", "opened here",
                                    "close it with `}` before " + describe(current(), source_));
      report(std::move(diagnostic));
      return;
    }
    read_item(read);
  }
}

}  // namespace continuo::model::detail
