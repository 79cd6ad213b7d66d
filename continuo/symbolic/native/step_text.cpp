// Writes a step as sums of products, with all coefficients in the text.
#include <algorithm>
#include <utility>

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
  line(fmt::format("lanes x@[{0}], y@[{0}], end@[{0}], square@;", states_));
  for (std::size_t j = 0; j < stages(); ++j) line(fmt::format("lanes k{}@[{}];", j, states_));
}

void StepText::start() {
  line("r@[0] = t@;");
  line("rates(r@, x@, k0@);");
}

void StepText::step() {
  for (std::size_t j = 1; j < inner_stages(); ++j) stage(j);
  each_state([&](std::string_view i) {
    return fmt::format("end@[{0}] = x@[{0}] + h@ * ({1});", i, sum(formula_.b, stages(), i));
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
    if (is_alone) return fmt::format("y@[{0}] = x@[{0}] + w{1}@ * {2}[{0}];", i, j, last);
    return fmt::format("y@[{0}] = (x@[{0}] + h@ * ({1})) + w{2}@ * {3}[{0}];", i, sum(weights, newest, i), j, last);
  });
  const double c = formula_.c[j];
  line(c == 0   ? "r@[0] = t@;"
       : c == 1 ? "r@[0] = t@ + h@;"
                : fmt::format("r@[0] = t@ + h@ * all_lanes({});", number(c)));
  line(fmt::format("rates(r@, y@, k{}@);", j));
}

/// The terms with a weight that is not 0, of the stages before `end`, from the first one on.
std::string StepText::sum(std::span<const double> weights, std::size_t end, std::string_view i) {
  std::string text;
  for (std::size_t j = 0; j < end; ++j)
    if (weights[j] != 0)
      text += fmt::format("{}all_lanes({}) * k{}@[{}]", text.empty() ? "" : " + ", number(weights[j]), j, i);
  return text.empty() ? "all_lanes(0.0)" : text;
}

void StepText::error() {
  const bool has_two = !formula_.second_error.empty();
  line("lanes sum@ = all_lanes(0.0), sum3@ = all_lanes(0.0);");
  each_state([&](std::string_view i) {
    std::string text =
        fmt::format("{{ const lanes scale = load({1}) + load({2}) * greater(size_of(x@[{0}]), size_of(end@[{0}])); ", i,
                    element("s->atol", fmt::format("(s->atol_each * {})", i)),
                    element("s->rtol", fmt::format("(s->rtol_each * {})", i)));
    const std::string first = sum(formula_.error, formula_.error.size(), i);
    text += has_two ? fmt::format("const lanes ratio = ({}) / scale; const lanes ratio3 = ({}) / scale; ", first,
                                  sum(formula_.second_error, formula_.second_error.size(), i))
                    : fmt::format("const lanes weight = h@ / scale; const lanes ratio = ({}) * weight; ", first);
    text += fmt::format("sum@ = sum@ + (ratio * ratio + (end@[{0}] - end@[{0}])); ", i);
    return text + (has_two ? "sum3@ = sum3@ + ratio3 * ratio3; }" : "}");
  });
  const std::string mean = fmt::format("all_lanes({})", number(1.0 / static_cast<double>(states_)));
  if (has_two) {
    line("const lanes both@ = (sum@ + all_lanes(0.01) * sum3@) + all_lanes(1e-37);");
    line(fmt::format("square@ = (h@ * sum@) * (h@ * sum@) / both@ * {};", mean));
  } else {
    line(fmt::format("square@ = sum@ * {};", mean));
  }
}

void StepText::load_state(std::string_view array) {
  each_state([&](std::string_view i) { return fmt::format("x@[{}] = load({});", i, element(array, i)); });
}

void StepText::store(std::string_view name, std::string_view array) {
  each_state([&](std::string_view i) { return fmt::format("store({}@[{}], {});", name, i, element(array, i)); });
}

}  // namespace continuo::model
