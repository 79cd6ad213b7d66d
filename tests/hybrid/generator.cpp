// tests/hybrid/generator.cpp
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <tests/hybrid/flow.hpp>
#include <tests/hybrid/generator.hpp>
#include <tests/hybrid/random.hpp>

namespace continuo::hybrid {
namespace {

using Parameters = Block::Parameters;

class Generator {
 public:
  Generator(std::uint64_t seed, const Ability& ability) : random_(seed), ability_(ability) {}

  HybridModel model() {
    model_.end = 100 * whole(15, 50);
    model_.modes = chance(0.25) ? whole_int(2, 3) : 1;
    if (chance(0.04)) {
      cradle();
    } else {
      blocks();
    }
    if (ability_.algebraic && !plain_.empty() && chance(0.6)) unknowns();
    if (ability_.algebraic && chance(0.2)) decay_through_unknown();
    const int count = whole_int(1, 5);
    for (int i = 0; i < count; ++i) events();
    if (!counters_.empty() && chance(0.05)) dominoes();
    return std::move(model_);
  }

 private:
  // ---- numbers ----
  int whole_int(int least, int most) { return static_cast<int>(random_.whole(least, most)); }
  long whole(long least, long most) { return random_.whole(least, most); }
  bool chance(double probability) { return random_.chance(probability); }
  double decimal(double least, double most) { return random_.decimal(least, most); }
  double signed_decimal(double least, double most) { return random_.signed_decimal(least, most); }
  template <class T>
  const T& any_of(const std::vector<T>& list) {
    return random_.any_of(list);
  }

  double rate() { return decimal(0.3, ability_.any_rate ? 7 : 3); }
  void seen(double rate) { model_.fastest = std::max(model_.fastest, std::fabs(rate)); }

  // ---- equations ----
  int add_state(const std::string& name, double start) {
    model_.names.push_back(name);
    model_.initial.push_back(start);
    return static_cast<int>(model_.names.size()) - 1;
  }

  void blocks() {
    const int discrete = whole_int(0, 3);
    for (int i = 0; i < discrete; ++i) {
      Block b;
      const bool is_flag = chance(0.5);
      b.state = add_state(fmt::format("{}{}", is_flag ? "f" : "n", i), is_flag && chance(0.3) ? 1 : 0);
      b.in_mode.resize(1);
      (is_flag ? flags_ : counters_).push_back(b.state);
      model_.blocks.push_back(b);
    }
    if (chance(0.15)) stepping_input();
    const int moving = whole_int(1, 3);
    for (int i = 0; i < moving; ++i) plain_block(i);
    if (chance(0.3)) switching_block();
    for (int relays = 0; relays < 2 && chance(0.25); ++relays) relay_block(relays);
  }

  /// A step function from a file, with steps at times without scheduled events.
  void stepping_input() {
    Block b;
    b.is_input = true;
    b.in_mode.resize(1);
    const bool is_switch = chance(0.6);
    b.state = add_state("F", is_switch ? 0 : signed_decimal(0, 1));
    const int steps = whole_int(1, 5);
    long time = 0;
    for (int i = 0; i < steps; ++i) {
      time += 2 * whole(20, 700) + 1;
      if (time >= model_.end) break;
      Event e{.kind = Event::Kind::at, .time = time, .is_step = true};
      e.actions.push_back({.target = b.state, .value = number(is_switch ? (i + 1) % 2 : signed_decimal(0, 1))});
      model_.events.push_back(e);
    }
    inputs_.push_back(b.state);
    model_.blocks.push_back(b);
  }

  /// The state of an input or flag that drives an equation.
  int any_push() { return !inputs_.empty() && (flags_.empty() || chance(0.6)) ? inputs_[0] : any_of(flags_); }
  bool has_push() const { return !flags_.empty() || !inputs_.empty(); }

