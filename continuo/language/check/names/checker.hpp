// continuo/language/check/names/checker.hpp
// What the parts of the check share: the declared names with families written out, and the way from an expression of
// the text to a node.
//
// The order of things: declarations are collected and families written out (declarations/); primes give the states
// and with them the places of all variables (states/); then everything else is turned into nodes.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include <continuo/language/check/names/declarations.hpp>
#include <continuo/language/check/names/equations_at_work.hpp>
#include <continuo/language/syntax/ast.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/world.hpp>
#include <continuo/symbolic/graph/table.hpp>
#include <continuo/symbolic/units/unit_check.hpp>

namespace continuo::model {
struct Checked;
}

namespace continuo::model::detail {

class Checker {
 public:
  Checker(const ast::Model& tree, const Source& source, const Overrides& overrides);
  Checked run();

 private:
  // ---- messages (report.cpp) ----
  Diagnostic* fail(const char* code, Span span, std::string message, std::string label = {}, std::string help = {});
  void warn(const char* code, Span span, std::string message, std::string label = {}, std::string help = {});
  std::string quote(Span span) const;  // `text`, cut off where it is long
  std::string unit_text(const Measured& measured) const;
  std::vector<std::string> all_names() const;
  bool was_reported(const char* code, Span span) const;

  // ---- names (declare.cpp, indices.cpp) ----
  void declare_top_level();
  void walk(const std::vector<ast::Statement>& statements, Scope& scope, bool inside);
  void walk_statement(const ast::Statement& statement, Scope& scope, bool inside);
  void walk_mode(const ast::Mode& mode, Scope& scope);
  void define_all(Definition::Kind kind, const std::vector<ast::Definition>& items, Scope& scope, bool inside,
                  const ast::Input* input = nullptr);
  void define_member(Definition::Kind kind, const ast::Definition& item, const std::vector<long>& indices,
                     const ast::Expression& value, const Scope& scope, const ast::Input* input);
  void define_elements(Definition::Kind kind, const ast::Definition& item, Scope& scope, const ast::Input* input);
  void walk_other(const ast::Table& table, Scope& scope, Span span);
  void walk_other(const ast::Unknown& unknown, Scope& scope, Span span);
  void walk_other(const ast::Start& start, Scope& scope, Span span);
  void walk_other(const ast::Run& run, Scope& scope, Span span);
  void walk_other(const ast::Guess& node, Scope& scope, Span span) { guesses_.push_back({&node, scope, span}); }
  void walk_other(const ast::World&, Scope&, Span) {}  // declare_world has read it
  void walk_other(const ast::Force& node, Scope& scope, Span span) { world_.forces.push_back({&node, scope, span}); }
  void walk_other(const ast::Check& node, Scope& scope, Span span) { checks_.push_back({&node, scope, span}); }
  void walk_other(const ast::Plot& node, Scope& scope, Span span) { plots_.push_back({&node, scope, span}); }
  void walk_other(const ast::Draw& node, Scope& scope, Span span) { draws_.push_back({&node, scope, span}); }
  void walk_other(const ast::When& node, Scope& scope, Span) { events_.push_back({&node, scope, node.head}); }
  void walk_other(const ast::At& node, Scope& scope, Span) { events_.push_back({&node, scope, node.head}); }
  void walk_other(const ast::Every& node, Scope& scope, Span) { events_.push_back({&node, scope, node.head}); }
  void walk_other(const ast::Initially& node, Scope& scope, Span span) { events_.push_back({&node, scope, span}); }
  bool declare(const std::string& key, const std::string& name, Symbol symbol, std::string_view family,
               const std::vector<long>& indices);
  bool is_free_name(const std::string& name, Span span);
  void declare_modes();
  void lose(const std::vector<ast::Statement>& body);
  template <class Body>
  bool for_each_index(const ast::Identifier& index, const ast::Range& range, Scope& scope, Body&& body);
  template <class Body>
  void for_each_term(const ast::Sum& sum, Scope& scope, Body&& body);
  bool count_written_out(Span span);
  std::optional<std::pair<long, long>> bounds(const ast::Range& range, Scope& scope);
  std::optional<long> whole_number(const ast::Expression& expression, Scope& scope, std::string_view what);
  std::optional<std::vector<long>> indices_of(const ast::Name& name, Scope& scope);
  std::optional<std::string> key_of(const ast::Name& name, Scope& scope);
  const Symbol* find(const std::string& key, int mode) const;
  std::optional<std::size_t> mode_named(const ast::Identifier& name);

