// Writes the choice of the sizes of steps, which is that of Controller in single precision.
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include <continuo/symbolic/native/c_steps.hpp>

namespace continuo::model {

namespace {

constexpr std::string_view motions =
    "struct lane_motion {\n"
    "  double *registers, *t, *next, *carried, *steps, *x;\n"
    "  float *last, *before_last, *rejects;\n"
    "  const double *limit, *longest, *until, *active;\n"
    "  double *x_new, *square, *first_stage, *last_stage;\n"
    "  long long evaluates_start, waits;\n"
    "};\n"
    "struct lane_steps {\n"
    "  struct lane_motion *motions;\n"
    "  long long count, most;\n"
    "  const double *rtol, *atol;\n"
    "  long long rtol_each, atol_each;\n"
    "  double forward;\n"
    "  float beta2, beta3, minus_order, order_beta1, safety, least_factor, greatest_factor;\n"
    "};\n";

constexpr std::string_view floats_of_lanes =
    "typedef float floats __attribute__((vector_size(4 * WIDTH)));\n"
    "typedef int float_masks __attribute__((vector_size(4 * WIDTH)));\n"
    "static inline floats all_floats(float a) { return a - (floats){0}; }\n"
    "static inline floats choose_floats(float_masks m, floats a, floats b) {\n"
    "  return (floats)(((float_masks)a & m) | ((float_masks)b & ~m));\n"
    "}\n"
    "static inline float_masks bits_of(floats a) { return (float_masks)a; }\n"
    "static inline floats of_bits(float_masks a) { return (floats)a; }\n"
    "static inline floats narrow(lanes a) { return __builtin_convertvector(a, floats); }\n"
    "static inline lanes widen(floats a) { return __builtin_convertvector(a, lanes); }\n"
    "static inline lane_masks opposite(lane_masks m) { return ~m; }\n"
    "static inline int any(lane_masks m) {\n"
    "  long long bits = 0;\n"
    "  for (int i = 0; i < WIDTH; ++i) bits |= m[i];\n"
    "  return bits != 0;\n"
    "}\n";
constexpr std::string_view float_of_one =
    "typedef float floats;\n"
    "typedef int float_masks;\n"
    "static inline floats all_floats(float a) { return a; }\n"
    "static inline floats choose_floats(float_masks m, floats a, floats b) { return m ? a : b; }\n"
    "static inline float_masks bits_of(floats a) {\n"
    "  float_masks bits;\n"
    "  __builtin_memcpy(&bits, &a, sizeof a);\n"
    "  return bits;\n"
    "}\n"
    "static inline floats of_bits(float_masks bits) {\n"
    "  floats a;\n"
    "  __builtin_memcpy(&a, &bits, sizeof a);\n"
    "  return a;\n"
    "}\n"
    "static inline floats narrow(lanes a) { return (float)a; }\n"
    "static inline lanes widen(floats a) { return a; }\n"
    "static inline lane_masks opposite(lane_masks m) { return !m; }\n"
    "static inline int any(lane_masks m) { return m; }\n";

/// quick_log2, quick_exp2 and ErrorHistoryOf::accept of solve/steps/controller.hpp.
constexpr std::string_view controller =
    "static inline floats load_floats(const float *from) {\n"
    "  floats a;\n"
    "  __builtin_memcpy(&a, from, sizeof a);\n"
    "  return a;\n"
    "}\n"
    "static inline void store_floats(floats a, float *to) { __builtin_memcpy(to, &a, sizeof a); }\n"
    "static inline floats greater_floats(floats a, floats b) { return choose_floats(a < b, b, a); }\n"
    "static inline floats lesser_floats(floats a, floats b) { return choose_floats(b < a, b, a); }\n"
    "static inline floats quick_log2(floats x) {\n"
    "  const floats m = of_bits((bits_of(x) & 0x007fffff) | 0x3f800000);\n"
    "  const floats exponent = of_bits((bits_of(x) >> 23) | 0x4b000000) - all_floats(0x1p23f + 127.0f);\n"
    "  const floats below = exponent - all_floats(2.16416994f);\n"
    "  return (below + all_floats(3.06469457f) * m) + m * m * (all_floats(0.159219831f) * m - "
    "all_floats(1.05974446f));\n"
    "}\n"
    "static inline floats quick_exp2(floats x) {\n"
    "  const floats bounded = lesser_floats(greater_floats(x, all_floats(-126.0f)), all_floats(127.0f));\n"
    "  const floats shifted = bounded + all_floats(0x1.8p23f);\n"
    "  const floats f = bounded - (shifted - all_floats(0x1.8p23f));\n"
    "  return of_bits((bits_of(shifted) + 127) << 23) * ((all_floats(0.999928014f) + all_floats(0.693261013f) * f) +\n"
    "      f * f * (all_floats(0.242612141f) + all_floats(0.0551720782f) * f));\n"
    "}\n"
    "static inline floats factor_of(const struct lane_steps *s, floats here, floats last, floats before_last,\n"
    "    floats rejects) {\n"
    "  const floats older = all_floats(s->beta2) * last + all_floats(s->beta3) * before_last;\n"
    "  const floats power = quick_exp2(all_floats(s->minus_order) * older - all_floats(s->order_beta1) * here);\n"
    "  const floats factor = lesser_floats(greater_floats(all_floats(s->safety) * power, "
    "all_floats(s->least_factor)),\n"
    "      all_floats(s->greatest_factor));\n"
    "  return choose_floats(rejects > all_floats(0.0f), lesser_floats(factor, all_floats(1.0f)), factor);\n"
    "}\n";

/// Of eight runs, two groups of as many as a register has numbers go side by side, as the processor computes one while
/// the other waits for a stage.
constexpr std::array<std::string_view, 2> both_units = {"_a", "_b"};

class ManySteps {
 public:
  explicit ManySteps(const StepText& empty)
      : step_(empty), units_(both_units.begin(), empty.is_single() ? both_units.begin() + 1 : both_units.end()) {}

