// A binary tree of bounds over numbered leaves: which of them overlap each other, given bounds, or the way of a box or
// a ray.
//
//   BoundsTree<float, 3> tree(bounds);                                      // of each shape, by its number
//   tree.for_each_pair([&](std::uint32_t i, std::uint32_t j) { ... });      // i < j overlap
//   tree.refit(moved);
//   if (tree.rebuild_pays()) tree.build(moved);
//
// It is built in O(n log n) by the surface area heuristic, whatever the sizes and places of the bounds, and refitted in
// O(n). It and the order of all visits depend on the bounds alone. Its depth is below 64, also where all bounds are the
// same. Empty bounds overlap nothing; a NaN counts as unbounded, and an infinite bound as the largest finite number, so
// that no pair is lost.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/bounds/bounds.hpp>
#include <continuo/bodies/bounds/surface_area_split.hpp>
#include <continuo/bodies/bounds/sweep.hpp>

namespace continuo {

template <class Real, int Dim>
class WayTree;

/// A tree of bounds. A search changes nothing, so that many threads may search at once.
template <class Real, int Dim>
class BoundsTree {
 public:
  using Box = Bounds<Real, Dim>;

  /// Of nothing.
  BoundsTree() = default;
  /// Of leaves that are numbered in this order; at most 2^31.
  explicit BoundsTree(std::span<const Box> leaves) { build(leaves); }

  /// Builds the tree anew.
  void build(std::span<const Box> leaves);
  /// Fits the tree to leaves that have moved, in O(n). It stays right wherever they are, but becomes slow if those that
  /// were near each other are no longer. Another number of leaves builds it anew.
  void refit(std::span<const Box> leaves);

  /// Numbers the leaves in the order in which the tree has them, so that those that are near each other have numbers
  /// that are. Returns their numbers of before.
  [[nodiscard]] std::vector<std::uint32_t> renumber();

  /// The number of leaves.
  [[nodiscard]] std::size_t size() const { return (nodes_.size() + 1) / 2; }
  /// Of all leaves; what is infinite is so far away as the largest number.
  [[nodiscard]] Box bounds() const { return nodes_.empty() ? Box{} : nodes_[0].box; }
  /// How much greater the surface of all inner nodes, which is what a search costs, is now than the least since
  /// `build`.
  [[nodiscard]] double growth() const { return now_ > least_ ? now_ / least_ : 1; }
  /// Whether searches have become so slow that building the tree anew costs less. To build it costs some 1.5 times a
  /// search for all pairs, so that this pays after three searches of half the cost more.
  [[nodiscard]] bool rebuild_pays() const { return growth() > 1.5; }
  /// Bytes of memory.
  [[nodiscard]] std::size_t memory() const { return nodes_.capacity() * sizeof(Node); }

  /// Calls visit(leaf) for all leaves that overlap `box`.
  template <class Visit>
  void for_each_overlap(const Box& box, Visit&& visit) const;
  /// Calls visit(i, j) with i < j for all pairs of leaves that overlap, each once.
  template <class Visit>
  void for_each_pair(Visit&& visit) const;
  /// Two nodes, by their numbers.
  struct NodePair {
    std::uint32_t a = 0, b = 0;
  };
  /// Divides the search for all pairs into at least so many parts, where there are as many, which may be done at once.
  [[nodiscard]] std::vector<NodePair> pair_searches(std::size_t parts) const;
  /// Does one of them: calls visit(i, j) with i < j.
  template <class Visit>
  void for_each_pair_of(NodePair search, Visit&& visit) const;
  /// Calls visit(i, j) for all leaves i of this tree that overlap leaf j of the other, each pair once.
  template <class Visit>
  void for_each_pair_with(const BoundsTree& other, Visit&& visit) const;
  /// Calls visit(leaf, fraction) for all leaves that the box may hit on its way, and the fraction at which it enters
  /// their bounds, to rounding. The visitor returns the fraction up to which the box still moves: less than before to
  /// shorten its way, below 0 to end the search. Of two nodes the one that is entered first is searched first.
  template <class Visit>
  void for_each_on_way(const BoxSweep<Real, Dim>& sweep, Visit&& visit) const;
  /// Calls visit(leaf) for all leaves whose bounds are within a distance of a point, at first `reach`. The visitor
  /// returns the distance up to which the search goes on. Of two nodes the nearer one is searched first.
  template <class Visit>
  void for_each_near(const Vector<Real, Dim>& point, Real reach, Visit&& visit) const;

