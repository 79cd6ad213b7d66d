// Writes a step as sums of products, with all coefficients in the text.
#include <algorithm>
#include <utility>

#include <continuo/symbolic/native/c_operations.hpp>
#include <continuo/symbolic/native/step_text.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t most_registers_unrolled = 100;

std::string number(double value) {
  return fmt::format("{:a}", value);
}

}  // namespace

void StepText::line(std::string_view what) {
  std::string& line = lines_.emplace_back("  ");
  for (const char one : what) {
    if (one == '@') {
      line += unit_;
    } else {
      line += one;
    }
  }
  line += '\n';
}

std::string StepText::text() const {
  std::string text;
  for (const std::string& line : lines_) text += line;
  return text;
}

void StepText::take_turns(std::size_t begin, std::size_t units) {
  std::vector<std::string> turns;
  const std::size_t of_each = (lines_.size() - begin) / units;
  for (std::size_t i = 0; i < of_each; ++i)
    for (std::size_t unit = 0; unit < units; ++unit) turns.push_back(std::move(lines_[begin + unit * of_each + i]));
  std::ranges::move(turns, lines_.begin() + static_cast<std::ptrdiff_t>(begin));
}

void StepText::registers(std::string_view array) {
  if (is_single()) return line(fmt::format("double *const r@ = {};", array));
  line(fmt::format("lanes r@[{}];", tape_.register_count()));
  each(tape_.register_count(), most_registers_unrolled,
       [&](std::string_view i) { return fmt::format("r@[{}] = load({});", i, element(array, i)); });
}

void StepText::declare() {
  line(fmt::format("lanes x@[{0}], y@[{0}], slope@[{0}], end@[{0}], square@;", states_));
  for (std::size_t j = 0; j < stages(); ++j) line(fmt::format("lanes k{}@[{}];", j, states_));
}

void StepText::start() {
  line("r@[0] = t@;");
  line("rates(r@, x@, k0@);");
}

void StepText::step() {
  for (std::size_t j = 1; j < inner_stages(); ++j) stage(j);
  each_state([&](std::string_view i) {
    return fmt::format("slope@[{0}] = {1}; end@[{0}] = {2};", i, sum(formula_.b, stages(), i),
                       plus_product(fmt::format("x@[{}]", i), "h@", fmt::format("slope@[{}]", i)));
  });
  if (!formula_.ends_with_f) return;
  line("r@[0] = t@ + h@;");
  line(fmt::format("rates(r@, end@, k{}@);", inner_stages()));
}

void StepText::stage(std::size_t j) {
  const std::vector<double>& weights = formula_.a[j];
  std::size_t newest = j;
  while (newest > 0 && weights[newest - 1] == 0) --newest;
  --newest;
  const std::string last = fmt::format("k{}@", newest);
  line(fmt::format("const lanes w{}@ = h@ * all_lanes({});", j, number(weights[newest])));
  const bool is_alone = std::all_of(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(newest),
                                    [](double weight) { return weight == 0; });
  each_state([&](std::string_view i) {
    const std::string begin = fmt::format("x@[{}]", i);
    const std::string of_others = is_alone ? begin : plus_product(begin, "h@", sum(weights, newest, i));
    return fmt::format("y@[{}] = {};", i,
                       plus_product(of_others, fmt::format("w{}@", j), fmt::format("{}[{}]", last, i)));
  });
  const double c = formula_.c[j];
  line(c == 0   ? "r@[0] = t@;"
       : c == 1 ? "r@[0] = t@ + h@;"
                : fmt::format("r@[0] = t@ + h@ * all_lanes({});", number(c)));
  line(fmt::format("rates(r@, y@, k{}@);", j));
}

/// The terms with a weight that is not 0, of the stages before `end`, from the first one on.
std::string StepText::sum(std::span<const double> weights, std::size_t end, std::string_view i) const {
  std::string text;
  for (std::size_t j = 0; j < end; ++j) {
    if (weights[j] == 0) continue;
    const std::string weight = fmt::format("all_lanes({})", number(weights[j])), stage = fmt::format("k{}@[{}]", j, i);
    text = text.empty() ? fmt::format("{} * {}", weight, stage) : plus_product(text, weight, stage);
  }
  return text.empty() ? "all_lanes(0.0)" : "(" + text + ")";
}

