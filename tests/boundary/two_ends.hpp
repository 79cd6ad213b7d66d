// Conditions at both ends and models from text, shared by tests of boundary values.
#pragma once
#include <memory>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::boundary {

/// The conditions x(first) = a, x(last) = b of a boundary-value problem x'' = ...
inline auto ends(double a, double b) {
  return [a, b](Values x, Values, std::span<double> g) {
    g[0] = x[0] - a;
    g[1] = x[2] - b;
  };
}

inline std::shared_ptr<const model::ModelProgram> program_of(const std::string& text) {
  const model::Loaded loaded = model::load(model::Source("test.sim", text));
  EXPECT_TRUE(loaded) << loaded.text();
  return model::compile(*loaded.model);
}

}  // namespace continuo::boundary
