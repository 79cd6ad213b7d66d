// The second way to boundary values: integrate from guessed states at several times, and change these by Newton's
// iteration until the pieces join and the conditions hold. What the integrator's error control gives is what the motion
// has; fewer unknowns than collocation, but every piece must be integrable: not for layers. J. Stoer, R. Bulirsch,
// "Introduction to Numerical Analysis", 7.3.5.
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/studies/boundary_value.hpp>

namespace continuo::studies {

struct ShootingOptions {
  std::size_t segments = 8;  // between two times of conditions
  double rtol = 1e-10, atol = 1e-12;
  double tolerance = 1e-9;  // of the last correction, relative to the size of each component
  std::size_t most_iterations = 50;
  const std::atomic<bool>* interrupt = nullptr;
};

struct ShootingSolution {
  Outcome<double> outcome;
  std::vector<double> times;                // of the joints
  std::vector<std::vector<double>> states;  // there
  std::vector<double> parameters;
  std::size_t iterations = 0;
};

ShootingSolution solve_by_shooting(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess = {},
                                   const ShootingOptions& options = {});

}  // namespace continuo::studies