  [[nodiscard]] std::string text() {
    for_units([&] { begin(); });
    step_.line("long long n = 0;");
    // One run alone leaves a step that it does not accept as if it had not been made.
    step_.line(step_.is_single() ? "for (; n < s->most; ++n) {" : "for (;; ++n) {");
    step_.side_by_side(units_, [&] {
      choose();
      step_.step();
      judge();
    });
    step_.line(step_.is_single() ? "if (any(stops_a)) break;" : "if (n == s->most || any(stops_a | stops_b)) break;");
    step_.side_by_side(units_, [&] { accept(); });
    step_.line("}");
    for_units([&] { end(); });
    return (step_.is_single() ? "static inline void advance(const struct lane_steps *s, struct lane_motion *m_a) {\n"
                                "  enum { part_a = 0 };\n"
                              : "static inline void advance(const struct lane_steps *s, struct lane_motion *m_a, int "
                                "part_a,\n    struct lane_motion *m_b, int part_b) {\n") +
           step_.text() + "}\n";
  }

 private:
  template <class Write>
  void for_units(const Write& write) {
    for (const std::string_view unit : units_) {
      step_.set_unit(unit);
      write();
    }
  }

  void begin() {
    step_.registers("m@->registers");
    step_.declare();
    step_.load_state("m@->x");
    step_.line("lanes t@ = load(m@->t + part@), next@ = load(m@->next + part@);");
    step_.line("lanes carried@ = load(m@->carried + part@), steps@ = load(m@->steps + part@);");
    step_.line("const lanes limit@ = load(m@->limit + part@), longest@ = load(m@->longest + part@);");
    step_.line("const lanes until@ = load(m@->until + part@);");
    step_.line("const lane_masks active@ = load(m@->active + part@) != all_lanes(0.0);");
    step_.line("floats last@ = load_floats(m@->last + part@), before_last@ = load_floats(m@->before_last + part@);");
    step_.line("floats rejects@ = load_floats(m@->rejects + part@);");
    step_.line("lanes h@, end_time@, next_size@, lacks@;");
    step_.line("floats here@;");
    step_.line("lane_masks stops@;");
    if (!step_.formula().ends_with_f) return;
    step_.line("if (m@->evaluates_start) {");
    step_.start();
    step_.line("} else {");
    step_.each_state(
        [&](std::string_view i) { return fmt::format("k0@[{}] = load({});", i, step_.element("m@->first_stage", i)); });
    step_.line("}");
  }

