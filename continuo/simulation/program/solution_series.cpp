// Compiles a model's derivatives to operations on Taylor series.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <continuo/methods/taylor_series/series_program.hpp>
#include <continuo/simulation/program/guard_source.hpp>
#include <continuo/simulation/program/series_source.hpp>
#include <continuo/simulation/program/solution_series.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model {

using Register = std::uint32_t;

/// The equations as a program of series, for one set of exponents.
struct WrittenSeries {
  /// A number of the program: the value of an expression that does not move, or one that the compiler needs.
  struct Number {
    NodeId node;
    double value = 0;
  };
  std::vector<double> exponents;
  std::shared_ptr<const SeriesProgram<double>> series{};
  std::vector<Register> derivatives{};  // their registers
  Register zero = 0;                    // that of a 0
  std::vector<Number> numbers{};
  std::vector<NodeId> nodes{};  // of the numbers that have one
  std::size_t members = 0;      // of all operations
  bool is_compiled = false;     // as soon as that pays
  /// Machine code of an order with these registers of the derivatives.
  mutable SharedParts<std::pair<std::size_t, std::vector<Register>>, NativeFunction> functions{};
};

/// What all runs share, so that only the first one writes the equations as series.
struct SeriesEquations {
  Graph graph;
  std::vector<NodeId> derivatives;
  std::shared_ptr<const std::vector<Table>> tables;
  std::vector<NodeId> exponents;           // on whose values the program depends
  std::vector<double> exponent_values{};   // those of variables behind the model's
  std::shared_ptr<NativeCompiler> native;  // null: none
  std::uint32_t states_begin, states_end;
  std::vector<NodeId> guards{};  // that many steps watch

  [[nodiscard]] std::vector<double> values_of(std::span<const NodeId> nodes, std::span<const double> variables) const {
    return evaluate(graph, nodes, variables, [this](std::uint32_t table, double x, bool slope) {
      const Table& of = (*tables)[table];
      return slope ? of.slope(x) : of.value(x);
    });
  }
  /// The program for the exponents that these variables give: the last one, or a new one.
  [[nodiscard]] std::shared_ptr<const WrittenSeries> written_for(std::span<const double> variables) const;
  [[nodiscard]] std::shared_ptr<const GuardSource> guard_source_of(std::size_t order) const {
    return guard_sources.of(order, [&] {
      return std::make_shared<GuardSource>(guard_source(graph, guards, states_begin, states_end, order));
    });
  }

  mutable std::mutex mutex{};  // of the last one
  mutable std::shared_ptr<const WrittenSeries> last{};
  mutable SharedParts<std::size_t, const GuardSource> guard_sources{};  // by the order of the series
};

struct SolutionSeries::Program {
  void renew();
  [[nodiscard]] NativeFunction* function_of(std::size_t order, std::span<const Register> rates);
  void expand(double t, double scale, std::span<double> c, std::span<const Register> rates);
  void run(NativeSeries code, double t, double scale, std::span<double> c, std::size_t n);

  std::shared_ptr<const SeriesEquations> equations;
  std::vector<double> variables;
  bool is_stale = true;  // a number has changed

  std::shared_ptr<const WrittenSeries> written{};  // of the exponents as they are now
  SeriesProgram<double> series{};                  // a copy, with the numbers of this run
  std::shared_ptr<NativeFunction> function{};      // of this order and these derivatives
  std::size_t function_order = 0;
  std::vector<Register> function_rates{};
  /// The code that the last call has run with all states free, and how many coefficients it writes: as long as nothing
  /// changes, the next call need not ask for it again. Null where it has to.
  NativeSeries last_code = nullptr;
  std::size_t last_size = 0;
  // Of many steps: memory, and the guards that they watch with what these read and does not move.
  std::vector<double> scratch{}, guard_numbers{};
  std::shared_ptr<const GuardSource> guards{};
};

/// Writes equations as series, level by level: the operands of an operation are on levels below its own.
class SeriesCompiler {
 public:
  SeriesCompiler(const SeriesEquations& equations, WrittenSeries& written)
      : equations_(equations),
        s_(written),
        graph_(equations.graph),
        program_(*new_program_),
        exponents_(written.exponents),
        nodes_(reachable(graph_, equations.derivatives)),
        level_(graph_.size(), 0),
        place_(graph_.size(), nowhere) {
    find_turned();
  }

