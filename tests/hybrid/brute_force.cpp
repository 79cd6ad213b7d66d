// tests/hybrid/brute_force.cpp
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <tests/hybrid/brute_force.hpp>

namespace continuo::hybrid {
namespace {

using State = std::vector<Real>;

/// The values of expressions and conditions at one instant.
class Reading {
 public:
  Reading(const HybridModel& model, int mode, Real t, const State& x) : model_(model), mode_(mode), t_(t), x_(x) {}

  Real value(const Expression& e) const {
    using Kind = Expression::Kind;
    switch (e.kind) {
      case Kind::number:
        return e.number;
      case Kind::time:
        return t_;
      case Kind::state:
        return x_[static_cast<std::size_t>(e.index)];
      case Kind::unknown:
        return unknown_value(model_.unknowns[static_cast<std::size_t>(e.index)]);
      case Kind::sum:
        return value(e.parts[0]) + value(e.parts[1]);
      case Kind::difference:
        return value(e.parts[0]) - value(e.parts[1]);
      case Kind::product:
        return value(e.parts[0]) * value(e.parts[1]);
      case Kind::sine:
        return std::sin(value(e.parts[0]));
    }
    return 0;
  }

  Real value(const Comparison& c) const {
    using Form = Comparison::Form;
    const Real left = value(c.left), right = value(c.right), width = c.width;
    switch (c.form) {
      case Form::plain:
        return left - right;
      case Form::absolute:
        return std::fabs(left) - right;
      case Form::pulse:
        return std::exp(-(left / width) * (left / width)) - right;
      case Form::steps:
        return std::floor(left / width) - right;
      case Form::square:
        return (left - width * std::floor(left / width) < right ? 1 : 0) - 0.5L;
      case Form::modulo:
        return left - width * std::floor(left / width) - right;
    }
    return 0;
  }

  bool holds(const Condition& c) const {
    using Kind = Condition::Kind;
    const auto difference = [&] { return value(model_.comparisons[static_cast<std::size_t>(c.comparison)]); };
    switch (c.kind) {
      case Kind::less:
        return difference() < 0;
      case Kind::less_equal:
        return difference() <= 0;
      case Kind::greater:
        return difference() > 0;
      case Kind::greater_equal:
        return difference() >= 0;
      case Kind::equal:
        return difference() == 0;
      case Kind::negation:
        return !holds(c.parts[0]);
      case Kind::all:
        return std::ranges::all_of(c.parts, [&](const Condition& part) { return holds(part); });
      case Kind::any:
        return std::ranges::any_of(c.parts, [&](const Condition& part) { return holds(part); });
    }
    return false;
  }

  /// The branch that each switching equation takes.
  std::vector<long> branches() const {
    std::vector<long> found;
    for (const Block& b : model_.blocks) {
      if (b.kind == Block::Kind::switched) {
        const bool alone = b.also.kind == Expression::Kind::number;
        found.push_back(value(b.surface) > 0 && (alone || value(b.also) > 0));
      }
      if (b.kind == Block::Kind::kink) found.push_back(value(b.surface) > 0 ? 1 : -1);
      if (b.kind == Block::Kind::staircase || b.kind == Block::Kind::sawtooth)
        found.push_back(std::lround(std::floor(value(b.surface) / b.width)));
    }
    return found;
  }