  void plain_block(int i) {
    using Kind = Block::Kind;
    static const std::vector<Kind> kinds{Kind::drift,        Kind::drift, Kind::decay,      Kind::driven,
                                         Kind::driven_decay, Kind::fall,  Kind::oscillator, Kind::oscillator};
    Block b;
    b.kind = any_of(kinds);
    const std::string name = fmt::format("x{}", i);
    b.state = add_state(name, signed_decimal(0.1, 2));
    plain_.push_back(b.state);
    if (b.states() == 2) {
      plain_.push_back(add_state(name + "'", signed_decimal(0.1, 2)));
    }
    if (has_push() && chance(0.4) && (b.kind == Kind::drift || b.kind == Kind::decay || b.kind == Kind::fall))
      b.flag = any_push();
    const bool stiff = b.kind == Kind::driven_decay && ability_.stiff && chance(0.5);
    const int versions = model_.modes > 1 && chance(0.7) ? model_.modes : 1;
    for (int m = 0; m < versions; ++m) b.in_mode.push_back(parameters(b.kind, stiff));
    model_.blocks.push_back(b);
  }

  Parameters parameters(Block::Kind kind, bool stiff) {
    using Kind = Block::Kind;
    Parameters p;
    p.a = signed_decimal(0.2, 2);
    p.b = signed_decimal(0.2, 3);
    p.c = signed_decimal(0.1, 2);
    p.w = rate();
    p.k = decimal(0.2, 4);
    if (stiff) p.k = std::pow(10, whole_int(3, 5));
    if (kind == Kind::driven || kind == Kind::oscillator || kind == Kind::driven_decay) seen(2 * p.w);
    if (kind == Kind::fall) p.a = signed_decimal(0.5, 9.81);
    if (kind == Kind::driven_decay && stiff) p.c = 0;
    if (!stiff) seen(p.k);
    return p;
  }

  /// Reads only time and blocks without switching, so that no surface depends on the block that it switches.
  void switching_block() {
    using Kind = Block::Kind;
    Block b;
    b.kind = any_of(std::vector<Kind>{Kind::switched, Kind::switched, Kind::kink, Kind::staircase, Kind::sawtooth});
    b.state = add_state("s", signed_decimal(0.1, 1));
    b.variant = whole_int(0, 2);
    b.in_mode.push_back(parameters(b.kind, false));
    if (b.kind == Kind::sawtooth) {
      b.surface = ramp();
      b.width = decimal(0.3, 1.5);
      seen(8 / b.width);
    } else if (b.kind == Kind::staircase) {
      b.surface = chance(0.3) ? time_now() : state(any_of(plain_));
      b.width = decimal(0.4, 2);
      seen(10 / b.width);
    } else if (b.kind == Kind::kink) {
      b.surface = state(any_of(plain_)) - number(signed_decimal(0, 1));
    } else {
      b.surface = surface();
      if (chance(0.3)) b.also = surface();
    }
    moved_.push_back(b.state);
    model_.blocks.push_back(b);
  }

  /// Time, or a state with a constant rate.
  Expression ramp() {
    for (const Block& b : model_.blocks) {
      if (b.kind == Block::Kind::drift && chance(0.6)) return state(b.state);
    }
    return time_now();
  }

  Expression surface() {
    if (chance(0.3)) {
      const double w = rate();
      seen(w);
      return sine(number(w) * time_now()) - number(signed_decimal(0.05, 0.7));
    }
    return state(any_of(plain_)) - number(signed_decimal(0, 1));
  }

