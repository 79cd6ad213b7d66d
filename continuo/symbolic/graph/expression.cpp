// continuo/symbolic/graph/expression.cpp
// The hash table of a Graph, and walks over expressions: variables, substitution, arguments.
#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/graph/node_values.hpp>

namespace continuo::model {

namespace {

constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint8_t many_uses = 16;

std::uint64_t mix(std::uint64_t h, std::uint64_t value) {
  h ^= value + 0x9e3779b97f4a7c15u + (h << 6) + (h >> 2);
  return h * 0xff51afd7ed558ccdu;  // multiplier of MurmurHash3's finaliser (A. Appleby, public domain)
}

/// Where a node is looked for first: at `place` beyond a point that its shape decides. Variables with numbers that
/// follow each other are neighbours in the index, not in all its corners, and so are operations on the same first
/// argument, such as the products of a table.
struct Home {
  std::uint64_t shape, place;
};

/// Of a constant; operations have none.
std::uint64_t bits_of(const Node& node) {
  return node.op == Op::constant ? std::bit_cast<std::uint64_t>(node.value) : 0;
}

Home home(const Node& node) {
  if (node.op == Op::variable) return {mix(0, node.number >> 24), node.number};
  std::uint64_t shape = mix(mix(static_cast<std::uint64_t>(node.op), node.number), node.a.index);
  shape = mix(mix(shape, node.c.index), bits_of(node));
  return {shape ^ (shape >> 29), node.b.index};
}

/// Where it is looked for from then on.
std::uint64_t hash(const Node& node) {
  std::uint64_t h = mix(static_cast<std::uint64_t>(node.op), node.number);
  h = mix(h, node.a.index);
  h = mix(h, (std::uint64_t{node.b.index} << 32) | node.c.index);
  h = mix(h, bits_of(node));
  return h ^ (h >> 29);
}

bool are_same_operation(const Node& p, const Node& q) {
  return p.op == q.op && p.a == q.a && p.b == q.b && p.number == q.number && p.c == q.c;
}

bool are_same_leaf(const Node& p, const Node& q) {
  return p.op == q.op && p.number == q.number && bits_of(p) == bits_of(q);
}

constexpr std::size_t operations = static_cast<std::size_t>(Op::interpolate_slope) + 1;

/// The bit in Node::uses of the first argument of an operation.
constexpr auto kinds = [] {
  std::array<std::uint16_t, operations> bits{};
  for (std::size_t i = 0; i < operations; ++i) bits[i] = arity(static_cast<Op>(i)) == 1 ? 32U : 64U;
  constexpr std::array frequent = {Op::add, Op::subtract, Op::multiply, Op::divide, Op::negate};
  for (std::size_t k = 0; k < frequent.size(); ++k)
    bits[static_cast<std::size_t>(frequent[k])] = static_cast<std::uint16_t>(1U << k);
  return bits;
}();

std::uint16_t kind_of(Op op) {
  return kinds[static_cast<std::size_t>(op)];
}

/// The bit of the second.
std::uint16_t as_second(std::uint16_t kind) {
  return static_cast<std::uint16_t>(kind << 8U);
}

/// The empty slot for a node, or the one where `is_it` says that the node in it is equal.
template <class IsIt>
std::size_t slot_of(const Node& node, const std::vector<std::uint32_t>& slots, const IsIt& is_it) {
  const auto ends_at = [&](std::size_t slot) { return slots[slot] == empty || is_it(slots[slot]); };
  const std::size_t mask = slots.size() - 1;
  Home near = home(node);
  for (int tries = 0; tries < 4; ++tries) {
    const std::size_t slot = (near.shape + near.place) & mask;
    if (ends_at(slot)) return slot;
    near.shape = mix(near.shape, 1);
  }
  const std::uint64_t h = hash(node), stride = (h >> 32) | 1;  // slots at home are taken in long rows: leap over them
  std::size_t slot = h & mask;
  while (!ends_at(slot)) slot = (slot + stride) & mask;
  return slot;
}

}  // namespace

Graph::Graph() : leaves_{std::vector<std::uint32_t>(16, empty)}, operations_{std::vector<std::uint32_t>(64, empty)} {}

/// Doubles an index that becomes too full by one node more.
void Graph::make_room(Index& index) {
  if (2 * index.count < index.slots.size()) return;
  const std::vector<std::uint32_t> entered = std::exchange(index.slots, {});
  index.slots.assign(2 * entered.size(), empty);
  index.count = 0;
  for (const std::uint32_t node : entered)
    if (node != empty) enter(index, node);
}

/// A node that is not there yet.
void Graph::enter(Index& index, std::uint32_t node) {
  const auto is_another = [](std::uint32_t) { return false; };
  index.slots[slot_of(nodes_[node], index.slots, is_another)] = node;
  ++index.count;
}

void Graph::reserve(std::size_t nodes) {
  nodes_.reserve(nodes);
}

NodeId Graph::append(const Node& node) {
  nodes_.push_back(node);
  return NodeId{static_cast<std::uint32_t>(nodes_.size() - 1)};
}

NodeId Graph::intern_leaf(const Node& node) {
  make_room(leaves_);
  const auto is_it = [&](std::uint32_t i) { return are_same_leaf(nodes_[i], node); };
  const std::size_t slot = slot_of(node, leaves_.slots, is_it);
  if (leaves_.slots[slot] != empty) return NodeId{leaves_.slots[slot]};
  ++leaves_.count;
  return NodeId{leaves_.slots[slot] = append(node).index};
}

bool Graph::has_many_uses(NodeId id) const {
  return nodes_[id.index].use_count == many_uses;
}

/// Of the uses of an argument, the one before this one.
NodeId Graph::use_before(NodeId argument, NodeId use) const {
  const Node& node = nodes_[use.index];
  return node.a == argument ? node.before.of_a : node.before.of_b;
}

NodeId Graph::find_among_uses(NodeId argument, const Node& node) const {
  NodeId use = nodes_[argument.index].latest_use;
  while (use.valid() && !are_same_operation(nodes_[use.index], node)) use = use_before(argument, use);
  return use;
}

/// An argument of it may have such a use.
NodeId Graph::find_operation(const Node& node) const {
  if (!has_many_uses(node.a)) return find_among_uses(node.a, node);
  if (node.b.valid() && !has_many_uses(node.b)) return find_among_uses(node.b, node);
  const auto is_it = [&](std::uint32_t i) { return are_same_operation(nodes_[i], node); };
  return NodeId{operations_.slots[slot_of(node, operations_.slots, is_it)]};  // not valid where it is empty
}

/// One use more, before it is among the uses. Where they become many, those that are there move to the index, unless
/// another argument of theirs still has few.
void Graph::count_use(NodeId argument) {
  if (has_many_uses(argument) || ++nodes_[argument.index].use_count < many_uses) return;
  for (NodeId use = nodes_[argument.index].latest_use; use.valid(); use = use_before(argument, use)) {
    const Node& node = nodes_[use.index];
    if (!has_many_uses(node.a) || (node.b.valid() && !has_many_uses(node.b))) continue;
    make_room(operations_);
    enter(operations_, use.index);
  }
}

NodeId Graph::intern_operation(const Node& node) {
  const std::uint16_t first = kind_of(node.op), second = as_second(first);
  const bool is_binary = node.b.valid(), has_second = is_binary && node.b != node.a;
  if ((nodes_[node.a.index].uses & first) != 0 && (!is_binary || (nodes_[node.b.index].uses & second) != 0)) {
    if (const NodeId known = find_operation(node); known.valid()) return known;
  }
  count_use(node.a);
  if (has_second) count_use(node.b);
  const NodeId made = append(node);
  Node& a = nodes_[node.a.index];
  Node::Before before{.of_a = std::exchange(a.latest_use, made)};
  a.uses |= first;
  if (is_binary) nodes_[node.b.index].uses |= second;
  if (has_second) before.of_b = std::exchange(nodes_[node.b.index].latest_use, made);
  nodes_[made.index].before = before;
  if (has_many_uses(node.a) && (!is_binary || has_many_uses(node.b))) {
    make_room(operations_);
    enter(operations_, made.index);
  }
  return made;
}

NodeId Graph::constant(double value) {
  if (value == 0) value = 0;  // one zero: -0 would differ only after a division by it
  return intern_leaf({.op = Op::constant, .finite = std::isfinite(value), .value = value});
}

NodeId Graph::variable(std::uint32_t number) {
  if (number < variables_.size() && variables_[number].valid()) return variables_[number];
  return new_variable(number);
}

/// One that is not in its place: it may be in the index all the same, from when its number was too large for a place.
NodeId Graph::new_variable(std::uint32_t number) {
  const Node node{.op = Op::variable, .finite = true, .number = number, .value = 0};
  constexpr std::size_t spare = 1024;
  if (number >= 2 * nodes_.size() + spare) return intern_leaf(node);
  if (number >= variables_.size()) variables_.resize(std::max<std::size_t>(number + 1, 2 * variables_.size()));
  const auto is_it = [&](std::uint32_t i) { return are_same_leaf(nodes_[i], node); };
  const NodeId known{leaves_.slots[slot_of(node, leaves_.slots, is_it)]};
  return variables_[number] = known.valid() ? known : append(node);
}

NodeId Graph::read_table(Op op, std::uint32_t table, NodeId x) {
  const bool finite = (*this)[x].finite;
  return intern_operation({.op = op, .finite = finite, .corners = true, .number = table, .a = x, .before = {}});
}

std::vector<NodeId> reachable(const Graph& graph, std::span<const NodeId> roots) {
  constexpr std::size_t few = 64;  // a small expression is not worth a look at the whole graph
  std::uint32_t top = 0;
  for (const NodeId root : roots) top = std::max(top, root.index + 1);
  std::vector<bool> seen;
  std::vector<NodeId> found;
  const auto visit = [&](NodeId id) {
    if (seen.empty()) {
      if (std::ranges::find(found, id) != found.end()) return;
      found.push_back(id);
      if (found.size() < few) return;
      seen.assign(top, false);
      for (const NodeId known : found) seen[known.index] = true;
      return;
    }
    if (!seen[id.index]) found.push_back(id);
    seen[id.index] = true;
  };
  std::ranges::for_each(roots, visit);
  for (std::size_t next = 0; next < found.size(); ++next) std::ranges::for_each(arguments(graph[found[next]]), visit);
  if (seen.empty() || found.size() <= top / 32) {
    std::ranges::sort(found);
    return found;
  }
  found.clear();  // it is most of the graph: sooner counted than sorted
  for (std::uint32_t i = 0; i < top; ++i) {
    if (seen[i]) found.push_back(NodeId{i});
  }
  return found;
}

bool depends_on(const Graph& graph, NodeId node, std::uint32_t variable) {
  return std::ranges::any_of(reachable(graph, {&node, 1}),
                             [&](NodeId id) { return graph[id].op == Op::variable && graph[id].number == variable; });
}

std::vector<std::uint32_t> variables_of(const Graph& graph, std::span<const NodeId> nodes) {
  std::vector<std::uint32_t> numbers;
  for (const NodeId id : reachable(graph, nodes)) {
    if (graph[id].op == Op::variable) numbers.push_back(graph[id].number);
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<std::uint32_t> variables_of(const Graph& graph, NodeId node) {
  return variables_of(graph, {&node, 1});
}

NodeId with_arguments(Graph& graph, NodeId node, const std::function<NodeId(NodeId)>& image) {
  const Node old = graph[node];  // a copy: the graph grows below
  if (arity(old.op) == 0) return node;
  const NodeId a = image(old.a);
  if (old.op == Op::interpolate) return graph.interpolate(old.number, a);
  if (old.op == Op::interpolate_slope) return graph.interpolate_slope(old.number, a);
  if (arity(old.op) == 1) return graph.apply(old.op, a);
  if (arity(old.op) == 2) return graph.apply(old.op, a, image(old.b));
  return graph.select(a, image(old.b), image(old.c));
}

NodeId substitute(Graph& graph, NodeId node, const Replacement& replacement) {
  const std::vector<NodeId> nodes = reachable(graph, {&node, 1});
  NodeValues<NodeId> images(nodes);
  const std::function<NodeId(NodeId)> of = [&](NodeId id) { return images[id]; };
  for (const NodeId id : nodes) {
    images[id] =
        graph[id].op == Op::variable ? replacement(graph[id].number).value_or(id) : with_arguments(graph, id, of);
  }
  return of(node);
}

NodeId substitute(Graph& graph, NodeId node, std::uint32_t variable, NodeId replacement) {
  return substitute(graph, node, [&](std::uint32_t number) {
    return number == variable ? std::optional(replacement) : std::nullopt;
  });
}

std::vector<double> evaluate(const Graph& graph, std::span<const NodeId> nodes, std::span<const double> variables,
                             const TableLookup& table) {
  const std::vector<NodeId> computed = reachable(graph, nodes);
  NodeValues<double> value(computed);
  const auto of = [&](NodeId id) { return id.valid() ? value[id] : 0.0; };
  for (const NodeId id : computed) {
    const Node& n = graph[id];
    if (n.op == Op::constant) {
      value[id] = n.value;
    } else if (n.op == Op::variable) {
      value[id] = variables[n.number];
    } else if (n.op >= Op::interpolate && table) {
      value[id] = table(n.number, of(n.a), n.op == Op::interpolate_slope);
    } else {
      value[id] = compute(n.op, of(n.a), of(n.b), of(n.c));
    }
  }
  std::vector<double> results;
  results.reserve(nodes.size());
  for (const NodeId node : nodes) results.push_back(of(node));
  return results;
}

double evaluate(const Graph& graph, NodeId node, std::span<const double> variables, const TableLookup& table) {
  return evaluate(graph, {&node, 1}, variables, table).front();
}

}  // namespace continuo::model
