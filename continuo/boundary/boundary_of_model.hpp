// Models whose conditions stand at several times: solved by collocation, and given back as a run like any other.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/boundary/boundary_problem_of_model.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::boundary {

/// What is asked beside the experiment of a model whose conditions stand at several times.
struct BoundaryRequest {
  std::size_t solution = 1;  // which of several
  /// Solved at `from` first and followed to `to`, which takes the parameter's place in the experiment.
  struct Along {
    std::string parameter;
    double from, to;
  };
  std::optional<Along> along{};
  /// Where to begin, in place of the model's guesses: columns named like states, as a run writes them.
  std::optional<GuessTable> guess{};
};

/// All solutions of a boundary-value problem that the model's guesses lead to, each once, in the order of the guesses.
/// The k-th guess is the k-th `guess` statement of every state (the last where there are fewer). Without a solution no
/// runs, and diagnostics that say why (E321, E322, E33x, E34x).
struct BoundaryRuns {
  std::vector<model::Run> runs;
  std::size_t guesses = 0;
  std::vector<model::Diagnostic> diagnostics;
};
/// Solves the problem once from each guess of the model, or from the one that the request names.
[[nodiscard]] BoundaryRuns solve_boundary(const std::shared_ptr<const model::ModelProgram>& program,
                                          const model::Experiment& experiment = {},
                                          const BoundaryRequest& request = {});

/// The one of them that is asked for, as a run.
[[nodiscard]] model::Simulated simulate_boundary(const std::shared_ptr<const model::ModelProgram>& program,
                                                 const model::Experiment& experiment = {},
                                                 const BoundaryRequest& request = {});

}  // namespace continuo::boundary