  void relay_block(int which) {
    Block b;
    b.kind = Block::Kind::relay;
    b.with_position = chance(0.5);
    b.variant = whole_int(0, 2);
    b.level = chance(0.5) ? 0 : signed_decimal(0.1, 0.5);
    b.state = add_state(fmt::format("y{}", which), std::round((b.level + signed_decimal(0.1, 1.5)) * 1000) / 1000);
    moved_.push_back(b.state);
    if (b.with_position) moved_.push_back(add_state(fmt::format("p{}", which), signed_decimal(0, 1)));
    Parameters p;
    p.a = signed_decimal(0.2, 3);
    p.w = rate();
    p.mu = decimal(0.3, 2);
    p.c = chance(0.5) ? 0 : signed_decimal(0.1, 1);
    if (has_push() && chance(0.4)) {
      b.flag = any_push();
      p.b = signed_decimal(0.2, 2);
    }
    if (!b.with_position && chance(0.4)) {
      b.drive = any_of(plain_);
    } else {
      seen(2 * p.w);
    }
    b.in_mode.push_back(p);
    model_.blocks.push_back(b);
  }

  /// x' = u, 0 = u + k*x - c.
  void decay_through_unknown() {
    Block b;
    b.kind = Block::Kind::decay;
    b.state = add_state("d", signed_decimal(0.1, 2));
    Parameters p;
    p.k = decimal(0.2, 4);
    seen(p.k);
    p.c = signed_decimal(0.1, 2);
    b.in_mode.push_back(p);
    b.through = static_cast<int>(model_.unknowns.size());
    model_.unknowns.push_back({.source = number(p.c) - number(p.k) * state(b.state), .offset = {0}});
    moved_.push_back(b.state);
    model_.blocks.push_back(b);
  }

  /// Equal balls in a row, of which the first strikes: two or three collisions at one instant.
  void cradle() {
    model_.modes = 1;
    const int balls = whole_int(3, 4);
    const double speed = decimal(0.5, 2), distance = decimal(0.3, 1);
    for (int i = 0; i < balls; ++i) {
      Block b;
      b.kind = Block::Kind::fall;
      b.constructed = true;
      b.state = add_state(fmt::format("b{}", i), i == 0 ? 0 : distance);
      add_state(fmt::format("b{}'", i), i == 0 ? speed : 0);
      b.in_mode.resize(1);
      model_.blocks.push_back(b);
    }
    for (int i = 0; i + 1 < balls; ++i) {
      Comparison touch{.left = state(2 * i + 2) - state(2 * i), .right = number(0)};
      touch.contact = i > 0;
      Event e{.kind = Event::Kind::falls, .comparison = add(touch)};
      e.actions.push_back({.target = 2 * i + 1, .value = state(2 * i + 3)});
      e.actions.push_back({.target = 2 * i + 3, .value = state(2 * i + 1)});
      model_.events.push_back(e);
    }
    plain_block(9);
  }

  void unknowns() {
    const int count = whole_int(1, 2);
    for (int i = 0; i < count; ++i) {
      Unknown u;
      u.variant = whole_int(0, 1);
      u.cubic = chance(0.4);
      u.source = number(signed_decimal(0.3, 2)) * state(any_of(plain_));
      if (chance(0.4)) u.source = u.source + number(signed_decimal(0.3, 1)) * state(any_of(plain_));
      if (chance(0.4)) {
        const double w = rate();
        seen(2 * w);
        u.source = u.source - sine(number(w) * time_now());
      }
      u.offset = {signed_decimal(0, 1)};
      if (!u.cubic && model_.modes > 1 && chance(0.6)) {
        while (u.offset.size() < static_cast<std::size_t>(model_.modes)) u.offset.push_back(signed_decimal(0, 1));
      }
      model_.unknowns.push_back(u);
    }
  }

  // ---- events ----
  int add(const Comparison& c) {
    const auto same = std::ranges::find(model_.comparisons, c);
    if (same != model_.comparisons.end()) return static_cast<int>(same - model_.comparisons.begin());
    model_.comparisons.push_back(c);
    return static_cast<int>(model_.comparisons.size()) - 1;
  }

  /// A value of the expression along the motion from the start, without its events.
  double level_of(const Expression& e) {
    std::vector<Real> x(model_.initial.begin(), model_.initial.end());
    const Flow flow(model_, 0, 0, x);
    return std::round(1000 * static_cast<double>(
                                 evaluate(e, flow.at(static_cast<Real>(model_.end_time() * decimal(0, 1)))).value())) /
           1000;
  }

