// Random grids against the same models written out member by member: as tapes, as machine code, and as exported C.
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tests/symbolic/native_referee.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/c_export.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model::grid_test {
namespace {

constexpr std::array<const char*, 3> index_names = {"i", "j", "k"};
using Point = std::array<int, 3>;

/// A random equation of a grid, as the text of a family and as that of any of its members.
class RandomGrid {
 public:
  explicit RandomGrid(std::mt19937& random) : random_(random), dimensions_(1 + any(3)) {
    constexpr std::array most = {60, 12, 6};
    for (int d = 0; d < dimensions_; ++d)
      size_[static_cast<std::size_t>(d)] = 3 + any(most[static_cast<std::size_t>(dimensions_ - 1)]);
    for (int term = 2 + any(5); term > 0; --term) terms_.push_back(random_term());
  }

  std::string family() {
    std::string loops;
    for (int d = 0; d < dimensions_; ++d)
      loops += fmt::format("{}{} in 1..{}", d == 0 ? "" : ", ", index_names[static_cast<std::size_t>(d)], size_at(d));
    return fmt::format("model Grid\nparam c = 0.3\nfor {} {{\n{}}}\nrun 0..1\n", loops, member(nullptr));
  }

  std::string written_out() {
    std::string text = "model Grid\nparam c = 0.3\n";
    Point at{1, 1, 1};
    for (;;) {
      text += member(&at);
      int d = dimensions_ - 1;
      for (; d >= 0 && ++at[static_cast<std::size_t>(d)] > size_at(d); --d) at[static_cast<std::size_t>(d)] = 1;
      if (d < 0) return text + "run 0..1\n";
    }
  }

 private:
  struct Term {
    int kind, axis, offset, factor;
    std::string name, function;
  };

  int any(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  [[nodiscard]] int size_at(int d) const { return size_[static_cast<std::size_t>(d)]; }

  Term random_term() {
    constexpr std::array functions = {"", "sin", "exp", "abs"};
    return {.kind = any(5),
            .axis = any(dimensions_),
            .offset = 1 + any(2),
            .factor = 1 + any(9),
            .name = any(2) == 0 ? "u" : "v",
            .function = functions[static_cast<std::size_t>(any(4))]};
  }

  /// `u[i,j-1]`, or `u[3,4]`.
  std::string named(const std::string& name, const Point* at, int axis, int offset) const {
    std::string text = name + "[";
    for (int d = 0; d < dimensions_; ++d) {
      const auto k = static_cast<std::size_t>(d);
      const int shift = d == axis ? offset : 0;
      text += d == 0 ? "" : ",";
      if (at != nullptr) {
        text += fmt::format("{}", (*at)[k] + shift);
      } else {
        text += shift == 0 ? index_names[k] : fmt::format("{}{:+}", index_names[k], shift);
      }
    }
    return text + "]";
  }
  std::string index(const Point* at, int axis) const {
    const auto k = static_cast<std::size_t>(axis);
    return at != nullptr ? fmt::format("{}", (*at)[k]) : index_names[k];
  }

  std::string text_of(const Term& term, const Point* at) const {
    const std::string here = named(term.name, at, 0, 0);
    const std::string before = named(term.name, at, term.axis, -term.offset);
    const std::string after = named(term.name, at, term.axis, term.offset);
    const int last = size_at(term.axis) - term.offset;
    const int place = at != nullptr ? (*at)[static_cast<std::size_t>(term.axis)] : 0;
    switch (term.kind) {
      case 0:
        if (at != nullptr) return place > term.offset ? before : "0";
        return fmt::format("(if {} > {} then {} else 0)", index(at, term.axis), term.offset, before);
      case 1:
        if (at != nullptr) return place <= last ? fmt::format("{}({})*c", term.function, after) : here;
        return fmt::format("(if {} <= {} then {}({})*c else {})", index(at, term.axis), last, term.function, after,
                           here);
      case 2:
        return fmt::format("{}*{}", index(at, term.axis), here);
      case 3:
        return fmt::format("sin({}*c)*{}/{}", index(at, term.axis), term.factor, here);
      default:
        return fmt::format("(u{0} - v{0})^2*{1}", here.substr(1), term.factor);
    }
  }

  std::string member(const Point* at) const {
    std::string right;
    for (const Term& term : terms_) right += (right.empty() ? "" : " - ") + text_of(term, at);
    const std::string u = named("u", at, 0, 0), v = named("v", at, 0, 0);
    return fmt::format("{0}(0) = 1 + sin({2}*c)\n{1}(0) = 1/{2}\n{0}' = {3}\n{1}' = {0} - c*({3})\n", u, v,
                       index(at, 0), right);
  }

  std::mt19937& random_;
  int dimensions_;
  Point size_{1, 1, 1};
  std::vector<Term> terms_;
};

std::vector<double> rates_at(const ModelProgram& program, const std::vector<double>& start,
                             const std::vector<double>& x) {
  return Evaluation(program.derivatives[0], start)(0.25, x);
}

void expect_the_same(const std::vector<double>& actual, const std::vector<double>& expected, const char* what) {
  ASSERT_EQ(actual.size(), expected.size()) << what;
  for (std::size_t k = 0; k < expected.size(); ++k)
    ASSERT_EQ(bits(actual[k]), bits(expected[k])) << what << " " << k << ": " << actual[k] << ", not " << expected[k];
}

std::vector<double> rates_of_c(const TestFolder& folder, const std::string& text, const std::vector<double>& x) {
  const std::string file = (folder.path / "grid").string();
  std::ofstream c(file + ".c");
  c << text
    << "\n#include <stdio.h>\nint main(void) {\n  static double x[GRID_STATES], y[GRID_STATES], r[GRID_WORK + 20000];\n"
    << "  FILE *f = fopen(\"" << file << ".x\", \"rb\");\n"
    << "  if (fread(x, 8, GRID_STATES, f) != GRID_STATES) return 1;\n"
    << "  for (int i = 0; i < 20000; ++i) r[GRID_WORK + i] = 7;\n"
    << "  Grid_rates(0.25, x, Grid_parameters, 0, r, y);\n"
    << "  for (int i = 0; i < 20000; ++i) if (r[GRID_WORK + i] != 7) return 2;\n"
    << "  for (int i = 0; i < GRID_STATES; ++i) printf(\"%a\\n\", y[i]);\n}\n";
  c.close();
  std::ofstream(file + ".x", std::ios::binary)
      .write(reinterpret_cast<const char*>(x.data()), static_cast<std::streamsize>(8 * x.size()));
  EXPECT_EQ(
      std::system(fmt::format("cc -std=c11 -O2 -w -ffp-contract=off {0}.c -o {0} -lm && {0} > {0}.y", file).c_str()), 0)
      << text;
  std::vector<double> y;
  std::ifstream stream(file + ".y");
  for (std::string word; stream >> word;) y.push_back(std::strtod(word.c_str(), nullptr));
  return y;
}

TEST(Grid, IsWhatItsMembersWrittenOutAre) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    RandomGrid grid(random);
    const std::string text = grid.family();
    SCOPED_TRACE(text);
    const Loaded family = load(Source("grid.sim", text)), apart = load(Source("apart.sim", grid.written_out()));
    ASSERT_TRUE(family && apart);
    Loaded compiled = load(Source("grid.sim", text));
    compiled.model->native = native;
    const auto of_family = compile(*family.model), of_members = compile(*apart.model), in_c = compile(*compiled.model);
    const std::vector<double> start = start_values(of_family->model);
    expect_the_same(start, start_values(of_members->model), "start");
    std::normal_distribution<double> normal;
    std::vector<double> x(of_family->model.states.size());
    for (double& value : x) value = normal(random);
    const std::vector<double> expected = rates_at(*of_members, start, x);
    expect_the_same(rates_at(*of_family, start, x), expected, "tape");
    const Tape::Size size = in_c->derivatives[0]->size();  // terms may cancel until nothing is left
    ASSERT_TRUE(in_c->derivatives[0]->is_native() || size.single + size.batches == 0) << native->report().trouble;
    expect_the_same(rates_at(*in_c, start, x), expected, "machine code");
    if (seed % 4 != 0) continue;
    const std::vector<double> printed = rates_of_c(folder, *c_text(*of_family), x);
    ASSERT_EQ(printed.size(), expected.size());
    // Nothing is prepared: a factor of parameters may round in another order.
    for (std::size_t k = 0; k < x.size(); ++k)
      EXPECT_NEAR(printed[k], expected[k], 1e-12 * (1 + std::abs(expected[k]))) << k;
  }
}

}  // namespace
}  // namespace continuo::model::grid_test
