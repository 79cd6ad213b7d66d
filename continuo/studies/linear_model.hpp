// A model near one point as a linear system: x' = A x + B u, y = C x + D u, all exact by the model's graph. Its inputs
// are the `input`s of the model, its outputs the `output`s.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/studies/equilibria/algebraic_elimination.hpp>

namespace continuo::studies {

/// The matrices of a linear system, with names.
struct LinearModel {
  std::vector<std::string> states, inputs, outputs;  // without the unknowns of algebraic equations, which are taken out
  std::vector<double> a, b, c, d;                    // row by row: n * n, n * inputs, outputs * n, outputs * inputs
  Undetermined undetermined{};                       // by the algebraic equations; then the matrices are empty
};

/// At (t, x), inputs and parameters as the model has them unless `parameters` says otherwise.
[[nodiscard]] LinearModel linearize_model(const std::shared_ptr<const model::ModelProgram>& program,
                                          std::vector<double> x, double t, const model::Overrides& parameters = {},
                                          std::size_t mode = 0);

}  // namespace continuo::studies
