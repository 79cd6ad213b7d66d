// Zero lines and filled areas of functions whose areas are known.
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include <continuo/studies/accuracy/contour.hpp>

namespace continuo::studies::contour_test {
namespace {

constexpr std::size_t points = 201;

/// On the square from (-2, -2) to (2, 2).
Grid grid_of(const std::function<double(double, double)>& f) {
  Grid grid{.columns = points, .rows = points, .left = -2, .bottom = -2, .width = 0.02, .height = 0.02};
  for (std::size_t j = 0; j < points; ++j)
    for (std::size_t i = 0; i < points; ++i) grid.values.push_back(f(grid.x(i), grid.y(j)));
  return grid;
}

double area_inside(const Polyline& path) {
  double sum = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto [x, y] = path[i];
    const auto [x2, y2] = path[(i + 1) % path.size()];
    sum += x * y2 - x2 * y;
  }
  return sum / 2;
}

// The polygon through points of a circle at distances up to d = 0.03 (a cell's diagonal) has an area less by a part of
// (d/r)^2/12 at most; linear interpolation of r^2 adds as much.
constexpr double error = 1e-3;

TEST(Contour, ADiscIsWoundRoundOnce) {
  const auto path = path_round_negative(grid_of([](double x, double y) { return x * x + y * y - 1; }));
  EXPECT_NEAR(area_inside(path), std::numbers::pi, error);
}

TEST(Contour, TheOutsideOfADiscReachesTheBorder) {
  const auto path = path_round_negative(grid_of([](double x, double y) { return 1 - x * x - y * y; }));
  EXPECT_NEAR(area_inside(path), 16 - std::numbers::pi, error);
}

TEST(Contour, ARingHasAHoleAndTheHoleAnIsland) {  // 0.5 < r < 1.5, and r < 0.25
  const auto path = path_round_negative(grid_of([](double x, double y) {
    const double r = std::hypot(x, y);
    return r < 0.375 ? r - 0.25 : std::abs(r - 1) - 0.5;
  }));
  EXPECT_NEAR(area_inside(path), std::numbers::pi * (2.25 - 0.25 + 0.0625), 3 * error);
}

TEST(Contour, TwoDiscsAreOnePath) {
  const auto path =
      path_round_negative(grid_of([](double x, double y) { return std::hypot(std::abs(x) - 1, y) - 0.5; }));
  EXPECT_NEAR(area_inside(path), 2 * std::numbers::pi / 4, 2 * error);
}

TEST(Contour, WhatIsNoNumberIsLeftOut) {  // the left half
  const auto path = path_round_negative(grid_of([](double x, double) { return x < -0.01 ? NAN : -1; }));
  EXPECT_NEAR(area_inside(path), 8, 4 * 0.02);
}

}  // namespace
}  // namespace continuo::studies::contour_test
