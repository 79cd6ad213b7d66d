// tests/methods/rooted_trees.hpp
// Order conditions by program: a Runge-Kutta method has order p where for every rooted tree of at most p nodes
// sum_i b_i phi_i(tree) = 1 / gamma(tree) (Hairer, Norsett, Wanner, "Solving Ordinary Differential Equations I", II.2,
// theorem 2.13). There are 1, 1, 2, 4, 9, 20, 48, 115, 286, 719 trees of 1 to 10 nodes (ibid., table 2.1).
#pragma once
#include <cstddef>
#include <vector>

namespace continuo::testing {

struct RootedTree {
  std::vector<std::size_t> branches;  // trees hanging from the root, by index in the forest, none larger than the last
  int nodes = 1;
  double density = 1;  // gamma: nodes times the densities of the branches; an integer
};

/// All rooted trees of at most `nodes` nodes, smaller ones first.
inline std::vector<RootedTree> rooted_trees(int nodes) {
  std::vector<RootedTree> forest;
  std::vector<std::size_t> end_of_size{0};  // end_of_size[n]: how many have at most n nodes
  for (int size = 1; size <= nodes; ++size) {
    const auto grow = [&](auto&& self, RootedTree tree, std::size_t next) -> void {
      if (tree.nodes == size) {
        tree.density *= size;
        forest.push_back(tree);
        return;
      }
      for (std::size_t i = next; i < end_of_size.back() && forest[i].nodes <= size - tree.nodes; ++i) {
        RootedTree larger = tree;
        larger.branches.push_back(i);
        larger.nodes += forest[i].nodes;
        larger.density *= forest[i].density;
        self(self, larger, i);
      }
    };
    grow(grow, RootedTree{}, 0);
    end_of_size.push_back(forest.size());
  }
  return forest;
}

/// phi_i(tree) for every tree of the forest and stage i of the matrix a: the product over the branches of
/// sum_j a_ij phi_j(branch).
template <class Real>
std::vector<std::vector<Real>> elementary_weights(const std::vector<RootedTree>& forest,
                                                  const std::vector<std::vector<Real>>& a) {
  const std::size_t stages = a.size();
  std::vector<std::vector<Real>> weights, through_a;  // phi, and a phi
  for (const RootedTree& tree : forest) {
    std::vector<Real> phi(stages, Real(1));
    for (std::size_t branch : tree.branches) {
      for (std::size_t i = 0; i < stages; ++i) phi[i] *= through_a[branch][i];
    }
    std::vector<Real> next(stages, Real(0));
    for (std::size_t i = 0; i < stages; ++i) {
      for (std::size_t j = 0; j < stages; ++j) next[i] += a[i][j] * phi[j];
    }
    weights.push_back(phi);
    through_a.push_back(next);
  }
  return weights;
}

}  // namespace continuo::testing