std::string StepText::plus_product(std::string_view sum, std::string_view a, std::string_view b) const {
  if (fusing_ == Fusing::steps) return fused_text(a, b, sum, !is_single());
  return fmt::format("({} + {} * {})", sum, a, b);
}

void StepText::error() {
  const bool has_two = !formula_.second_error.empty();
  line("lanes sum@ = all_lanes(0.0), sum3@ = all_lanes(0.0);");
  each_state([&](std::string_view i) {
    const std::string atol = fmt::format("load({})", element("s->atol", fmt::format("(s->atol_each * {})", i)));
    const std::string rtol = fmt::format("load({})", element("s->rtol", fmt::format("(s->rtol_each * {})", i)));
    const std::string size = fmt::format("greater(size_of(x@[{0}]), size_of(end@[{0}]))", i);
    return fmt::format("{{ const lanes scale = {}; {} {}}}", plus_product(atol, rtol, size), ratios(i),
                       has_two ? fmt::format("sum3@ = {}; ", plus_product("sum3@", "ratio3", "ratio3")) : "");
  });
  const std::string mean = fmt::format("all_lanes({})", number(1.0 / static_cast<double>(states_)));
  if (has_two) {
    line(fmt::format("const lanes both@ = {} + all_lanes(1e-37);", plus_product("sum@", "all_lanes(0.01)", "sum3@")));
    line(fmt::format("square@ = (h@ * sum@) * (h@ * sum@) / both@ * {};", mean));
  } else {
    line(fmt::format("square@ = sum@ * {};", mean));
  }
}

/// The errors of a component in units of its tolerance; the square of the first one is added to `sum`, with a number
/// that is none where the end is not finite. Where steps are fused, both are products with one reciprocal, and of the
/// second estimate only the part is summed in which it differs from the step.
std::string StepText::ratios(std::string_view i) const {
  const std::string first = sum(formula_.error, formula_.error.size(), i);
  const std::string not_finite = fmt::format("(end@[{0}] - end@[{0}])", i);
  const bool has_two = !formula_.second_error.empty();
  std::string text = fmt::format("const lanes weight = {} / scale; ", has_two ? "all_lanes(1.0)" : "h@");
  if (fusing_ == Fusing::steps) {
    text += fmt::format("const lanes ratio = {} * weight; ", first);
    if (has_two) text += fmt::format("const lanes ratio3 = {} * weight; ", rest_of_second(i));
    return text + fmt::format("sum@ = {};", plus_product(fmt::format("(sum@ + {})", not_finite), "ratio", "ratio"));
  }
  text = has_two ? fmt::format("const lanes ratio = {} / scale; const lanes ratio3 = {} / scale; ", first,
                               sum(formula_.second_error, formula_.second_error.size(), i))
                 : text + fmt::format("const lanes ratio = {} * weight; ", first);
  return text + fmt::format("sum@ = sum@ + (ratio * ratio + {});", not_finite);
}

std::string StepText::rest_of_second(std::string_view i) const {
  std::string text = fmt::format("slope@[{}]", i);
  for (std::size_t j = 0; j < stages(); ++j) {
    const double weight = formula_.second_error[j] - formula_.b[j];
    if (weight != 0)
      text = plus_product(text, fmt::format("all_lanes({})", number(weight)), fmt::format("k{}@[{}]", j, i));
  }
  return text;
}

void StepText::load_state(std::string_view array) {
  each_state([&](std::string_view i) { return fmt::format("x@[{}] = load({});", i, element(array, i)); });
}

void StepText::store(std::string_view name, std::string_view array) {
  each_state([&](std::string_view i) { return fmt::format("store({}@[{}], {});", name, i, element(array, i)); });
}

}  // namespace continuo::model
