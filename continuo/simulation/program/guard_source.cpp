// Writes guards as operations on ranges, which are widened by more than the rounding of each.
#include <iterator>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include <continuo/language/model.hpp>
#include <continuo/simulation/program/guard_source.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t most_nodes = 200, most_states = 24;

/// Every function of what is not bounded is the whole line, for it may be undefined there. `widened` allows for the
/// rounding of an operation, 18 units in the last place; the state besides for that of a sum of 25 terms.
constexpr std::string_view range_helpers = R"(struct range {
  double lo, hi;
};
INLINE int is_bounded(struct range a) { return a.hi - a.lo < __builtin_inf(); }
INLINE struct range whole_line(void) { return (struct range){-__builtin_inf(), __builtin_inf()}; }
INLINE double less_of(double a, double b) { return b < a ? b : a; }
INLINE double more_of(double a, double b) { return a < b ? b : a; }
INLINE struct range widened(double lo, double hi) {
  const double part = 4e-15 * more_of(__builtin_fabs(lo), __builtin_fabs(hi)) + 1e-290;
  const struct range result = {lo - part, hi + part};
  return is_bounded(result) ? result : whole_line();
}
INLINE struct range one_number(double a) { return a - a == 0 ? (struct range){a, a} : whole_line(); }
INLINE struct range from_to(double a, double b) { return widened(less_of(a, b), more_of(a, b)); }
INLINE struct range sum(struct range a, struct range b) { return widened(a.lo + b.lo, a.hi + b.hi); }
INLINE struct range opposite(struct range a) { return (struct range){-a.hi, -a.lo}; }
INLINE struct range difference(struct range a, struct range b) { return sum(a, opposite(b)); }
INLINE struct range product(struct range a, struct range b) {
  if (!is_bounded(a) || !is_bounded(b)) return whole_line();
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return widened(less_of(less_of(p, q), less_of(r, s)), more_of(more_of(p, q), more_of(r, s)));
}
INLINE struct range size_of_range(struct range a) {
  if (!is_bounded(a)) return whole_line();
  const double p = __builtin_fabs(a.lo), q = __builtin_fabs(a.hi);
  return (struct range){a.lo <= 0 && a.hi >= 0 ? 0 : less_of(p, q), more_of(p, q)};
}
INLINE struct range square(struct range a) {
  const struct range b = size_of_range(a);
  return is_bounded(b) ? widened(b.lo * b.lo, b.hi * b.hi) : b;
}
INLINE struct range inverse(struct range a) {
  return is_bounded(a) && (a.lo > 0 || a.hi < 0) ? widened(1 / a.hi, 1 / a.lo) : whole_line();
}
INLINE struct range quotient(struct range a, struct range b) { return product(a, inverse(b)); }
INLINE struct range least(struct range a, struct range b) {
  return is_bounded(a) && is_bounded(b) ? (struct range){less_of(a.lo, b.lo), less_of(a.hi, b.hi)} : whole_line();
}
INLINE struct range greatest(struct range a, struct range b) {
  return is_bounded(a) && is_bounded(b) ? (struct range){more_of(a.lo, b.lo), more_of(a.hi, b.hi)} : whole_line();
}
INLINE struct range root(struct range a) {
  return is_bounded(a) && a.lo >= 0 ? widened(sqrt(a.lo), sqrt(a.hi)) : whole_line();
}
INLINE struct range positive(struct range a) { return (struct range){more_of(a.lo, 0), a.hi}; }
INLINE struct range length(struct range a, struct range b) { return root(positive(sum(square(a), square(b)))); }
INLINE struct range power(struct range a, struct range p) {
  if (!is_bounded(a) || !is_bounded(p)) return whole_line();
  if (p.lo == 2 && p.hi == 2) return square(a);
  return a.lo > 0 && p.lo == p.hi ? from_to(pow(a.lo, p.lo), pow(a.hi, p.lo)) : whole_line();
}
INLINE struct range rising(struct range a, double (*f)(double)) {
  return is_bounded(a) ? widened(f(a.lo), f(a.hi)) : whole_line();
}
INLINE struct range wave(struct range a, double (*f)(double)) {
  if (!is_bounded(a)) return whole_line();
  const double middle = f(0.5 * (a.lo + a.hi)), way = 0.51 * (a.hi - a.lo) + 1e-15 * (__builtin_fabs(a.lo) + 1);
  return widened(middle - way, middle + way);
}
INLINE struct range logarithm(struct range a) { return a.lo > 0 ? rising(a, log) : whole_line(); }
INLINE struct range state(double x, double first, double others) {
  const double part = others + 1e-13 * (__builtin_fabs(x) + __builtin_fabs(first) + others);
  return widened(x + less_of(first, 0) - part, x + more_of(first, 0) + part);
}
INLINE int may_be_zero(struct range a) { return !(a.lo > 0 || a.hi < 0); }
)";

