// The order conditions of methods for q'' = a(t, q), all of them up to an order, by the trees of E. Hairer, S. P.
// Norsett, G. Wanner, "Solving Ordinary Differential Equations I", II.14.
//
// A tree is an acceleration with a multiset of branches, each a derivative of a with respect to q: either q' (a leaf:
// c_i at stage i, theta along the exact solution) or another acceleration (sum_j a_ij phi_j, or its double integral).
// Time is a position whose velocity is 1, so a(t, q) needs no further trees. Along the exact solution a tree of degree
// n is exact * theta^n; so the weights of velocity must give exact / (n+1), those of position exact / ((n+1)(n+2)).
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace continuo {

template <class Real>
struct NystromTree {
  std::vector<Real> phi;  // by stage
  Real exact = 1;
};

/// The numbers of a method in the scalar the conditions are checked in.
template <class Real>
struct NystromNumbers {
  std::vector<Real> c;
  std::vector<std::vector<Real>> a;  // a[i] as long as there are stages
  std::vector<Real> b, bv;
};

/// The trees of each degree up to `highest`.
template <class Real>
std::vector<std::vector<NystromTree<Real>>> nystrom_trees(const NystromNumbers<Real>& method, std::size_t highest) {
  const std::size_t stages = method.c.size();
  struct Branch {
    std::size_t degree;
    NystromTree<Real> tree;
  };
  std::vector<Branch> branches{{1, {method.c, Real(1)}}};
  std::vector<std::vector<NystromTree<Real>>> trees(highest + 1);
  for (std::size_t n = 0; n <= highest; ++n) {
    for (std::size_t k = 0; n >= 2 && k < trees[n - 2].size(); ++k) {
      const NystromTree<Real>& inner = trees[n - 2][k];
      Branch branch{n, {std::vector<Real>(stages, Real(0)), inner.exact / Real((n - 1) * n)}};
      for (std::size_t i = 0; i < stages; ++i)
        for (std::size_t j = 0; j < stages; ++j) branch.tree.phi[i] += method.a[i][j] * inner.phi[j];
      branches.push_back(branch);
    }
    const auto grow = [&](const auto& self, std::size_t first, std::size_t left,
                          const NystromTree<Real>& tree) -> void {
      if (left == 0) trees[n].push_back(tree);
      for (std::size_t k = first; k < branches.size() && left > 0; ++k) {
        if (branches[k].degree > left) continue;
        NystromTree<Real> grown = tree;
        for (std::size_t i = 0; i < stages; ++i) grown.phi[i] *= branches[k].tree.phi[i];
        grown.exact *= branches[k].tree.exact;
        self(self, k, left - branches[k].degree, grown);
      }
    };
    grow(grow, 0, n, {std::vector<Real>(stages, Real(1)), Real(1)});
  }
  return trees;
}

/// The greatest deviation of the position weights from their conditions at theta, for errors up to h^order.
template <class Real>
Real position_defect(const std::vector<std::vector<NystromTree<Real>>>& trees, const std::vector<Real>& weights,
                     std::size_t order, const Real& theta = Real(1)) {
  using std::abs, std::max;
  Real worst(0), power = theta * theta;
  for (std::size_t n = 0; n + 2 <= order; ++n, power *= theta) {
    for (const NystromTree<Real>& tree : trees[n]) {
      Real sum = -tree.exact * power / Real((n + 1) * (n + 2));
      for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * tree.phi[i];
      worst = max<Real>(worst, abs(sum));
    }
  }
  return worst;
}
template <class Real>
Real velocity_defect(const std::vector<std::vector<NystromTree<Real>>>& trees, const std::vector<Real>& weights,
                     std::size_t order, const Real& theta = Real(1)) {
  using std::abs, std::max;
  Real worst(0), power = theta;
  for (std::size_t n = 0; n + 1 <= order; ++n, power *= theta) {
    for (const NystromTree<Real>& tree : trees[n]) {
      Real sum = -tree.exact * power / Real(n + 1);
      for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * tree.phi[i];
      worst = max<Real>(worst, abs(sum));
    }
  }
  return worst;
}

}  // namespace continuo
