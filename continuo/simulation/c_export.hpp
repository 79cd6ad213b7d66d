// A model's equations as C: right-hand side, Jacobian, guards and outputs, for programs that bring their own solver.
//
//   const Result<std::string> text = c_text(*compile(*load("spring.sim").model));
//
// The text is one file of C11 that needs <math.h> alone. A comment at its top explains the calls.
#pragma once
#include <string>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/status/result.hpp>

namespace continuo::model {

/// Refused, with a sentence: models with bodies, whose motion is no differential equation. The numbers that the
/// functions give are those of the simulation, to the bit, where the compiler does not contract products and sums
/// (`-ffp-contract=off`).
[[nodiscard]] Result<std::string> c_text(const ModelProgram& program);

}  // namespace continuo::model
