// The tree of bounds: its answers against a search through all of them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "random_bounds.hpp"
#include <continuo/bodies/bounds/bounds_tree.hpp>

namespace continuo::bounds_test {
namespace {

template <class Real, int Dim>
void expect_right(const BoundsTree<Real, Dim>& tree, const std::vector<Bounds<Real, Dim>>& set,
                  const Bounds<Real, Dim>& sought) {
  Pairs expected, found, found_in_parts;
  std::vector<std::uint32_t> expected_leaves, found_leaves;
  for (std::uint32_t i = 0; i < set.size(); ++i) {
    for (std::uint32_t j = i + 1; j < set.size(); ++j)
      if (overlap(set[i], set[j])) expected.emplace_back(i, j);
    if (overlap(set[i], sought)) expected_leaves.push_back(i);
  }
  tree.for_each_pair([&](std::uint32_t i, std::uint32_t j) { found.emplace_back(i, j); });
  tree.for_each_overlap(sought, [&](std::uint32_t i) { found_leaves.push_back(i); });
  for (const auto search : tree.pair_searches(9))
    tree.for_each_pair_of(search, [&](std::uint32_t i, std::uint32_t j) { found_in_parts.emplace_back(i, j); });
  std::ranges::sort(found);
  std::ranges::sort(found_in_parts);
  std::ranges::sort(found_leaves);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found_in_parts, expected);
  EXPECT_EQ(found_leaves, expected_leaves);
}
template <class Real, int Dim>
void expect_right_with(const BoundsTree<Real, Dim>& a, const std::vector<Bounds<Real, Dim>>& of_a,
                       const BoundsTree<Real, Dim>& b, const std::vector<Bounds<Real, Dim>>& of_b) {
  Pairs expected, found;
  for (std::uint32_t i = 0; i < of_a.size(); ++i)
    for (std::uint32_t j = 0; j < of_b.size(); ++j)
      if (overlap(of_a[i], of_b[j])) expected.emplace_back(i, j);
  a.for_each_pair_with(b, [&](std::uint32_t i, std::uint32_t j) { found.emplace_back(i, j); });
  std::ranges::sort(found);
  EXPECT_EQ(found, expected);
}

template <class Real, int Dim>
void overlaps_are_all_found() {
  std::mt19937 engine(17);
  for (const Kind kind : kinds)
    for (const std::size_t count : {0u, 1u, 2u, 3u, 70u}) {
      SCOPED_TRACE(testing::Message() << Dim << "D, kind " << static_cast<int>(kind) << ", " << count);
      auto set = random_set<Real, Dim>(engine, kind, count);
      const auto other = random_set<Real, Dim>(engine, kinds[engine() % 7], 20);
      BoundsTree<Real, Dim> tree(set);
      EXPECT_EQ(tree.size(), count);
      expect_right(tree, set, random_bounds<Real, Dim>(engine, kinds[engine() % 7]));
      expect_right_with(tree, set, BoundsTree<Real, Dim>(other), other);
      // What was empty may be so no longer, and the reverse.
      set = random_set<Real, Dim>(engine, kinds[engine() % 7], count);
      tree.refit(set);
      expect_right(tree, set, random_bounds<Real, Dim>(engine, Kind::uniform));
      expect_right_with(tree, set, BoundsTree<Real, Dim>(other), other);
    }
}
TEST(BoundsTree, OverlapsAreAllFound) {
  overlaps_are_all_found<float, 2>();
  overlaps_are_all_found<float, 3>();
  overlaps_are_all_found<double, 2>();
  overlaps_are_all_found<double, 3>();
}

/// The fraction at which a sweep enters bounds that are grown by `margin`, in a wider format; infinity where it never
/// does.
template <class Real, int Dim>
long double entry_of(const BoxSweep<Real, Dim>& sweep, const Bounds<Real, Dim>& box, long double margin) {
  long double from = 0, to = static_cast<long double>(sweep.end);
  if (is_empty(box)) return infinity<long double>;
  for (std::size_t axis = 0; axis < sweep.way.size(); ++axis) {
    const long double lower = static_cast<long double>(box.lower[axis]) - sweep.begin.upper[axis] - margin;
    const long double upper = static_cast<long double>(box.upper[axis]) - sweep.begin.lower[axis] + margin;
    const long double way = sweep.way[axis];
    if (way == 0 && (lower > 0 || upper < 0)) return infinity<long double>;
    if (way == 0) continue;
    from = std::max(from, std::min(lower / way, upper / way));
    to = std::min(to, std::max(lower / way, upper / way));
  }
  return from <= to ? from : infinity<long double>;
}

template <class Real, int Dim>
BoxSweep<Real, Dim> random_sweep(std::mt19937& engine) {
  std::uniform_real_distribution<Real> uniform(-2, 2);
  BoxSweep<Real, Dim> sweep;
  Vector<Real, Dim> x;
  for (std::size_t axis = 0; axis < x.size(); ++axis) {
    x[axis] = uniform(engine);
    sweep.way[axis] = engine() % 4 == 0 ? Real(0) : uniform(engine);
  }
  sweep.begin = around(x, engine() % 2 == 0 ? Real(0) : Real(0.2));
  if (engine() % 3 == 0) sweep.end = infinity<Real>;
  return sweep;
}

/// The bounds of a case are at most 3 in size, or endless, and the ways at most 4 long, so that the margin is some
/// hundreds of roundings.
template <class Real, int Dim>
void ways_meet_what_they_should() {
  std::mt19937 engine(5);
  const long double margin = 1e3L * std::numeric_limits<Real>::epsilon();
  std::size_t hits = 0;
  for (int k = 0; k < 150; ++k) {
    const Kind kind = k % 2 == 0 ? Kind::uniform : k % 4 == 1 ? Kind::six_decades : Kind::empty;
    const auto set = random_set<Real, Dim>(engine, kind, 30);
    const BoundsTree<Real, Dim> tree(set);
    const BoxSweep<Real, Dim> sweep = random_sweep<Real, Dim>(engine);
    std::vector<int> visits(set.size(), 0);
    tree.for_each_on_way(sweep, [&](std::uint32_t leaf, Real fraction) {
      ++visits[leaf];
      EXPECT_LE(entry_of(sweep, set[leaf], margin), fraction);
      return sweep.end;
    });
    long double nearest = infinity<long double>, first = infinity<long double>;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const long double exact = entry_of(sweep, set[i], 0);
      nearest = std::min(nearest, exact);
      EXPECT_GE(visits[i], exact < infinity<long double> ? 1 : 0);
      EXPECT_LE(visits[i], entry_of(sweep, set[i], margin) < infinity<long double> ? 1 : 0);
    }
    // A visitor that shortens the way to its hit ends with the nearest one.
    Real end = sweep.end;
    tree.for_each_on_way(sweep, [&](std::uint32_t leaf, Real) {
      const long double exact = entry_of(sweep, set[leaf], 0);
      first = std::min(first, exact);
      if (exact < infinity<long double>) end = std::min(end, static_cast<Real>(exact));
      return end;
    });
    EXPECT_EQ(first, nearest);
    hits += nearest < infinity<long double>;
  }
  EXPECT_GT(hits, 15u);
}
TEST(BoundsTree, WaysMeetWhatTheyShould) {
  ways_meet_what_they_should<float, 2>();
  ways_meet_what_they_should<float, 3>();
  ways_meet_what_they_should<double, 2>();
  ways_meet_what_they_should<double, 3>();
}

