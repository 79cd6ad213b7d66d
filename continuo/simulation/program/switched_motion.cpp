// Sets switches, chooses between crossing and sliding, and computes the weights of a sliding motion.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/simulation/program/switched_motion.hpp>
#include <continuo/solve/events/guard_motion.hpp>

namespace continuo::model {
namespace {

/// The value of a switch where its surface has the value z.
double natural_value(const Switch& one, double z) {
  if (one.kind == Switch::Kind::floor) return std::floor(z);
  if (one.kind == Switch::Kind::sign) return static_cast<double>((z > 0) - (z < 0));
  return z > 0 || (z == 0 && one.closed) ? 1 : 0;
}

}  // namespace

SwitchedMotion::SwitchedMotion(const ModelProgram& program, std::span<const double> variables) : program_(&program) {
  std::size_t most = 0;
  for (const SwitchedEquations& equations : program.switches) {
    OfMode& mine = modes_.emplace_back();
    if (equations.empty()) continue;
    mine.rates = Evaluation(equations.rates, variables);
    mine.surfaces = Evaluation(equations.surfaces, variables);
    mine.approach = Evaluation(equations.approach, variables);
    most = std::max(most, equations.switches.size());
  }
  surfaces_.resize(most);
  approach_.resize(most);
}

void SwitchedMotion::set(std::uint32_t variable, double value) {
  for (OfMode& mine : modes_) {
    mine.rates.set(variable, value);
    mine.surfaces.set(variable, value);
    mine.approach.set(variable, value);
  }
}

void SwitchedMotion::place(std::size_t mode, std::size_t k, double value) {
  const std::uint32_t variable = switches(mode)[k].variable;
  values_[k] = value;
  modes_[mode].rates.place(variable, value);
  modes_[mode].surfaces.place(variable, value);
  modes_[mode].approach.place(variable, value);
}

/// A step looks for the crossing of a surface a little beyond it, where the equations of this side may have no value:
/// `sqrt(max(h, 0))` held as sqrt(h), at a level that falls through 0. There every switch but that asked for, and those
/// along whose surfaces the motion slides, has the value of the place. The step ends at the surface, and its error
/// estimate sees the corner, as that of a step without switches.
void SwitchedMotion::evaluate(std::size_t mode, Evaluation& equations, double t, const X& x, std::span<double> values,
                              std::size_t asked) {
  equations(t, x, values);
  if (all_finite(values)) return;
  const std::vector<double> kept = values_;
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (k != asked && !slides_along(k)) place(mode, k, natural_value(switches(mode)[k], surface(mode, k, t, x)));
  equations(t, x, values);
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (values_[k] != kept[k]) place(mode, k, kept[k]);
}

void SwitchedMotion::side_rates(std::size_t mode, double t, const X& x, X& dxdt) {
  evaluate(mode, modes_[mode].rates, t, x, dxdt, none);
}

void SwitchedMotion::approach(std::size_t mode, double t, const X& x, std::span<double> values, std::size_t asked) {
  evaluate(mode, modes_[mode].approach, t, x, values, asked);
}

double SwitchedMotion::surface(std::size_t mode, std::size_t k, double t, const X& x) {
  modes_[mode].surfaces(t, x, std::span(surfaces_).first(switches(mode).size()));
  return surfaces_[k];
}

/// The share of the upper side of each surface in the sliding motion; leaves all of these switches below.
std::vector<double> SwitchedMotion::weights(std::size_t mode, double t, const X& x) {
  const std::size_t n = sliding_.size(), all = switches(mode).size();
  for (const Sliding& one : sliding_) place(mode, one.k, one.below);
  const std::span<double> values = std::span(approach_).first(all);
  std::vector<double> right(n);
  approach(mode, t, x, values);
  for (std::size_t j = 0; j < n; ++j) right[j] = -values[sliding_[j].k];
  DenseLU<double> matrix(n);
  for (std::size_t i = 0; i < n; ++i) {
    place(mode, sliding_[i].k, sliding_[i].above);
    approach(mode, t, x, values);
    for (std::size_t j = 0; j < n; ++j) matrix.matrix()[j * n + i] = values[sliding_[j].k] + right[j];
    place(mode, sliding_[i].k, sliding_[i].below);
  }
  if (!matrix.factor()) return std::vector<double>(n, std::numeric_limits<double>::quiet_NaN());
  matrix.solve(right.data());
  return right;
}

void SwitchedMotion::rates(std::size_t mode, double t, const X& x, X& dxdt) {
  if (sliding_.empty()) {
    side_rates(mode, t, x, dxdt);
    return;
  }
  const std::vector<double> part = weights(mode, t, x);
  base_.resize(x.size());
  other_.resize(x.size());
  side_rates(mode, t, x, base_);
  dxdt = base_;
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    place(mode, sliding_[i].k, sliding_[i].above);
    side_rates(mode, t, x, other_);
    for (std::size_t s = 0; s < x.size(); ++s) dxdt[s] += part[i] * (other_[s] - base_[s]);
    place(mode, sliding_[i].k, sliding_[i].below);
  }
}

