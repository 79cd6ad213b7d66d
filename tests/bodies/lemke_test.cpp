// Pivots find solutions of linear complementarity problems where brute force over all bases does.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_rigid/lemke.hpp>

namespace continuo::lemke_test {
namespace {

/// M column by column.
struct LinearComplementarity {
  std::vector<double> m, q;
  [[nodiscard]] std::size_t size() const { return q.size(); }
  [[nodiscard]] double& at(std::size_t i, std::size_t j) { return m[j * size() + i]; }
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return m[j * size() + i]; }
};

/// How far z is from a solution: the most of what z and w lack to 0, and of the less of each z and its w.
[[nodiscard]] double lack(const LinearComplementarity& of, const std::vector<double>& z) {
  double most = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    double w = of.q[i];
    for (std::size_t j = 0; j < of.size(); ++j) w += of.at(i, j) * z[j];
    most = std::max({most, std::abs(std::min(z[i], w))});
  }
  return most;
}
[[nodiscard]] std::optional<std::vector<double>> pivots(const LinearComplementarity& of) {
  return Lemke<double>(of.m, of.q, std::vector<double>(of.size(), 1)).solve();
}

/// Elimination with complete pivoting; nothing of a singular matrix, row by row with the constants last.
[[nodiscard]] std::optional<std::vector<double>> eliminated(std::vector<std::vector<double>> rows) {
  const std::size_t n = rows.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::abs(rows[i][k]) > std::abs(rows[best][k])) best = i;
    if (std::abs(rows[best][k]) < 1e-10) return {};
    std::swap(rows[k], rows[best]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j <= n; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  std::vector<double> x;
  for (std::size_t k = 0; k < n; ++k) x.push_back(rows[k][n] / rows[k][k]);
  return x;
}
/// All solutions with a regular basis, of which there is one wherever there is any solution.
[[nodiscard]] std::vector<std::vector<double>> brute_force(const LinearComplementarity& of) {
  const std::size_t n = of.size();
  std::vector<std::vector<double>> found;
  for (unsigned acts = 0; acts < 1u << n; ++acts) {
    std::vector<std::size_t> set;
    for (std::size_t i = 0; i < n; ++i)
      if ((acts >> i & 1u) != 0) set.push_back(i);
    std::vector<std::vector<double>> rows;
    for (const std::size_t i : set) {
      rows.emplace_back();
      for (const std::size_t j : set) rows.back().push_back(of.at(i, j));
      rows.back().push_back(-of.q[i]);
    }
    const auto part = eliminated(std::move(rows));
    if (!part) continue;
    std::vector<double> z(n);
    for (std::size_t k = 0; k < set.size(); ++k) z[set[k]] = (*part)[k];
    if (lack(of, z) < 1e-9) found.push_back(std::move(z));
  }
  return found;
}

class RandomProblems {
 public:
  explicit RandomProblems(unsigned seed) : engine_(seed) {}
  [[nodiscard]] double number(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  [[nodiscard]] std::size_t size(std::size_t least, std::size_t most) { return least + engine_() % (most + 1 - least); }
  [[nodiscard]] LinearComplementarity any(std::size_t n) {
    LinearComplementarity made{std::vector<double>(n * n), std::vector<double>(n)};
    for (double& entry : made.m) entry = number(-1, 1);
    for (double& entry : made.q) entry = number(-1, 1);
    return made;
  }
  /// B B^T + a skew part, with B of n x rank.
  [[nodiscard]] LinearComplementarity monotone(std::size_t n, std::size_t rank, double skew) {
    LinearComplementarity made = any(n);
    const LinearComplementarity b = any(std::max(n, rank));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < rank; ++k) sum += b.at(i, k) * b.at(j, k);
        const double turned = i == j ? 0 : skew * number(-1, 1);
        made.at(i, j) = sum + turned, made.at(j, i) = sum - turned;
      }
    return made;
  }

 private:
  std::mt19937 engine_;
};