 private:
  friend class WayTree<Real, Dim>;
  static constexpr std::size_t deepest = 63;
  static constexpr std::uint32_t inner = std::numeric_limits<std::uint32_t>::max();
  /// Two children are neighbours, and after their parent.
  struct Node {
    Box box;
    std::uint32_t children = 0;  // the first of them
    std::uint32_t leaf = inner;  // its number
    [[nodiscard]] bool is_leaf() const { return leaf != inner; }
  };
  // A search that replaces an entry of the stack by k others needs at most k - 1 more of them for each level.
  using NodeStack = std::array<std::uint32_t, deepest + 2>;
  using PairStack = std::array<NodePair, 3 * deepest + 2>;

  [[nodiscard]] static Box finite(Box box);
  [[nodiscard]] static bool meet(const Node& a, const Node& b) { return meet(a.box, b.box); }
  /// Of finite or empty bounds.
  [[nodiscard]] static bool meet(const Box& a, const Box& b) {
    bool is_met = true;  // no branch: it would be unpredictable
    for (std::size_t axis = 0; axis < a.lower.size(); ++axis) {
      const bool begins = a.lower[axis] <= b.upper[axis], ends = b.lower[axis] <= a.upper[axis];
      is_met &= begins & ends;
    }
    return is_met;
  }
  /// Puts the pairs of children of two nodes that meet on the stack.
  static void descend(const std::vector<Node>& first, const std::vector<Node>& second, NodePair pair, PairStack& stack,
                      std::size_t& count);
  /// Puts the pairs of a search of pairs of this tree that follow one on the stack.
  void open(NodePair pair, PairStack& stack, std::size_t& count) const;
  void fit_inner_nodes();

  std::vector<Node> nodes_;
  double now_ = 0, least_ = 0;  // the surface of all inner nodes
};

/// No comparison holds for a NaN.
template <class Real, int Dim>
auto BoundsTree<Real, Dim>::finite(Box box) -> Box {
  constexpr Real most = std::numeric_limits<Real>::max();
  if (is_empty(box)) return {};
  for (std::size_t axis = 0; axis < box.lower.size(); ++axis) {
    if (!(box.lower[axis] >= -most)) box.lower[axis] = -most;
    if (!(box.upper[axis] <= most)) box.upper[axis] = most;
    box.lower[axis] = std::min(box.lower[axis], most);
    box.upper[axis] = std::max(box.upper[axis], -most);
  }
  return box;
}

template <class Real, int Dim>
void BoundsTree<Real, Dim>::build(std::span<const Box> leaves) {
  struct Part {
    std::uint32_t node, first, last, depth;
  };
  nodes_.clear();
  now_ = least_ = 0;
  if (leaves.empty()) return;
  std::vector<BoundedLeaf<Real, Dim>> items(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) items[i] = {finite(leaves[i]), static_cast<std::uint32_t>(i)};
  nodes_.reserve(2 * leaves.size() - 1);
  nodes_.emplace_back();
  std::vector<Part> parts{{0, 0, static_cast<std::uint32_t>(leaves.size()), 0}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    const std::uint32_t count = part.last - part.first;
    if (count == 1) {
      nodes_[part.node] = {items[part.first].bounds, 0, items[part.first].number};
      continue;
    }
    // Below this depth halves suffice, however the bounds lie.
    const bool is_deep = part.depth + static_cast<std::uint32_t>(std::bit_width(count - 1)) >= deepest;
    const auto half = is_deep ? count / 2
                              : static_cast<std::uint32_t>(
                                    SurfaceAreaSplit<Real, Dim>::divide(std::span(items).subspan(part.first, count)));
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[part.node].children = children;
    nodes_.resize(nodes_.size() + 2);
    parts.push_back({children + 1, part.first + half, part.last, part.depth + 1});
    parts.push_back({children, part.first, part.first + half, part.depth + 1});
  }
  fit_inner_nodes();
  least_ = now_;
}

template <class Real, int Dim>
void BoundsTree<Real, Dim>::refit(std::span<const Box> leaves) {
  if (leaves.size() != size()) return build(leaves);
  for (Node& node : nodes_)
    if (node.is_leaf()) node.box = finite(leaves[node.leaf]);
  fit_inner_nodes();
  least_ = std::min(least_, now_);
}

template <class Real, int Dim>
std::vector<std::uint32_t> BoundsTree<Real, Dim>::renumber() {
  std::vector<std::uint32_t> before;
  before.reserve(size());
  for (Node& node : nodes_)
    if (node.is_leaf()) {
      before.push_back(node.leaf);
      node.leaf = static_cast<std::uint32_t>(before.size() - 1);
    }
  return before;
}

/// The surface is that of nodes that are not endless, since these cost the same in any tree.
template <class Real, int Dim>
void BoundsTree<Real, Dim>::fit_inner_nodes() {
  now_ = 0;
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    Node& node = nodes_[k];
    if (node.is_leaf()) continue;
    node.box = united_finite(nodes_[node.children].box, nodes_[node.children + 1].box);
    const double area = static_cast<double>(surface(node.box));
    if (area < static_cast<double>(std::numeric_limits<Real>::max())) now_ += area;
  }
}

