// Sensitivities of motions whose conditions stand at several times. Internal to sensitivity.
//
// Differentiating x' = f(t, x, p), g(x(t1), x(t2), ..., p) = 0 by p gives a linear boundary-value problem for S,
//
//   S' = df/dx S + df/dp,   sum_j dg/dx(tj) (S(tj) + f(tj) tj') + dg/dp = 0,
//
// which is solved along with that for x, on a mesh that resolves both. U. M. Ascher, R. M. M. Mattheij, R. D. Russell,
// "Numerical Solution of Boundary Value Problems for Ordinary Differential Equations" (1995), section 2.3.
#pragma once
#include <memory>

#include <continuo/studies/sensitivity.hpp>
#include <continuo/studies/sensitivity/sensitive_program.hpp>

namespace continuo::studies::detail {

/// Of the first solution that the model's guesses lead to.
[[nodiscard]] SensitivityRun boundary_sensitivity(const std::shared_ptr<const SensitiveProgram>& program,
                                                  const SensitivityRequest& request);

/// Why there is none by these influences: E361.
[[nodiscard]] std::optional<model::Diagnostic> no_boundary_sensitivity(const model::Model& model,
                                                                       std::span<const Influence> influences);

}  // namespace continuo::studies::detail