void SwitchedMotion::guards(std::size_t mode, double t, const X& x, std::span<double> values) {
  const std::vector<Switch>& all = switches(mode);
  std::vector<double> part;
  if (slides()) part = weights(mode, t, x);
  modes_[mode].surfaces(t, x, std::span(surfaces_).first(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    values[k] = all[k].kind == Switch::Kind::floor ? 0.5 - std::abs(surfaces_[k] - values_[k] - 0.5) : surfaces_[k];
  }
  for (std::size_t i = 0; i < sliding_.size(); ++i) values[sliding_[i].k] = std::min(part[i], 1 - part[i]);
}

SwitchedMotion::Sliding SwitchedMotion::sides_of(std::size_t mode, std::size_t k, double surface) const {
  switch (switches(mode)[k].kind) {
    case Switch::Kind::relation:
      return {k, 0, 1};
    case Switch::Kind::sign:
      return {k, -1, 1};
    case Switch::Kind::floor:
      break;
  }
  const double whole = std::round(surface);
  return {k, whole - 1, whole};
}

/// How fast the motion goes towards the upper side of surface k, were the switch at this value.
double SwitchedMotion::approach_of(std::size_t mode, std::size_t k, double value, double t, const X& x) {
  const double kept = values_[k];
  const std::span<double> values = std::span(approach_).first(switches(mode).size());
  place(mode, k, value);
  double rate = 0;
  if (slides()) {
    const std::vector<double> part = weights(mode, t, x);
    approach(mode, t, x, values, k);
    const double base = rate = values[k];
    for (std::size_t i = 0; i < sliding_.size(); ++i) {
      place(mode, sliding_[i].k, sliding_[i].above);
      approach(mode, t, x, values, k);
      rate += part[i] * (values[k] - base);
      place(mode, sliding_[i].k, sliding_[i].below);
    }
  } else {
    approach(mode, t, x, values, k);
    rate = values[k];
  }
  place(mode, k, kept);
  return rate;
}

/// On the surface: the side to which the motion leads from both, or along it.
Passage SwitchedMotion::choose(std::size_t mode, Sliding sides, double t, const X& x) {
  const double below = approach_of(mode, sides.k, sides.below, t, x);
  const double above = approach_of(mode, sides.k, sides.above, t, x);
  if (below > 0 && above < 0) {
    place(mode, sides.k, sides.below);
    sliding_.push_back(sides);
    return Passage::begins_to_slide;
  }
  const double kept = values_[sides.k];
  if (below == 0 && above == 0 && kept != sides.below && kept != sides.above) return Passage::none;
  // Where the motion leads away on both sides, it goes on in the direction that it came by.
  const bool up = below >= 0 && above >= 0 ? below + above > 0 : below <= 0 && above <= 0 ? false : kept == sides.below;
  place(mode, sides.k, up ? sides.above : sides.below);
  return values_[sides.k] != kept ? Passage::crosses : Passage::none;
}

Passage SwitchedMotion::pass(std::size_t mode, std::size_t k, double t, const X& x) {
  const std::size_t n = switches(mode).size();
  std::vector<double> before(n);
  modes_[mode].surfaces(t, x, before);
  const auto slides_here = std::ranges::find(sliding_, k, &Sliding::k);
  Passage passage = Passage::leaves;
  if (slides_here == sliding_.end()) {
    passage = choose(mode, sides_of(mode, k, before[k]), t, x);
  } else {
    const std::vector<double> part = weights(mode, t, x);
    const double mine = part[static_cast<std::size_t>(slides_here - sliding_.begin())];
    const Sliding sides = *slides_here;
    sliding_.erase(slides_here);
    place(mode, k, mine > 0.5 ? sides.above : sides.below);
  }
  // The switch may stand in the surfaces of others, which come after it: `mod(t, 2) < 1` holds again where mod jumps.
  for (std::size_t j = k + 1; j < n && passage != Passage::none; ++j)
    if (!slides_along(j) && surface(mode, j, t, x) != before[j]) settle_one(mode, j, t, x, nullptr, {});
  return passage;
}

double SwitchedMotion::rounding(std::size_t mode, std::size_t k, double t, const X& x) {
  const double here = surface(mode, k, t, x);
  double most = 0;
  moved_.resize(x.size());
  for_each_rounded(t, x, moved_, [&](double at, const X& moved) {
    most = std::max(most, std::abs(surface(mode, k, at, moved) - here));
  });
  return most;
}

/// True where the value of the switch has changed.
bool SwitchedMotion::settle_one(std::size_t mode, std::size_t k, double t, const X& x, const X* before,
                                std::span<const char> slid) {
  const Switch& one = switches(mode)[k];
  const double z = surface(mode, k, t, x), kept = values_[k];
  const double off = one.kind == Switch::Kind::floor ? z - std::round(z) : z;
  bool on_surface = std::abs(off) <= rounding(mode, k, t, x);
  if (before != nullptr && slid[k] != 0 && surface(mode, k, t, *before) == z) on_surface = true;
  place(mode, k, natural_value(one, z));
  if (on_surface) choose(mode, sides_of(mode, k, z), t, x);
  return values_[k] != kept;
}

void SwitchedMotion::settle(std::size_t mode, double t, const X& x, const X* before) {
  const std::size_t n = switches(mode).size();
  std::vector<char> slid(n, 0);
  const std::vector<Switch>& before_now = switches(std::exchange(mode_, mode));
  for (const Sliding& one : std::exchange(sliding_, {})) {
    const Switch& old = before_now[one.k];
    for (std::size_t k = 0; k < n; ++k)
      if (switches(mode)[k].kind == old.kind && switches(mode)[k].surface == old.surface) slid[k] = 1;
  }
  values_.assign(n, 0);
  for (std::size_t k = 0; k < n; ++k) place(mode, k, 0);
  // A switch may stand in the surface of another: later passes see the values of earlier ones.
  constexpr int most_passes = 4;
  bool changed = true;
  for (int pass = 0; pass < most_passes && changed; ++pass) {
    changed = false;
    for (std::size_t k = 0; k < n; ++k) {
      const bool slides_now = std::ranges::find(sliding_, k, &Sliding::k) != sliding_.end();
      if (!slides_now) changed = settle_one(mode, k, t, x, before, slid) || changed;
    }
  }
}

}  // namespace continuo::model
