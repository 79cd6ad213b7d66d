// tests/hybrid/referee.cpp
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <tests/hybrid/flow.hpp>
#include <tests/hybrid/referee.hpp>

namespace continuo::hybrid {
namespace {

constexpr Real apart = 1e-6L;     // two events closer than this must coincide by construction
constexpr Real touching = 1e-4L;  // of the value at an extremum
constexpr Real flat = 0.05L;      // of the slope at a root: an error of 3e-11 moves it by 6e-10
constexpr std::size_t many_events = 80, many_rounds = 8;

/// Sign of a comparison at an instant and whether the condition holds with it.
bool holds(Condition::Kind kind, int sign) {
  using Kind = Condition::Kind;
  switch (kind) {
    case Kind::less:
      return sign < 0;
    case Kind::less_equal:
      return sign <= 0;
    case Kind::greater:
      return sign > 0;
    case Kind::greater_equal:
      return sign >= 0;
    default:
      return sign == 0;
  }
}

bool holds(const Condition& c, std::span<const int> signs) {
  using Kind = Condition::Kind;
  if (c.kind == Kind::negation) return !holds(c.parts[0], signs);
  if (c.kind == Kind::all) return std::ranges::all_of(c.parts, [&](const auto& part) { return holds(part, signs); });
  if (c.kind == Kind::any) return std::ranges::any_of(c.parts, [&](const auto& part) { return holds(part, signs); });
  return holds(c.kind, signs[static_cast<std::size_t>(c.comparison)]);
}

void add_comparisons(const Condition& c, std::set<int>& found) {
  if (c.comparison != none) found.insert(c.comparison);
  for (const Condition& part : c.parts) add_comparisons(part, found);
}

std::set<int> watched_by(const Event& e) {
  std::set<int> found;
  if (e.comparison != none) found.insert(e.comparison);
  if (e.kind == Event::Kind::condition) add_comparisons(e.condition, found);
  return found;
}

bool is_scheduled(const Event& e) {
  return e.kind == Event::Kind::at || e.kind == Event::Kind::every;
}

/// Whether a scheduled event is due at a time in thousandths.
bool is_due(const Event& e, long now) {
  if (e.kind == Event::Kind::at) return now == e.time;
  if (e.kind != Event::Kind::every) return false;
  const long first = e.from == none ? e.time : e.from;
  return now >= first && (now - first) % e.time == 0;
}

/// A root found in the motion: of a comparison, or of a surface of the equations.
struct Root {
  Real t;
  std::size_t function;  // comparisons first, then surfaces
};

class Referee {
 public:
  Referee(const HybridModel& model, int refinement)
      : model_(model), refinement_(refinement), watched_(model.comparisons.size(), false) {
    for (const Event& e : model.events) {
      for (const int c : watched_by(e)) watched_[static_cast<std::size_t>(c)] = true;
    }
    for (const double x : model.initial) x_.push_back(x);
  }

  Expected run() {
    begin();
    while (expected_.rejected.empty() && now_ < end()) advance();
    if (expected_.rejected.empty()) expected_.end = x_;
    return std::move(expected_);
  }

 private:
  Real end() const { return model_.end_time(); }
  void reject(std::string why) {
    if (expected_.rejected.empty()) expected_.rejected = std::move(why);
  }

  void begin() {
    restart();
    signs_ = signs_now();
    sides_.assign(model_.events.size(), 0);
    for (std::size_t e = 0; e < model_.events.size(); ++e) sides_[e] = side(e, signs_, 0);
    for (std::size_t c = 0; c < signs_.size(); ++c) {
      if (watched_[c] && signs_[c] == 0 && !model_.comparisons[c].contact && !model_.comparisons[c].discrete)
        reject("a guard that stays at zero");
    }
    std::vector<int> at_start = signs_;
    for (std::size_t c = 0; c < at_start.size(); ++c) {
      if (watched_[c] && jets_[c].value() == 0) at_start[c] = 0;
    }
    for (const Event& e : model_.events) {
      // A condition that is false at the start and true just after it: the rules do not define whether it fires.
      if (e.kind == Event::Kind::condition && holds(e.condition, at_start) != holds(e.condition, signs_))
        reject("a condition at its threshold at the start");
    }
  }