  void compile() {
    const Register time = program_.add_variable();
    const Register states = program_.add_variable(equations_.states_end - equations_.states_begin);
    std::map<std::size_t, std::vector<NodeId>> by_level;
    for (const NodeId id : nodes_) {
      const Node node = node_of(id);
      if (node.op == Op::variable && node.number == Layout::time) {
        set_moving(id, 1, time);
      } else if (node.op == Op::variable && is_state(node.number)) {
        set_moving(id, 1, states + node.number - equations_.states_begin);
      } else if (const std::size_t below = level_of_arguments(node); below > 0) {
        level_[id.index] = below + 1;
        by_level[below + 1].push_back(id);
      }
    }
    std::vector<std::vector<Nodes>> levels;
    for (const auto& [level, nodes] : by_level) levels.push_back(families(nodes));
    split(levels);
    for (const std::vector<Nodes>& level : levels)
      for (const Nodes& family : level) write_family(family);
    for (const NodeId id : equations_.derivatives) s_.derivatives.push_back(place_of(id));
    count_ = 1;
    s_.zero = numbers(0);
    for (std::size_t n = 0; n < s_.numbers.size(); ++n) {
      const auto [node, value] = s_.numbers[n];
      if (node.valid()) s_.nodes.push_back(node);
      program_.set_number(n, node.valid() && is_exponent(node) ? exponent(node) : value);
    }
    for (const SeriesOperation& o : program_.operations()) s_.members += o.count;
    s_.is_compiled = is_worth_compiling(program_);
    s_.series = std::move(new_program_);
  }

 private:
  using Nodes = std::vector<NodeId>;
  /// Nodes with the same kind are written alike: operation, which arguments move, table or exponent.
  using Kind = std::tuple<Op, std::array<bool, 3>, bool, std::uint32_t, double>;

  static constexpr Register nowhere = std::numeric_limits<Register>::max();
  static constexpr std::size_t least_together = 4, least_part = 8;  // members
  static constexpr std::size_t most_to_split = 100'000;             // nodes

  /// Finds the negated differences that are read as such alone: a graph writes b - a so where a stands before b. A
  /// negation less stands between the coefficients of two orders, which wait for each other.
  void find_turned() {
    std::vector<std::uint32_t> uses(graph_.size(), 0);
    for (const NodeId id : equations_.derivatives) ++uses[id.index];
    for (const NodeId id : nodes_)
      for (const NodeId argument : arguments(graph_[id])) ++uses[argument.index];
    const auto is_turned = [&](const Node& node) {
      return node.op == Op::negate && graph_[node.a].op == Op::subtract && uses[node.a.index] == 1;
    };
    std::vector<bool> vanishes(graph_.size(), false);
    for (const NodeId id : nodes_) {
      if (!is_turned(graph_[id])) continue;
      turned_.emplace(id, graph_[id].a);
      vanishes[graph_[id].a.index] = true;
    }
    std::erase_if(nodes_, [&](NodeId id) { return vanishes[id.index]; });
  }
  /// The operation that is written for a node: of a negated difference, that of the terms in the other order.
  Node node_of(NodeId id) const {
    const auto inner = turned_.find(id);
    if (inner == turned_.end()) return graph_[id];
    const Node& difference = graph_[inner->second];
    return {.op = Op::subtract, .a = difference.b, .b = difference.a, .before = {}};
  }

  bool is_state(std::uint32_t variable) const {
    return variable >= equations_.states_begin && variable < equations_.states_end;
  }
  bool moves(NodeId id) const { return level_[id.index] > 0; }
  void set_moving(NodeId id, std::size_t level, Register place) {
    level_[id.index] = level;
    place_[id.index] = place;
  }
  std::size_t level_of_arguments(const Node& node) const {
    std::size_t level = 0;
    for (const NodeId argument : arguments(node)) level = std::max(level, level_[argument.index]);
    return level;
  }

  /// What does not move gets its register, of a number, when it is first read.
  Register place_of(NodeId id) {
    if (place_[id.index] == nowhere) {
      place_[id.index] = program_.add_number(0);
      s_.numbers.push_back({.node = id});
    }
    return place_[id.index];
  }

  bool is_exponent(NodeId id) const {
    return std::ranges::find(equations_.exponents, id) != equations_.exponents.end();
  }
  double exponent(NodeId id) const {
    const auto found = std::ranges::find(equations_.exponents, id);
    return exponents_[static_cast<std::size_t>(found - equations_.exponents.begin())];
  }

  Kind kind_of(NodeId id) const {
    const Node node = node_of(id);
    std::array<bool, 3> moving{};
    std::size_t k = 0;
    for (const NodeId argument : arguments(node)) moving[k++] = moves(argument);
    const bool is_square = node.op == Op::multiply && node.a == node.b;
    const bool is_table = node.op == Op::interpolate || node.op == Op::interpolate_slope;
    const double power = node.op == Op::power && !moving[1] ? exponent(node.b) : 0;
    return {node.op, moving, is_square, is_table ? node.number : 0, std::isnan(power) ? 0.5 : power};
  }