template <class Real, int Dim>
template <class Visit>
void BoundsTree<Real, Dim>::for_each_overlap(const Box& box, Visit&& visit) const {
  const Box sought = finite(box);
  if (nodes_.empty() || !meet(nodes_[0].box, sought)) return;
  NodeStack stack;
  std::size_t count = 0;
  stack[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[stack[--count]];
    if (node.is_leaf()) {
      visit(node.leaf);
      continue;
    }
    // Both are written, and counted if they are met.
    stack[count] = node.children + 1;
    count += meet(nodes_[node.children + 1].box, sought);
    stack[count] = node.children;
    count += meet(nodes_[node.children].box, sought);
  }
}

template <class Real, int Dim>
void BoundsTree<Real, Dim>::descend(const std::vector<Node>& first, const std::vector<Node>& second, NodePair pair,
                                    PairStack& stack, std::size_t& count) {
  const Node &a = first[pair.a], &b = second[pair.b];
  const std::uint32_t of_a = a.is_leaf() ? pair.a : a.children, of_b = b.is_leaf() ? pair.b : b.children;
  for (std::uint32_t i = a.is_leaf() ? 1 : 2; i-- > 0;)
    for (std::uint32_t j = b.is_leaf() ? 1 : 2; j-- > 0;) {
      stack[count] = {of_a + i, of_b + j};
      count += meet(first[of_a + i], second[of_b + j]);
    }
}

template <class Real, int Dim>
void BoundsTree<Real, Dim>::open(NodePair pair, PairStack& stack, std::size_t& count) const {
  const Node& a = nodes_[pair.a];
  if (pair.a != pair.b) return descend(nodes_, nodes_, pair, stack, count);
  if (a.is_leaf()) return;
  const std::uint32_t left = a.children, right = left + 1;
  stack[count] = {left, right};
  count += meet(nodes_[left], nodes_[right]);
  stack[count++] = {right, right};
  stack[count++] = {left, left};
}

template <class Real, int Dim>
template <class Visit>
void BoundsTree<Real, Dim>::for_each_pair(Visit&& visit) const {
  if (!nodes_.empty()) for_each_pair_of({0, 0}, visit);
}

template <class Real, int Dim>
auto BoundsTree<Real, Dim>::pair_searches(std::size_t parts) const -> std::vector<NodePair> {
  std::vector<NodePair> searches, opened;
  if (!nodes_.empty()) searches.push_back({0, 0});
  // Level by level, until no pair of a level can be divided.
  for (std::size_t before = 0; searches.size() < parts && !searches.empty() && before != searches.size();) {
    before = searches.size();
    opened.clear();
    for (const NodePair pair : searches) {
      if (pair.a != pair.b && nodes_[pair.a].is_leaf() && nodes_[pair.b].is_leaf()) {
        opened.push_back(pair);
        continue;
      }
      PairStack stack;
      std::size_t count = 0;
      open(pair, stack, count);
      opened.insert(opened.end(), stack.begin(), stack.begin() + static_cast<std::ptrdiff_t>(count));
    }
    searches.swap(opened);
  }
  return searches;
}