  // A remainder below 1 % of h before the limit is absorbed into the step.
  void choose() {
    step_.line("const lanes room@ = limit@ - t@;");
    step_.line("const lanes planned@ = choose(size_of(next@) > longest@, s->forward * longest@, next@);");
    step_.line("const lane_masks is_last@ = s->forward * (all_lanes(1.01) * planned@ - room@) >= all_lanes(0.0);");
    step_.line("h@ = choose(is_last@, room@, planned@);");
    if (!step_.formula().ends_with_f) step_.start();
  }

  void judge() {
    step_.error();
    step_.line("here@ = quick_log2(greater_floats(narrow(square@), all_floats(1e-20f)));");
    step_.line("next_size@ = h@ * widen(factor_of(s, here@, last@, before_last@, rejects@));");
    step_.line("const lanes wanted@ = h@ + carried@;");
    step_.line("end_time@ = t@ + wanted@;");
    step_.line("lacks@ = wanted@ - (end_time@ - t@);");
    step_.line("const lane_masks passes@ = s->forward * (end_time@ - until@) >= all_lanes(0.0);");
    step_.line("stops@ = (opposite(square@ <= all_lanes(1.0)) | is_last@ | passes@ | (end_time@ == t@)) & active@;");
  }

  void accept() {
    step_.line("t@ = end_time@;");
    step_.line("next@ = next_size@;");
    step_.line("carried@ = lacks@;");
    step_.line("steps@ = steps@ + all_lanes(1.0);");
    step_.line("before_last@ = last@;");
    step_.line("last@ = here@;");
    step_.line("rejects@ = all_floats(0.0f);");
    const std::size_t last = step_.inner_stages();
    step_.each_state([&](std::string_view i) {
      return fmt::format("x@[{0}] = end@[{0}];", i) +
             (step_.formula().ends_with_f ? fmt::format(" k0@[{0}] = k{1}@[{0}];", i, last) : std::string());
    });
  }

  void end() {
    if (!step_.is_single()) end_or_wait();
    step_.store("x", "m@->x");
    if (step_.formula().ends_with_f || !step_.is_single()) step_.store("k0", "m@->first_stage");
    for (const char* name : {"t", "next", "carried", "steps"})
      step_.line(fmt::format("store({0}@, m@->{0} + part@);", name));
    for (const char* name : {"last", "before_last", "rejects"})
      step_.line(fmt::format("store_floats({0}@, m@->{0} + part@);", name));
  }

  // All groups of a motion wait, or none.
  void end_or_wait() {
    step_.line("if (PARTS > 1 || n == s->most || any(stops@)) {");
    step_.line("m@->waits = 1;");
    step_.store("end", "m@->x_new");
    step_.line("store(square@, m@->square + part@);");
    if (step_.formula().ends_with_f) step_.store(fmt::format("k{}", step_.inner_stages()), "m@->last_stage");
    step_.line("} else {");
    accept();
    step_.line("}");
  }

  StepText step_;
  std::span<const std::string_view> units_;
};

constexpr std::string_view take_steps_of_one =
    "static long long take_steps(const struct lane_steps *s) {\n"
    "  for (long long u = 0; u < s->count; ++u) advance(s, s->motions + u);\n"
    "  return 1;\n"
    "}\n";
constexpr std::string_view take_steps_of_lanes =
    "static long long take_steps(const struct lane_steps *s) {\n"
    "  for (long long u = 0; u + 1 < s->count * PARTS; u += 2)\n"
    "    advance(s, s->motions + u / PARTS, (int)(u % PARTS) * WIDTH, s->motions + (u + 1) / PARTS,\n"
    "        (int)((u + 1) % PARTS) * WIDTH);\n"
    "  return 1;\n"
    "}\n";

}  // namespace

std::string c_many_steps(const StepText& empty) {
  const bool single = empty.is_single();
  std::string text = fmt::format("#define PARTS ({} / WIDTH)\n", empty.runs());
  text += motions;
  text += single ? float_of_one : floats_of_lanes;
  text += controller;
  text += ManySteps(empty).text();
  text += single ? take_steps_of_one : take_steps_of_lanes;
  return text;
}

}  // namespace continuo::model