  // ---- states (orders.cpp) ----
  void see_equation(const ast::Equation& equation, Scope& scope);
  void see_primes(const ast::Expression& expression, Scope& scope);
  std::optional<std::size_t> see_base(const ast::Name& name, Scope& scope, int order);
  void see_condition(const ast::Condition& condition, Scope& scope, Span span);
  void lay_out();
  void name_states();
  Measured state_measure(std::size_t base, int primes, std::size_t depth = 0);
  void hold_to_chain(std::size_t base, int primes);
  Measured own_measure(std::size_t base, int primes, std::size_t depth);
  Measured time_measure() const;
  Measured per_time(const Measured& measured, int times = 1) const;
  std::size_t base_of_state(std::size_t state) const;
  Measured time_or_number() const;
  void find_time_unit();
  void stated_time_unit(const ast::Unit& text);

  // ---- expressions (translator.cpp, calls.cpp, lookup.cpp, values.cpp) ----
  Value elaborate(const ast::Expression& expression, Scope& scope);
  Value elaborate_node(const ast::Expression& expression, Scope& scope);
  /// The highest derivatives in it replaced by what they equal.
  Value settle(Value value, Span span, const std::vector<std::uint32_t>& highest);
  Value settled(const ast::Expression& expression, Scope& scope);
  Value number_of(const ast::Expression& expression, Scope& scope);     // settled, and no condition
  Value condition_of(const ast::Expression& expression, Scope& scope);  // settled, and one
  NodeId in_unit(const ast::Expression& expression, const Value& value, const Measured& wanted,
                 std::string_view what);  // E201 where it does not fit `what`
  Value of_number(double value);
  Value bad();
  bool want_number(const ast::Expression& text, Value& value);
  bool want_numbers(Term& a, Term& b);
  bool want_condition(const ast::Expression& text, Value& value);
  Value unary(const ast::Unary& node, Scope& scope);
  Value binary(const ast::Binary& node, Scope& scope);
  Value additive(Op op, const Term& a, const Term& b, Span span, Scope& scope);
  bool align(const Term& a, Term& b, Span span, Scope& scope);
  Value raise(const Term& base, const Term& exponent, Span span);
  Value pure_number(const Term& argument, std::string_view function);
  Value conditional(const ast::Conditional& node, Span span, Scope& scope);
  Value quantity(const ast::Quantity& node, Scope& scope);
  Value sum(const ast::Sum& node, Scope& scope);
  Value call(const ast::Call& node, Span span, Scope& scope);
  Value apply_function(std::string_view name, std::vector<Term>& arguments, Span span, Scope& scope);
  Value interpolation(const ast::Call& node, Span span, Scope& scope);
  Value sample(const ast::Call& node, Span span, Scope& scope);
  Value lookup(const ast::Name& name, Scope& scope);
  Value builtin(const ast::Name& name, const std::string& key, Scope& scope);
  Value not_constant(Span span, const std::string& name, const Scope& scope);
  Value without_time(const ast::Name& name, const Scope& scope);
  Value unknown_name(const ast::Name& name, const std::string& key, std::string undeclared = {});
  Value not_a_value(const ast::Name& name);
  Value derivative(const ast::Name& name, std::size_t base, Scope& scope);
  Value defined(std::size_t index, const ast::Name& name, const Scope& outer);
  void finish_definition(std::size_t index, Value value);
  Value constant_defined(std::size_t index, const ast::Name& name, const Scope& outer);
  Value circular(std::size_t index, Span span);
  Value total_energy(Span span, Scope& scope);
  std::optional<Unit> unit_of(const ast::Unit& unit);
  std::string repair(const Term& term, const Measured& wanted, Scope& scope);
  std::optional<double> constant(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                 std::string_view what);
  std::optional<Setting> setting(const ast::Expression& expression, Scope& scope, const Measured& wanted,
                                 std::string_view what);
  std::optional<Setting> time_setting(const ast::Expression& expression, Scope& scope, std::string_view what);
  bool only_parameters(NodeId node, Span span, std::string_view what, std::string help = {});
  std::string name_of(std::uint32_t variable) const;