template <class Real, int Dim>
template <class Visit>
void BoundsTree<Real, Dim>::for_each_pair_of(NodePair search, Visit&& visit) const {
  PairStack stack;
  std::size_t count = 0;
  stack[count++] = search;
  while (count > 0) {
    const NodePair pair = stack[--count];
    const Node &a = nodes_[pair.a], &b = nodes_[pair.b];
    if (pair.a != pair.b && a.is_leaf() && b.is_leaf())
      visit(std::min(a.leaf, b.leaf), std::max(a.leaf, b.leaf));
    else
      open(pair, stack, count);
  }
}

template <class Real, int Dim>
template <class Visit>
void BoundsTree<Real, Dim>::for_each_pair_with(const BoundsTree& other, Visit&& visit) const {
  if (nodes_.empty() || other.nodes_.empty() || !meet(nodes_[0], other.nodes_[0])) return;
  PairStack stack;
  std::size_t count = 0;
  stack[count++] = {0, 0};
  while (count > 0) {
    const NodePair pair = stack[--count];
    const Node &a = nodes_[pair.a], &b = other.nodes_[pair.b];
    if (a.is_leaf() && b.is_leaf())
      visit(a.leaf, b.leaf);
    else
      descend(nodes_, other.nodes_, pair, stack, count);
  }
}

template <class Real, int Dim>
template <class Visit>
void BoundsTree<Real, Dim>::for_each_on_way(const BoxSweep<Real, Dim>& sweep, Visit&& visit) const {
  struct Entered {
    std::uint32_t node;
    Real fraction;
  };
  const SweepSlabs<Real, Dim> slabs({finite(sweep.begin), sweep.way, sweep.end});
  constexpr Real never = std::numeric_limits<Real>::infinity();
  Real end = sweep.end;
  std::array<Entered, deepest + 2> stack;
  std::size_t count = 0;
  const auto push = [&](const Entered& entered) {
    stack[count] = entered;
    count += entered.fraction < never;
  };
  if (!nodes_.empty() && !is_empty(sweep.begin)) push({0, slabs.entry(nodes_[0].box, end)});
  while (count > 0) {
    const Entered at = stack[--count];
    if (slabs.is_beyond(at.fraction, end)) continue;
    const Node& node = nodes_[at.node];
    if (node.is_leaf()) {
      end = visit(node.leaf, at.fraction);
      if (end < Real(0)) return;
      continue;
    }
    const Entered left{node.children, slabs.entry(nodes_[node.children].box, end)};
    const Entered right{node.children + 1, slabs.entry(nodes_[node.children + 1].box, end)};
    const bool is_left_first = left.fraction <= right.fraction;
    push(is_left_first ? right : left);
    push(is_left_first ? left : right);
  }
}

template <class Real, int Dim>
template <class Visit>
void BoundsTree<Real, Dim>::for_each_near(const Vector<Real, Dim>& point, Real reach, Visit&& visit) const {
  struct Near {
    std::uint32_t node;
    Real distance;
  };
  // To rounding: what may be as near is searched.
  const auto is_beyond = [&](const Real& distance) {
    return distance > reach + (8 * std::numeric_limits<Real>::epsilon() * reach + std::numeric_limits<Real>::min());
  };
  const auto near = [&](std::uint32_t node) -> Near { return {node, distance(point, nodes_[node].box)}; };
  std::array<Near, deepest + 2> stack;
  std::size_t count = 0;
  if (!nodes_.empty() && !is_empty(nodes_[0].box)) stack[count++] = near(0);
  while (count > 0) {
    const Near at = stack[--count];
    if (is_beyond(at.distance)) continue;
    const Node& node = nodes_[at.node];
    if (node.is_leaf()) {
      if (!is_empty(node.box)) reach = visit(node.leaf);
      continue;
    }
    const Near left = near(node.children), right = near(node.children + 1);
    const bool is_left_first = left.distance <= right.distance;
    stack[count++] = is_left_first ? right : left;
    stack[count++] = is_left_first ? left : right;
  }
}

}  // namespace continuo
