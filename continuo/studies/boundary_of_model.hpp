// Models whose conditions stand at several times: solved by collocation, and given back as a run like any other.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include <continuo/model/simulate.hpp>

namespace continuo::studies {

/// Runs any model: by integration from the start, or, where its conditions stand at several times, by collocation; then
/// `solution` (from 1) says which of several is wanted.
model::Simulated run_model(const std::shared_ptr<const model::ModelProgram>& program,
                           const model::Experiment& experiment = {}, std::size_t solution = 1);

/// All solutions of a boundary-value problem that the model's guesses lead to, each once, in the order of the guesses.
/// The k-th guess is the k-th `guess` statement of every state (the last where there are fewer). Without a solution no
/// runs, and diagnostics that say why (E321, E322, E33x, E34x).
struct BoundaryRuns {
  std::vector<model::Run> runs;
  std::size_t guesses = 0;
  std::vector<model::Diagnostic> diagnostics;
};
BoundaryRuns solve_boundary(const std::shared_ptr<const model::ModelProgram>& program,
                            const model::Experiment& experiment = {});

}  // namespace continuo::studies