  /// The nodes of a level that are written alike.
  std::vector<Nodes> families(const Nodes& nodes) {
    std::map<Kind, Nodes> kinds;
    for (const NodeId id : nodes) kinds[kind_of(id)].push_back(id);
    std::vector<Nodes> result;
    for (auto& [kind, members] : kinds) result.push_back(std::move(members));
    return result;
  }

  /// Takes families apart by what reads their members, and by what these read: the differences of N bodies by their
  /// axes. The parts then lie as those that they are computed with, and fewer have to be copied.
  void split(std::vector<std::vector<Nodes>>& levels) {
    if (nodes_.size() > most_to_split) return;
    std::vector<std::vector<std::size_t>> readers(graph_.size());  // 4 times a reader and which argument
    std::vector<std::size_t> family(graph_.size(), 0);             // of a node; 0: none
    std::size_t count = 0;
    for (const std::vector<Nodes>& level : levels) {
      for (const Nodes& members : level) {
        ++count;
        for (const NodeId id : members) {
          family[id.index] = count;
          std::size_t k = 0;
          for (const NodeId argument : arguments(node_of(id))) readers[argument.index].push_back(4 * id.index + k++);
        }
      }
    }
    const auto by_readers = [&](NodeId id) {
      std::vector<std::size_t> sign;
      for (const std::size_t reader : readers[id.index]) sign.push_back(4 * family[reader / 4] + reader % 4);
      std::ranges::sort(sign);
      sign.erase(std::ranges::unique(sign).begin(), sign.end());
      return sign;
    };
    const auto by_arguments = [&](NodeId id) {
      std::vector<std::size_t> sign;
      for (const NodeId argument : arguments(node_of(id))) sign.push_back(family[argument.index]);
      return sign;
    };
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) split_level(*level, by_readers, family, count);
    for (std::vector<Nodes>& level : levels) split_level(level, by_arguments, family, count);
  }
  template <class Sign>
  static void split_level(std::vector<Nodes>& level, Sign&& sign_of, std::vector<std::size_t>& family,
                          std::size_t& count) {
    std::vector<Nodes> result;
    for (Nodes& members : level) {
      std::map<std::vector<std::size_t>, Nodes> parts;
      if (members.size() >= 2 * least_part)
        for (const NodeId id : members) parts[sign_of(id)].push_back(id);
      if (parts.size() < 2 || std::ranges::any_of(parts, [](auto& part) { return part.second.size() < least_part; })) {
        result.push_back(std::move(members));
        continue;
      }
      for (auto& [sign, part] : parts) {
        ++count;
        for (const NodeId id : part) family[id.index] = count;
        result.push_back(std::move(part));
      }
    }
    level = std::move(result);
  }

  void write_family(Nodes members) {
    if (members.size() < least_together) {
      for (const NodeId id : members) write({id});
    } else {
      std::ranges::sort(members, {}, [&](NodeId id) { return places_of(id); });
      write(members);
    }
  }
  std::array<Register, 3> places_of(NodeId id) {
    std::array<Register, 3> places{};
    std::size_t k = 0;
    for (const NodeId argument : arguments(node_of(id))) places[k++] = place_of(argument);
    return places;
  }

  /// Members of one kind, with results side by side.
  void write(const Nodes& members) {
    std::array<std::vector<Register>, 3> lists;
    const std::size_t count = arity(node_of(members.front()).op);
    for (const NodeId id : members) {
      const std::array<Register, 3> places = places_of(id);
      for (std::size_t k = 0; k < count; ++k) lists[k].push_back(places[k]);
    }
    count_ = static_cast<std::uint32_t>(members.size());
    std::array<Register, 3> operands{};
    for (std::size_t k = 0; k < count; ++k) operands[k] = operand(members, k, lists[k]);
    Register result = operation(members.front(), operands);
    for (const NodeId id : members) place_[id.index] = result++;
  }

  /// The argument k of all members side by side. Numbers are numbers again there, which no order has to copy.
  Register operand(const Nodes& members, std::size_t k, const std::vector<Register>& places) {
    const auto argument = [&](NodeId id) { return arguments(node_of(id)).ids[k]; };
    if (members.size() == 1 || moves(argument(members.front()))) return side_by_side(places);
    const Register first = program_.add_number(0);
    for (std::size_t i = 1; i < members.size(); ++i) (void)program_.add_number(0);
    for (const NodeId id : members) s_.numbers.push_back({.node = argument(id)});
    return first;
  }

  /// Where these lie side by side, or are copied to.
  Register side_by_side(const std::vector<Register>& places) {
    bool is_straight = true;
    for (std::size_t k = 1; k < places.size(); ++k) is_straight = is_straight && places[k] == places[k - 1] + 1;
    if (is_straight) return places.front();
    const auto [found, is_new] = copies_.try_emplace(places, 0);
    if (is_new) found->second = program_.add_copies(places);
    return found->second;
  }

  Register add(SeriesCode code, Register a, Register b = 0, Register c = 0) {
    return program_.add(code, a, b, c, count_);
  }
  /// This number for each member.
  Register numbers(double value) {
    const auto [found, is_new] = numbers_.try_emplace(value, 0);
    if (is_new) {
      found->second = program_.add_number(value);
      s_.numbers.push_back({.node = {}, .value = value});
    }
    return side_by_side(std::vector<Register>(count_, found->second));
  }

  Register operation(NodeId id, const std::array<Register, 3>& operand) {
    const auto [a, b, c] = operand;
    const Node node = node_of(id);
    switch (node.op) {
      case Op::add:
        if (!moves(node.a)) return add(SeriesCode::add_number, b, a);
        return add(moves(node.b) ? SeriesCode::add : SeriesCode::add_number, a, b);
      case Op::subtract:
        return add(moves(node.a) ? SeriesCode::subtract : SeriesCode::subtract_from_number, a, b);
      case Op::negate:
        return add(SeriesCode::negate, a);
      case Op::multiply:
        if (!moves(node.a)) return add(SeriesCode::scale, a, b);
        if (!moves(node.b)) return add(SeriesCode::scale, b, a);
        if (node.a == node.b) return add(SeriesCode::square, a);
        // The newest coefficient of the first factor comes last into the sum: it is that which is known later.
        return add(SeriesCode::product, std::max(a, b), std::min(a, b));
      case Op::divide:
        return add(moves(node.b) ? SeriesCode::quotient : SeriesCode::divide_by_number, a, b);
      case Op::power:
        return moves(node.b) ? add(SeriesCode::exponential, add(SeriesCode::product, b, add(SeriesCode::logarithm, a)))
                             : power(a, b, exponent(node.b));
      case Op::smooth:
        return a;
      case Op::interpolate:
      case Op::interpolate_slope:
        return add(node.op == Op::interpolate ? SeriesCode::table : SeriesCode::table_slope, a, table(node.number));
      default:
        return function(node.op, a, b, c);
    }
  }

  Register function(Op op, Register a, Register b, Register c) {
    switch (op) {
      case Op::sine:
        return pair(SeriesCode::sine_cosine, a);
      case Op::cosine:
        return pair(SeriesCode::sine_cosine, a) + count_;
      case Op::hyperbolic_sine:
        return pair(SeriesCode::hyperbolic_sine_cosine, a);
      case Op::hyperbolic_cosine:
        return pair(SeriesCode::hyperbolic_sine_cosine, a) + count_;
      case Op::tangent:
        return add(SeriesCode::tangent, a);
      case Op::hyperbolic_tangent:
        return add(SeriesCode::hyperbolic_tangent, a);
      case Op::arc_tangent:
        return add(SeriesCode::arc_tangent, a, add(SeriesCode::add_number, add(SeriesCode::square, a), numbers(1)));
      case Op::arc_sine:
        return add(SeriesCode::arc_sine, a, root_of_one_less_square(a));
      case Op::arc_cosine:
        return add(SeriesCode::arc_cosine, a, root_of_one_less_square(a));
      case Op::arc_tangent2:
        return add(SeriesCode::arc_tangent2, a, b, sum_of_squares(a, b));
      case Op::hypotenuse:
        return add(SeriesCode::square_root, sum_of_squares(a, b));
      case Op::exponential:
        return add(SeriesCode::exponential, a);
      case Op::logarithm:
        return add(SeriesCode::logarithm, a);
      case Op::logarithm10:
        return add(SeriesCode::divide_by_number, add(SeriesCode::logarithm, a), numbers(std::numbers::ln10));
      case Op::square_root:
        return add(SeriesCode::square_root, a);
      case Op::modulo:
        return add(SeriesCode::subtract, a,
                   add(SeriesCode::product, b, add(SeriesCode::floor, add(SeriesCode::quotient, a, b))));
      default:
        return add(piecewise(op), a, b, c);
    }
  }

  static SeriesCode piecewise(Op op) {
    switch (op) {
      case Op::minimum:
        return SeriesCode::minimum;
      case Op::maximum:
        return SeriesCode::maximum;
      case Op::absolute:
        return SeriesCode::absolute;
      case Op::select:
        return SeriesCode::select;
      case Op::sign:
        return SeriesCode::sign;
      case Op::floor:
        return SeriesCode::floor;
      case Op::ceiling:
        return SeriesCode::ceiling;
      case Op::less:
        return SeriesCode::less;
      case Op::less_equal:
        return SeriesCode::less_equal;
      case Op::equal:
        return SeriesCode::equal;
      case Op::not_equal:
        return SeriesCode::not_equal;
      case Op::logical_and:
        return SeriesCode::logical_and;
      case Op::logical_or:
        return SeriesCode::logical_or;
      default:
        return SeriesCode::logical_not;
    }
  }

  /// sin and cos of the same are one operation.
  Register pair(SeriesCode code, Register a) {
    const auto [found, is_new] = pairs_.try_emplace({code, a, count_}, 0);
    if (is_new) found->second = add(code, a);
    return found->second;
  }
  Register sum_of_squares(Register a, Register b) {
    return add(SeriesCode::add, add(SeriesCode::square, a), add(SeriesCode::square, b));
  }
  Register root_of_one_less_square(Register a) {
    const Register one = numbers(1);
    const Register product =
        add(SeriesCode::product, add(SeriesCode::subtract_from_number, one, a), add(SeriesCode::add_number, a, one));
    return add(SeriesCode::square_root, product);
  }

  /// Whole exponents are products: exact at zero, where the recurrence of powers divides by it.
  Register power(Register a, Register b, double exponent) {
    constexpr double greatest_product = 16;
    const double size = std::abs(exponent);
    if (exponent == 0 || size > greatest_product || size != std::floor(size)) return add(SeriesCode::power, a, b);
    Register result = nowhere;
    for (auto n = static_cast<unsigned>(size);; a = add(SeriesCode::square, a)) {
      if (n % 2 == 1) result = result == nowhere ? a : add(SeriesCode::product, result, a);
      if ((n >>= 1) == 0) break;
    }
    return exponent < 0 ? add(SeriesCode::quotient, numbers(1), result) : result;
  }

  Register table(std::uint32_t number) {
    const auto [found, is_new] = numbers_of_tables_.try_emplace(number, 0);
    if (is_new) {
      found->second = program_.add_table([tables = equations_.tables, number](double x) {
        const Table::Piece& piece = (*tables)[number].at(x);
        return LinearPiece<double>{piece.x, piece.y, piece.slope};
      });
    }
    return found->second;
  }

  const SeriesEquations& equations_;
  WrittenSeries& s_;
  const Graph& graph_;
  std::shared_ptr<SeriesProgram<double>> new_program_ = std::make_shared<SeriesProgram<double>>();
  SeriesProgram<double>& program_;
  std::span<const double> exponents_;
  Nodes nodes_;
  std::map<NodeId, NodeId> turned_;  // negations, and the differences that are written as one with them
  std::vector<std::size_t> level_;   // by node; 0: it does not move
  std::vector<Register> place_;      // by node
  std::map<std::vector<Register>, Register> copies_;
  std::map<std::tuple<SeriesCode, Register, std::uint32_t>, Register> pairs_;
  std::map<std::uint32_t, Register> numbers_of_tables_;
  std::map<double, Register> numbers_;
  std::uint32_t count_ = 1;  // of the members that are written
};

