// Machine code on the models of the gallery: every number as of the tape, whole runs too; and the exported C files.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
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
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_derivatives.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>
#include <continuo/symbolic/tape/tape_enclosure.hpp>

namespace continuo::model::native_models_test {
namespace {

namespace fs = std::filesystem;

void expect_the_same(const std::vector<double>& actual, const std::vector<double>& expected, const std::string& what) {
  ASSERT_EQ(actual.size(), expected.size()) << what;
  for (std::size_t k = 0; k < expected.size(); ++k)
    ASSERT_EQ(bits(actual[k]), bits(expected[k]))
        << what << ", output " << k << ": " << actual[k] << ", not " << expected[k];
}

/// States near the start, so that most functions are defined there.
std::vector<double> near(const std::vector<double>& x, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<double> moved = x;
  for (double& value : moved) value += 0.1 * normal(random) * (1 + std::abs(value));
  return moved;
}

/// All models of the gallery but those of bodies alone.
std::vector<fs::path> gallery() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(CONTINUO_SOURCE_DIR) / "models"))
    if (entry.path().extension() == ".sim") found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

/// Of the start's mode, in its sparse or banded layout.
void expect_the_same_jacobian(const ModelProgram& compiled, const ModelProgram& interpreted,
                              const std::vector<double>& start, const std::vector<double>& begin, std::mt19937& random,
                              const std::string& file) {
  if (interpreted.model.has_world()) return;
  ModelDerivatives a(interpreted, start), b(compiled, start);
  const bool banded = a.pattern().is_banded();
  const std::size_t size = banded ? a.pattern().band().numbers() : a.pattern().entries();
  for (int i = 0; i < 3; ++i) {
    const std::vector<double> x = near(begin, random);
    std::vector<double> expected(size), actual(size);
    banded ? a.jacobian_band(0, 0.3 * i, x, expected) : a.jacobian_values(0, 0.3 * i, x, expected);
    banded ? b.jacobian_band(0, 0.3 * i, x, actual) : b.jacobian_values(0, 0.3 * i, x, actual);
    expect_the_same(actual, expected, file + ", Jacobian");
  }
}

TEST(NativeGallery, EveryModelGivesTheBitsOfItsTapes) {
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::always, folder.path / "cache"});
  std::mt19937 random(7);
  std::size_t models = 0;
  for (const fs::path& file : gallery()) {
    Loaded loaded = load(file.string());
    ASSERT_TRUE(loaded) << file;
    const auto interpreted = compile(*loaded.model);
    if (interpreted->model.states.empty()) continue;
    loaded.model->native = native;
    const auto compiled = compile(*loaded.model);
    const std::vector<double> start = start_values(interpreted->model);
    const Layout& layout = interpreted->model.layout;
    const std::vector<double> begin(
        start.begin() + layout.states,
        start.begin() + layout.states + static_cast<std::ptrdiff_t>(interpreted->model.states.size()));
    for (std::size_t mode = 0; mode < interpreted->derivatives.size(); ++mode) {
      Evaluation a(interpreted->derivatives[mode], start), b(compiled->derivatives[mode], start);
      Evaluation guards(interpreted->guards[mode].tape, start), native_guards(compiled->guards[mode].tape, start);
      for (int i = 0; i < 5; ++i) {
        const std::vector<double> x = near(begin, random);
        expect_the_same(b(0.3 * i, x), a(0.3 * i, x), file.string() + ", rates");
        expect_the_same(native_guards(0.3 * i, x), guards(0.3 * i, x), file.string() + ", guards");
      }
    }
    expect_the_same_jacobian(*compiled, *interpreted, start, begin, random, file.string());
    ++models;
  }
  EXPECT_GT(models, 30u);
  EXPECT_EQ(native->report().trouble, "");
  EXPECT_GT(native->report().compiled, 40u);
}

