// tests/results/example.hpp
// A run made by hand: a ball that falls from h = 1 with g = 2, so that h = 1 - t^2 and the floor is hit at t = 1.
#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include <continuo/language/model.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::results {

struct Example {
  model::Model model;
  model::Run run;
};

inline Example falling_ball() {
  Example example;
  auto& [model, run] = example;
  model.name = "Ball";
  model.text = {"ball.sim", "model Ball\nh'' = -2\n"};
  model.time_unit = "s";
  model.parameters = {{.name = "g",
                       .variable = 3,
                       .expression = {},
                       .value = 2,
                       .unit = "m/s^2",
                       .range = {},
                       .comment = "",
                       .independent = true,
                       .structural = false,
                       .span = {}}};
  run.plan = {.method = "dop853",
              .reason = "",
              .rtol = 1e-10,
              .rtol_each = {},
              .atol = {1e-12},
              .from = 0,
              .to = 1,
              .variables = {0, 1, 0, 2}};
  run.motion.columns = {{"t", "s"}, {"h", "m"}, {"h'", "m/s"}};
  run.motion.values = {0, 1, 0, 0.5, 0.75, -1, 1, 0, -2, 1, 0, 1};
  run.motion.states = 2;
  run.total_energy = {2, 2, 2, 0.5};
  run.events = {{"h falls through 0", "", 1, {0, -2}, {0, 1}}};
  run.outcome.t = 1;
  run.statistics = {.steps = 3, .rejected = 1, .evaluations = 48, .events = 1, .seconds = 0.25};
  run.energy = model::EnergyBalance{2, 0.5, 0.75, "J"};
  run.checks = {{"h(1) = 0 within 1e-9", true, 0, 0, 1e-9, "m", ""}};
  return example;
}

/// A folder of one's own, gone at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("continuo-test-" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

inline std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace continuo::results