namespace {

/// The equations written so that they cost fewer recurrences. Roots of sums of squares are powers of those sums:
/// hypot(x, hypot(y, z))^3 = (x^2 + y^2 + z^2)^1.5 is one where it was five; so is s sqrt(s), as which a graph writes
/// s^1.5. And the terms of a - b and of b - a, by which a pair of bodies attract each other, are shared: squares, and
/// quotients but for their sign and what does not move.
class Sharing {
 public:
  /// Variables from `first_free` on stand for exponents: a constant would be written as products and a root again.
  Sharing(Graph& graph, std::uint32_t states_begin, std::uint32_t states_end, std::uint32_t first_free)
      : graph_(graph), states_begin_(states_begin), states_end_(states_end), first_free_(first_free) {}

  std::vector<NodeId> of(std::span<const NodeId> roots) {
    for (const NodeId id : reachable(graph_, roots)) image_[id] = rewritten(id);
    std::vector<NodeId> result;
    for (const NodeId root : roots) result.push_back(image_.at(root));
    return result;
  }
  /// The values of the variables that stand for exponents.
  [[nodiscard]] const std::vector<double>& exponents() const { return exponents_; }

 private:
  struct Power {
    NodeId base;
    double exponent;
  };

  NodeId rewritten(NodeId id) {
    const Node node = graph_[id];  // a copy: the graph grows below
    if (node.op == Op::hypotenuse) {
      squares_[id] = graph_.add(square_of(node.a), square_of(node.b));
      return root_of(squares_[id]);
    }
    if (node.op == Op::square_root) return root_of(image_.at(node.a));
    if (node.op == Op::multiply && node.a == node.b) return square_of(node.a);
    if (node.op == Op::multiply) return product(image_.at(node.a), image_.at(node.b));
    if (node.op == Op::power && squares_.contains(node.a))
      return graph_.power(squares_.at(node.a), graph_.multiply(graph_.constant(0.5), image_.at(node.b)));
    if (node.op == Op::divide) return quotient(image_.at(node.a), image_.at(node.b));
    return with_arguments(graph_, id, [this](NodeId argument) { return image_.at(argument); });
  }

