// Writes the stages, the end and the error of a step as sums of products, with all coefficients in the text.
#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_source.hpp>
#include <continuo/symbolic/native/c_step.hpp>
#include <continuo/symbolic/tape/tape_lanes.hpp>

namespace continuo::model {

namespace {

// Beyond, statements are loops, and f is a function that is called.
constexpr std::size_t most_states_unrolled = 8, most_registers_unrolled = 100, most_operations_inside = 1500;
constexpr std::size_t most_states_of_step = 16;  // of one run

constexpr std::string_view beginning =
    "struct lane_step {\n"
    "  const double *t, *x, *h;\n"
    "  long long evaluates_start, keeps_stages;\n"
    "  double *const *stages;\n"
    "  double *x_new, *square;\n"
    "  const double *rtol, *atol;\n"
    "  long long rtol_each, atol_each;\n"
    "};\n"
    "static inline lanes load(const double *from) {\n"
    "  lanes a;\n"
    "  __builtin_memcpy(&a, from, sizeof a);\n"
    "  return a;\n"
    "}\n"
    "static inline void store(lanes a, double *to) { __builtin_memcpy(to, &a, sizeof a); }\n";
constexpr std::string_view choices_of_lanes =
    "static inline lanes size_of(lanes a) { return (lanes)((lane_masks)a & ~(lane_masks)all_lanes(-0.0)); }\n"
    "static inline lanes greater(lanes a, lanes b) { return choose(a < b, b, a); }\n";
/// One run: its lanes are a number.
constexpr std::string_view single_lane =
    "#define WIDTH 1\n"
    "typedef double lanes;\n"
    "static inline lanes all_lanes(double a) { return a; }\n"
    "static inline lanes size_of(lanes a) { return fabs(a); }\n"
    "static inline lanes greater(lanes a, lanes b) { return a < b ? b : a; }\n";

/// Whether f can be written wherever it is needed.
bool is_short(const Tape& tape, const CStepFormula& formula) {
  const Tape::Size size = tape.size();
  return size.batches == 0 && size.single * (formula.b.size() + 1) <= most_operations_inside;
}

class StepText {
 public:
  /// `runs`: how many make the step together, those of TapeLanes or one.
  StepText(const Tape& tape, const CStepFormula& formula, std::size_t runs)
      : tape_(tape), formula_(formula), runs_(runs), states_(tape.states_end() - tape.states_begin()) {}

  [[nodiscard]] std::string text() {
    const std::string rates = rates_function();
    if (!formula_.b.empty()) step();
    const std::string step = std::exchange(text_, {});
    evaluate();
    const std::string all = rates + step + text_;
    if (is_single()) return std::string(single_lane) + std::string(beginning) + all;
    return c_lane_helpers(all) + std::string(beginning) + std::string(choices_of_lanes) + all;
  }

 private:
  [[nodiscard]] bool is_single() const { return runs_ == 1; }
  /// Number `i` of all runs in this array.
  [[nodiscard]] std::string element(std::string_view array, std::string_view i) const {
    return fmt::format("{} + {} * {} + part", array, runs_, i);
  }

  [[nodiscard]] std::string rates_function() const {
    const CArray states[] = {{"x", tape_.states_begin(), tape_.states_end()}};
    const std::string signature = fmt::format(
        "static inline __attribute__(({})) void rates(lanes *restrict r, const lanes *restrict x, "
        "lanes *restrict y)",
        is_short(tape_, formula_) ? "always_inline" : "noinline");
    return c_function(tape_, {.signature = signature, .arrays = states, .in_lanes = !is_single()}).text;
  }

  void line(std::string_view what) { text_ += fmt::format("  {}\n", what); }
  /// A statement for each component: i in it is the number of the component.
  template <class Statement>
  void each(std::size_t count, std::size_t most, const Statement& statement) {
    if (count > most) {
      text_ += "#pragma GCC ivdep\n";
      line(fmt::format("for (int i = 0; i < {}; ++i) {{ {} }}", count, statement("i")));
      return;
    }
    for (std::size_t i = 0; i < count; ++i) line(statement(fmt::format("{}", i)));
  }
  template <class Statement>
  void each_state(const Statement& statement) {
    each(states_, most_states_unrolled, statement);
  }

  /// The terms with a weight that is not 0, of the stages before `end`, from the first one on.
  [[nodiscard]] static std::string sum(std::span<const double> weights, std::size_t end, std::string_view i) {
    std::string text;
    for (std::size_t j = 0; j < end; ++j)
      if (weights[j] != 0)
        text += fmt::format("{}all_lanes({}) * k{}[{}]", text.empty() ? "" : " + ", number(weights[j]), j, i);
    return text.empty() ? "all_lanes(0.0)" : text;
  }
  [[nodiscard]] static std::string number(double value) { return fmt::format("{:a}", value); }