  /// The derivatives, of switching equations in the branches that are given.
  State slope(const std::vector<long>& branches) const {
    State f(x_.size(), 0);
    std::size_t next = 0;
    for (const Block& b : model_.blocks) {
      const auto i = static_cast<std::size_t>(b.state);
      const Block::Parameters& p = b.parameters(mode_);
      const Real x = x_[i], push = b.flag == none ? 0 : p.b * x_[static_cast<std::size_t>(b.flag)];
      switch (b.kind) {
        case Block::Kind::discrete:
          break;
        case Block::Kind::drift:
          f[i] = p.a + push;
          break;
        case Block::Kind::decay:
          f[i] = b.through == none ? -p.k * x + p.c + push : value(unknown(b.through));
          break;
        case Block::Kind::driven:
          f[i] = p.a * std::cos(p.w * t_) + p.c;
          break;
        case Block::Kind::driven_decay:
          f[i] = -p.k * (x - p.a * std::cos(p.w * t_)) + p.c;
          break;
        case Block::Kind::fall:
        case Block::Kind::oscillator:
          f[i] = x_[i + 1];
          f[i + 1] = b.kind == Block::Kind::fall ? p.a + push : -p.w * p.w * (x - p.c);
          break;
        case Block::Kind::switched:
          f[i] = branches[next++] != 0 ? p.a : p.c;
          break;
        case Block::Kind::kink:
          f[i] = p.a * value(b.surface) * static_cast<Real>(branches[next++]) + p.c;
          break;
        case Block::Kind::staircase:
          f[i] = p.a * static_cast<Real>(branches[next++]);
          break;
        case Block::Kind::sawtooth:
          f[i] = p.a * (value(b.surface) - static_cast<Real>(b.width) * static_cast<Real>(branches[next++]));
          break;
        case Block::Kind::relay:
          break;
      }
    }
    return f;
  }

 private:
  /// u + u^3 = s by halving: |u| <= |s|.
  Real unknown_value(const Unknown& u) const {
    const Real s = value(u.source);
    if (!u.cubic) return s + (u.offset.size() == 1 ? u.offset[0] : u.offset[static_cast<std::size_t>(mode_)]);
    Real low = -std::fabs(s), high = std::fabs(s);
    for (int i = 0; i < 80; ++i) {
      const Real middle = (low + high) / 2;
      (middle + middle * middle * middle < s ? low : high) = middle;
    }
    return high;
  }

  const HybridModel& model_;
  int mode_;
  Real t_;
  const State& x_;
};

class BruteForce {
 public:
  explicit BruteForce(const HybridModel& model) : model_(model) {
    for (const double x : model.initial) x_.push_back(x);
  }

  Expected run() {
    truths_ = truths_soon();
    for (long tick = 0; tick < model_.end;) {
      ++tick;
      const Real until = static_cast<double>(tick) / 1000;
      while (t_ < until && found_.events.size() < 200) step(until);
      std::vector<std::size_t> due;
      for (std::size_t e = 0; e < model_.events.size(); ++e) {
        if (is_due(model_.events[e], tick)) due.push_back(e);
      }
      act(due);
    }
    found_.end = x_;
    return found_;
  }

 private:
  static bool is_due(const Event& e, long now) {
    if (e.kind == Event::Kind::at) return now == e.time;
    if (e.kind != Event::Kind::every) return false;
    for (long tick = e.from == none ? e.time : e.from; tick <= now; tick += e.time) {
      if (tick == now) return true;
    }
    return false;
  }

  Reading reading(Real t, const State& x) const { return {model_, mode_, t, x}; }

  /// One step of the classical method of Runge and Kutta in fixed branches.
  State moved(Real h, const std::vector<long>& branches) const {
    const auto beyond = [&](const State& k, Real s) {
      State y = x_;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += s * k[i];
      return y;
    };
    const State k1 = reading(t_, x_).slope(branches);
    const State y2 = beyond(k1, h / 2), k2 = reading(t_ + h / 2, y2).slope(branches);
    const State y3 = beyond(k2, h / 2), k3 = reading(t_ + h / 2, y3).slope(branches);
    const State y4 = beyond(k3, h), k4 = reading(t_ + h, y4).slope(branches);
    State x = x_;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return x;
  }

  /// Of directed guards whether they are above zero, of conditions whether they hold.
  std::vector<bool> truths(Real t, const State& x) const {
    std::vector<bool> found;
    const Reading now = reading(t, x);
    for (const Event& e : model_.events) {
      if (e.kind == Event::Kind::at || e.kind == Event::Kind::every) {
        found.push_back(false);
      } else if (e.kind == Event::Kind::condition) {
        found.push_back(now.holds(e.condition));
      } else {
        found.push_back(now.value(model_.comparisons[static_cast<std::size_t>(e.comparison)]) > 0);
      }
    }
    return found;
  }

