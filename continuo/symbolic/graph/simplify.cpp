// continuo/symbolic/graph/simplify.cpp
// The makers of Graph: what an operation on given arguments becomes before it is looked up among the nodes.
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {

namespace {

constexpr bool is_finite_of_finite(Op op) {
  switch (op) {
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::minimum:
    case Op::maximum:
    case Op::hypotenuse:
    case Op::arc_tangent2:
    case Op::negate:
    case Op::sine:
    case Op::cosine:
    case Op::arc_tangent:
    case Op::hyperbolic_tangent:
    case Op::absolute:
    case Op::sign:
    case Op::floor:
    case Op::ceiling:
    case Op::smooth:
    case Op::select:
    case Op::interpolate:
    case Op::interpolate_slope:
      return true;
    default:
      return is_logical(op);
  }
}

/// What make() asks of each operation.
struct Traits {
  bool stays_finite, has_corners;
};
constexpr auto traits = [] {
  std::array<Traits, static_cast<std::size_t>(Op::interpolate_slope) + 1> all{};
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = {is_finite_of_finite(static_cast<Op>(i)), has_corners(static_cast<Op>(i))};
  return all;
}();

bool is_power_of_two(double value) {
  int exponent = 0;
  return std::abs(std::frexp(value, &exponent)) == 0.5 && exponent > -1000 && exponent < 1000;
}

}  // namespace

/// One rule after the other; a rule that does not apply returns an invalid node.
struct Simplifier {
  Graph& g;

  Op op(NodeId id) const { return g[id].op; }
  // By value: a reference to a node does not outlive the making of another.
  NodeId inner(NodeId id) const { return g[id].a; }
  NodeId second(NodeId id) const { return g[id].b; }
  bool is(NodeId id, double value) const { return g.is(id, value); }
  bool is_constant(NodeId id) const { return op(id) == Op::constant; }
  bool vanishes(NodeId factor, NodeId other) const { return is(factor, 0) && g[other].finite; }

  NodeId make(Op what, NodeId a, NodeId b = {}, NodeId c = {}) const {
    const Traits& of_operation = traits[static_cast<std::size_t>(what)];
    bool finite = of_operation.stays_finite || (what == Op::divide && is_constant(b) && !is(b, 0));
    bool corners = of_operation.has_corners;
    const auto take = [&](const Node& argument) {
      finite = finite && argument.finite;
      corners = corners || argument.corners;
    };
    take(g[a]);
    if (b.valid()) take(g[b]);
    if (c.valid()) take(g[c]);
    if (what == Op::smooth) corners = false;
    return g.intern_operation({.op = what, .finite = finite, .corners = corners, .a = a, .b = b, .c = c, .before = {}});
  }

  /// Sums of squares and their like: known without looking far.
  bool is_nonnegative(NodeId id, int depth = 8) const {
    const Node& n = g[id];
    switch (n.op) {
      case Op::constant:
        return n.value >= 0;
      case Op::absolute:
      case Op::square_root:
      case Op::exponential:
      case Op::hypotenuse:
        return true;
      case Op::multiply:
        return n.a == n.b || (depth > 0 && is_nonnegative(n.a, depth - 1) && is_nonnegative(n.b, depth - 1));
      case Op::add:
        return depth > 0 && is_nonnegative(n.b, depth - 1) && is_nonnegative(n.a, depth - 1);
      default:
        return false;
    }
  }

  NodeId add(NodeId a, NodeId b) const {
    if (is(a, 0)) return b;
    if (is(b, 0)) return a;
    if (op(b) == Op::negate) return g.subtract(a, inner(b));
    if (op(a) == Op::negate) return g.subtract(b, inner(a));
    if (a == b) return g.multiply(g.constant(2), a);
    return {};
  }

  NodeId subtract(NodeId a, NodeId b) const {
    if (is(b, 0)) return a;
    if (is(a, 0)) return g.negate(b);
    if (a == b && g[a].finite) return g.constant(0);
    if (op(b) == Op::negate) return g.add(a, inner(b));
    if (op(a) == Op::negate) return g.negate(g.add(inner(a), b));
    if (is_constant(b)) return g.add(a, g.constant(-*g.value(b)));
    // One order for both: x - y and y - x share a node, so that a pair of bodies computes its distance once.
    if (!is_constant(a) && b < a) return g.negate(make(Op::subtract, b, a));
    return {};
  }

  NodeId multiply(NodeId a, NodeId b) const {
    if (is_constant(b)) std::swap(a, b);
    if (vanishes(a, b)) return g.constant(0);
    if (is(a, 1)) return b;
    if (is(a, -1)) return g.negate(b);
    if (a == b && op(a) == Op::square_root && is_nonnegative(inner(a))) return inner(a);
    if (op(a) == Op::negate && op(b) == Op::negate) return g.multiply(inner(a), inner(b));
    if (op(a) == Op::negate) return g.negate(g.multiply(inner(a), b));
    if (op(b) == Op::negate && is_constant(a)) return g.multiply(g.constant(-*g.value(a)), inner(b));
    if (op(b) == Op::negate) return g.negate(g.multiply(a, inner(b)));
    if (is_constant(a) && op(b) == Op::multiply && is_constant(inner(b))) {
      return g.multiply(g.constant(*g.value(a) * *g.value(inner(b))), second(b));
    }
    return {};
  }

  NodeId divide(NodeId a, NodeId b) const {
    if (is(b, 1)) return a;
    if (is(b, -1)) return g.negate(a);
    if (is(a, 0) && is_constant(b) && !is(b, 0)) return a;
    if (op(a) == Op::negate && op(b) == Op::negate) return g.divide(inner(a), inner(b));
    if (op(a) == Op::negate) return g.negate(g.divide(inner(a), b));
    if (op(b) == Op::negate) return g.negate(g.divide(a, inner(b)));
    if (is_constant(b) && is_power_of_two(*g.value(b))) return g.multiply(g.constant(1 / *g.value(b)), a);
    return {};
  }

  /// Whole and half exponents up to 16 become products and a square root: cheaper, and at least as exact.
  NodeId power(NodeId a, NodeId b) const {
    if (!is_constant(b)) return {};
    const double exponent = *g.value(b), twice = 2 * std::abs(exponent);
    if (exponent == 0) return g.constant(1);
    if (twice != std::floor(twice) || twice > 32) return {};
    const int whole = static_cast<int>(std::floor(std::abs(exponent)));
    NodeId result = whole > 0 ? whole_power(a, whole) : NodeId{};
    if (twice != 2 * whole) {
      const NodeId root = g.apply(Op::square_root, a);
      result = whole > 0 ? g.multiply(result, root) : root;
    }
    return exponent > 0 ? result : g.divide(g.constant(1), result);
  }

  NodeId whole_power(NodeId a, int exponent) const {
    if (exponent == 1) return a;
    const NodeId half = whole_power(a, exponent / 2);
    const NodeId square = g.multiply(half, half);
    return exponent % 2 == 0 ? square : g.multiply(square, a);
  }

  NodeId logical(Op what, NodeId a, NodeId b) const {
    const bool absorbing = what == Op::logical_or;  // 1 or x = 1, 0 and x = 0
    for (const auto& [known, other] : {std::pair(a, b), std::pair(b, a)}) {
      if (!is_constant(known)) continue;
      if ((*g.value(known) != 0) == absorbing) return g.truth(absorbing);
      if (is_logical(op(other))) return other;
    }
    return a == b && is_logical(op(a)) ? a : NodeId{};
  }

  NodeId binary(Op what, NodeId a, NodeId b) const {
    switch (what) {
      case Op::add:
        return add(a, b);
      case Op::subtract:
        return subtract(a, b);
      case Op::multiply:
        return multiply(a, b);
      case Op::divide:
        return divide(a, b);
      case Op::power:
        return power(a, b);
      case Op::minimum:
      case Op::maximum:
        return a == b ? a : NodeId{};
      case Op::hypotenuse:
        return is(a, 0) ? g.apply(Op::absolute, b) : is(b, 0) ? g.apply(Op::absolute, a) : NodeId{};
      case Op::logical_and:
      case Op::logical_or:
        return logical(what, a, b);
      default:
        return {};
    }
  }

  NodeId unary(Op what, NodeId a) const {
    const Op argument = op(a);
    if (what == Op::negate && argument == Op::negate) return inner(a);
    if (what == Op::negate && argument == Op::multiply && is_constant(inner(a))) {
      return g.multiply(g.constant(-*g.value(inner(a))), second(a));
    }
    if (what == Op::smooth && !g[a].corners) return a;
    if (what == Op::absolute && (argument == Op::absolute || argument == Op::square_root)) return a;
    if (what == Op::absolute && argument == Op::negate) return g.apply(Op::absolute, inner(a));
    if (what == Op::cosine && argument == Op::negate) return g.apply(Op::cosine, inner(a));
    if (what == Op::logical_not && argument == Op::logical_not && is_logical(op(inner(a)))) return inner(a);
    return {};
  }
};

NodeId Graph::apply(Op op, NodeId a) {
  if (const auto known = value(a)) return constant(compute(op, *known));
  const Simplifier simplify{*this};
  const NodeId simpler = simplify.unary(op, a);
  return simpler.valid() ? simpler : simplify.make(op, a);
}

NodeId Graph::apply(Op op, NodeId a, NodeId b) {
  const auto known_a = value(a), known_b = value(b);
  if (known_a && known_b) return constant(compute(op, *known_a, *known_b));
  const Simplifier simplify{*this};
  if (const NodeId simpler = simplify.binary(op, a, b); simpler.valid()) return simpler;
  // One order for both spellings: a constant first, else the older node first.
  if (is_commutative(op) && (known_b || (!known_a && b < a))) std::swap(a, b);
  return simplify.make(op, a, b);
}

NodeId Graph::select(NodeId condition, NodeId if_true, NodeId if_false) {
  if (const auto known = value(condition)) return *known != 0 ? if_true : if_false;
  if (if_true == if_false) return if_true;
  if ((*this)[condition].op == Op::logical_not) return select((*this)[condition].a, if_false, if_true);
  return Simplifier{*this}.make(Op::select, condition, if_true, if_false);
}

}  // namespace continuo::model
