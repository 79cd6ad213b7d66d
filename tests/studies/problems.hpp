// tests/studies/problems.hpp
// Systems shared by tests of studies: known from the literature, or models from text and from the gallery.
#pragma once
#include <memory>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// E. N. Lorenz, J. Atmos. Sci. 20 (1963), with the constants sigma, rho, beta.
inline ParametricSystem lorenz(double rho) {
  const auto f = [](double, Values x, Values p, std::span<double> dxdt) {
    dxdt[0] = p[0] * (x[1] - x[0]);
    dxdt[1] = x[0] * (p[1] - x[2]) - x[1];
    dxdt[2] = x[0] * x[1] - p[2] * x[2];
  };
  return parametric_system(3, f, {10, rho, 8.0 / 3});
}

inline std::shared_ptr<const model::ModelProgram> program_of(const model::Loaded& loaded) {
  EXPECT_TRUE(loaded) << loaded.text();
  return model::compile(*loaded.model);
}
inline std::shared_ptr<const model::ModelProgram> program_of(const std::string& text) {
  return program_of(model::load(model::Source("test.sim", text)));
}
inline std::shared_ptr<const model::ModelProgram> gallery(const std::string& name) {
  return program_of(model::load(CONTINUO_SOURCE_DIR "/models/" + name + ".sim"));
}

}  // namespace continuo::studies
