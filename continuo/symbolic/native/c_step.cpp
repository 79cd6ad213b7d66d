// Writes one step, and the function that chooses what is done.
#include <algorithm>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_source.hpp>
#include <continuo/symbolic/native/c_steps.hpp>
#include <continuo/symbolic/native/step_text.hpp>
#include <continuo/symbolic/tape/tape_lanes.hpp>

namespace continuo::model {

namespace {

// Of all stages: beyond, f is a function that is called. Of one: beyond, little is gained.
constexpr std::size_t most_operations_inside = 1500;
constexpr std::size_t most_states_of_step = 64;  // of one run
constexpr std::size_t most_states_side_by_side = 16;

constexpr std::string_view beginning =
    "struct lane_step {\n"
    "  const double *t, *x, *h;\n"
    "  long long evaluates_start, keeps_stages;\n"
    "  double *const *stages;\n"
    "  double *x_new, *square;\n"
    "  const double *rtol, *atol;\n"
    "  long long rtol_each, atol_each;\n"
    "};\n"
    "struct lane_steps;\n"
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
    "typedef int lane_masks;\n"
    "static inline lanes all_lanes(double a) { return a; }\n"
    "static inline lanes choose(lane_masks m, lanes a, lanes b) { return m ? a : b; }\n"
    "static inline lanes size_of(lanes a) { return fabs(a); }\n"
    "static inline lanes greater(lanes a, lanes b) { return a < b ? b : a; }\n";

/// Whether f can be written wherever it is needed.
bool is_short(const Tape& tape, const CStepFormula& formula) {
  const Tape::Size size = tape.size();
  return size.batches == 0 && size.single * (formula.b.size() + 1) <= most_operations_inside;
}

std::string rates_function(const StepText& step) {
  const Tape& tape = step.tape();
  const CArray states[] = {{"x", tape.states_begin(), tape.states_end()}};
  const std::string signature = fmt::format(
      "static inline __attribute__(({})) void rates(lanes *restrict r, const lanes *restrict x, "
      "lanes *restrict y)",
      is_short(tape, step.formula()) ? "always_inline" : "noinline");
  return c_function(tape, {.signature = signature,
                           .arrays = states,
                           .in_lanes = !step.is_single(),
                           .fused = step.fusing() != Fusing::none})
      .text;
}

void keep_stage(StepText& step, std::size_t j) {
  step.store(fmt::format("k{}", j), fmt::format("s->stages[{}]", j));
}

std::string step_function(StepText step) {
  step.declare();
  step.line("const lanes t = load(s->t + part), h = load(s->h + part);");
  step.load_state("s->x");
  step.line("if (s->evaluates_start) {");
  step.start();
  step.line("} else {");
  step.each_state(
      [&](std::string_view i) { return fmt::format("k0[{}] = load({});", i, step.element("s->stages[0]", i)); });
  step.line("}");
  step.step();
  step.store("end", "s->x_new");
  keep_stage(step, 0);
  const std::size_t inner = step.inner_stages();
  if (step.formula().ends_with_f) keep_stage(step, inner);
  step.line("if (s->keeps_stages) {");
  for (std::size_t j = 1; j < inner; ++j) keep_stage(step, j);
  step.line("}");
  if (!step.formula().error.empty()) {
    step.line("if (!s->square) return;");
    step.error();
    step.line("store(square, s->square + part);");
  }
  return "static inline void take_step(lanes *restrict r, const struct lane_step *s, int part) {\n" + step.text() +
         "}\n";
}

std::string evaluate_function(StepText step, bool has_many) {
  const std::size_t outputs = step.tape().output_count();
  step.line(has_many ? "if (!step && steps) return take_steps(steps);" : "if (!step && steps) return 0;");
  step.line(fmt::format("for (int part = 0; part < {}; part += WIDTH) {{", step.runs()));
  step.registers("registers");
  if (step.stages() > 0) {
    step.line("if (step) {");
    step.line("take_step(r, step, part);");
    step.line("continue;");
    step.line("}");
  }
  step.line(
      fmt::format("lanes x[{}], y[{}];", std::max<std::size_t>(step.states(), 1), std::max<std::size_t>(outputs, 1)));
  step.load_state("states");
  step.line("rates(r, x, y);");
  step.each(outputs, StepText::most_states_unrolled,
            [&](std::string_view i) { return fmt::format("store(y[{}], {});", i, step.element("rates_there", i)); });
  step.line("}");
  step.line("return 1;");
  return "long long evaluate(double *restrict registers, const double *states, double *rates_there,\n"
         "    const struct lane_step *step, const struct lane_steps *steps) {\n" +
         step.text() + "}\n";
}

/// Two groups of runs go side by side where all stages of both fit one function.
bool has_many_steps(const StepText& step) {
  if (step.formula().error.empty()) return false;
  return step.is_single() || (step.states() <= most_states_side_by_side && is_short(step.tape(), step.formula()));
}

std::string whole_text(const StepText& step) {
  const bool has_many = has_many_steps(step);
  std::string all = rates_function(step);
  if (step.stages() > 0) all += step_function(step);
  if (has_many) all += c_many_steps(step);
  all += evaluate_function(step, has_many);
  if (step.is_single()) return std::string(single_lane) + std::string(beginning) + all;
  return c_lane_helpers(all) + std::string(beginning) + std::string(choices_of_lanes) + all;
}

}  // namespace

std::string c_lane_evaluation(const Tape& tape, const CStepFormula& formula, Fusing fusing) {
  return whole_text({tape, formula, TapeLanes::width, fusing});
}

std::string c_step(const Tape& tape, const CStepFormula& formula, Fusing fusing) {
  return whole_text({tape, formula, 1, fusing});
}

bool is_worth_a_step(const Tape& tape, const CStepFormula& formula) {
  const std::size_t states = tape.states_end() - tape.states_begin();
  return states > 0 && states <= most_states_of_step && tape.size().single <= most_operations_inside &&
         formula.b.size() > 1;
}

}  // namespace continuo::model
