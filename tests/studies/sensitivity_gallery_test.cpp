// Sensitivities of every model of the gallery against differences of its runs.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::studies::sensitivity_gallery_test {
namespace {

/// Ends of runs for models in which, by chaos or many orbits, a difference of 1e-3 in a parameter would become large,
/// and for large models with long runs. All others run to their own end, but at most ten units of their time.
const std::map<std::string, double> ends = {
    {"arenstorf", 3},       {"beam", 1e-3},          {"double_pendulum", 2},
    {"galaxy", 0.05},       {"kepler", 5},           {"lorenz", 1},
    {"outer_planets", 300}, {"pleiades", 0.5},       {"robertson", 40},
    {"rc_diode", 1e-2},     {"relaxation", 0.05},    {"rc_ladder", 5e-3},
    {"fed_batch", 1},       {"oregonator", 0.1},     {"ball_on_stairs", 2},
    {"wave_equation", 0.2}, {"heat_equation", 0.05}, {"brusselator_line", 0.2},
    {"thermostat", 3},      {"ball_located", 8},  // the fourth impact is at 9.995
};

struct Case {
  std::shared_ptr<const model::ModelProgram> program;
  double end;
  Influence influence;

  double value() const {
    const auto start = model::start_values(program->model);
    return start[influence.kind == Influence::Kind::parameter ? program->model.parameters[influence.index].variable
                                                              : program->model.states[influence.index].variable];
  }
  SensitivityRequest request(double value, double rtol = 1e-11) const {
    SensitivityRequest request{.experiment = {.rtol = rtol}};
    // With conditions at the end, another end would be another problem.
    if (!program->model.needs_boundary_solver()) request.experiment.to = end;
    if (influence.kind == Influence::Kind::initial) {
      request.initial = {{influence.index, value}};
    } else {
      request.experiment.parameters = {{program->model.parameters[influence.index].name, value}};
    }
    return request;
  }
  /// The row at which states are compared: the first with conditions at several times, since free components are most
  /// sensitive there, else the last.
  std::size_t row(std::size_t rows) const { return program->model.needs_boundary_solver() ? 0 : rows - 1; }
  /// The state in that row, by a plain run of the model if the influence is a parameter.
  std::vector<double> state(double value, double rtol = 1e-11) const {
    const SensitivityRequest asked = request(value, rtol);
    if (influence.kind == Influence::Kind::initial) {
      const SensitivityRun run = SensitivityStudy(program, {influence}).run(asked);
      const auto x = run.row(row(run.rows()));
      return {x.begin(), x.begin() + static_cast<long>(run.states)};
    }
    model::Experiment experiment = asked.experiment;
    if (!program->model.needs_boundary_solver())
      experiment.method = program->model.needs_dae_solver() ? "radau" : "dop853_radau";
    const model::Simulated simulated = runs::run(program, experiment);
    EXPECT_TRUE(simulated.run && succeeded(simulated.run->outcome.ending));
    const auto x = simulated.run->motion.state(row(simulated.run->motion.rows()));
    return {x.begin(), x.end()};
  }
};

// Central differences with h, h/2, h/4 and Richardson's extrapolation in h^2. The last correction bounds the truncation
// error; the error e of the runs contributes e/h with weights whose sum is below 8. The errors of runs and of
// sensitivities are estimated from two computations of the same quantity, or from one with a tenth of the accuracy.
void compare(const Case& of, const std::string& name) {
  const SensitivityRun run = SensitivityStudy(of.program, {of.influence}).run(of.request(of.value()));
  ASSERT_TRUE(run.good()) << name << ": " << describe(run.status);
  const std::size_t here = of.row(run.rows());
  const SensitivityRun loose = SensitivityStudy(of.program, {of.influence}).run(of.request(of.value(), 1e-10));
  const double p = of.value(), h = p == 0 ? 1e-3 : 1e-3 * std::abs(p);
  const std::vector<double> middle = of.state(p), coarse = of.state(p, 1e-10);
  std::vector<std::vector<double>> differences;
  for (const double step : {h, h / 2, h / 4}) {
    const auto high = of.state(p + step), low = of.state(p - step);
    std::vector<double>& difference = differences.emplace_back();
    for (std::size_t i = 0; i < run.states; ++i) difference.push_back((high[i] - low[i]) / (2 * step));
  }
  // Members of a family (x[1], x[2], ...) have errors of the same size, but for chance: the largest is used for all.
  const auto family = [&](std::size_t i) {
    const model::State& state = of.program->model.states[i];
    return state.base.substr(0, state.base.find('[')) + std::string(static_cast<std::size_t>(state.primes), '\'');
  };
  std::vector<double> expected(run.states);
  std::map<std::string, double> tolerances;
  double largest = 0, loosest = 0;
  for (std::size_t i = 0; i < run.states; ++i) {
    const double first = (4 * differences[1][i] - differences[0][i]) / 3;
    const double second = (4 * differences[2][i] - differences[1][i]) / 3;
    expected[i] = (16 * second - first) / 15;
    // The factor of 100 is for the rounding of that many steps.
    const double rounding = 100 * std::numeric_limits<double>::epsilon() * std::abs(middle[i]);
    const double error_of_run = std::abs(middle[i] - run.value(here, i)) + std::abs(middle[i] - coarse[i]) + rounding;
    const double error_of_s = std::abs(run.sensitivity(here, i, 0) - loose.sensitivity(of.row(loose.rows()), i, 0));
    double& tolerance = tolerances[family(i)];
    tolerance = std::max(tolerance, std::abs(expected[i] - second) + 8 * error_of_run / h + error_of_s);
  }
  for (std::size_t i = 0; i < run.states; ++i) {
    const double s = run.sensitivity(here, i, 0), tolerance = tolerances[family(i)];
    EXPECT_NEAR(s, expected[i], tolerance)
        << name << ": d " << of.program->model.states[i].column << " / d " << name_of(of.program->model, of.influence);
    largest = std::max(largest, std::abs(s));
    loosest = std::max(loosest, tolerance);
  }
  EXPECT_LE(loosest, 1e-3 * largest) << name << ": the comparison says nothing";
}

TEST(SensitivityGallery, EveryModelAgreesWithDifferences) {
  std::size_t compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CONTINUO_SOURCE_DIR "/models")) {
    if (entry.path().extension() != ".sim") continue;
    const std::string name = entry.path().stem().string();
    const model::Loaded loaded = model::load(entry.path());
    ASSERT_TRUE(loaded) << loaded.text();
    if (loaded.model->has_world()) continue;  // bodies have no equations
    const auto program = model::compile(*loaded.model);
    const model::Model& model = program->model;
    std::vector<Influence> influences;
    for (std::size_t i = 0; i < model.parameters.size() && influences.size() < 2; ++i)
      if (!model.parameters[i].structural) influences.push_back({.index = i});
    if (influences.empty() && model.needs_boundary_solver()) continue;  // nothing in it could be otherwise
    if (influences.empty()) influences.push_back({Influence::Kind::initial, 0});
    EXPECT_FALSE(no_sensitivity(model, influences)) << name;
    const auto end = ends.find(name);
    const double to = end != ends.end() ? end->second : std::min(model.run.to->value, 10.0);
    for (const Influence& influence : influences) compare({program, to, influence}, name);
    ++compared;
  }
  EXPECT_GT(compared, 30u);
}

}  // namespace
}  // namespace continuo::studies::sensitivity_gallery_test