TEST(Lemke, PMatricesHaveTheOneSolutionOfBruteForce) {
  RandomProblems random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t n = random.size(1, 8);
    LinearComplementarity problem = random.monotone(n, n, 1);
    for (std::size_t i = 0; i < n; ++i) problem.at(i, i) += 0.1;  // positive definite, so a P-matrix
    const auto all = brute_force(problem);
    ASSERT_EQ(all.size(), 1u) << trial;
    const auto z = pivots(problem);
    ASSERT_TRUE(z) << trial;
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR((*z)[i], all[0][i], 1e-8) << trial;
  }
}

/// Semidefinite with a skew part, many of them with equal rows as of two contacts at one place: M is copositive plus,
/// so that pivots find a solution wherever there is one, and end on a ray only where there is none.
TEST(Lemke, SingularMonotoneProblemsEndWithASolutionOrWithNoneAsBruteForceDoes) {
  RandomProblems random(2);
  int solved = 0, infeasible = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const std::size_t n = random.size(2, 8);
    LinearComplementarity problem = random.monotone(n, random.size(1, n - 1), trial % 2 == 0 ? 0 : 0.5);
    if (trial % 3 == 0) {
      for (std::size_t k = 0; k < n; ++k) problem.at(n - 1, k) = problem.at(0, k);
      for (std::size_t k = 0; k < n; ++k) problem.at(k, n - 1) = problem.at(k, 0);
      problem.q[n - 1] = problem.q[0];
    }
    const bool exists = !brute_force(problem).empty();
    const auto z = pivots(problem);
    ASSERT_EQ(z.has_value(), exists) << trial;
    if (z) {
      EXPECT_LT(lack(problem, *z), 1e-8) << trial;
    }
    ++(exists ? solved : infeasible);
  }
  EXPECT_GT(solved, 100);
  EXPECT_GT(infeasible, 100);
}

/// Copositive but not monotone: entries at least 0, above 0 on the diagonal. There is a solution for every q.
TEST(Lemke, StrictlyCopositiveProblemsAreSolved) {
  RandomProblems random(3);
  for (int trial = 0; trial < 400; ++trial) {
    LinearComplementarity problem = random.any(random.size(1, 8));
    for (double& entry : problem.m) entry = std::abs(entry);
    for (std::size_t i = 0; i < problem.size(); ++i) problem.at(i, i) += 0.1;
    const auto z = pivots(problem);
    ASSERT_TRUE(z) << trial;
    EXPECT_LT(lack(problem, *z), 1e-8) << trial;
    EXPECT_FALSE(brute_force(problem).empty()) << trial;
  }
}

/// Of matrices of any kind a ray says nothing, but what is found is a solution, and none is where there is none.
TEST(Lemke, WhatIsFoundOfAnyMatrixIsASolution) {
  RandomProblems random(4);
  int found = 0, without = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const LinearComplementarity problem = random.any(random.size(1, 8));
    const auto z = pivots(problem);
    const bool exists = !brute_force(problem).empty();
    without += exists ? 0 : 1;
    if (!z) continue;
    ++found;
    EXPECT_TRUE(exists) << trial;
    EXPECT_LT(lack(problem, *z), 1e-7) << trial;
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(without, 100);
}

/// A block on two points with friction that sticks, all constants equal or 0: every step is degenerate.
TEST(Lemke, DegeneratePivotsEnd) {
  for (const double push : {0.0, 0.25, 0.5, 1.0}) {
    // Two normal forces, the two forces across, and the slip, of mass 1 and friction 0.5, without rotation.
    LinearComplementarity problem{std::vector<double>(25), {-1, -1, push, -push, 0}};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        problem.at(i, j) = 1;
        problem.at(2 + i, 2 + j) = i == j ? 1 : -1;
        problem.at(4, i) = 0.5, problem.at(2 + i, 4) = 1, problem.at(4, 2 + i) = -1;
      }
    const auto z = pivots(problem);
    ASSERT_TRUE(z) << push;
    EXPECT_LT(lack(problem, *z), 1e-14) << push;
    EXPECT_NEAR((*z)[0] + (*z)[1], 1, 1e-14);
    EXPECT_NEAR((*z)[3] - (*z)[2], std::min(push, 0.5), 1e-14);
    EXPECT_NEAR((*z)[4], std::max(push - 0.5, 0.0), 1e-14);
  }
}

}  // namespace
}  // namespace continuo::lemke_test
