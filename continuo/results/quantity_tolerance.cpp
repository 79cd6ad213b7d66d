// Moves the states by their tolerances, up and down in several patterns, and keeps the largest changes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <continuo/results/quantity_tolerance.hpp>

namespace continuo::results {
namespace {

constexpr double rounding = 1e-12;  // of a run in fixed steps, relative: what thousands of steps round
constexpr int patterns = 4;

}  // namespace

QuantityTolerance::QuantityTolerance(const model::Plan& plan, std::size_t states, std::size_t quantities)
    : size_(states, 0), moved_(states), values_(quantities), largest_(quantities, 0) {
  for (std::size_t i = 0; i < states; ++i) {
    const bool has_tolerance = !(plan.step > 0);
    const bool has_absolute = has_tolerance && (plan.atol.size() == 1 || i < plan.atol.size());
    const bool has_relative = has_tolerance && (plan.rtol_each.empty() || i < plan.rtol_each.size());
    rtol_.push_back(std::max(has_relative ? plan.rtol_of(i) : 0, rounding));
    atol_.push_back(has_absolute ? plan.atol_of(i) : 0);
  }
}

void QuantityTolerance::see(std::span<const double> x, std::span<const double> values, const Quantities& quantities) {
  for (std::size_t i = 0; i < size_.size(); ++i)
    if (std::isfinite(x[i])) size_[i] = std::max(size_[i], std::abs(x[i]));
  std::minstd_rand random(1);  // the same patterns in every run
  for (int pattern = 0; pattern < patterns; ++pattern) {
    for (std::size_t i = 0; i < size_.size(); ++i) {
      const double off = rtol_[i] * size_[i] + atol_[i];
      moved_[i] = x[i] + (random() % 2 == 0 ? off : -off);
    }
    quantities(moved_, values_);
    for (std::size_t k = 0; k < largest_.size(); ++k) {
      const double change = std::abs(values_[k] - values[k]);
      if (std::isfinite(change)) largest_[k] = std::max(largest_[k], change);
    }
  }
}

}  // namespace continuo::results