  NodeId root_of(NodeId square) {
    const NodeId root = graph_.apply(Op::square_root, square);
    if (graph_[root].op == Op::square_root) powers_[root] = {graph_[root].a, 0.5};
    return root;
  }
  /// A power with a fraction, where it is one of the factors times another power of the same.
  NodeId product(NodeId a, NodeId b) {
    for (const auto& [root, other] : {std::pair(a, b), std::pair(b, a)}) {
      const auto one = powers_.find(root);
      if (one == powers_.end() || !is_fraction(one->second.exponent)) continue;
      const auto [base, exponent] = one->second;
      const auto known = powers_.find(other);
      if (other == base) return power(base, exponent + 1);
      if (known != powers_.end() && known->second.base == base && !is_fraction(known->second.exponent))
        return power(base, exponent + known->second.exponent);
    }
    return graph_.multiply(a, b);
  }
  NodeId power(NodeId base, double exponent) {
    const auto [found, is_new] = numbers_.try_emplace(exponent);
    if (is_new) {
      found->second = graph_.variable(first_free_ + static_cast<std::uint32_t>(exponents_.size()));
      exponents_.push_back(exponent);
    }
    const NodeId result = graph_.power(base, found->second);
    powers_[result] = {base, exponent};
    return result;
  }
  static bool is_fraction(double exponent) { return exponent != std::floor(exponent); }

