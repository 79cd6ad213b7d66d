// The Jacobian of every model of the gallery computed in four ways: from the graph, by dual numbers through the tape,
// by differences of coloured groups of columns as in the methods, and by differences with an estimate of their error.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/check_derivatives.hpp>
#include <continuo/simulation/drive/planner.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/simulation/run_along.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/symbolic/tape/tape_run.hpp>
#include <continuo/system/jacobian.hpp>

namespace continuo::model {
namespace {

using X = ModelSystem::X;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct GalleryModel {
  std::string path;
  friend void PrintTo(const GalleryModel& model, std::ostream* out) { *out << model.path; }
};

std::vector<GalleryModel> all_models() {
  std::vector<GalleryModel> all;
  for (const auto& entry : std::filesystem::directory_iterator(CONTINUO_SOURCE_DIR "/models"))
    if (entry.path().extension() == ".sim") all.push_back({entry.path().string()});
  std::ranges::sort(all, {}, &GalleryModel::path);
  return all;
}

/// Models with bodies have no equations. They are recognized by their text alone, since every test of this program
/// calls this before it starts.
bool seems_to_have_world(const GalleryModel& model) {
  std::ifstream file(model.path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("world")) return true;
  return false;
}

std::vector<GalleryModel> gallery() {
  std::vector<GalleryModel> all = all_models();
  std::erase_if(all, seems_to_have_world);
  return all;
}

TEST(Gallery, WorldsAreSeenByTheirFirstWord) {
  for (const GalleryModel& model : all_models()) {
    const Loaded loaded = load(model.path);
    ASSERT_TRUE(loaded) << model.path;
    EXPECT_EQ(loaded.model->has_world(), seems_to_have_world(model)) << model.path;
  }
}

/// df/dx row by row by ceres::Jet as the number type of the tape, some columns a call.
std::vector<double> by_duals(const Tape& tape, const Layout& layout, std::vector<double> variables, const X& x) {
  constexpr int columns = 8;
  using Dual = ceres::Jet<double, columns>;
  const std::size_t n = x.size();
  std::ranges::copy(x, variables.begin() + layout.states);
  std::vector<Dual> registers(tape.register_count()), f(n);
  std::vector<double> rows(n * n);
  for (std::size_t first = 0; first < n; first += columns) {
    for (std::size_t i = 0; i < variables.size(); ++i) registers[i] = Dual(variables[i]);
    const std::size_t count = std::min<std::size_t>(columns, n - first);
    for (std::size_t j = 0; j < count; ++j) registers[layout.states + first + j].v[static_cast<int>(j)] = 1;
    tape.prepare<Dual>(registers);
    tape.evaluate<Dual>(registers, f);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < count; ++j) rows[i * n + first + j] = f[i].v[static_cast<int>(j)];
  }
  return rows;
}

/// A model with its sparsity pattern but no derivatives.
struct OnlyPattern {
  ModelSystem& system;
  void operator()(double t, const X& x, X& dxdt) { system(t, x, dxdt); }
  const SparsePattern& jacobian_pattern() { return system.jacobian_pattern(); }
};
static_assert(!HasSparseJacobian<OnlyPattern, X> && !HasJacobian<OnlyPattern, X>);

class GalleryJacobian : public testing::TestWithParam<GalleryModel> {
 protected:
  void SetUp() override {
    const Loaded loaded = load(GetParam().path);
    ASSERT_TRUE(loaded);
    program_ = compile(*loaded.model);
    run_ = motion();
    ASSERT_GT(run_.motion.rows(), 1U);
    size_ = program_->model.states.size();
    sizes_.assign(size_, 0);
    rates_.assign(size_, 0);
    at_moments([&](ModelSystem& system, double t, const X& x) {
      X f(size_);
      system(t, x, f);
      for (std::size_t i = 0; i < size_; ++i) {
        sizes_[i] = std::max(sizes_[i], std::abs(x[i]));
        rates_[i] = std::max(rates_[i], std::abs(f[i]));
      }
    });
  }

