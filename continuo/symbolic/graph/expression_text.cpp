// continuo/symbolic/graph/expression_text.cpp
// Expressions printed as a model would write them.
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include <continuo/symbolic/graph/expression.hpp>

namespace continuo::model {

namespace {

/// How tightly an operation binds in the language; an argument that binds less needs brackets.
enum Binding {
  binds_select,
  binds_or,
  binds_and,
  binds_not,
  binds_comparison,
  binds_sum,
  binds_product,
  binds_power,
  binds_atom
};

Binding binding(const Node& node) {
  if (node.op == Op::multiply && node.a == node.b) return binds_power;
  switch (node.op) {
    case Op::select:
      return binds_select;
    case Op::logical_or:
      return binds_or;
    case Op::logical_and:
      return binds_and;
    case Op::logical_not:
      return binds_not;
    case Op::less:
    case Op::less_equal:
    case Op::equal:
    case Op::not_equal:
      return binds_comparison;
    case Op::add:
    case Op::subtract:
    case Op::negate:
      return binds_sum;
    case Op::multiply:
    case Op::divide:
      return binds_product;
    case Op::power:
      return binds_power;
    default:
      return binds_atom;
  }
}

struct Printer {
  static constexpr int deepest = 400;  // far more than anybody reads, far less than the call stack holds

  const Graph& g;
  const VariableName& name;
  std::size_t longest;
  std::string text;

  void number(double value, Binding least) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    const bool brackets = value < 0 && least > binds_sum;
    text += brackets ? "(" : "";
    text.append(digits, end);
    text += brackets ? ")" : "";
  }

  void call(std::string_view function, const Arguments& of, int depth) {
    text += function;
    for (std::size_t i = 0; i < of.count; ++i) {
      text += i == 0 ? "(" : ", ";
      print(of.ids[i], binds_select, depth);
    }
    text += ')';
  }

  void infix(const Node& n, Binding mine, int depth) {
    if (n.op == Op::multiply && n.a == n.b) {
      print(n.a, binds_atom, depth);
      text += "^2";
      return;
    }
    if (const auto first = g.value(n.a); first && n.op == Op::add) {  // the constant comes first in the graph
      print(n.b, mine, depth);
      text += *first < 0 ? " - " : " + ";
      return number(std::abs(*first), mine);
    }
    const bool tight = mine >= binds_product;
    // a - (b - c) and a/(b*c) keep their brackets, and so does every comparison inside a comparison.
    const bool left_too = mine == binds_comparison || mine == binds_power;
    print(n.a, left_too ? Binding(mine + 1) : mine, depth);
    text += tight ? "" : " ";
    text += model::name(n.op);
    text += tight ? "" : " ";
    print(n.b, n.op == Op::add || n.op == Op::multiply ? mine : Binding(mine + 1), depth);
  }

  void inside(const Node& n, Binding mine, Binding least, int depth) {
    switch (n.op) {
      case Op::constant:
        return number(n.value, least);
      case Op::variable:
        text += name(n.number);
        return;
      case Op::negate:
        if (g[n.a].op == Op::subtract)
          return infix({.op = Op::subtract, .a = g[n.a].b, .b = g[n.a].a, .before = {}}, mine, depth);
        text += '-';
        return print(n.a, binds_product, depth);
      case Op::logical_not:
        text += "not ";
        return print(n.a, binds_not, depth);
      case Op::select:
        text += "if ";
        print(n.a, binds_or, depth);
        text += " then ";
        print(n.b, binds_or, depth);
        text += " else ";
        return print(n.c, binds_select, depth);
      case Op::interpolate:
      case Op::interpolate_slope:
        text += std::string(model::name(n.op)) + "(table" + std::to_string(n.number) + ", ";
        print(n.a, binds_select, depth);
        text += ')';
        return;
      default:
        break;
    }
    if (mine < binds_atom) return infix(n, mine, depth);
    call(model::name(n.op), arguments(n), depth);
  }

  void print(NodeId id, Binding least, int depth) {
    if (text.size() > longest || depth > deepest) {
      if (!text.ends_with("...")) text += "...";
      return;
    }
    const Node& n = g[id];
    const Binding mine = binding(n);
    const bool brackets = mine < least;
    text += brackets ? "(" : "";
    inside(n, mine, least, depth + 1);
    text += brackets ? ")" : "";
  }
};

}  // namespace

std::string to_text(const Graph& graph, NodeId node, const VariableName& name, std::size_t longest) {
  Printer printer{graph, name, longest, {}};
  printer.print(node, binds_select, 0);
  return std::move(printer.text);
}

}  // namespace continuo::model
