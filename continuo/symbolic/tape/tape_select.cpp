// continuo/symbolic/tape/tape_select.cpp
// Selects the operation of a tape for each node, with negations, products and sums fused.
#include <algorithm>
#include <utility>

#include <continuo/symbolic/tape/tape_select.hpp>

namespace continuo::model::tape {

namespace {

Code code_of(Op op) {
  switch (op) {
    case Op::add:
      return Code::add;
    case Op::subtract:
      return Code::subtract;
    case Op::multiply:
      return Code::multiply;
    case Op::divide:
      return Code::divide;
    case Op::power:
      return Code::power;
    case Op::minimum:
      return Code::minimum;
    case Op::maximum:
      return Code::maximum;
    case Op::hypotenuse:
      return Code::hypotenuse;
    case Op::arc_tangent2:
      return Code::arc_tangent2;
    case Op::modulo:
      return Code::modulo;
    case Op::less:
      return Code::less;
    case Op::less_equal:
      return Code::less_equal;
    case Op::equal:
      return Code::equal;
    case Op::not_equal:
      return Code::not_equal;
    case Op::logical_and:
      return Code::logical_and;
    case Op::logical_or:
      return Code::logical_or;
    case Op::negate:
      return Code::negate;
    case Op::sine:
      return Code::sine;
    case Op::cosine:
      return Code::cosine;
    case Op::tangent:
      return Code::tangent;
    case Op::arc_sine:
      return Code::arc_sine;
    case Op::arc_cosine:
      return Code::arc_cosine;
    case Op::arc_tangent:
      return Code::arc_tangent;
    case Op::hyperbolic_sine:
      return Code::hyperbolic_sine;
    case Op::hyperbolic_cosine:
      return Code::hyperbolic_cosine;
    case Op::hyperbolic_tangent:
      return Code::hyperbolic_tangent;
    case Op::exponential:
      return Code::exponential;
    case Op::logarithm:
      return Code::logarithm;
    case Op::logarithm10:
      return Code::logarithm10;
    case Op::square_root:
      return Code::square_root;
    case Op::absolute:
      return Code::absolute;
    case Op::sign:
      return Code::sign;
    case Op::floor:
      return Code::floor;
    case Op::ceiling:
      return Code::ceiling;
    case Op::logical_not:
      return Code::logical_not;
    case Op::select:
      return Code::select;
    case Op::interpolate:
      return Code::interpolate;
    case Op::interpolate_slope:
      return Code::interpolate_slope;
    case Op::constant:
    case Op::variable:
    case Op::smooth:
      break;
  }
  return Code::stop;
}

class Selector {
 public:
  explicit Selector(const Prepared& prepared)
      : graph_(prepared.graph), steady_(prepared.steady), uses_(graph_.size()), needed_(graph_.size()) {
    for (const NodeId output : prepared.outputs) {
      ++uses_[output.index];
      needed_[output.index] = true;
    }
    for (const NodeId id : reachable(graph_, prepared.outputs)) {
      for (const NodeId argument : arguments(graph_[id])) ++uses_[argument.index];
    }
  }

  std::vector<Selected> select() {
    std::vector<Selected> chosen;
    chosen.reserve(graph_.size());  // memory that is not written to costs nothing; moving a grid's operations does
    for (std::uint32_t i = static_cast<std::uint32_t>(graph_.size()); i-- > 0;) {
      const NodeId id{i};
      if (!needed_[i] || arity(graph_[id].op) == 0) continue;
      Selected s = fused(id);
      s.result = id;
      s.steady = steady_[i];
      for (std::size_t k = 0; k < operands(s.code); ++k) needed_[s.operand[k].index] = true;
      chosen.push_back(s);
    }
    std::ranges::reverse(chosen);
    return chosen;
  }

 private:
  /// The node may vanish into the one that uses it.
  bool folds(NodeId child, NodeId parent, Op op) const {
    return graph_[child].op == op && uses_[child.index] == 1 && steady_[child.index] == steady_[parent.index];
  }

  static Selected make(Code code, NodeId a, NodeId b = {}, NodeId c = {}, NodeId d = {}) {
    return {.code = code, .result = {}, .operand = {a, b, c, d}};
  }

  Selected fused(NodeId id) const {
    const Node& n = graph_[id];
    switch (n.op) {
      case Op::add:
        return sum(id, n);
      case Op::subtract:
        return difference(id, n);
      case Op::multiply:
        return product(id, n);
      case Op::negate:
        return negation(id, n);
      case Op::select:
        return choice(n);
      default:
        break;
    }
    Selected s = make(code_of(n.op), n.a, n.b, n.c);
    s.table = n.number;
    return s;
  }