  Expression moving() {
    if (!model_.unknowns.empty() && chance(0.4))
      return unknown(whole_int(0, static_cast<int>(model_.unknowns.size()) - 1));
    if (!moved_.empty() && chance(0.4)) return state(any_of(moved_));
    return state(any_of(plain_));
  }

  Comparison comparison() {
    using Form = Comparison::Form;
    if (!flags_.empty() && chance(0.15)) return {.left = state(any_of(flags_)), .right = number(0.5), .discrete = true};
    if (!counters_.empty() && chance(0.15))
      return {.left = state(any_of(counters_)), .right = number(whole_int(0, 4) + 0.5), .discrete = true};
    if (!inputs_.empty() && chance(0.2))
      return {.left = state(inputs_[0]), .right = number(chance(0.7) ? 0.5 : 0.0005), .discrete = true};
    Comparison c;
    const int kind = whole_int(0, 13);
    if (kind <= 3) {
      c.left = moving();
    } else if (kind == 4) {
      c.left = moving() + number(signed_decimal(0.2, 1.5)) * moving();
    } else if (kind == 5) {
      c.left = moving() * moving();
    } else if (kind == 6) {
      const Expression a = moving(), b = moving();
      c.left = a * a + b * b;
    } else if (kind == 7) {
      const double w = rate();
      seen(2 * w);
      c.left = moving() - number(signed_decimal(0.1, 0.8)) * sine(number(w) * time_now());
    } else if (kind == 8) {
      const double s = decimal(0.5, 2);
      seen(8 * s);
      c.left = sine(number(s) * moving());
    } else if (kind == 9) {
      c.form = Form::absolute;
      c.left = moving();
      c.right = number(std::max(0.05, std::fabs(level_of(c.left))));
      return c;
    } else if (kind == 10) {
      c.form = Form::pulse;
      const Expression m = chance(0.5) ? time_now() : moving();
      c.left = m - number(level_of(m));
      c.right = number(0.5);
      c.width = chance(0.5) ? 0.01 : decimal(0.01, 0.3);
      return c;
    } else if (kind == 11) {
      c.form = Form::steps;
      c.width = decimal(0.4, 2);
      c.left = moving();
      c.right = number(std::floor(level_of(c.left) / c.width) + 0.5);
      return c;
    } else {
      c.form = kind == 12 ? Form::square : Form::modulo;
      c.width = decimal(0.4, 2);
      c.left = chance(0.5) ? time_now() : moving();
      c.right = number(std::round(c.width * decimal(0.1, 0.9) * 1000) / 1000);
      seen(10 / c.width);
      return c;
    }
    c.right = number(level_of(c.left));
    return c;
  }

  Condition simple_condition(bool strict) {
    using Kind = Condition::Kind;
    if (!counters_.empty() && chance(0.1)) {
      const Comparison same{.left = state(any_of(counters_)), .right = number(whole_int(1, 4)), .discrete = true};
      return {.kind = any_of(std::vector<Kind>{Kind::equal, Kind::greater_equal, Kind::greater}),
              .comparison = add(same)};
    }
    const std::vector<Kind> all{Kind::less, Kind::greater, Kind::less_equal, Kind::greater_equal};
    Kind kind = any_of(all);
    if (strict) kind = chance(0.5) ? Kind::less : Kind::greater;
    // A condition on the function of a directed guard fires at the same instant.
    const bool shared = !directed_.empty() && chance(0.12);
    return {.kind = kind, .comparison = shared ? any_of(directed_) : add(comparison())};
  }

