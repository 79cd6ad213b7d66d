// continuo/studies/orbits/continuation/orbit_return.cpp
// Recognizes the return of a motion, also one that advances by whole turns.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <continuo/studies/orbits/continuation/orbit_return.hpp>

namespace continuo::studies::detail {

namespace {

using X = std::vector<double>;

constexpr std::size_t most_passes = 8;  // through the section within one period
constexpr double whole_turn = 2 * std::numbers::pi;

/// Whether f is the same wherever the state has gone on so far.
bool is_symmetry(const ParametricSystem& system, const std::vector<X>& states, const X& advance) {
  constexpr double alike = 1e-9;
  constexpr std::size_t samples = 40;
  const std::size_t stride = std::max<std::size_t>(1, states.size() / samples);
  X here(system.size), there(system.size), greatest(system.size), apart(system.size);
  for (std::size_t k = 0; k < states.size(); k += stride) {
    X moved(states[k]);
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += advance[i];
    system.derivative(0, states[k], system.constants, here);
    system.derivative(0, moved, system.constants, there);
    for (std::size_t i = 0; i < here.size(); ++i) {
      greatest[i] = std::max(greatest[i], std::abs(here[i]));
      if (!(std::abs(here[i] - there[i]) <= apart[i])) apart[i] = std::abs(here[i] - there[i]);
    }
  }
  for (std::size_t i = 0; i < apart.size(); ++i)
    if (!(apart[i] <= alike * greatest[i])) return false;
  return true;
}

}  // namespace

Extent extent_of(const std::vector<X>& states) {
  Extent extent{states.front(), states.front()};
  for (const X& x : states) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      extent.low[i] = std::min(extent.low[i], x[i]);
      extent.high[i] = std::max(extent.high[i], x[i]);
    }
  }
  return extent;
}

Return last_return(const ParametricSystem& system, std::span<const SectionPoint> points, const Extent& extent,
                   const std::vector<X>& states, double part, double noise) {
  for (std::size_t turns = 1; turns <= most_passes && turns < points.size(); ++turns) {
    const SectionPoint& last = points.back();
    const SectionPoint& before = points[points.size() - 1 - turns];
    bool alike = true, turned = false;
    X advance(last.x.size());
    for (std::size_t i = 0; i < last.x.size(); ++i) {
      const double apart = last.x[i] - before.x[i];
      advance[i] = whole_turn * std::round(apart / whole_turn);
      turned = turned || advance[i] != 0;
      const double size = advance[i] == 0 ? extent.size(i) : std::min(extent.size(i), whole_turn);
      alike = alike && std::abs(apart - advance[i]) <= part * size + noise;
    }
    if (!alike || (turned && !is_symmetry(system, states, advance))) continue;
    return {last.t - before.t, turned ? advance : X()};
  }
  return {};
}

bool goes_on(const std::vector<X>& states, const Extent& extent, std::size_t i) {
  constexpr double much = 0.3;
  const double first = states[states.size() / 2][i] - states.front()[i],
               second = states.back()[i] - states[states.size() / 2][i];
  return extent.size(i) > whole_turn && first * second > 0 &&
         std::min(std::abs(first), std::abs(second)) > much * extent.size(i);
}

}  // namespace continuo::studies::detail