  void step() {
    const std::size_t stages = formula_.b.size();
    text_ += "static inline void take_step(lanes *restrict r, const struct lane_step *s, int part) {\n";
    line(fmt::format("lanes x[{0}], y[{0}], end[{0}];", states_));
    for (std::size_t j = 0; j < stages; ++j) line(fmt::format("lanes k{}[{}];", j, states_));
    line("const lanes t = load(s->t + part), h = load(s->h + part);");
    each_state([this](std::string_view i) { return fmt::format("x[{}] = load({});", i, element("s->x", i)); });
    line("if (s->evaluates_start) {");
    line("r[0] = t;");
    line("rates(r, x, k0);");
    line("} else {");
    each_state([this](std::string_view i) { return fmt::format("k0[{}] = load({});", i, element("s->stages[0]", i)); });
    line("}");
    for (std::size_t j = 1; j + (formula_.ends_with_f ? 1 : 0) < stages; ++j) stage(j);
    each_state([&](std::string_view i) {
      return fmt::format("end[{0}] = x[{0}] + h * ({1});", i, sum(formula_.b, stages, i));
    });
    if (formula_.ends_with_f) {
      line("r[0] = t + h;");
      line(fmt::format("rates(r, end, k{});", stages - 1));
    }
    each_state([this](std::string_view i) { return fmt::format("store(end[{}], {});", i, element("s->x_new", i)); });
    const auto keep = [&](std::size_t j) {
      each_state([this, j](std::string_view i) {
        return fmt::format("store(k{}[{}], {});", j, i, element(fmt::format("s->stages[{}]", j), i));
      });
    };
    keep(0);
    const std::size_t inner = stages - (formula_.ends_with_f ? 1 : 0);
    if (formula_.ends_with_f) keep(inner);
    line("if (s->keeps_stages) {");
    for (std::size_t j = 1; j < inner; ++j) keep(j);
    line("}");
    if (!formula_.error.empty()) error();
    text_ += "}\n";
  }
  void stage(std::size_t j) {
    const std::vector<double>& weights = formula_.a[j];
    std::size_t newest = j;
    while (newest > 0 && weights[newest - 1] == 0) --newest;
    --newest;
    const std::string last = fmt::format("k{}", newest);
    line(fmt::format("const lanes w{} = h * all_lanes({});", j, number(weights[newest])));
    const bool is_alone = std::all_of(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(newest),
                                      [](double weight) { return weight == 0; });
    each_state([&](std::string_view i) {
      if (is_alone) return fmt::format("y[{0}] = x[{0}] + w{1} * {2}[{0}];", i, j, last);
      return fmt::format("y[{0}] = (x[{0}] + h * ({1})) + w{2} * {3}[{0}];", i, sum(weights, newest, i), j, last);
    });
    const double c = formula_.c[j];
    line(c == 0 ? "r[0] = t;" : c == 1 ? "r[0] = t + h;" : fmt::format("r[0] = t + h * all_lanes({});", number(c)));
    line(fmt::format("rates(r, y, k{});", j));
  }

  void error() {
    const bool has_two = !formula_.second_error.empty();
    line("if (!s->square) return;");
    line("lanes sum = all_lanes(0.0), sum3 = all_lanes(0.0);");
    each_state([&](std::string_view i) {
      std::string text =
          fmt::format("{{ const lanes scale = load({1}) + load({2}) * greater(size_of(x[{0}]), size_of(end[{0}])); ", i,
                      element("s->atol", fmt::format("(s->atol_each * {})", i)),
                      element("s->rtol", fmt::format("(s->rtol_each * {})", i)));
      const std::string first = sum(formula_.error, formula_.error.size(), i);
      text += has_two ? fmt::format("const lanes ratio = ({}) / scale; const lanes ratio3 = ({}) / scale; ", first,
                                    sum(formula_.second_error, formula_.second_error.size(), i))
                      : fmt::format("const lanes weight = h / scale; const lanes ratio = ({}) * weight; ", first);
      text += fmt::format("sum = sum + (ratio * ratio + (end[{0}] - end[{0}])); ", i);
      return text + (has_two ? "sum3 = sum3 + ratio3 * ratio3; }" : "}");
    });
    const std::string mean = fmt::format("all_lanes({})", number(1.0 / static_cast<double>(states_)));
    if (has_two) {
      line("const lanes both = (sum + all_lanes(0.01) * sum3) + all_lanes(1e-37);");
      line(fmt::format("store((h * sum) * (h * sum) / both * {}, s->square + part);", mean));
    } else {
      line(fmt::format("store(sum * {}, s->square + part);", mean));
    }
  }

  void evaluate() {
    text_ += fmt::format(
        "void evaluate(double *restrict registers, const double *x, double *y, const struct lane_step *step) {{\n"
        "  for (int part = 0; part < {}; part += WIDTH) {{\n",
        runs_);
    registers();
    if (!formula_.b.empty()) {
      line("if (step) {");
      line("take_step(r, step, part);");
      line("continue;");
      line("}");
    }
    line(fmt::format("lanes states[{}], rates_here[{}];", std::max<std::size_t>(states_, 1),
                     std::max<std::size_t>(tape_.output_count(), 1)));
    each_state([this](std::string_view i) { return fmt::format("states[{}] = load({});", i, element("x", i)); });
    line("rates(r, states, rates_here);");
    each(tape_.output_count(), most_states_unrolled,
         [this](std::string_view i) { return fmt::format("store(rates_here[{}], {});", i, element("y", i)); });
    text_ += "  }\n}\n";
  }
  void registers() {
    if (is_single()) return line("double *const r = registers;");
    line(fmt::format("lanes r[{}];", tape_.register_count()));
    each(tape_.register_count(), most_registers_unrolled,
         [this](std::string_view i) { return fmt::format("r[{}] = load({});", i, element("registers", i)); });
  }

  const Tape& tape_;
  const CStepFormula& formula_;
  std::size_t runs_, states_;
  std::string text_;
};

}  // namespace

std::string c_lane_evaluation(const Tape& tape, const CStepFormula& formula) {
  return StepText(tape, formula, TapeLanes::width).text();
}

std::string c_step(const Tape& tape, const CStepFormula& formula) {
  return StepText(tape, formula, 1).text();
}

bool is_worth_a_step(const Tape& tape, const CStepFormula& formula) {
  const std::size_t states = tape.states_end() - tape.states_begin();
  return states > 0 && states <= most_states_of_step && is_short(tape, formula);
}

}  // namespace continuo::model
