// tests/hybrid/hybrid_model.cpp
#include <utility>

#include <fmt/format.h>
#include <tests/hybrid/hybrid_model.hpp>

namespace continuo::hybrid {
namespace {

Expression joined(Expression::Kind kind, Expression a, Expression b) {
  return {kind, 0, none, {std::move(a), std::move(b)}};
}

/// Writes one model.
class Writer {
 public:
  explicit Writer(const HybridModel& model) : model_(model) {}

  std::string text() const {
    std::string text;
    for (std::size_t u = 0; u < model_.unknowns.size(); ++u) text += fmt::format("unknown u{} = 0\n", u);
    for (std::size_t c = 0; c < model_.comparisons.size(); ++c) text += square_wave(c);
    for (const Block& block : model_.blocks) {
      if (block.in_mode.size() == 1) text += equations(block, 0);
    }
    for (std::size_t u = 0; u < model_.unknowns.size(); ++u) {
      if (model_.unknowns[u].offset.size() == 1) text += algebraic(u, 0);
    }
    for (int mode = 0; model_.modes > 1 && mode < model_.modes; ++mode) text += mode_text(mode);
    for (const Block& block : model_.blocks) {
      if (!block.is_input) text += starts(block);
    }
    for (std::size_t e = 0; e < model_.events.size(); ++e) text += event(e);
    return text + fmt::format("run 0..{}\n", model_.end_time());
  }

 private:
  std::string starts(const Block& b) const {
    std::string text;
    for (int s = b.state; s < b.state + b.states(); ++s)
      text += fmt::format("{}(0) = {}\n", name(s), model_.initial[static_cast<std::size_t>(s)]);
    return text;
  }

  std::string square_wave(std::size_t index) const {
    const Comparison& c = model_.comparisons[index];
    if (c.form != Comparison::Form::square) return "";
    return fmt::format("let w{} = if mod({}, {}) < {} then 1 else 0\n", index, written(c.left), c.width,
                       written(c.right));
  }

  std::string mode_text(int mode) const {
    std::string text = fmt::format("mode m{} {{\n", mode);
    for (const Block& block : model_.blocks) {
      if (block.in_mode.size() > 1) text += equations(block, mode);
    }
    for (std::size_t u = 0; u < model_.unknowns.size(); ++u) {
      if (model_.unknowns[u].offset.size() > 1) text += algebraic(u, mode);
    }
    return text + "}\n";
  }

  const std::string& name(int state) const { return model_.names[static_cast<std::size_t>(state)]; }

  std::string written(const Expression& e) const {
    using Kind = Expression::Kind;
    switch (e.kind) {
      case Kind::number:
        return e.number < 0 ? fmt::format("({})", e.number) : fmt::format("{}", e.number);
      case Kind::time:
        return "t";
      case Kind::state:
        return name(e.index);
      case Kind::unknown:
        return fmt::format("u{}", e.index);
      case Kind::sum:
        return fmt::format("({} + {})", written(e.parts[0]), written(e.parts[1]));
      case Kind::difference:
        return fmt::format("({} - {})", written(e.parts[0]), written(e.parts[1]));
      case Kind::product:
        return fmt::format("{}*{}", written(e.parts[0]), written(e.parts[1]));
      case Kind::sine:
        return fmt::format("sin({})", written(e.parts[0]));
    }
    return {};
  }

  std::string right(const Comparison& c) const { return c.form == Comparison::Form::square ? "0.5" : written(c.right); }

  std::string left(const Comparison& c) const {
    using Form = Comparison::Form;
    switch (c.form) {
      case Form::plain:
        return written(c.left);
      case Form::absolute:
        return fmt::format("abs({})", written(c.left));
      case Form::pulse:
        return fmt::format("exp(-({}/{})^2)", written(c.left), c.width);
      case Form::steps:
        return fmt::format("floor({}/{})", written(c.left), c.width);
      case Form::square:
        return fmt::format("w{}", &c - model_.comparisons.data());
      case Form::modulo:
        return fmt::format("mod({}, {})", written(c.left), c.width);
    }
    return {};
  }