  /// Two to four comparisons, or a narrow window.
  Condition condition() {
    using Kind = Condition::Kind;
    if (chance(0.2)) return simple_condition(false);
    if (chance(0.35)) return windows();
    Condition c{.kind = chance(0.5) ? Kind::all : Kind::any};
    const int count = whole_int(2, 4);
    for (int i = 0; i < count; ++i) c.parts.push_back(maybe_negated(simple_condition(false)));
    if (count == 4 && chance(0.5)) {
      Condition inner{.kind = c.kind == Kind::all ? Kind::any : Kind::all};
      inner.parts.assign(c.parts.begin() + 2, c.parts.end());
      c.parts.resize(2);
      c.parts.push_back(inner);
    }
    return maybe_negated(c);
  }

  Condition maybe_negated(Condition c) {
    if (!chance(0.15)) return c;
    return {.kind = Condition::Kind::negation, .parts = {std::move(c)}};
  }

  Condition window(const Expression& e) {
    using Kind = Condition::Kind;
    const double low = level_of(e), width = chance(0.5) ? 0.001 : decimal(0.001, 0.1);
    Condition c{.kind = Kind::all};
    c.parts.push_back({.kind = Kind::greater, .comparison = add({.left = e, .right = number(low)})});
    const double high = std::round((low + width) * 1000) / 1000;
    c.parts.push_back({.kind = Kind::less, .comparison = add({.left = e, .right = number(high)})});
    return c;
  }

  Condition windows() {
    const Expression e = chance(0.3) ? time_now() : moving();
    if (chance(0.5)) return window(e);
    return {.kind = Condition::Kind::any, .parts = {window(e), window(chance(0.5) ? e : moving())}};
  }

  void events() {
    using Kind = Event::Kind;
    Event e;
    const int kind = whole_int(0, 9);
    if (kind == 0) {
      e.kind = Kind::at;
      e.time = chance(0.2) ? model_.end : 100 * whole(1, model_.end / 100);
    } else if (kind <= 2) {
      e.kind = Kind::every;
      e.time = any_of(std::vector<long>{100, 200, 250, 300, 400, 500, 700, 1000, 1100});
      if (chance(0.3)) e.from = 100 * whole(1, 15);
    } else if (kind <= 6) {
      e.kind = any_of(std::vector<Kind>{Kind::falls, Kind::rises, Kind::crosses});
      if (!directed_.empty() && chance(0.3)) {
        e.comparison = any_of(directed_);
      } else {
        e.comparison = add(comparison());
        directed_.push_back(e.comparison);
      }
    } else {
      e.kind = Kind::condition;
      e.condition = condition();
    }
    if (model_.modes > 1 && chance(0.4) && kind > 2) e.in_mode = whole_int(0, model_.modes - 1);
    e.actions = actions(e);
    model_.events.push_back(e);
  }

  /// Each event is caused by the one before, all at one instant; they are written in any order.
  void dominoes() {
    const int n = any_of(counters_), count = whole_int(3, 6);
    std::vector<Event> row;
    for (int i = 0; i < count; ++i) {
      Event e{.kind = Event::Kind::condition};
      const Comparison fallen{.left = state(n), .right = number(100 + i), .discrete = true};
      e.condition = {.kind = Condition::Kind::equal, .comparison = add(fallen)};
      e.actions.push_back({.target = n, .value = number(101 + i)});
      if (chance(0.4)) e.actions.push_back({.target = any_of(plain_), .value = number(signed_decimal(0.1, 2))});
      row.push_back(e);
    }
    Event first{.kind = Event::Kind::at, .time = 100 * whole(1, model_.end / 100)};
    first.actions.push_back({.target = n, .value = number(100)});
    row.push_back(first);
    while (!row.empty()) {
      const auto next = row.begin() + whole(0, static_cast<long>(row.size()) - 1);
      model_.events.push_back(*next);
      row.erase(next);
    }
  }

  std::vector<Action> actions(const Event& e) {
    std::vector<Action> list;
    assigned_.clear();
    const int count = whole_int(0, 3);
    // Users often write bouncing balls and oscillations between two levels.
    if (e.comparison != none && chance(0.4)) add_to(list, reset(e));
    // Two numbers change places.
    if (chance(0.08) && plain_.size() > 1) {
      const int x = any_of(plain_), y = any_of(plain_);
      if (add_to(list, {.target = x, .value = state(y)})) add_to(list, {.target = y, .value = state(x)});
    }
    for (int i = 0; i < count; ++i) add_to(list, action());
    return list;
  }