  /// The code of a sum or difference where both of its terms, only one, or none is a product computed with it.
  struct TermCodes {
    Code both, first, second, none;
  };
  static constexpr TermCodes of_sum{Code::sum_of_products, Code::multiply_add, Code::multiply_add, Code::add};
  static constexpr TermCodes of_difference{Code::difference_of_products, Code::multiply_subtract,
                                           Code::subtract_product, Code::subtract};

  Selected sum(NodeId id, const Node& n) const {
    for (const auto& [inner, other] : {std::pair(n.a, n.b), std::pair(n.b, n.a)}) {
      if (!folds(inner, id, Op::subtract) || folds(other, id, Op::multiply)) continue;
      const Selected s = terms(id, graph_[inner], of_difference);
      if (s.code == Code::subtract_product)
        return make(Code::less_product_plus, s.operand[0], s.operand[1], s.operand[2], other);
    }
    return terms(id, n, of_sum);
  }
  Selected difference(NodeId id, const Node& n) const {
    const Selected s = terms(id, n, of_difference);
    if (s.code != Code::subtract_product || !folds(n.a, id, Op::add)) return s;
    const Selected first = terms(id, graph_[n.a], of_sum);
    if (first.code != Code::add) return s;
    return make(Code::sum_less_product, s.operand[0], s.operand[1], first.operand[0], first.operand[1]);
  }
  Selected terms(NodeId id, const Node& n, const TermCodes& code) const {
    const Node &a = graph_[n.a], &b = graph_[n.b];
    const bool product_a = folds(n.a, id, Op::multiply), product_b = folds(n.b, id, Op::multiply);
    if (product_a && product_b) return make(code.both, a.a, a.b, b.a, b.b);
    if (product_a) return make(code.first, a.a, a.b, n.b);
    if (product_b) return make(code.second, b.a, b.b, n.a);
    return make(code.none, n.a, n.b);
  }

  Selected product(NodeId id, const Node& n) const {
    for (const auto& [inner, other] : {std::pair(n.a, n.b), std::pair(n.b, n.a)}) {
      if (folds(inner, id, Op::add)) return make(Code::sum_times, graph_[inner].a, graph_[inner].b, other);
      if (folds(inner, id, Op::subtract)) return make(Code::difference_times, graph_[inner].a, graph_[inner].b, other);
    }
    for (const auto& [inner, other] : {std::pair(n.a, n.b), std::pair(n.b, n.a)}) {
      if (folds(inner, id, Op::multiply)) return make(Code::multiply_twice, graph_[inner].a, graph_[inner].b, other);
    }
    return make(Code::multiply, n.a, n.b);
  }

  Selected negation(NodeId id, const Node& n) const {
    const Node& a = graph_[n.a];
    if (folds(n.a, id, Op::subtract)) return difference(id, {.op = Op::subtract, .a = a.b, .b = a.a, .before = {}});
    if (folds(n.a, id, Op::add)) return negated(terms(id, a, of_sum));
    if (folds(n.a, id, Op::multiply)) {
      const Selected s = product(id, a);
      return s.code == Code::multiply || s.code == Code::difference_times ? negated(s)
                                                                          : make(Code::negated_product, a.a, a.b);
    }
    if (a.op == Op::subtract && steady_[n.a.index] == steady_[id.index]) return make(Code::subtract, a.b, a.a);
    return make(Code::negate, n.a);
  }

  /// -(a - b)*c is (b - a)*c; the others have a code of their own.
  Selected negated(Selected s) const {
    switch (s.code) {
      case Code::add:
        s.code = Code::negated_sum;
        break;
      case Code::multiply_add:
        s.code = Code::negated_multiply_add;
        break;
      case Code::sum_of_products:
        s.code = Code::negated_sum_of_products;
        break;
      case Code::multiply:
        s.code = Code::negated_product;
        break;
      default:
        std::swap(s.operand[0], s.operand[1]);  // difference_times
    }
    return s;
  }

  Selected choice(const Node& n) const {
    const Node& condition = graph_[n.a];
    if (condition.op == Op::less) return make(Code::select_less, condition.a, condition.b, n.b, n.c);
    if (condition.op == Op::less_equal) return make(Code::select_less_equal, condition.a, condition.b, n.b, n.c);
    return make(Code::select, n.a, n.b, n.c);
  }

  const Graph& graph_;
  const std::vector<bool>& steady_;
  std::vector<std::uint32_t> uses_;
  std::vector<bool> needed_;
};

}  // namespace

std::vector<Selected> select_operations(const Prepared& prepared) {
  return Selector(prepared).select();
}

}  // namespace continuo::model::tape
