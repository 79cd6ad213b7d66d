// What happens on a branch of orbits between two neighbouring places, however the orbits are solved for. Internal to
// what follows orbits.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/support/false_position.hpp>

namespace continuo::studies::detail {

/// The rotation of a torus in turns per period, 0 of another mark; none where the multipliers do not bear the mark out.
/// `about_minus_one`: how near to -1 one must be where a period doubles. Multipliers of 1e80 pass -1 within the last
/// digit of the constant: what is found there is no place.
[[nodiscard]] inline std::optional<double> borne_out(OrbitBifurcation kind,
                                                     std::span<const std::complex<double>> multipliers,
                                                     double about_minus_one) {
  constexpr double about_one = 1e-2;        // of the multiplier where branches cross
  constexpr double still_on_circle = 1e-5;  // how near to 1 the size of a located pair is
  const auto one_is_near = [&](double value, double distance) {
    return std::ranges::any_of(multipliers, [&](const auto& each) { return std::abs(each - value) < distance; });
  };
  if (kind == OrbitBifurcation::crossing && !one_is_near(1, about_one)) return std::nullopt;
  if (kind == OrbitBifurcation::period_doubling && !one_is_near(-1, about_minus_one)) return std::nullopt;
  if (kind != OrbitBifurcation::torus) return 0;
  // Two real multipliers whose product is 1 are no torus: nothing happens.
  const auto pair = std::ranges::find_if(multipliers, [](const std::complex<double>& value) {
    return value.imag() > 0 && std::abs(std::abs(value) - 1) < still_on_circle;
  });
  if (pair == multipliers.end()) return std::nullopt;
  return std::arg(*pair) / (2 * std::numbers::pi);
}

/// What lies between two neighbours, narrowed down to where its test is zero. `stepped(s)`: the place so far from `a`,
/// optional, with `b` at `step`. `add(kind, place, s)` has each mark, its place at s.
///
/// At a fold the branch turns and a multiplier passes 1; at a crossing the multiplier alone on a branch that goes
/// straight on, the direction alone on one that begins there. Both are looked at next to the place, for more may
/// happen within a step. The direction may also turn by what rounding leaves of a constant that keeps still, as in
/// the explosion of a canard: then no multiplier is near 1.
template <class Place, class Stepped, class Add>
void mark_between(const Place& a, const Place& b, double step, const Stepped& stepped, const Add& add) {
  double at = 0;
  const auto fold = [](const Place& place) { return place.fold; };
  const auto unity = [](const Place& place) { return place.tests.unity; };
  const auto doubling = [](const Place& place) { return place.tests.doubling; };
  const auto torus = [](const Place& place) { return place.tests.torus; };
  const auto changes = [](const Place& from, const Place& to, const auto& test) {
    return (test(from) < 0) != (test(to) < 0);
  };
  const auto zero_of = [&](const auto& test) { return located_zero(stepped, test, step, test(a), test(b), at); };
  const auto is_fold_at = [&](double s) {
    return std::ranges::any_of(std::array{1e-3, 1e-5}, [&](double part) {
      const double aside = part * std::min({step, s, step - s});
      const auto before = stepped(s - aside), after = stepped(s + aside);
      return before && after && changes(*before, *after, fold) && changes(*before, *after, unity);
    });
  };
  const bool turns = changes(a, b, fold), passes = changes(a, b, unity);
  if (turns || passes) {
    if (auto place = turns ? zero_of(fold) : zero_of(unity)) {
      const bool is_fold = turns && passes ? true : is_fold_at(at);
      add(is_fold ? OrbitBifurcation::fold : OrbitBifurcation::crossing, std::move(*place), at);
    }
  }
  if (changes(a, b, doubling))
    if (auto place = zero_of(doubling)) add(OrbitBifurcation::period_doubling, std::move(*place), at);
  if (changes(a, b, torus))
    if (auto place = zero_of(torus)) add(OrbitBifurcation::torus, std::move(*place), at);
}

}  // namespace continuo::studies::detail