  /// Takes the form of the equations just after now.
  void restart() {
    flow_.emplace(model_, mode_, now_, x_);
    if (!flow_->doubt().empty()) reject(flow_->doubt());
    expected_.slides += static_cast<std::size_t>(flow_->sliding());
  }

  /// Just after now, of the watched comparisons.
  std::vector<int> signs_now() {
    const Quantities q = flow_->at(now_);
    jets_.assign(watched_.size(), Jet{});
    std::vector<int> signs(watched_.size(), 0);
    std::string doubt;
    for (std::size_t c = 0; c < watched_.size(); ++c) {
      if (!watched_[c]) continue;
      jets_[c] = evaluate(model_.comparisons[c], q);
      signs[c] = sign_just_after(jets_[c], doubt);
    }
    if (!doubt.empty()) reject(doubt);
    return signs;
  }

  /// Of a directed guard -1, 0, 1, which keeps the old one at a lasting zero; of a condition 0 or 1.
  int side(std::size_t event, std::span<const int> signs, int old) const {
    const Event& e = model_.events[event];
    if (is_scheduled(e)) return 0;
    if (e.kind == Event::Kind::condition) return holds(e.condition, signs) ? 1 : 0;
    const int s = signs[static_cast<std::size_t>(e.comparison)];
    return s == 0 ? old : s;
  }

  bool fires(std::size_t event, int old, int now) const {
    const Event& e = model_.events[event];
    switch (e.kind) {
      case Event::Kind::falls:
        return old >= 0 && now < 0;
      case Event::Kind::rises:
        return old <= 0 && now > 0;
      case Event::Kind::crosses:
        return old != now && now != 0;
      case Event::Kind::condition:
        return old == 0 && now == 1;
      default:
        return false;
    }
  }

  bool is_active(std::size_t event) const {
    const int in = model_.events[event].in_mode;
    return in == none || in == mode_;
  }

  /// The next tick after now, in thousandths; the end where there is none.
  long next_tick() const {
    long next = model_.end;
    for (const Event& e : model_.events) {
      const long now = std::lround(std::floor(static_cast<double>(now_) * 1000 + 1e-7));
      if (e.kind == Event::Kind::at && e.time > now) next = std::min(next, e.time);
      if (e.kind != Event::Kind::every) continue;
      const long first = e.from == none ? e.time : e.from;
      const long following = now < first ? first : first + ((now - first) / e.time + 1) * e.time;
      next = std::min(next, following);
    }
    return next;
  }

  /// Advances to the next event and performs its actions.
  void advance() {
    const long tick = next_tick();
    const Real tick_time = static_cast<double>(tick) / 1000;
    const std::optional<Root> root = first_root(tick_time);
    if (!expected_.rejected.empty()) return;
    if (root) {
      if (root->t - now_ < apart || tick_time - root->t < apart) return reject("two instants too near to each other");
      meet(*root);
    } else {
      if (is_near_root(tick_time)) return reject("two instants too near to each other");
      x_ = flow_->states_at(tick_time);
      now_ = tick_time;
      restart();
      std::vector<std::size_t> due;
      for (std::size_t e = 0; e < model_.events.size(); ++e) {
        if (is_due(model_.events[e], tick)) due.push_back(e);
      }
      const auto steps = [&](std::size_t e) { return model_.events[e].is_step; };
      if (due.size() > 1 && std::ranges::any_of(due, steps)) return reject("an input that steps at a tick");
      act_in_rounds(due);
    }
  }

  void meet(const Root& root) {
    x_ = flow_->states_at(root.t);
    now_ = root.t;
    if (root.function >= watched_.size()) {
      restart();
      // A change of the equations may reverse a guard that is zero at the same instant: that would be two events at
      // once.
      if (signs_now() != signs_) reject("a guard that turns where the equations switch");
      return;
    }
    const int before = std::exchange(signs_[root.function], 0);
    const std::vector<int> at_root = signs_;
    signs_[root.function] = -before;
    std::vector<std::size_t> due;
    for (std::size_t e = 0; e < model_.events.size(); ++e) {
      const int turned = side(e, signs_, sides_[e]);
      if (is_active(e) && fires(e, sides_[e], turned)) due.push_back(e);
      if (turned == sides_[e] && turned != side(e, at_root, turned))
        reject("a condition that is another at a single instant");
      sides_[e] = turned;
    }
    restart();
    act_in_rounds(due);
  }