TEST(BoundsTree, AWayThatNobodyKnowsMeetsAll) {
  std::mt19937 engine(3);
  const auto set = random_set<float, 3>(engine, Kind::uniform, 50);
  const BoundsTree<float, 3> tree(set);
  const auto met = [&](const BoxSweep<float, 3>& sweep) {
    std::size_t count = 0;
    tree.for_each_on_way(sweep, [&](std::uint32_t, float) {
      ++count;
      return sweep.end;
    });
    return count;
  };
  const Bounds<float, 3> here = around<float, 3>({}, 0.01f), anywhere{{{nan<float>, 0, 0}}, {{nan<float>, 9, 9}}};
  EXPECT_EQ(met({here, {{nan<float>, nan<float>, nan<float>}}}), set.size());
  EXPECT_EQ(met({anywhere, {{0, nan<float>, nan<float>}}}), set.size());
  // 1 / 1e-40 overflows, but 1e38 times this way leads out of the set.
  EXPECT_GT(met({.begin = here, .way = {{1e-40f, 0, 0}}, .end = infinity<float>}), met({here, {}}));
  EXPECT_EQ(met({{}, {{1, 0, 0}}, infinity<float>}), 0u);  // nothing meets nothing
}

TEST(BoundsTree, ASearchEndsWhereTheVisitorSaysSo) {
  const std::vector<Bounds<double, 2>> row{{{{3, 0}}, {{4, 1}}}, {{{1, 0}}, {{2, 1}}}, {{{5, 0}}, {{6, 1}}}};
  std::vector<std::uint32_t> met;
  BoundsTree<double, 2>(row).for_each_on_way({.begin = {{{0, 0.5}}, {{0, 0.5}}}, .way = {{10, 0}}},
                                             [&](std::uint32_t leaf, double fraction) {
                                               EXPECT_DOUBLE_EQ(fraction, row[leaf].lower[0] / 10);
                                               met.push_back(leaf);
                                               return met.size() == 2 ? -1.0 : 1.0;
                                             });
  EXPECT_EQ(met, (std::vector<std::uint32_t>{1, 0}));
}