  // ---- the parts of the model ----
  void declare();  // check.cpp
  void fill();
  void nothing_to_simulate();

  void make_parameters();  // parameters.cpp
  void make_inputs();
  void make_unknowns();
  void append_unknowns();
  void check_index(std::size_t mode);
  void make_quantities();
  void mark_structural();
  void check_overrides();
  std::string comment_beside(Span span) const;
  std::optional<Range> slider(const Definition& definition, double value);
  std::string file_of(const std::string& name, Span span);
  std::optional<Table> points_of(const std::string& file, Span span, Table::Between between, std::string_view column);

  void make_conditions();  // initial_values.cpp
  const Value& condition_value(std::size_t index, std::size_t depth = 0);
  void count_conditions();
  void place_condition(std::size_t index, bool initial);
  void missing_conditions();
  void solve_starts();  // starts.cpp
  void refuse_in_start(std::uint32_t variable, std::string_view why, Span span);
  void report_circle(const std::vector<std::uint32_t>& variables);
  void make_guesses();

  void make_equations();  // equations.cpp, equation_counts.cpp, reduction.cpp
  EquationAtWork read_equation(const Placed<ast::Equation>& equation);
  void solve_mode(std::size_t mode);
  void sort_out_algebraic(ModeAtWork& work);
  void solve_one_by_one(ModeAtWork& work);
  void solve_for(ModeAtWork& work, const EquationAtWork& equation, std::uint32_t base);
  Vanishes vanishing_beside(const LinearRows& rows);
  void solve_coupled(ModeAtWork& work);
  void solve_group(ModeAtWork& work, const std::vector<std::size_t>& members, std::vector<std::uint32_t> open);
  NodeId with_solved(const ModeAtWork& work, NodeId node);
  std::vector<std::string> highest_names(const std::vector<std::uint32_t>& bases) const;
  void report_empty_equation(ModeAtWork& work, std::size_t index, const std::vector<std::uint32_t>& variables);
  void report_surplus(const ModeAtWork& work, const std::vector<std::size_t>& members,
                      const std::vector<std::uint32_t>& open);
  void report_missing(const ModeAtWork& work);
  void report_without_equation(std::uint32_t base);
  void store_derivatives(const ModeAtWork& work);
  void pair_up();

  void make_events();  // events.cpp, actions.cpp
  void make_event(const ast::When& text, Scope& scope, Span span);
  void make_event(const ast::At& text, Scope& scope, Span span);
  void make_event(const ast::Every& text, Scope& scope, Span span);
  void make_event(const ast::Initially& text, Scope& scope, Span span);
  void make_scheduled(Scheduled event, const std::vector<ast::Action>& actions, Scope& scope);
  Value guard(const ast::Expression& condition, Scope& scope);
  bool changes_at_events_only(NodeId node) const;
  Block block(const std::vector<ast::Action>& actions, Scope& scope);
  Block actions_of(const std::vector<ast::Action>& actions, Scope& scope);
  void add_action(Block& to, const ast::Action& action, Scope& scope);
  std::optional<Assign> assignment(const ast::Assignment& assignment, Scope& scope);
  struct Taken {
    std::map<std::size_t, Span> states;
    std::optional<Span> go;
  };
  void note_assignments(const Block& block, Taken& taken);

  void declare_world();  // world_names.cpp
  void declare_world_items(const std::vector<ast::WorldItem>& items, Scope& scope);
  void declare_body(const std::string& name, const std::vector<long>& indices, Span span);
  void declare_pattern(const ast::WorldBodies& bodies, Scope& scope, Span span);
  void declare_measures();
  void add_world_base(const std::string& name, const std::string& family, int order, Span span);
  void measure_world();
  Measured stated_length();
  Value member(const ast::Name& name, Scope& scope);
  Value own_of_body(const ast::Name& name, std::size_t body);
  void refuse_equation_of_body(const ast::Name& name);