  /// The run of the model; for a boundary-value problem an arbitrary motion, since derivatives of f can be tested
  /// anywhere.
  model::Run motion() const {
    if (!program_->model.needs_boundary_solver()) {
      auto simulated = simulate(program_, {.output_steps = true, .max_steps = 2000});
      return simulated.run ? std::move(*simulated.run) : model::Run{};
    }
    std::vector<Diagnostic> problems;
    const Experiment experiment{.output_steps = true};
    Planner planner(program_->model, experiment, problems);
    planner.begin();
    planner.set_integration();
    auto planned = planner.finish();
    if (!planned) return {};
    const double from = planned->from, third = (planned->to - from) / 3;
    const std::vector<double> steps{from + third, from + 2 * third};
    return run_along(*program_, std::move(*planned), steps, [](double t, X& x) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.3 + 0.5 * std::sin(t + static_cast<double>(i));
    });
  }

  /// Visits some rows of the run, in every mode, since derivatives of f can be tested anywhere.
  template <class Visit>
  void at_moments(Visit&& visit) {
    constexpr std::size_t most = 12;
    const std::size_t rows = run_.motion.rows(), stride = (rows + most - 1) / most;
    ModelSystem system(program_, run_.plan.variables);
    for (std::size_t row = 0; row < rows; row += stride) {
      const double t = run_.motion.time(row);
      const auto state = run_.motion.state(row);
      for (const TableInput& input : program_->step_inputs) system.set(input.variable, input.table.value(t));
      for (std::size_t mode = 0; mode < program_->model.modes.size(); ++mode) {
        system.go(mode);
        visit(system, t, X(state.begin(), state.end()));
      }
    }
  }

  std::vector<double> exact(ModelSystem& system, double t, const X& x) {
    std::vector<double> rows(size_ * size_);
    system.jacobian(t, x, rows);
    return rows;
  }

  /// The greatest value of entry (i, j) that is compatible with row i along the run: the scale for its error.
  double part_of_row(const std::vector<double>& rows, std::size_t i, std::size_t j) const {
    double greatest = rates_[i];
    for (std::size_t k = 0; k < size_; ++k) greatest = std::max(greatest, std::abs(rows[i * size_ + k]) * sizes_[k]);
    return sizes_[j] > 0 ? greatest / sizes_[j] : greatest;
  }

  /// The band gets the same entries, and no other entry of it is written.
  static void expect_same_in_band(ModelSystem& system, double t, const X& x, std::span<const double> values) {
    const SparsePattern& pattern = system.jacobian_pattern();
    if (!pattern.is_banded()) return;
    constexpr double untouched = -7;
    std::vector<double> band(pattern.band().numbers(), untouched), expected = band;
    const std::vector<std::uint32_t> places = pattern.places_in_band();
    for (std::size_t p = 0; p < places.size(); ++p) expected[places[p]] = values[p];
    system.jacobian_band(t, x, band);
    ASSERT_EQ(band, expected);
  }

  std::shared_ptr<const ModelProgram> program_;
  model::Run run_;
  std::size_t size_ = 0;
  X sizes_, rates_;  // the largest of each state and of its derivative
};

// Both Jacobians are exact but for the rounding of some hundred operations.
TEST_P(GalleryJacobian, OfTheGraphIsThatOfDuals) {
  at_moments([&](ModelSystem& system, double t, const X& x) {
    std::vector<double> variables = run_.plan.variables;
    variables[Layout::time] = t;
    for (const TableInput& input : program_->step_inputs) variables[input.variable] = input.table.value(t);
    const auto rows = exact(system, t, x);
    const auto dual = by_duals(*program_->derivatives[system.mode()], program_->model.layout, variables, x);
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) {
        ASSERT_NEAR(rows[i * size_ + j], dual[i * size_ + j], 1000 * epsilon * part_of_row(rows, i, j))
            << "d(" << program_->model.states[i].column << "')/d(" << program_->model.states[j].column << ") at " << t;
      }
    }
  });
}