  std::string condition(const Condition& c) const {
    using Kind = Condition::Kind;
    if (c.kind == Kind::negation) return fmt::format("not ({})", condition(c.parts[0]));
    if (c.kind == Kind::all || c.kind == Kind::any) {
      std::string text;
      for (const Condition& part : c.parts) {
        if (!text.empty()) text += c.kind == Kind::all ? " and " : " or ";
        text += fmt::format("({})", condition(part));
      }
      return text;
    }
    const Comparison& sides = model_.comparisons[static_cast<std::size_t>(c.comparison)];
    const char* sign = c.kind == Kind::less            ? "<"
                       : c.kind == Kind::less_equal    ? "<="
                       : c.kind == Kind::greater       ? ">"
                       : c.kind == Kind::greater_equal ? ">="
                                                       : "==";
    return fmt::format("{} {} {}", left(sides), sign, right(sides));
  }

  std::string actions(const std::vector<Action>& list) const {
    std::string text;
    for (const Action& action : list) {
      if (!text.empty()) text += "; ";
      switch (action.kind) {
        case Action::Kind::assign:
          text += fmt::format("{} := {}", name(action.target), written(action.value));
          break;
        case Action::Kind::go:
          text += fmt::format("go m{}", action.target);
          break;
        case Action::Kind::choose:
          text += fmt::format("if {} {{ {} }}", condition(action.condition), actions(action.chosen));
          if (!action.otherwise.empty()) text += fmt::format(" else {{ {} }}", actions(action.otherwise));
      }
    }
    return text;
  }

  std::string event(std::size_t index) const {
    const Event& e = model_.events[index];
    if (e.is_step) return "";
    const auto decimal = [](long thousandths) { return static_cast<double>(thousandths) / 1000; };
    std::string head;
    if (e.kind == Event::Kind::at) {
      head = fmt::format("at {}", decimal(e.time));
    } else if (e.kind == Event::Kind::every) {
      head = fmt::format("every {}", decimal(e.time));
      if (e.from != none) head += fmt::format(" from {}", decimal(e.from));
    } else if (e.kind == Event::Kind::condition) {
      head = fmt::format("when {}", condition(e.condition));
    } else {
      const Comparison& sides = model_.comparisons[static_cast<std::size_t>(e.comparison)];
      const char* direction = e.kind == Event::Kind::falls   ? "falls"
                              : e.kind == Event::Kind::rises ? "rises"
                                                             : "crosses";
      head = fmt::format("when {} {} through {}", left(sides), direction, right(sides));
    }
    if (e.in_mode != none) head += fmt::format(" in m{}", e.in_mode);
    const std::string list = actions(e.actions);
    return fmt::format("{} {{ {}{}mark \"e{}\" }}\n", head, list, list.empty() ? "" : "; ", index);
  }

  std::string algebraic(std::size_t index, int mode) const {
    const Unknown& u = model_.unknowns[index];
    const std::string s = written(u.source);
    if (u.cubic) return fmt::format("0 = u{} + u{}^3 - {}\n", index, index, s);
    const double offset = u.offset.size() == 1 ? u.offset[0] : u.offset[static_cast<std::size_t>(mode)];
    if (u.variant == 0) return fmt::format("0 = u{} - {} - {}\n", index, s, offset);
    return fmt::format("0 = 2*{} - 2*u{} + {}\n", s, index, 2 * offset);
  }

  std::string equations(const Block& b, int mode) const {
    using Kind = Block::Kind;
    const Block::Parameters& p = b.parameters(mode);
    const std::string x = name(b.state);
    const std::string flag = b.flag == none ? "" : fmt::format(" + {}*{}", p.b, name(b.flag));
    switch (b.kind) {
      case Kind::discrete:
        if (b.is_input) return fmt::format("input {} = 0 from \"{}\" step\n", x, input_file(model_, b));
        return fmt::format("{}' = 0\n", x);
      case Kind::drift:
        return fmt::format("{}' = {}{}\n", x, p.a, flag);
      case Kind::decay:
        if (b.through != none) return fmt::format("{}' = u{}\n", x, b.through);
        return fmt::format("{}' = -{}*{} + {}{}\n", x, p.k, x, p.c, flag);
      case Kind::driven:
        return fmt::format("{}' = {}*cos({}*t) + {}\n", x, p.a, p.w, p.c);
      case Kind::driven_decay:
        return fmt::format("{}' = -{}*({} - {}*cos({}*t)) + {}\n", x, p.k, x, p.a, p.w, p.c);
      case Kind::fall:
        return fmt::format("{}'' = {}{}\n", x, p.a, flag);
      case Kind::oscillator:
        return fmt::format("{}'' = -{}*{}*({} - {})\n", x, p.w, p.w, x, p.c);
      case Kind::switched:
        return switched(b, p, x);
      case Kind::kink:
        if (b.variant == 0) return fmt::format("{}' = {}*abs({}) + {}\n", x, p.a, written(b.surface), p.c);
        return fmt::format("{}' = {}*max({}, -{}) + {}\n", x, p.a, written(b.surface), written(b.surface), p.c);
      case Kind::staircase:
        return fmt::format("{}' = {}*floor({}/{})\n", x, p.a, written(b.surface), b.width);
      case Kind::sawtooth:
        return fmt::format("{}' = {}*mod({}, {})\n", x, p.a, written(b.surface), b.width);
      case Kind::relay:
        return relay(b, p, x);
    }
    return {};
  }