  void act_in_rounds(std::vector<std::size_t> due) {
    for (std::size_t round = 1; !due.empty(); ++round) {
      if (round > many_rounds) return reject("rounds without end");
      expected_.most_rounds = std::max(expected_.most_rounds, round);
      if (due.size() > 1) ++expected_.simultaneous;
      due = act_one_round(due);
      if (!expected_.rejected.empty()) return;
      if (expected_.events.size() > many_events) return reject("events without end");
    }
  }

  /// Performs the actions of these events; returns the events that they cause.
  std::vector<std::size_t> act_one_round(const std::vector<std::size_t>& due) {
    const std::vector<int> before = sides_, signs_before = signs_;
    const int mode_before = mode_;
    assigned_.clear();
    std::vector<bool> changed(model_.events.size(), false);
    for (const std::size_t e : due) {
      if (!model_.events[e].is_step)
        expected_.events.push_back({static_cast<int>(e), now_, is_scheduled(model_.events[e])});
      act(model_.events[e]);
      restart();
      const std::vector<int> signs_left = std::exchange(signs_, signs_now());
      reject_turned_jumps(signs_left);
      if (!expected_.rejected.empty()) return {};
      for (std::size_t f = 0; f < sides_.size(); ++f) {
        const int turned = side(f, signs_, sides_[f]);
        if (fires(f, sides_[f], turned)) changed[f] = true;
        sides_[f] = turned;
      }
    }
    reject_lasting_zeros(signs_before);
    std::vector<std::size_t> next;
    for (std::size_t f = 0; f < sides_.size(); ++f) {
      // Where one event of a round undoes the change of another, the rules are ambiguous.
      if (changed[f] != fires(f, before[f], sides_[f])) reject("a guard that turned and turned back within a round");
      if (mode_ != mode_before && model_.events[f].in_mode != none) {
        if (changed[f]) reject("a guard that turns while its mode begins or ends");
        if (model_.events[f].kind == Event::Kind::condition && is_active(f) && sides_[f] == 1)
          reject("a condition that holds when its mode begins");
        if (is_active(f) && is_at_zero(f)) reject("a guard at zero when its mode begins");
      }
      if (changed[f] && is_active(f)) next.push_back(f);
    }
    return next;
  }

  bool is_at_zero(std::size_t event) const {
    return std::ranges::any_of(watched_by(model_.events[event]), [&](int c) {
      return std::fabs(jets_[static_cast<std::size_t>(c)].value()) <= value_margin.zero;
    });
  }

  bool reads_assigned(const Expression& e) const {
    if (e.kind == Expression::Kind::state) return assigned_.contains(e.index);
    if (e.kind == Expression::Kind::unknown)
      return reads_assigned(model_.unknowns[static_cast<std::size_t>(e.index)].source);
    return std::ranges::any_of(e.parts, [&](const Expression& part) { return reads_assigned(part); });
  }

  /// A guard set to zero on the side where it was: whether this is another crossing, since it is at zero and moves in
  /// the watched direction, is tested by no model here.
  void reject_lasting_zeros(std::span<const int> signs_before) {
    for (std::size_t c = 0; c < watched_.size(); ++c) {
      const Comparison& sides = model_.comparisons[c];
      if (!watched_[c] || sides.discrete || sides.contact) continue;
      if (signs_[c] == 0) return reject("a guard that stays at zero");
      if (std::fabs(jets_[c].value()) > value_margin.zero || signs_[c] != signs_before[c]) continue;
      if (reads_assigned(sides.left) || reads_assigned(sides.right)) reject("a guard set to zero on the same side");
    }
  }

  /// A guard that no action has set has changed its side: the motion, reversed by an action, returns over the jump at
  /// which the guard is. It has not moved yet, and its side is within rounding, so the rules are ambiguous.
  void reject_turned_jumps(std::span<const int> signs_before) {
    using Form = Comparison::Form;
    for (std::size_t c = 0; c < watched_.size(); ++c) {
      const Comparison& sides = model_.comparisons[c];
      const bool jumps = sides.form == Form::steps || sides.form == Form::square || sides.form == Form::modulo;
      if (!jumps || !watched_[c] || signs_[c] == signs_before[c]) continue;
      // The same is true of a guard that was set to the value it had.
      if (!reads_assigned(sides.left) || std::fabs(jets_[c].value()) <= value_margin.zero)
        return reject("a jump that turns where it stands");
    }
  }