// The difference quotient over [x, x + d] is the mean of the derivative there. Its error is at most the change of the
// derivative over it, plus the rounding of f: some roundings of its terms over d.
TEST_P(GalleryJacobian, OfTheGraphIsThatOfColouredDifferences) {
  ModelSystem first(program_, run_.plan.variables);
  const SparsePattern pattern = first.jacobian_pattern();
  const ColumnGroups groups(pattern);
  const auto least = [&](std::size_t j) { return std::sqrt(epsilon) * (sizes_[j] > 0 ? sizes_[j] : 1.0); };
  at_moments([&](ModelSystem& system, double t, const X& x) {
    X fx(size_), moved = x, slope(size_);
    OnlyPattern f{system};
    f(t, x, fx);
    std::vector<double> differences(pattern.entries()), values(pattern.entries()), beyond(pattern.entries());
    evaluate_jacobian(f, t, x, fx, moved, slope, least, pattern, groups, std::span(differences));
    system.jacobian_values(t, x, values);
    expect_same_in_band(system, t, x, values);
    const auto rows = exact(system, t, x);
    for (std::size_t g = 0; g < groups.count(); ++g) {
      X group_moved = x;
      for (const std::size_t j : groups.group(g)) group_moved[j] += difference_increment(x[j], least(j));
      system.jacobian_values(t, group_moved, beyond);
      for (const std::size_t j : groups.group(g)) {
        const double increment = group_moved[j] - x[j];
        for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p) {
          const std::size_t i = pattern.row(p);
          const double truncation = std::abs(beyond[p] - values[p]);
          const double rounding = 100 * epsilon * part_of_row(rows, i, j) * std::max(sizes_[j], increment) / increment;
          ASSERT_NEAR(differences[p], values[p], truncation + rounding)
              << "d(" << program_->model.states[i].column << "')/d(" << program_->model.states[j].column << ") at "
              << t;
        }
      }
    }
  });
}

TEST_P(GalleryJacobian, AnAutonomousModelHasNoDerivativeByTime) {
  at_moments([&](ModelSystem& system, double t, const X& x) {
    X by_time(size_, 1);
    system.time_derivative(t, x, by_time);
    if (!system.autonomous) return;
    ASSERT_EQ(by_time, X(size_, 0)) << "at " << t;
  });
}

TEST_P(GalleryJacobian, OfTheGraphAndByTimeAreThoseOfDifferencesToTheirLastTrustedDigit) {
  if (program_->model.needs_boundary_solver()) GTEST_SKIP() << "it follows a run from the start";
  std::vector<Diagnostic> problems;
  const auto report = check_derivatives(program_, {}, problems);
  ASSERT_TRUE(report);
  EXPECT_GT(report->points, 2U);
  for (const DerivativeEntry& entry : report->wrong)
    ADD_FAILURE() << entry.name << " at " << entry.t << ": " << entry.exact << ", by differences " << entry.measured;
  EXPECT_TRUE(report->kinks.empty());
  EXPECT_TRUE(report->undecided.empty());
  ASSERT_TRUE(report->furthest);
  EXPECT_LT(report->furthest->apart, 1e-9);  // the differences are accurate
}

INSTANTIATE_TEST_SUITE_P(Models, GalleryJacobian, testing::ValuesIn(gallery()),
                         [](const auto& model) { return std::filesystem::path(model.param.path).stem().string(); });

TEST(CheckDerivatives, KinksOfAModelAreSaid) {
  const Loaded loaded =
      load(Source("kink.sim", "x' = v\nv' = -abs(v) - max(x - 1, 0)\nx(0) = 1; v(0) = 0\nrun 0..1\n"));
  ASSERT_TRUE(loaded) << loaded.text();
  std::vector<Diagnostic> problems;
  const auto report = check_derivatives(compile(*loaded.model), {}, problems);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->agrees());
  ASSERT_EQ(report->kinks.size(), 2U);  // of max at x = 1 and of abs at v = 0
  EXPECT_EQ(report->kinks[0].name, "d(v')/d(x)");
  EXPECT_NEAR(report->kinks[0].above, -1, 1e-9);
  EXPECT_EQ(report->kinks[1].name, "d(v')/d(v)");
}

TEST(CheckDerivatives, AModelThatCannotRunSaysWhy) {
  const Loaded loaded = load(Source("x.sim", "x' = -x\nx(0) = 1\n"));
  std::vector<Diagnostic> problems;
  EXPECT_FALSE(check_derivatives(compile(*loaded.model), {}, problems));
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(problems.front().code, "E333");
}

}  // namespace
}  // namespace continuo::model
