// tests/hybrid/flow.cpp
#include <cmath>
#include <numbers>

#include <tests/hybrid/flow.hpp>

namespace continuo::hybrid {
namespace {

constexpr Real pi = std::numbers::pi_v<Real>;

/// a cos(w (t0 + s)) as a sinusoid of s, times a factor and with a phase: amplitude cos(w s + phase).
void add_cosine(Closed& x, Real amplitude, Real w, Real phase) {
  x.w = w;
  x.a += amplitude * std::cos(phase);
  x.b -= amplitude * std::sin(phase);
}

/// The antiderivative that has the value `start` at s = 0, of a motion whose cubic term is 0.
Closed integral(const Closed& v, Real start) {
  Closed x;
  for (std::size_t i = 0; i < 3; ++i) x.p[i + 1] = v.p[i] / static_cast<Real>(i + 1);
  x.w = v.w;
  if (v.w != 0) {
    x.a = -v.b / v.w;
    x.b = v.a / v.w;
  }
  if (v.c != 0) {
    x.k = v.k;
    x.c = -v.c / v.k;
  }
  x.p[0] = start - x.a - x.c;
  return x;
}

/// factor * v + constant
Closed scaled(Closed v, Real factor, Real constant) {
  for (Real& p : v.p) p *= factor;
  v.c *= factor;
  v.a *= factor;
  v.b *= factor;
  v.p[0] += constant;
  return v;
}

}  // namespace

Real Closed::value(Real s) const {
  Real r = p[0] + s * (p[1] + s * (p[2] + s * p[3]));
  if (c != 0) r += c * std::exp(-k * s);
  if (a != 0 || b != 0) r += a * std::cos(w * s) + b * std::sin(w * s);
  return r;
}

Jet Closed::at(Real s) const {
  Jet r{{p[0] + s * (p[1] + s * (p[2] + s * p[3])), p[1] + s * (2 * p[2] + 3 * s * p[3]), p[2] + 3 * s * p[3], p[3]}};
  if (c != 0) {
    const Real e = c * std::exp(-k * s);
    r = r + Jet{{e, -k * e, k * k * e / 2, -k * k * k * e / 6}};
  }
  if (a != 0 || b != 0) {
    const Real cosine = std::cos(w * s), sine = std::sin(w * s);
    const Real f = a * cosine + b * sine, g = b * cosine - a * sine;
    r = r + Jet{{f, w * g, -w * w * f / 2, -w * w * w * g / 6}};
  }
  return r;
}

Jet evaluate(const Expression& e, const Quantities& q) {
  using Kind = Expression::Kind;
  switch (e.kind) {
    case Kind::number:
      return Jet::constant(e.number);
    case Kind::time:
      return q.time;
    case Kind::state:
      return q.states[static_cast<std::size_t>(e.index)];
    case Kind::unknown:
      return q.unknowns[static_cast<std::size_t>(e.index)];
    case Kind::sum:
      return evaluate(e.parts[0], q) + evaluate(e.parts[1], q);
    case Kind::difference:
      return evaluate(e.parts[0], q) - evaluate(e.parts[1], q);
    case Kind::product:
      return evaluate(e.parts[0], q) * evaluate(e.parts[1], q);
    case Kind::sine:
      return sine_cosine(evaluate(e.parts[0], q)).sine;
  }
  return {};
}

Jet evaluate(const Comparison& c, const Quantities& q) {
  using Form = Comparison::Form;
  const Jet left = evaluate(c.left, q), right = evaluate(c.right, q);
  const Real width = c.width;
  switch (c.form) {
    case Form::plain:
      return left - right;
    case Form::absolute:
      return left * left - right * right;
    case Form::pulse:
      return Jet::constant(width * std::log(2.0L)) - (1 / width) * left * left;
    case Form::steps:
      return left - Jet::constant(width * (right.value() + 0.5L));
    case Form::square:
      return sine_cosine(pi / width * left).sine * sine_cosine(pi / width * (right - left)).sine;
    case Form::modulo:
      // For left/width = n + f: the signs of the two sines are equal iff f > right/width.
      return sine_cosine(pi / width * left).sine * sine_cosine(pi / width * (left - right)).sine;
  }
  return {};
}

int sign_just_after(const Jet& g, std::string& doubt) {
  Margin margin = value_margin;
  for (const Real c : g.c) {
    const Real size = std::fabs(c);
    if (size > margin.clear) return c > 0 ? 1 : -1;
    if (size > margin.zero) doubt = "a value near its threshold";
    margin = derivative_margin;
  }
  return 0;
}

Flow::Flow(const HybridModel& model, int mode, Real t, std::span<const Real> x)
    : model_(model), mode_(mode), t0_(t), closed_(x.size()) {
  for (const Block& block : model.blocks) start(block, x);
  // Switching blocks read only blocks that do not switch, which are complete by now.
  Quantities now;
  now.time.c = {t0_, 1, 0, 0};
  for (const Closed& state : closed_) now.states.push_back(state.at(0));
  for (const Block& block : model.blocks) {
    if (block.kind == Block::Kind::relay) start_relay(block, x, now);
    start_switching(block, x, now);
  }
}

int Flow::sign(const Jet& g) {
  const int s = sign_just_after(g, doubt_);
  if (s == 0) doubt_ = "equations that stay at a switching surface";
  return s;
}

void Flow::start(const Block& block, std::span<const Real> x) {
  using Kind = Block::Kind;
  const Block::Parameters& p = block.parameters(mode_);
  const auto i = static_cast<std::size_t>(block.state);
  const Real x0 = x[i], w = p.w, k = p.k;
  const Real push = block.flag == none ? 0 : p.b * x[static_cast<std::size_t>(block.flag)];
  Closed& f = closed(block.state);
  switch (block.kind) {
    case Kind::discrete:
      f.p[0] = x0;
      break;
    case Kind::drift:
      f.p = {x0, p.a + push, 0, 0};
      break;
    case Kind::decay:
      f.p[0] = (p.c + push) / k;
      f.c = x0 - f.p[0];
      f.k = k;
      break;
    case Kind::driven: {
      Closed slope;
      slope.p[0] = p.c;
      add_cosine(slope, p.a, w, w * t0_);
      f = integral(slope, x0);
      break;
    }
    case Kind::driven_decay: {
      // x' + k x = k a cos(w t) + c has the solution c/k + k a (k cos(w t) + w sin(w t))/(k^2 + w^2).
      const Real factor = k * p.a / (k * k + w * w);
      f.p[0] = p.c / k;
      add_cosine(f, factor * k, w, w * t0_);
      add_cosine(f, factor * w, w, w * t0_ - pi / 2);
      f.c = x0 - f.p[0] - f.a;
      f.k = k;
      break;
    }
    case Kind::fall:
      f.p = {x0, x[i + 1], (p.a + push) / 2, 0};
      closed_[i + 1].p = {x[i + 1], p.a + push, 0, 0};
      break;
    case Kind::oscillator:
      f.p[0] = p.c;
      f.w = closed_[i + 1].w = w;
      f.a = x0 - p.c;
      f.b = x[i + 1] / w;
      closed_[i + 1].a = w * f.b;
      closed_[i + 1].b = -w * f.a;
      break;
    case Kind::switched:
    case Kind::kink:
    case Kind::staircase:
    case Kind::sawtooth:
    case Kind::relay:
      break;
  }
}

void Flow::start_switching(const Block& block, std::span<const Real> x, const Quantities& now) {
  using Kind = Block::Kind;
  if (block.kind != Kind::switched && block.kind != Kind::kink && block.kind != Kind::staircase &&
      block.kind != Kind::sawtooth)
    return;
  const Block::Parameters& p = block.parameters(mode_);
  const Real x0 = x[static_cast<std::size_t>(block.state)], width = block.width;
  Closed& f = closed(block.state);
  const Jet s = evaluate(block.surface, now);
  if (block.kind == Kind::switched) {
    bool above = sign(s) > 0;
    surfaces_.push_back({block.surface, false});
    if (block.also.kind != Expression::Kind::number) {
      above = sign(evaluate(block.also, now)) > 0 && above;
      surfaces_.push_back({block.also, false});
    }
    f.p = {x0, above ? p.a : p.c, 0, 0};
    return;
  }
  if (block.kind == Kind::kink) {
    // S is a state less a number.
    const Real factor = sign(s) > 0 ? p.a : -p.a, level = block.surface.parts[1].number;
    f = integral(scaled(closed(block.surface.parts[0].index), factor, p.c - factor * level), x0);
    surfaces_.push_back({block.surface, false});
    return;
  }
  const Jet z = (1 / width) * s;
  const Real nearest = std::round(z.value());
  const Real whole = sign(z - Jet::constant(nearest)) > 0 ? nearest : nearest - 1;
  if (block.kind == Kind::staircase) {
    f.p = {x0, p.a * whole, 0, 0};
  } else {
    // z is at most of the second degree in time.
    f.p = {x0, p.a * (s.c[0] - width * whole), p.a * s.c[1] / 2, p.a * s.c[2] / 3};
  }
  surfaces_.push_back({sine(number(static_cast<double>(pi)) * (number(1 / block.width) * block.surface)), true});
}

void Flow::start_relay(const Block& block, std::span<const Real> x, const Quantities& now) {
  const Block::Parameters& p = block.parameters(mode_);
  const auto i = static_cast<std::size_t>(block.state);
  const Real constant = p.c + (block.flag == none ? 0 : p.b * x[static_cast<std::size_t>(block.flag)]);
  const Expression moving = number(p.a) * (block.drive == none ? sine(number(p.w) * time_now()) : state(block.drive));
  const Expression drive = moving + number(static_cast<double>(constant));
  const Expression beyond_above = drive - number(p.mu), beyond_below = drive + number(p.mu);
  const Real distance = x[i] - block.level;
  int side = std::fabs(distance) > value_margin.zero ? (distance > 0 ? 1 : -1) : 0;
  if (side != 0 && std::fabs(distance) < value_margin.clear) doubt_ = "a relay near its surface";
  if (side == 0) {
    // On the surface the drive determines the motion: it sticks as long as the drive is weaker than the friction.
    if (sign(evaluate(beyond_above, now)) > 0) {
      side = 1;
    } else if (sign(evaluate(beyond_below, now)) < 0) {
      side = -1;
    }
    // A state that leaves its surface slowly after an event may return before the next sample.
    constexpr Real little = 0.02L;
    const Real speed = side == 0 ? 0 : std::fabs(evaluate(side > 0 ? beyond_above : beyond_below, now).value());
    if (speed > value_margin.zero && speed < little) doubt_ = "a relay that hardly leaves its surface";
  }
  Closed& f = closed(block.state);
  if (side == 0) {
    f.p[0] = x[i];
    surfaces_.push_back({beyond_above, false});
    surfaces_.push_back({beyond_below, false});
    ++sliding_;
  } else {
    Closed slope;
    if (block.drive == none) {
      add_cosine(slope, p.a, p.w, p.w * t0_ - pi / 2);
    } else {
      slope = scaled(closed(block.drive), p.a, 0);
    }
    slope.p[0] += constant - side * p.mu;
    f = integral(slope, x[i]);
    surfaces_.push_back({state(block.state) - number(block.level), false});
  }
  if (block.with_position) closed_[i + 1] = integral(f, x[i + 1]);
}

void Flow::solve_unknowns(Quantities& q) const {
  for (const Unknown& u : model_.unknowns) {
    const Jet s = evaluate(u.source, q);
    const double offset = u.offset.size() == 1 ? u.offset[0] : u.offset[static_cast<std::size_t>(mode_)];
    q.unknowns.push_back(u.cubic ? cubic_root(s) : s + Jet::constant(offset));
  }
}

Quantities Flow::at(Real t) const {
  Quantities q;
  q.time.c = {t, 1, 0, 0};
  q.states.reserve(closed_.size());
  for (const Closed& state : closed_) q.states.push_back(state.at(t - t0_));
  solve_unknowns(q);
  return q;
}

std::vector<Real> Flow::states_at(Real t) const {
  std::vector<Real> x;
  x.reserve(closed_.size());
  for (const Closed& state : closed_) x.push_back(state.value(t - t0_));
  return x;
}

}  // namespace continuo::hybrid