  /// Whether it is a - b where b - a is the one that counts.
  [[nodiscard]] bool is_turned(NodeId id) const { return graph_[id].op == Op::subtract && graph_[id].b < graph_[id].a; }
  NodeId turned(NodeId id) { return graph_.subtract(graph_[id].b, graph_[id].a); }

  NodeId square_of(NodeId id) {
    const auto known = squares_.find(id);
    if (known != squares_.end()) return known->second;
    const NodeId root = is_turned(image_.at(id)) ? turned(image_.at(id)) : image_.at(id);
    const NodeId square = graph_.multiply(root, root);
    const auto one = powers_.find(root);
    if (one == powers_.end()) {
      powers_[square] = {root, 2};
    } else if (!is_fraction(2 * one->second.exponent)) {
      powers_[square] = {one->second.base, 2 * one->second.exponent};
    }
    return square;
  }

  /// Of a power with a fraction the inverse is a power too: one recurrence, where the quotient would be another. A
  /// root alone may be read elsewhere.
  NodeId quotient(NodeId a, NodeId b) {
    if (!moves(b)) return graph_.divide(a, b);
    NodeId inverse;
    if (const auto known = powers_.find(b); known != powers_.end()) {
      const auto [base, exponent] = known->second;
      if (is_fraction(exponent) && exponent > 1) inverse = power(base, -exponent);
    } else if (graph_[b].op == Op::power && graph_[b].b.valid()) {
      const std::optional<double> exponent = graph_.value(graph_[b].b);
      if (exponent && is_fraction(*exponent)) inverse = graph_.power(graph_[b].a, graph_.negate(graph_[b].b));
    }
    if (!inverse.valid()) return shared(a, [&](NodeId part) { return graph_.divide(part, b); });
    return shared(a, [&](NodeId part) { return graph_.multiply(part, inverse); });
  }
  /// of(a), without a sign and factors that do not move.
  template <class Of>
  NodeId shared(NodeId a, Of&& of) {
    if (is_turned(a)) return graph_.negate(of(turned(a)));
    const Node node = graph_[a];
    if (node.op != Op::multiply || moves(node.a) == moves(node.b)) return of(a);
    const NodeId factor = moves(node.a) ? node.b : node.a, part = moves(node.a) ? node.a : node.b;
    if (is_turned(part)) return graph_.multiply(graph_.negate(factor), of(turned(part)));
    return graph_.multiply(factor, of(part));
  }

  /// Whether it depends on the time or a state.
  bool moves(NodeId id) {
    for (auto i = static_cast<std::uint32_t>(moves_.size()); i < graph_.size(); ++i) {
      const Node& node = graph_[NodeId{i}];
      bool any = node.op == Op::variable &&
                 (node.number == Layout::time || (node.number >= states_begin_ && node.number < states_end_));
      for (const NodeId argument : arguments(node)) any = any || moves_[argument.index] != 0;
      moves_.push_back(any ? 1 : 0);
    }
    return moves_[id.index] != 0;
  }