  /// Adds the action, unless the event has already assigned its target: the language refuses a second assignment.
  bool add_to(std::vector<Action>& list, Action action) {
    std::set<int> targets;
    gather_targets(action, targets);
    for (const int target : targets) {
      if (assigned_.contains(target)) return false;
    }
    if (action.target == none) return false;
    assigned_.merge(targets);
    list.push_back(std::move(action));
    return true;
  }

  /// States, and -2 for the mode.
  static void gather_targets(const Action& action, std::set<int>& targets) {
    if (action.kind == Action::Kind::assign) targets.insert(action.target);
    if (action.kind == Action::Kind::go) targets.insert(-2);
    for (const Action& inner : action.chosen) gather_targets(inner, targets);
    for (const Action& inner : action.otherwise) gather_targets(inner, targets);
  }

  Action reset(const Event& e) {
    const Comparison& c = model_.comparisons[static_cast<std::size_t>(e.comparison)];
    if (c.form != Comparison::Form::plain || c.left.kind != Expression::Kind::state || c.discrete)
      return {.target = none};
    const int x = c.left.index;
    for (const Block& b : model_.blocks) {
      if (b.state == x && b.states() == 2 && b.kind == Block::Kind::fall)
        return {.target = x + 1, .value = number(-decimal(0.3, 1)) * state(x + 1)};
    }
    const double other = c.right.number + (e.kind == Event::Kind::falls ? 1 : -1) * decimal(0.3, 2);
    return {.target = x, .value = number(std::round(other * 1000) / 1000)};
  }

  Action action() {
    const int kind = whole_int(0, 9);
    if (kind <= 2 && !counters_.empty()) {
      const int n = any_of(counters_);
      if (chance(0.2)) return {.target = n, .value = number(2) * state(n) + number(1)};
      if (chance(0.2)) return {.target = n, .value = number(0)};
      return {.target = n, .value = state(n) + number(1)};
    }
    if (kind <= 4 && !flags_.empty()) {
      const int f = any_of(flags_);
      if (chance(0.4)) return {.target = f, .value = number(1) - state(f)};
      return {.target = f, .value = number(whole_int(0, 1))};
    }
    if (kind == 5 && model_.modes > 1) return {.kind = Action::Kind::go, .target = whole_int(0, model_.modes - 1)};
    if (kind == 6) {
      Action choice{.kind = Action::Kind::choose, .condition = simple_condition(true)};
      choice.chosen.push_back(action());
      if (chance(0.5)) choice.otherwise.push_back(action());
      std::erase_if(choice.chosen, [](const Action& a) { return a.target == none; });
      std::erase_if(choice.otherwise, [](const Action& a) { return a.target == none; });
      if (choice.chosen.empty()) choice.target = none;
      return choice;
    }
    const int x = !moved_.empty() && chance(0.3) ? any_of(moved_) : any_of(plain_);
    if (chance(0.3)) return {.target = x, .value = number(signed_decimal(0, 2))};
    Expression value = number(signed_decimal(0.2, 1)) * state(x);
    if (chance(0.5)) value = value + number(signed_decimal(0.2, 0.8)) * moving();
    if (chance(0.5)) value = value + number(signed_decimal(0, 1));
    return {.target = x, .value = value};
  }

  Random random_;
  Ability ability_;
  HybridModel model_{};
  std::vector<int> plain_{}, moved_{}, flags_{}, inputs_{}, counters_{}, directed_{};
  std::set<int> assigned_{};  // by the event in work
};

}  // namespace

HybridModel random_model(std::uint64_t seed, const Ability& ability) {
  return Generator(seed, ability).model();
}

}  // namespace continuo::hybrid