/// Powers of two make one leaf go to a side of its own at each plane, as many as the format has.
TEST(BoundsTree, NoSetIsTooDeep) {
  std::vector<Bounds<double, 2>> powers, same(20000, around<double, 2>({{3, 4}}, 1));
  for (int k = -1000; k < 1000; ++k) powers.push_back(around<double, 2>({{std::ldexp(1.0, k), 0}}, 0));
  std::size_t found = 0;
  const auto count = [&](auto...) { ++found; };
  BoundsTree<double, 2>(powers).for_each_pair(count);
  EXPECT_EQ(found, 0u);
  BoundsTree<double, 2>(powers).for_each_overlap({{{0, 0}}, {{1, 0}}}, count);
  EXPECT_EQ(found, 1001u);
  found = 0;
  BoundsTree<double, 2>(same).for_each_overlap(same[0], count);
  EXPECT_EQ(found, same.size());
  found = 0;
  same.resize(300);
  BoundsTree<double, 2>(same).for_each_pair(count);
  EXPECT_EQ(found, 300u * 299 / 2);
  EXPECT_GE((BoundsTree<double, 2>(same).pair_searches(50).size()), 50u);
}

TEST(BoundsTree, AnotherTreePaysWhereNeighboursHaveParted) {
  std::mt19937 engine(9);
  auto set = random_set<double, 3>(engine, Kind::uniform, 300);
  BoundsTree<double, 3> tree(set);
  EXPECT_EQ(tree.growth(), 1);
  for (auto& box : set) box = grown(box, 1e-3);
  tree.refit(set);
  EXPECT_GT(tree.growth(), 1);
  EXPECT_FALSE(tree.rebuild_pays());
  std::ranges::reverse(set);
  tree.refit(set);
  EXPECT_TRUE(tree.rebuild_pays());
  tree.build(set);
  EXPECT_FALSE(tree.rebuild_pays());
  // From a single point any way out is infinitely far.
  std::vector<Bounds<double, 3>> point(10);
  for (auto& box : point) box = around<double, 3>({}, 0);
  tree.build(point);
  EXPECT_FALSE(tree.rebuild_pays());
  tree.refit(std::span(set).first(10));
  EXPECT_TRUE(tree.rebuild_pays());
}

/// The hash was computed once; it must not depend on compiler or library.
TEST(BoundsTree, TheOrderOfVisitsDependsOnTheBoundsAlone) {
  std::uint32_t state = 1;
  const auto next = [&] { return static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) / (1u << 24); };
  std::vector<Bounds<float, 3>> set(200);
  for (auto& box : set) {
    Vector<float, 3> x;
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] = next();
    box = around(x, 0.1f * next());
  }
  std::uint64_t hash = 14695981039346656037u;
  BoundsTree<float, 3>(set).for_each_pair([&](std::uint32_t i, std::uint32_t j) {
    for (const std::uint32_t number : {i, j}) hash = (hash ^ number) * 1099511628211u;
  });
  EXPECT_EQ(hash, 7304276204724202757u);
}

TEST(Bounds, NothingIsLostByANumberThatIsNone) {
  using Box = Bounds<double, 2>;
  const Box unknown{{{nan<double>, 0}}, {{1, 1}}}, near{{{5, 1}}, {{6, 2}}}, right{{{-7, 0}}, {{-6, 1}}}, empty;
  EXPECT_FALSE(overlap(unknown, near));  // its upper bound is known
  EXPECT_TRUE(overlap(unknown, right));
  for (const Box& both : {united(unknown, right), united(right, unknown)}) {
    EXPECT_TRUE(std::isnan(both.lower[0]));
    EXPECT_EQ(both.upper, (Vector<double, 2>{{1, 1}}));
  }
  EXPECT_TRUE(is_empty(empty));
  EXPECT_TRUE(is_empty(grown(empty, 5.0)));
  EXPECT_FALSE(overlap(empty, Box{{{-infinity<double>, -1}}, {{infinity<double>, 1}}}));
  EXPECT_EQ(united(empty, near), near);
  EXPECT_EQ(united(near, empty), near);
  EXPECT_EQ(united(near, right), (Box{{{-7, 0}}, {{6, 2}}}));
}
TEST(Bounds, AreMeasured) {
  const Bounds<double, 2> flat{{{0, 0}}, {{2, 3}}};
  const Bounds<double, 3> brick{{{0, 0, 0}}, {{1, 2, 3}}};
  EXPECT_EQ(surface(flat), 5);
  EXPECT_EQ(surface(brick), 11);
  EXPECT_EQ(surface(Bounds<double, 3>{}), 0);
  EXPECT_EQ(grown(flat, 1.0), (Bounds<double, 2>{{{-1, -1}}, {{3, 4}}}));
  EXPECT_TRUE(overlap(flat, Bounds<double, 2>{{{2, 3}}, {{4, 4}}}));  // at a corner
}

}  // namespace
}  // namespace continuo::bounds_test