  /// Whether the comparisons of events are above zero.
  std::vector<bool> signs(Real t, const State& x) const {
    std::vector<bool> found;
    const Reading now = reading(t, x);
    for (const Comparison& c : model_.comparisons) found.push_back(now.value(c) > 0);
    return found;
  }

  std::vector<long> branches_soon() const {
    const std::vector<long> now = reading(t_, x_).branches();
    return reading(t_ + soon, moved(soon, now)).branches();
  }
  std::vector<bool> truths_soon() const { return truths(t_ + soon, moved(soon, branches_soon())); }

  bool fires(std::size_t event, bool before, bool after) const {
    switch (model_.events[event].kind) {
      case Event::Kind::falls:
        return before && !after;
      case Event::Kind::rises:
      case Event::Kind::condition:
        return !before && after;
      case Event::Kind::crosses:
        return before != after;
      default:
        return false;
    }
  }
  bool is_active(std::size_t event) const {
    return model_.events[event].in_mode == none || model_.events[event].in_mode == mode_;
  }

  /// Moves to `until`, or to just after the first change before it.
  void step(Real until) {
    const std::vector<long> branches = branches_soon();
    // The sign of each comparison is tested by itself, since a window narrower than the step opens and closes within
    // it.
    const std::vector<bool> signs_before = signs(t_ + soon, moved(soon, branches));
    const auto changed_after = [&](Real h) {
      const State x = moved(h, branches);
      return truths(t_ + h, x) != truths_ || signs(t_ + h, x) != signs_before ||
             reading(t_ + h, x).branches() != branches;
    };
    // A function that is zero now and has just left zero need not be distinguished from rounding.
    Real least = std::min(soon, until - t_), most = until - t_;
    bool changed = false;
    for (int part = 1; part <= parts && !changed; ++part) {
      const Real h = most * part / parts;
      if (h <= least) continue;
      if (changed_after(h)) {
        changed = true;
        most = h;
      } else {
        least = h;
      }
    }
    for (int i = 0; changed && i < 60; ++i) {
      const Real middle = (least + most) / 2;
      (changed_after(middle) ? most : least) = middle;
    }
    if (changed) most += past_root;
    x_ = moved(most, branches);
    t_ = most >= until - t_ ? until : t_ + most;
    if (!changed) return;
    const std::vector<bool> now = truths(t_, x_);
    std::vector<std::size_t> due;
    for (std::size_t e = 0; e < now.size(); ++e) {
      if (is_active(e) && fires(e, truths_[e], now[e])) due.push_back(e);
    }
    truths_ = now;
    act(due);
  }

  void act(std::vector<std::size_t> due) {
    for (int round = 0; !due.empty() && round < 20; ++round) {
      for (const std::size_t e : due) {
        if (!model_.events[e].is_step) found_.events.push_back({static_cast<int>(e), t_, false});
        State next = x_;
        int mode = mode_;
        assign(model_.events[e].actions, reading(t_, x_), next, mode);
        x_ = std::move(next);
        mode_ = mode;
      }
      const std::vector<bool> now = truths_soon();
      due.clear();
      for (std::size_t e = 0; e < now.size(); ++e) {
        if (is_active(e) && fires(e, truths_[e], now[e])) due.push_back(e);
      }
      truths_ = now;
    }
  }

  void assign(const std::vector<Action>& actions, const Reading& before, State& x, int& mode) const {
    for (const Action& action : actions) {
      if (action.kind == Action::Kind::assign) {
        x[static_cast<std::size_t>(action.target)] = before.value(action.value);
      } else if (action.kind == Action::Kind::go) {
        mode = action.target;
      } else {
        assign(before.holds(action.condition) ? action.chosen : action.otherwise, before, x, mode);
      }
    }
  }

  static constexpr Real soon = 1e-8L;
  static constexpr Real past_root = 1e-14L;  // where a root is exact `<` and `<=` differ
  static constexpr int parts = 4;
  const HybridModel& model_;
  State x_{};
  Real t_ = 0;
  int mode_ = 0;
  std::vector<bool> truths_{};
  Expected found_{};
};

}  // namespace

Expected brute_force(const HybridModel& model) {
  return BruteForce(model).run();
}

}  // namespace continuo::hybrid