/// What the tape may compute, however it rounds: an enclosure has what any order of rounding gives, see
/// numerics/enclosure.hpp.
std::vector<Enclosure<double>> enclosed(const Tape& tape, const std::vector<double>& start, double t,
                                        const std::vector<double>& x) {
  std::vector<Enclosure<double>> registers(tape.register_count()), outputs(tape.output_count());
  for (std::size_t i = 0; i < start.size(); ++i) registers[i] = Enclosure<double>(start[i]);
  registers[Layout::time] = Enclosure<double>(t);
  for (std::size_t i = 0; i < x.size(); ++i) registers[tape.states_begin() + i] = Enclosure<double>(x[i]);
  tape.prepare<Enclosure<double>>(registers);
  tape.evaluate<Enclosure<double>>(registers, outputs);
  return outputs;
}

/// Models with many products; each takes a compilation.
TEST(NativeGallery, FusedOperationsDifferByRounding) {
  if (!has_fused_operations()) GTEST_SKIP() << why_not(NativeUse::fused);
  const TestFolder folder;
  const auto native = std::make_shared<NativeCompiler>(NativeOptions{NativeUse::fused, folder.path / "cache"});
  std::mt19937 random(8);
  std::size_t others = 0;
  for (const char* name : {"arenstorf", "double_pendulum", "fed_batch", "lorenz", "oregonator", "pollution"}) {
    SCOPED_TRACE(name);
    const Loaded loaded = load((fs::path(CONTINUO_SOURCE_DIR) / "models" / fmt::format("{}.sim", name)).string());
    ASSERT_TRUE(loaded);
    const auto program = compile(*loaded.model);
    const std::vector<double> start = start_values(program->model);
    const auto first = start.begin() + program->model.layout.states;
    const std::vector<double> begin(first, first + static_cast<std::ptrdiff_t>(program->model.states.size()));
    const auto& tape = program->derivatives.front();
    const auto compiled = program->tape_of(program->model.modes.front().derivatives);
    native->watch(compiled, Fusing::equations);
    Evaluation plain(tape, start), fused(compiled, start);
    for (int i = 0; i < 10; ++i) {
      const std::vector<double> x = near(begin, random), expected = plain(0.3, x), actual = fused(0.3, x);
      const std::vector<Enclosure<double>> bounds = enclosed(*tape, start, 0.3, x);
      for (std::size_t k = 0; k < actual.size(); ++k) {
        ASSERT_TRUE(bounds[k].holds(expected[k])) << "output " << k;
        EXPECT_TRUE(bounds[k].holds(actual[k])) << "output " << k << ": " << actual[k] << " for " << expected[k];
        others += bits(actual[k]) != bits(expected[k]) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(native->report().trouble, "");
  EXPECT_GT(others, 10u);
}

/// Compiles the C text with a main that prints numbers of it in hexadecimal, and returns what that prints.
std::vector<double> numbers_of(const fs::path& folder, const std::string& text, const std::string& main) {
  std::ofstream(folder / "model.c") << text << "\n#include <stdio.h>\nint main(void) {\n" << main << "}\n";
  const std::string program = (folder / "model").string(), printed = (folder / "printed").string();
  const std::string build = fmt::format(
      "cc -std=c11 -Wall -Wextra -Werror -Wno-unused-parameter -Wno-unknown-pragmas -O1 -ffp-contract=off "
      "-fno-builtin-pow {0}.c -o {0} -lm && {0} > {1}",
      program, printed);
  EXPECT_EQ(std::system(build.c_str()), 0) << text;
  std::vector<double> numbers;
  std::ifstream stream(printed);
  for (std::string word; stream >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

/// The numbers that the compiled text prints, against the tape and the derivatives of the model.
void expect_that_c_is(const Loaded& loaded, const fs::path& folder) {
  const auto program = compile(*loaded.model);
  const Result<std::string> text = c_text(*program);
  ASSERT_TRUE(text);
  const std::vector<double> start = start_values(program->model);
  const std::size_t n = program->model.states.size();
  const std::vector<double> x(start.begin() + program->model.layout.states,
                              start.begin() + program->model.layout.states + static_cast<std::ptrdiff_t>(n));
  ModelDerivatives derivatives(*program, start);
  const std::string& own = program->model.name;
  std::string big = own;
  for (char& c : big) c = static_cast<char>(std::toupper(c));
  const std::vector<double> printed =
      numbers_of(folder, *text,
                 fmt::format("static double r[{0}_WORK], y[{0}_STATES], j[{0}_JACOBIAN];\n"
                             "(void){1}_state_names;\n"
                             "{1}_rates(0.25, {1}_start, {2}, 0, r, y);\n{1}_jacobian(0.25, {1}_start, {2}, 0, r, j);\n"
                             "for (int i = 0; i < {0}_STATES; ++i) printf(\"%a\\n\", y[i]);\n"
                             "for (int k = 0; k < {0}_JACOBIAN; ++k)\n"
                             "  printf(\"%d %d %a\\n\", {1}_jacobian_rows[k], {1}_jacobian_columns[k], j[k]);\n",
                             big, own, program->model.parameters.empty() ? "0" : own + "_parameters"));
  std::vector<double> expected = Evaluation(program->derivatives[0], start)(0.25, x), dense(n * n);
  derivatives.jacobian(0, 0.25, x, dense);
  ASSERT_GT(printed.size(), n);
  // Nothing is prepared: a factor of parameters may round in another order.
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(printed[i], expected[i], 1e-13 * (1 + std::abs(expected[i]))) << i;
  for (std::size_t k = n; k + 2 < printed.size(); k += 3) {
    double& entry = dense[static_cast<std::size_t>(printed[k]) * n + static_cast<std::size_t>(printed[k + 1])];
    EXPECT_NEAR(printed[k + 2], entry, 1e-13 * (1 + std::abs(entry)));
    entry = 0;
  }
  EXPECT_THAT(dense, ::testing::Each(0.0));  // all that are not zero were printed
}

Loaded model_of_gallery(const fs::path& file) {
  Loaded loaded = load(file.string());
  EXPECT_TRUE(loaded) << file;
  return loaded;
}

TEST(CExport, IsTheModel) {
  const TestFolder folder;
  for (const std::string name : {"pendulum", "kepler", "brusselator_line", "pollution", "lorenz"}) {
    SCOPED_TRACE(name);
    expect_that_c_is(model_of_gallery(fs::path(CONTINUO_SOURCE_DIR) / "models" / (name + ".sim")), folder.path);
  }
}

TEST(CExport, GalleryIsTheModelsOfOneMode) {
  const TestFolder folder;
  std::size_t models = 0;
  for (const fs::path& file : gallery()) {
    SCOPED_TRACE(file);
    const Loaded loaded = model_of_gallery(file);
    if (loaded.model->has_world() || loaded.model->modes.size() != 1 || !loaded.model->inputs.empty()) continue;
    expect_that_c_is(loaded, folder.path);
    ++models;
  }
  EXPECT_GT(models, 30u);
}

TEST(CExport, AGridOfManyPointsIsFewLines) {
  const Loaded loaded = load(Source("heat.sim", R"(model Heat
param N = 20000
for i in 1..N { u[i](0) = 0 }
u[1]' = u[2] - 2*u[1] + 1
for i in 2..N-1 { u[i]' = u[i-1] - 2*u[i] + u[i+1] }
u[N]' = u[N-1] - 2*u[N]
run 0..1
)"));
  ASSERT_TRUE(loaded);
  const Result<std::string> text = c_text(*compile(*loaded.model));
  ASSERT_TRUE(text);
  const std::size_t rates = text->find("void Heat_rates"), end = text->find("\n}", rates);
  EXPECT_LT(std::ranges::count(text->substr(rates, end - rates), '\n'), 40);
}

}  // namespace
}  // namespace continuo::model::native_models_test