  Graph& graph_;
  std::uint32_t states_begin_, states_end_, first_free_;
  std::map<NodeId, NodeId> image_, squares_;  // squares of hypotenuses
  std::map<NodeId, Power> powers_;            // what is known to be one
  std::map<double, NodeId> numbers_;          // exponents, as variables
  std::vector<double> exponents_;
  std::vector<char> moves_;
};

}  // namespace

std::shared_ptr<const WrittenSeries> SeriesEquations::written_for(std::span<const double> variables) const {
  std::vector<double> values = values_of(exponents, variables);
  const std::scoped_lock lock(mutex);
  if (last && last->exponents == values) return last;
  const auto made = std::make_shared<WrittenSeries>(WrittenSeries{.exponents = std::move(values)});
  SeriesCompiler(*this, *made).compile();
  last = made;
  return made;
}

void SolutionSeries::Program::renew() {
  if (const auto now = equations->written_for(variables); written != now) {
    written = now;
    series = *written->series;
    function.reset();
  }
  const std::vector<double> values = equations->values_of(written->nodes, variables);
  auto value = values.begin();
  for (std::size_t n = 0; n < written->numbers.size(); ++n) {
    const WrittenSeries::Number& number = written->numbers[n];
    series.set_number(n, number.node.valid() ? *value++ : number.value);
  }
  is_stale = false;
  last_code = nullptr;
  guard_numbers.clear();
}

/// What the text of the function is made of, as bytes.
std::string key_of(const SeriesProgram<double>& series, std::span<const Register> rates, std::size_t order) {
  std::string key = "series 5";
  const auto append = [&](const auto& list) {
    for (const auto part : list) key.append(reinterpret_cast<const char*>(&part), sizeof part);
  };
  append(std::array{order, rates.size(), series.row_size()});
  for (const SeriesOperation& o : series.operations()) {
    append(std::array{static_cast<std::uint32_t>(o.code), o.result, o.count, o.a, o.b, o.c});
    if (o.code == SeriesCode::power) append(std::array{series.number_in(o.b)});
  }
  append(series.copied());
  append(rates);
  return key;
}

NativeFunction* SolutionSeries::Program::function_of(std::size_t order, std::span<const Register> rates) {
  if (!equations->native || !written->is_compiled) return nullptr;
  if (!function || function_order != order || !std::ranges::equal(function_rates, rates)) {
    function_order = order;
    function_rates.assign(rates.begin(), rates.end());
    guards = equations->guard_source_of(order);
    guard_numbers.clear();
    function = written->functions.of({order, function_rates}, [&] {
      const std::string text = guards->text.value_or("");
      return equations->native->function(key_of(*written->series, rates, order) + text,
                                         [program = written->series, order, list = function_rates, text] {
                                           return series_source(*program, list, order, text);
                                         });
    });
  }
  return function.get();
}

void SolutionSeries::Program::expand(double t, double scale, std::span<double> c, std::span<const Register> rates) {
  const std::size_t n = rates.size(), order = c.size() / n - 1;
  last_code = nullptr;
  NativeFunction* const ready = function_of(order, rates);
  if (ready == nullptr || ready->code() == nullptr) {
    expand_solution<double>(series, rates, t, scale, c);
    if (ready != nullptr) ready->count(written->members * order * order / 4);
    return;
  }
  series.begin(order);
  const auto code = reinterpret_cast<NativeSeries>(ready->code());
  run(code, t, scale, c, n);
  if (rates.data() == written->derivatives.data()) last_code = code, last_size = c.size();
}

void SolutionSeries::Program::run(NativeSeries code, double t, double scale, std::span<double> c, std::size_t n) {
  double* const rows = series.rows().data();
  rows[0] = t;
  for (std::size_t i = 0; i < n; ++i) rows[i + 1] = c[i];
  code(rows, c.data(), scale, nullptr);
}