  void make_world();  // world_items.cpp
  void read_world_setting(const ast::WorldSetting& setting, Scope& scope);
  void read_combinations(const ast::WorldSetting& setting);
  void read_world_mode(const ast::WorldSetting& setting, Scope& scope);
  void read_wall(const ast::WorldWall& wall, Scope& scope, Span span);
  void read_container(const ast::WorldContainer& container, Scope& scope, Span span);
  void read_spring(const ast::WorldSpring& spring, Scope& scope, Span span);
  void read_springs(const ast::WorldSprings& springs, Scope& scope, Span span);
  void add_spring(SpringDescription spring, const ast::WorldAttributes& attributes, Scope& scope);
  void read_ignore(const ast::WorldIgnore& ignore, Span span);
  MaterialDescription material_of(const ast::WorldAttributes& attributes, Scope& scope);
  NodeId world_number(const ast::Expression& expression, Scope& scope, const Measured& wanted, std::string_view what,
                      Sort sort);
  NodePoint world_point(const ast::Expression& expression, Scope& scope, const Measured& wanted, std::string_view what,
                        bool parameters_only = true);
  std::vector<Term> components(const ast::Expression& expression, Scope& scope, std::size_t count);
  std::optional<std::size_t> body_named(const ast::Name& name, Scope& scope);
  void make_forces();
  void make_torque(Placed<ast::Force>& torque, std::size_t body);
  void judge_world();
  void look_at_start();  // overlaps.cpp
  void look_at_groups();

  bool asks_the_world(const ast::Name& callee, const Scope& scope) const;  // queries.cpp
  Value query(const ast::Call& node, Span span, Scope& scope);
  std::optional<Pairs> pairs_of(const ast::Call& node, std::size_t first, Span span, Scope& scope);
  std::optional<std::vector<Thing>> things(const ast::Expression& text, Scope& scope);
  std::optional<std::vector<Thing>> things_named(const ast::Name& name, Scope& scope);
  Thing thing_of(std::size_t body);
  Value least_gap(const Pairs& pairs);
  Value count_within(const Pairs& pairs, const ast::Call& node, Scope& scope);
  Value cast_ray(const Pairs& pairs, const ast::Call& node, Scope& scope);
  Measured measure_of_direction(const ast::Expression& text, Scope& scope);
  NodeId gap_between(const Thing& a, const Thing& b);
  NodeId way_to_body(const Thing& body, const NodePoint& centre, const NodePoint& direction, NodeId reach);
  NodeId way_to_wall(const WallDescription& wall, const NodePoint& from, const NodePoint& direction, NodeId reach);
  NodeId length_in(const ast::Expression& text, Scope& scope, std::string_view what);
  NodeId length_of(const NodePoint& v);
  NodeId inner_product(const NodePoint& v, const NodePoint& w);
  NodePoint from_to(const NodePoint& from, const NodePoint& to);

  void make_body(BodyText& body);  // bodies.cpp
  void make_pattern(PatternText& pattern);
  BodyDescription description_of(const ast::WorldAttributes& attributes, Scope& scope);
  Turn turn_of(const ast::WorldAttributes& attributes, Scope& scope);
  NodeId turn_in_plane(const ast::Expression& text, Scope& scope, const Measured& wanted, std::string_view what);
  NodePoint turn_in_space(const ast::Expression& text, Scope& scope, const Measured& wanted, std::string_view what,
                          bool parameters_only = true);
  void set_start(std::size_t body, const NodePoint& position, const NodePoint& velocity, const Turn& turn);
  void place_grid(PatternText& pattern, const NodePoint& velocity, const Turn& turn);
  void place_random(PatternText& pattern, const NodePoint& velocity, const Turn& turn);
  void place_stack(PatternText& pattern, const NodePoint& velocity, const Turn& turn);
  std::uint32_t group_of(const ast::WorldAttributes& attributes);
  NodePoint velocity_of(const ast::WorldAttributes& attributes, Scope& scope);

