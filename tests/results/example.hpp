// tests/results/example.hpp
// A run made by hand: a ball that falls from h = 1 with g = 2, so that h = 1 - t^2 and the floor is hit at t = 1.
#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include <continuo/results/record.hpp>

namespace continuo::results {

inline Record falling_ball() {
  Record record;
  record.setup = {.model = "Ball",
                  .path = "ball.sim",
                  .text = "model Ball\nh'' = -2\n",
                  .parameters = {{"g", 2}},
                  .method = "dop853",
                  .rtol = 1e-10,
                  .atol = {1e-12},
                  .from = 0,
                  .to = 1,
                  .time_unit = "s",
                  .seed = {}};
  record.motion.columns = {{"t", "s"}, {"h", "m"}, {"h'", "m/s"}};
  record.motion.values = {0, 1, 0, 0.5, 0.75, -1, 1, 0, -2, 1, 0, 1};
  record.states = 2;
  record.events = {{"h falls through 0", 1, {0, -2}, {0, 1}}};
  record.outcome.t = 1;
  record.statistics = {.steps = 3, .rejected = 1, .evaluations = 48, .events = 1, .seconds = 0.25};
  record.energy = EnergyBalance{2, 0.5, 0.75, "J"};
  record.checks = {{"h(1) = 0 within 1e-9", true, 0, 0, 1e-9, "m", ""}};
  return record;
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