  void act(const Event& event) {
    const Quantities q = flow_->at(now_);
    assign(event.actions, q);
  }

  void assign(const std::vector<Action>& actions, const Quantities& q) {
    for (const Action& action : actions) {
      switch (action.kind) {
        case Action::Kind::assign:
          x_[static_cast<std::size_t>(action.target)] = evaluate(action.value, q).value();
          assigned_.insert(action.target);
          break;
        case Action::Kind::go:
          mode_ = action.target;
          break;
        case Action::Kind::choose:
          assign(chooses(action.condition, q) ? action.chosen : action.otherwise, q);
      }
    }
  }

  bool chooses(const Condition& condition, const Quantities& q) {
    std::set<int> read;
    add_comparisons(condition, read);
    std::vector<int> signs(model_.comparisons.size(), 0);
    for (const int c : read) {
      const Comparison& sides = model_.comparisons[static_cast<std::size_t>(c)];
      const Real g = evaluate(sides, q).value();
      if (!sides.discrete && std::fabs(g) < value_margin.clear) reject("a choice at its threshold");
      signs[static_cast<std::size_t>(c)] = (g > 0) - (g < 0);
    }
    return holds(condition, signs);
  }

  // ---- the search for the next root ----

  Jet function(std::size_t f, const Quantities& q) const {
    if (f < watched_.size()) return evaluate(model_.comparisons[f], q);
    return evaluate(flow_->surfaces()[f - watched_.size()].function, q);
  }
  Jet function(std::size_t f, Real t) const { return function(f, flow_->at(t)); }

  /// The distance to the next sample: a part of the shortest period, and of the time since the start of a faster decay.
  Real sampling_step(Real t) const {
    Real rate = std::max(1.0, model_.fastest), decay = 0;
    for (const Block& b : model_.blocks) {
      for (const Block::Parameters& p : b.in_mode) decay = std::max<Real>(decay, p.k);
    }
    Real step = 0.06L / rate;
    if (decay > rate) step = std::min(step, std::max(0.06L / decay, 0.06L * (t - flow_->begin())));
    return step / refinement_;
  }

  /// The first root before `limit`, if no other one is near.
  std::optional<Root> first_root(Real limit) {
    std::vector<std::size_t> functions;
    std::vector<int> signs;
    gather(functions, signs);
    std::optional<Root> first;
    std::vector<Jet> a, b(functions.size());
    const Quantities at_begin = flow_->at(now_);
    for (const std::size_t f : functions) a.push_back(function(f, at_begin));
    for (Real t = now_; t < limit;) {
      const Real next = std::min(limit, t + sampling_step(t));
      const Quantities q = flow_->at(next);
      for (std::size_t i = 0; i < functions.size(); ++i) {
        b[i] = function(functions[i], q);
        const std::optional<Real> root = root_between(functions[i], signs[i], t, next, a[i], b[i]);
        if (!expected_.rejected.empty()) return {};
        if (!root) continue;
        if (first && std::fabs(*root - first->t) < apart) {
          reject("two roots too near to each other");
          return {};
        }
        if (!first || *root < first->t) first = Root{*root, functions[i]};
      }
      if (first) {
        // Shortly after the root the signs of all functions must be those that follow from this root alone.
        const Quantities later = flow_->at(first->t + apart);
        for (std::size_t i = 0; i < functions.size(); ++i) {
          const Real g = function(functions[i], later).value();
          const int turned = functions[i] == first->function ? -signs[i] : signs[i];
          if (g * static_cast<Real>(turned) <= 0) reject("two roots too near to each other");
        }
        if (std::fabs(function(first->function, first->t).slope()) < flat) reject("a root with little slope");
        return first;
      }
      std::swap(a, b);
      t = next;
    }
    return {};
  }

  /// Whether a root lies so close after t that it cannot be distinguished from one at t.
  bool is_near_root(Real t) {
    std::vector<std::size_t> functions;
    std::vector<int> signs;
    gather(functions, signs);
    for (const std::size_t f : functions) {
      const Jet g = function(f, t);
      if (std::fabs(g.value()) < apart * std::fabs(g.slope())) return true;
    }
    return false;
  }