class GuardWriter {
 public:
  GuardWriter(const Graph& graph, std::uint32_t states_begin, std::uint32_t states_end, std::size_t order)
      : graph_(graph), states_begin_(states_begin), states_end_(states_end), order_(order), moves_(graph.size(), 0) {}

  GuardSource source(std::span<const NodeId> guards) {
    const std::vector<NodeId> nodes = reachable(graph_, guards);
    if (nodes.size() > most_nodes) return {};
    if (!guards.empty()) text_ += range_helpers, others();
    line("INLINE int may_have_root(const double *c, const double *x, double t, double h, double theta,");
    line("    const double *numbers) {{");
    line("const double part = __builtin_fabs(theta), q = part * part;");
    for (const NodeId id : nodes) {
      moves_[id.index] = does_move(graph_[id]) ? 1 : 0;
      if (moves_[id.index] == 0) continue;
      const std::string value = range_of(graph_[id]);
      if (value.empty()) return {};
      line("const struct range g{} = {};", id.index, value);
    }
    for (const NodeId id : guards) line("if (may_be_zero({})) return 1;", name_of(id));
    line("return 0;\n}}");
    return {std::move(text_), std::move(numbers_)};
  }

 private:
  template <class... Arguments>
  void line(fmt::format_string<Arguments...> form, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }

  [[nodiscard]] bool is_state(const Node& node) const {
    return node.op == Op::variable && node.number >= states_begin_ && node.number < states_end_;
  }
  [[nodiscard]] bool does_move(const Node& node) const {
    if (node.op == Op::variable) return node.number == Layout::time || is_state(node);
    for (const NodeId argument : arguments(node))
      if (moves_[argument.index] != 0) return true;
    return false;
  }

  /// What does not move is a number, when it is first read.
  std::string name_of(NodeId id) {
    if (moves_[id.index] != 0) return fmt::format("g{}", id.index);
    const auto [found, is_new] = number_of_.try_emplace(id, numbers_.size());
    if (is_new) numbers_.push_back(id);
    return fmt::format("one_number(numbers[{}])", found->second);
  }

  /// The sum of the sizes of the terms from the second one on, even and odd ones apart.
  void others() {
    line("INLINE double others(const double *c, double part, double q) {{");
    for (const auto& [name, least] : {std::pair("even", std::size_t{2}), std::pair("odd", std::size_t{3})}) {
      std::size_t k = order_ - (order_ - least) % 2;
      line("double {} = __builtin_fabs(c[{} * N]);", name, k);
      for (k -= 2; k >= least; k -= 2) line("{0} = {0} * q + __builtin_fabs(c[{1} * N]);", name, k);
    }
    line("return q * (even + part * odd);\n}}");
  }

  /// Empty where it is not written.
  std::string range_of(const Node& node) {
    if (node.op == Op::variable && node.number == Layout::time) return "from_to(t, t + h)";
    if (is_state(node)) {
      if (++states_ > most_states) return {};
      return fmt::format("state(x[{0}], c[N + {0}] * theta, others(c + {0}, part, q))", node.number - states_begin_);
    }
    const auto call = [&](std::string_view function) {
      std::string text;
      for (const NodeId argument : arguments(node)) text += (text.empty() ? "" : ", ") + name_of(argument);
      return fmt::format("{}({})", function, text);
    };
    const auto of = [&](std::string_view kind, std::string_view function) {
      return fmt::format("{}({}, {})", kind, name_of(node.a), function);
    };
    switch (node.op) {
      case Op::add:
        return call("sum");
      case Op::subtract:
        return call("difference");
      case Op::multiply:
        return node.a == node.b ? fmt::format("square({})", name_of(node.a)) : call("product");
      case Op::divide:
        return call("quotient");
      case Op::power:
        return call("power");
      case Op::minimum:
        return call("least");
      case Op::maximum:
        return call("greatest");
      case Op::hypotenuse:
        return call("length");
      case Op::negate:
        return call("opposite");
      case Op::sine:
        return of("wave", "sin");
      case Op::cosine:
        return of("wave", "cos");
      case Op::arc_tangent:
        return of("rising", "atan");
      case Op::hyperbolic_sine:
        return of("rising", "sinh");
      case Op::hyperbolic_tangent:
        return of("rising", "tanh");
      case Op::exponential:
        return of("rising", "exp");
      case Op::logarithm:
        return call("logarithm");
      case Op::square_root:
        return call("root");
      case Op::absolute:
        return call("size_of_range");
      case Op::smooth:
        return call("");
      default:
        return {};
    }
  }

  const Graph& graph_;
  std::uint32_t states_begin_, states_end_;
  std::size_t order_, states_ = 0;
  std::vector<char> moves_;
  std::map<NodeId, std::size_t> number_of_;
  std::vector<NodeId> numbers_;
  std::string text_;
};

}  // namespace

GuardSource guard_source(const Graph& graph, std::span<const NodeId> guards, std::uint32_t states_begin,
                         std::uint32_t states_end, std::size_t order) {
  return GuardWriter(graph, states_begin, states_end, order).source(guards);
}

}  // namespace continuo::model
