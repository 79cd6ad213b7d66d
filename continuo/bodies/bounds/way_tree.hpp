// A tree of bounds whose nodes have four children, for what moves on straight ways: the slabs of four bounds are
// compared in the lanes of registers (I. Wald, C. Benthin, S. Boulos, "Getting rid of packets", IEEE Symp. Interactive
// Ray Tracing (2008) 49-57).
//
//   const WayTree<float, 3> tree(BoundsTree<float, 3>(bounds));
//   tree.for_each_on_way(ray, [&](std::uint32_t leaf, float) { return ...; });
//
// It is a binary tree of which every other level is left out. It visits the leaves that the binary tree visits.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/bodies/bounds/bounds.hpp>
#include <continuo/bodies/bounds/bounds_tree.hpp>
#include <continuo/bodies/bounds/sweep.hpp>

namespace continuo {

/// A tree of bounds for ways. A search changes nothing, so that many threads may search at once.
template <class Real, int Dim>
class WayTree {
 public:
  /// Of nothing.
  WayTree() = default;
  /// Of the leaves of a binary tree. O(leaves).
  explicit WayTree(const BoundsTree<Real, Dim>& tree);

  /// Bytes of memory.
  [[nodiscard]] std::size_t memory() const { return nodes_.capacity() * sizeof(Node); }

  /// As that of BoundsTree. Of the children of a node the one that is entered first is searched first.
  template <class Visit>
  void for_each_on_way(const BoxSweep<Real, Dim>& sweep, Visit&& visit) const;

 private:
  using Binary = BoundsTree<Real, Dim>;
  using Node = SweptNode<Real, Dim>;
  static constexpr std::uint32_t leaf_bit = std::uint32_t{1} << 31;  // of a child that is a leaf
  struct Entered {
    std::uint32_t child;
    Real fraction;
  };
  // A search that replaces an entry of the stack by four others needs at most three more for each level.
  using Stack = std::array<Entered, (Node::lanes - 1) * Binary::deepest + Node::lanes>;

  /// The nodes of the binary tree that become children of one node.
  [[nodiscard]] static std::vector<std::uint32_t> children_of(const Binary& tree, std::uint32_t root);
  /// Puts the children that are entered on the stack, the first of them on top.
  static void push(const Node& node, const std::array<Real, Node::lanes>& entry, Stack& stack, std::size_t& count);

  std::vector<Node> nodes_;
};

/// Of the children found so far the inner one with the greatest surface, which is entered most often, is replaced by
/// its own two.
template <class Real, int Dim>
std::vector<std::uint32_t> WayTree<Real, Dim>::children_of(const Binary& tree, std::uint32_t root) {
  std::vector<std::uint32_t> children{root};
  while (children.size() < Node::lanes) {
    constexpr std::size_t none = Node::lanes;
    std::size_t largest = none;
    Real most(-1);
    for (std::size_t k = 0; k < children.size(); ++k) {
      const auto& node = tree.nodes_[children[k]];
      if (node.is_leaf()) continue;
      const Real size = surface(node.box);
      if (largest == none || size > most) largest = k, most = size;
    }
    if (largest == none) break;
    const std::uint32_t first = tree.nodes_[children[largest]].children;
    children[largest] = first;
    children.push_back(first + 1);
  }
  return children;
}

template <class Real, int Dim>
WayTree<Real, Dim>::WayTree(const BoundsTree<Real, Dim>& tree) {
  if (tree.nodes_.empty()) return;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> left{{0, 0}};  // nodes of the binary tree, and what they become
  nodes_.reserve(tree.nodes_.size() / 4 + 1);
  nodes_.emplace_back();
  while (!left.empty()) {
    const auto [root, at] = left.back();
    left.pop_back();
    const auto children = children_of(tree, root);
    for (std::size_t k = children.size(); k-- > 0;) {
      const auto& node = tree.nodes_[children[k]];
      nodes_[at].set(k, node.box);
      nodes_[at].children[k] = node.is_leaf() ? node.leaf | leaf_bit : static_cast<std::uint32_t>(nodes_.size());
      if (node.is_leaf()) continue;
      left.emplace_back(children[k], nodes_[at].children[k]);
      nodes_.emplace_back();
    }
  }
}

template <class Real, int Dim>
void WayTree<Real, Dim>::push(const Node& node, const std::array<Real, Node::lanes>& entry, Stack& stack,
                              std::size_t& count) {
  const std::size_t first = count;
  for (std::size_t k = Node::lanes; k-- > 0;) {  // no branch: it would be unpredictable
    stack[count] = {node.children[k], entry[k]};
    // The root is no child: that is where there is none, which a sweep that is not finite would enter.
    count += entry[k] < std::numeric_limits<Real>::infinity() && node.children[k] != 0;
  }
  for (std::size_t k = first + 1; k < count; ++k)
    for (std::size_t i = k; i > first && stack[i - 1].fraction < stack[i].fraction; --i)
      std::swap(stack[i - 1], stack[i]);
}

template <class Real, int Dim>
template <class Visit>
void WayTree<Real, Dim>::for_each_on_way(const BoxSweep<Real, Dim>& sweep, Visit&& visit) const {
  if (nodes_.empty() || is_empty(sweep.begin)) return;
  const SweepSlabs<Real, Dim> slabs(sweep);
  Real end = sweep.end;
  Stack stack;
  std::size_t count = 0;
  stack[count++] = {0, Real(0)};
  while (count > 0) {
    const Entered at = stack[--count];
    if (slabs.is_beyond(at.fraction, end)) continue;
    if ((at.child & leaf_bit) != 0) {
      end = visit(at.child & ~leaf_bit, at.fraction);
      if (end < Real(0)) return;
      continue;
    }
    const Node& node = nodes_[at.child];
    push(node, slabs.entries(node, end), stack, count);
  }
}

}  // namespace continuo