  /// Functions that can change and their signs just after now.
  void gather(std::vector<std::size_t>& functions, std::vector<int>& signs) {
    for (std::size_t c = 0; c < watched_.size(); ++c) {
      if (!watched_[c] || model_.comparisons[c].discrete || signs_[c] == 0) continue;
      functions.push_back(c);
      signs.push_back(signs_[c]);
    }
    std::string doubt;
    for (std::size_t s = 0; s < flow_->surfaces().size(); ++s) {
      functions.push_back(watched_.size() + s);
      signs.push_back(sign_just_after(function(watched_.size() + s, now_), doubt));
      if (signs.back() == 0) reject("equations that stay at a switching surface");
    }
  }

  /// Between two neighbouring samples the function has at most one extremum.
  std::optional<Real> root_between(std::size_t f, int sign, Real begin, Real end, const Jet& a, const Jet& b) {
    const auto s = static_cast<Real>(sign);
    if (s * b.value() <= 0) return bisect(begin, end, [&](Real t) { return s * function(f, t).value() > 0; });
    // A function that is zero at the first sample has just left zero.
    if (std::fabs(a.value()) <= value_margin.zero || s * a.slope() >= 0 || s * b.slope() <= 0) return {};
    const Real extremum = bisect(begin, end, [&](Real t) { return s * function(f, t).slope() < 0; });
    const Real least = s * function(f, extremum).value();
    if (least <= 0) return bisect(begin, extremum, [&](Real t) { return s * function(f, t).value() > 0; });
    if (least < touching) reject("a guard that almost touches zero");
    return {};
  }

  /// The place at which `still` becomes false.
  template <class Still>
  static Real bisect(Real begin, Real end, const Still& still) {
    for (int i = 0; i < 80; ++i) {
      const Real middle = (begin + end) / 2;
      if (middle <= begin || middle >= end) break;
      (still(middle) ? begin : end) = middle;
    }
    return end;
  }

  const HybridModel& model_;
  int refinement_;
  std::vector<bool> watched_;
  std::vector<Real> x_{};
  int mode_ = 0;
  Real now_ = 0;
  std::optional<Flow> flow_{};
  std::vector<int> signs_{}, sides_{};
  std::vector<Jet> jets_{};
  std::set<int> assigned_{};  // states, in this round
  Expected expected_{};
};

/// Changes every initial value and rate by about `size`, relatively, always in the same way. A state that is at a
/// threshold by construction remains there.
HybridModel moved(HybridModel model, double size) {
  // A decay through an unknown has its rate in two places.
  const auto is_constructed = [](const Block& b) {
    return b.kind == Block::Kind::discrete || b.constructed || b.through != none;
  };
  unsigned seed = 12345;
  const auto factor = [&] {
    seed = seed * 1664525U + 1013904223U;
    return 1 + size * ((seed >> 8) % 2001 / 1000.0 - 1);
  };
  for (Block& block : model.blocks) {
    if (is_constructed(block)) continue;
    for (Block::Parameters& p : block.in_mode) {
      for (double* value : {&p.a, &p.b, &p.c, &p.k, &p.w, &p.mu}) *value *= factor();
    }
    for (int s = 0; s < block.states(); ++s) model.initial[static_cast<std::size_t>(block.state + s)] *= factor();
  }
  return model;
}

}  // namespace

Expected referee(const HybridModel& model, int refinement) {
  return Referee(model, refinement).run();
}

Expected referee_of_well_conditioned(const HybridModel& model, Real factor) {
  Expected expected = referee(model);
  if (!expected.rejected.empty()) return expected;
  constexpr double size = 1e-7;
  const Expected other = referee(moved(model, size));
  if (!other.rejected.empty() || other.events.size() != expected.events.size()) {
    expected.rejected = "events that a small change of rates moves far";
    return expected;
  }
  for (std::size_t i = 0; i < expected.events.size(); ++i) {
    if (other.events[i].event != expected.events[i].event ||
        std::fabs(other.events[i].t - expected.events[i].t) > factor * size)
      expected.rejected = "events that a small change of rates moves far";
  }
  for (std::size_t i = 0; i < expected.end.size(); ++i) {
    if (std::fabs(other.end[i] - expected.end[i]) > 100 * factor * size * (1 + std::fabs(expected.end[i])))
      expected.rejected = "an end that a small change of rates moves far";
  }
  return expected;
}

}  // namespace continuo::hybrid
