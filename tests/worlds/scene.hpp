// Worlds from texts.
#pragma once
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/parser.hpp>
#include <continuo/worlds/simulate_world.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

inline std::shared_ptr<const model::ModelProgram> program_of(const std::string& text) {
  const model::Source source("scene.sim", text);
  model::ParseResult parsed = model::parse(source);
  EXPECT_FALSE(has_errors(parsed.diagnostics)) << render(parsed.diagnostics, source);
  model::Checked checked = check(parsed.model, source);
  EXPECT_FALSE(has_errors(checked.diagnostics)) << render(checked.diagnostics, source);
  return checked.model ? model::compile(std::move(*checked.model)) : nullptr;
}

inline std::unique_ptr<WorldRun> started(const std::string& text, const WorldOptions& options = {}) {
  const auto program = program_of(text);
  auto world = start_world(program, options, start_values(program->model));
  EXPECT_TRUE(world) << world.status().message;
  return world ? *std::move(world) : nullptr;
}

inline model::Run run_of(const std::string& text, const model::Experiment& experiment = {}) {
  const auto program = program_of(text);
  model::Simulated simulated = simulate_world(program, experiment);
  EXPECT_TRUE(simulated.run) << render(simulated.diagnostics, model::Source("scene.sim", text));
  return std::move(simulated.run).value();
}

inline std::string failed_checks(const model::Run& run) {
  std::string text;
  for (const model::CheckResult& check : run.checks)
    if (!check.passed) text += check.text + ": " + std::to_string(check.value) + " " + check.message + "\n";
  return text;
}

inline double last(const model::Run& run, const std::string& column) {
  for (std::size_t i = 0; i < run.motion.columns.size(); ++i)
    if (run.motion.columns[i].name == column) return run.motion.row(run.motion.rows() - 1)[i];
  ADD_FAILURE() << "no column " << column;
  return 0;
}

}  // namespace continuo::worlds