  void make_run();  // run_settings.cpp
  void run_times(const ast::Run& run);
  void run_output(const ast::Run& run);
  void run_tolerances(const ast::Run& run);
  void run_limits(const ast::Run& run);
  void check_method_fits();

  void make_plots();  // views.cpp
  void make_drawings();
  void make_drawing(const std::vector<ast::DrawItem>& items, Scope& scope);
  bool depends_on_states(const DrawArgument& point) const;
  NodeId drawn(const ast::Expression& expression, Scope& scope, bool of_point);
  DrawArgument draw_argument(const ast::Expression& expression, Scope& scope, bool of_point);
  Series series(const ast::Expression& expression, Scope& scope);

  void make_checks();  // checks.cpp
  void make_check(const ast::Check& text, Scope& outer, Span span);
  Value measure(const ast::Check& text, Scope& scope, Check& check);
  Moment moment(const ast::Moment& text, Scope& scope, Span span);
  void check_event_name(const std::string& begin, Span span);
  bool is_in_run(const Setting& time) const;
  void check_time_in_run(const Setting& time, Span span);
  Value value_at(const ast::ValueOf& text, Scope& scope, Span span, Check& check);

  const ast::Model& tree_;
  const Source& source_;
  const Overrides& overrides_;
  Model model_;
  std::vector<Diagnostic> diagnostics_;
  std::set<std::tuple<std::string, std::uint32_t, std::uint32_t>> reported_;
  std::size_t errors_ = 0;

  std::vector<Definition> definitions_;
  std::unordered_map<std::string, Symbol> symbols_;
  std::map<std::string, FamilyShape, std::less<>> families_;
  std::vector<Base> bases_;
  std::vector<Placed<ast::Equation>> equations_;
  std::vector<ConditionText> conditions_;
  std::vector<Placed<ast::Guess>> guesses_;
  std::vector<UnknownText> unknowns_;
  struct EventText {
    std::variant<const ast::When*, const ast::At*, const ast::Every*, const ast::Initially*> text;
    Scope scope;
    Span span;
  };
  std::vector<EventText> events_;
  std::vector<Placed<ast::Check>> checks_;
  std::vector<Placed<ast::Plot>> plots_;
  std::vector<Placed<ast::Draw>> draws_;
  Measured drawn_in_;  // the unit of the first point that has one: of all that is drawn
  WorldAtWork world_;
  const ast::Run* run_ = nullptr;
  Span run_span_{};
  const ast::Start* start_ = nullptr;

  std::optional<Unit> time_unit_;  // none: the model has no units that reach t
  std::size_t written_out_ = 0;    // members of families and terms of sums so far
  std::vector<NodeId> solved_;     // highest derivative of each base where the model has one mode
  std::vector<std::size_t> busy_;  // definitions being elaborated, for the cycle's names
  std::vector<Progress> measure_progress_;
  std::vector<Measured> measures_;
  std::vector<std::size_t> parameter_order_;   // definitions that are parameters, in the order of the text
  std::vector<std::size_t> evaluation_order_;  // definitions with a value, each after those it needs
  std::vector<double> registers_;              // parameters and inputs as written, the rest 0
  std::vector<double> start_values_;           // of all variables, once the states have theirs; empty until asked for
  std::set<std::size_t> without_equation_;     // bases that have an initial value only
  std::map<std::pair<std::size_t, double>, Span> condition_seen_;  // by state and time
  double start_time_ = 0;
  std::set<std::string, std::less<>> lost_;  // families that could not be written out: nobody misses their members
  bool t_is_known_ = false;
  bool silent_ = false;  // trying what may have been meant
};

/// Variables that stand for the highest derivatives while equations are solved for them.
inline constexpr std::uint32_t highest_begin = 1u << 30;
/// More members of families and terms of sums than this are a mistake, or a job for C++.
inline constexpr std::size_t most_written_out = 500'000;

std::string with_primes(std::string_view name, int primes);
/// `a`, `b` and `c`; after five: and 7 more.
std::string listed(const std::vector<std::string>& names);
/// "this is inf".
std::string not_finite(double value);

}  // namespace continuo::model::detail