  std::string switched(const Block& b, const Block::Parameters& p, const std::string& x) const {
    const std::string s = written(b.surface);
    if (b.also.kind != Expression::Kind::number)
      return fmt::format("{}' = if {} > 0 and {} > 0 then {} else {}\n", x, s, written(b.also), p.a, p.c);
    if (b.variant == 0) return fmt::format("{}' = if {} > 0 then {} else {}\n", x, s, p.a, p.c);
    if (b.variant == 1) return fmt::format("{}' = if not ({} > 0) then {} else {}\n", x, s, p.c, p.a);
    // The mean of the two and half their difference, written out: sums of decimals that are sufficiently exact.
    return fmt::format("{}' = ({} + {})/2 + ({} - {})/2*sign({})\n", x, p.a, p.c, p.a, p.c, s);
  }

  std::string relay(const Block& b, const Block::Parameters& p, const std::string& x) const {
    const std::string flag = b.flag == none ? "" : fmt::format(" + {}*{}", p.b, name(b.flag));
    const std::string drive = b.drive == none ? fmt::format("{}*sin({}*t) + {}{}", p.a, p.w, p.c, flag)
                                              : fmt::format("{}*{} + {}{}", p.a, name(b.drive), p.c, flag);
    std::string text;
    if (b.variant == 0) {
      text = fmt::format("{}' = {} - {}*sign({} - {})\n", x, drive, p.mu, x, b.level);
    } else if (b.variant == 1) {
      text = fmt::format("{}' = {} + (if {} > {} then -{} else {})\n", x, drive, x, b.level, p.mu, p.mu);
    } else {
      text = fmt::format("{}' = if {} < {} then {} + {} else {} - {}\n", x, x, b.level, drive, p.mu, drive, p.mu);
    }
    if (b.with_position) text += fmt::format("{}' = {}\n", name(b.state + 1), x);
    return text;
  }

  const HybridModel& model_;
};

}  // namespace

Expression number(double value) {
  return {Expression::Kind::number, value, none, {}};
}
Expression time_now() {
  return {Expression::Kind::time, 0, none, {}};
}
Expression state(int index) {
  return {Expression::Kind::state, 0, index, {}};
}
Expression unknown(int index) {
  return {Expression::Kind::unknown, 0, index, {}};
}
Expression operator+(Expression a, Expression b) {
  return joined(Expression::Kind::sum, std::move(a), std::move(b));
}
Expression operator-(Expression a, Expression b) {
  return joined(Expression::Kind::difference, std::move(a), std::move(b));
}
Expression operator*(Expression a, Expression b) {
  return joined(Expression::Kind::product, std::move(a), std::move(b));
}
Expression sine(Expression a) {
  Expression e;
  e.kind = Expression::Kind::sine;
  e.parts.push_back(std::move(a));
  return e;
}

bool operator==(const Expression& a, const Expression& b) {
  return a.kind == b.kind && a.number == b.number && a.index == b.index && a.parts == b.parts;
}

std::string input_file(const HybridModel& model, const Block& block) {
  return model.names[static_cast<std::size_t>(block.state)] + ".csv";
}

std::string input_table(const HybridModel& model, const Block& block) {
  std::string text = fmt::format("t,v\n0,{}\n", model.initial[static_cast<std::size_t>(block.state)]);
  for (const Event& e : model.events) {
    if (e.is_step && e.actions[0].target == block.state)
      text += fmt::format("{},{}\n", static_cast<double>(e.time) / 1000, e.actions[0].value.number);
  }
  return text;
}

std::string text_of(const HybridModel& model) {
  return Writer(model).text();
}

}  // namespace continuo::hybrid
