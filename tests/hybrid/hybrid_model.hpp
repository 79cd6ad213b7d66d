// tests/hybrid/hybrid_model.hpp
// A hybrid system as an abstract structure: the text of a model and the referee's closed forms are both made from it.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace continuo::hybrid {

inline constexpr int none = -1;

/// The expressions of guards, actions and algebraic equations.
struct Expression {
  enum class Kind { number, time, state, unknown, sum, difference, product, sine };
  Kind kind = Kind::number;
  double number = 0;
  int index = none;  // of the state or unknown
  std::vector<Expression> parts{};
};

Expression number(double value);
Expression time_now();
Expression state(int index);
Expression unknown(int index);
Expression operator+(Expression a, Expression b);
Expression operator-(Expression a, Expression b);
Expression operator*(Expression a, Expression b);
Expression sine(Expression a);
bool operator==(const Expression& a, const Expression& b);

/// Two sides that are compared. All forms but the plain one have a smooth function of the same sign, which the referee
/// watches in place of the written one.
struct Comparison {
  enum class Form {
    plain,     // left against right
    absolute,  // abs(left) against right: left^2 - right^2
    pulse,     // exp(-(left/width)^2) against 0.5: width log(2) - left^2/width
    steps,     // floor(left/width) against right, a whole number and a half: left - width (right + 1/2)
    square,    // if mod(left, width) < right then 1 else 0, against 0.5: as modulo, upside down
    modulo,    // mod(left, width) against right: sin(pi left/width) sin(pi (left - right)/width)
  };
  Form form = Form::plain;
  Expression left{}, right{};  // right is a number with all but the plain form
  double width = 1;
  bool discrete = false;  // of quantities that only events change
  bool contact = false;   // may stay at zero: two bodies that touch

  bool operator==(const Comparison&) const = default;
};

/// Comparisons joined by `and`, `or`, `not`.
struct Condition {
  enum class Kind { less, less_equal, greater, greater_equal, equal, all, any, negation };
  Kind kind = Kind::greater;
  int comparison = none;  // index in the model, of the first five
  std::vector<Condition> parts{};
};

struct Action {
  enum class Kind { assign, go, choose };
  Kind kind = Kind::assign;
  int target = 0;  // the state or the mode
  Expression value{};
  Condition condition{};
  std::vector<Action> chosen{}, otherwise{};
};

/// Times in thousandths: decimals, exactly.
struct Event {
  enum class Kind { at, every, falls, rises, crosses, condition };
  Kind kind = Kind::at;
  long time = 0;          // of `at`, the period of `every`
  long from = none;       // of `every`
  int comparison = none;  // of falls, rises, crosses
  Condition condition{};
  int in_mode = none;
  std::vector<Action> actions{};
  bool is_step = false;  // of an input: `at` a time that the table of the input has, not in the text
};

/// One equation, or two: a piece of the system with a closed solution. Parameters may differ from mode to mode.
struct Block {
  enum class Kind {
    discrete,      // x' = 0, changed by events only
    drift,         // x' = a + b*flag
    decay,         // x' = -k*x + c + b*flag; or x' = u with the unknown u = -k*x + c
    driven,        // x' = a*cos(w*t) + c
    driven_decay,  // x' = -k*(x - a*cos(w*t)) + c
    fall,          // x'' = a + b*flag
    oscillator,    // x'' = -w^2*(x - c)
    switched,      // x' = if S > 0 then a else c, or with sign; or if S > 0 and also > 0
    kink,          // x' = a*abs(S) + c, or with max
    staircase,     // x' = a*floor(z/width)
    sawtooth,      // x' = a*mod(z, width)
    relay,         // x' = a*sin(w*t) + c + b*flag - mu*sign(x - level), and perhaps y' = x; or driven by a*state + c
  };
  struct Parameters {
    double a = 0, b = 0, c = 0, k = 0, w = 1, mu = 0;
  };
  Kind kind = Kind::discrete;
  int state = 0;  // the first of its states
  int flag = none;
  std::vector<Parameters> in_mode{};  // one, or one for each mode
  Expression surface{};               // S or z of switched equations: of blocks that do not switch
  Expression also{};                  // a second S; a number where there is none
  int drive = none;                   // the state that drives a relay
  int through = none;                 // the unknown through which a state decays
  double width = 1, level = 0;
  bool with_position = false;  // of a relay
  int variant = 0;             // of the ways to write it
  bool is_input = false;       // a discrete block whose value is a step function from a file
  bool constructed = false;    // its start and rates make things happen at one instant

  const Parameters& parameters(int mode) const {
    return in_mode.size() == 1 ? in_mode.front() : in_mode[static_cast<std::size_t>(mode)];
  }
  int states() const { return kind == Kind::fall || kind == Kind::oscillator || with_position ? 2 : 1; }
};

/// 0 = u - s - offset, or 0 = u + u^3 - s.
struct Unknown {
  Expression source{};  // s, of states and t
  bool cubic = false;
  std::vector<double> offset{0};  // one, or one for each mode
  int variant = 0;
};

struct HybridModel {
  int modes = 1;
  std::vector<Block> blocks{};
  std::vector<std::string> names{};
  std::vector<double> initial{};
  std::vector<Unknown> unknowns{};
  std::vector<Comparison> comparisons{};
  std::vector<Event> events{};
  long end = 1000;     // thousandths
  double fastest = 1;  // the largest rate in equations and guards; a stiff decay apart

  double end_time() const { return static_cast<double>(end) / 1000; }
};

/// The file of an input's table, in the folder of the model.
std::string input_file(const HybridModel& model, const Block& block);
/// The content of that file.
std::string input_table(const HybridModel& model, const Block& block);

/// The text of the model. Each event marks itself: `mark "e2"` is that of events[2].
std::string text_of(const HybridModel& model);

}  // namespace continuo::hybrid