SolutionSeries::SolutionSeries(const ModelProgram& program, std::span<const NodeId> derivatives,
                               std::span<const double> variables, std::span<const NodeId> guards) {
  const Layout& layout = program.model.layout;
  const auto make = [&] {
    auto equations = std::make_shared<SeriesEquations>();
    equations->graph = program.model.graph;
    equations->tables = std::make_shared<const std::vector<Table>>(program.tables);
    equations->native = program.model.native;
    equations->states_begin = layout.states;
    equations->states_end = layout.states + static_cast<std::uint32_t>(program.model.states.size());
    std::vector<NodeId> nodes;
    for (const NodeId node : derivatives) nodes.push_back(program.with_inputs(equations->graph, node));
    for (const NodeId node : guards) equations->guards.push_back(program.with_inputs(equations->graph, node));
    Sharing sharing(equations->graph, layout.states, equations->states_end, program.tape_variables().variables);
    equations->derivatives = sharing.of(nodes);
    equations->exponent_values = sharing.exponents();
    for (const NodeId id : reachable(equations->graph, equations->derivatives))
      if (equations->graph[id].op == Op::power) equations->exponents.push_back(equations->graph[id].b);
    return equations;
  };
  std::vector<NodeId> key(derivatives.begin(), derivatives.end());
  key.insert(key.end(), guards.begin(), guards.end());
  program_ = std::make_unique<Program>(
      Program{.equations = program.series_equations.of(key, make), .variables = {variables.begin(), variables.end()}});
  program_->variables.resize(program.tape_variables().variables);
  const std::vector<double>& exponents = program_->equations->exponent_values;
  program_->variables.insert(program_->variables.end(), exponents.begin(), exponents.end());
}

SolutionSeries::SolutionSeries(const SolutionSeries& other) : program_(std::make_unique<Program>(*other.program_)) {}
SolutionSeries::SolutionSeries(SolutionSeries&&) noexcept = default;
SolutionSeries& SolutionSeries::operator=(const SolutionSeries& other) {
  program_ = std::make_unique<Program>(*other.program_);
  return *this;
}
SolutionSeries& SolutionSeries::operator=(SolutionSeries&&) noexcept = default;
SolutionSeries::~SolutionSeries() = default;

bool SolutionSeries::has_corners() const {
  return program_->series.has_corners();
}

bool SolutionSeries::watches_guards() const {
  return program_->last_code != nullptr && program_->guards->text;
}

std::size_t SolutionSeries::take_steps(SeriesSteps<double>& steps) {
  // The code of the last series is that of these: it has the steps too.
  if (program_->is_stale || program_->last_code == nullptr ||
      program_->last_size != steps.components * (steps.order + 1) || (steps.has_guards && !program_->guards->text))
    return 0;
  program_->scratch.resize(series_scratch(steps.components));
  if (steps.has_guards && program_->guard_numbers.empty()) {
    program_->guard_numbers = program_->equations->values_of(program_->guards->numbers, program_->variables);
    program_->guard_numbers.push_back(0);  // so that there is one
  }
  const Tolerance<double>& tolerance = steps.tolerance;
  NativeSeriesSteps native{.rows = program_->series.rows().data(),
                           .scratch = program_->scratch.data(),
                           .x = steps.x,
                           .rest = steps.rest,
                           .now = steps.now,
                           .next = steps.next,
                           .t = steps.t,
                           .scale = steps.scale,
                           .size = steps.size,
                           .carried = steps.carried,
                           .limit = steps.limit,
                           .longest = steps.longest,
                           .until = steps.until,
                           .forward = steps.forward,
                           .rtol = tolerance.rtol_each ? tolerance.rtol_each : &tolerance.rtol,
                           .atol = tolerance.atol_each ? tolerance.atol_each : &tolerance.atol,
                           .rtol_each = tolerance.rtol_each ? 1 : 0,
                           .atol_each = tolerance.atol_each ? 1 : 0,
                           .terms = {steps.terms[0], steps.terms[1]},
                           .greatest_factor = steps.greatest_factor,
                           .safety = steps.safety,
                           .times = steps.times,
                           .numbers = steps.has_guards ? program_->guard_numbers.data() : nullptr,
                           .most = static_cast<long long>(steps.most),
                           .made = 0};
  program_->last_code(nullptr, nullptr, 0, &native);
  steps.t = native.t, steps.scale = native.scale, steps.size = native.size, steps.carried = native.carried;
  return static_cast<std::size_t>(native.made);
}

void SolutionSeries::set(std::uint32_t variable, double value) {
  if (program_->variables[variable] == value) return;
  program_->variables[variable] = value;
  program_->is_stale = true;
}

void SolutionSeries::expand(double t, double scale, std::span<double> c, std::span<const std::size_t> held) {
  if (program_->is_stale) program_->renew();
  const std::size_t n = program_->written->derivatives.size();
  if (held.empty() && program_->last_code != nullptr && program_->last_size == c.size())
    return program_->run(program_->last_code, t, scale, c, n);
  if (held.empty()) return program_->expand(t, scale, c, program_->written->derivatives);
  std::vector<Register> derivatives = program_->written->derivatives;
  for (const std::size_t i : held) derivatives[i] = program_->written->zero;
  program_->expand(t, scale, c, derivatives);
}

}  // namespace continuo::model
