// Families of solutions of a model whose conditions stand at several times, over one of its parameters.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/boundary/boundary_problem_of_model.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/studies/boundary/boundary_family.hpp>

namespace continuo::studies {

/// The parameter and its range.
struct FamilyRequest {
  std::string parameter;
  double low, high;
  std::optional<boundary::GuessTable> guess{};  // in place of the model's guesses
  std::function<void(double part)> progress{};
};

/// Through the solutions that the model's guesses lead to where the parameter has its value, or the end of the range
/// that is nearest to it. No families, and diagnostics that say why (E307, E321, E322, E33x, E34x).
struct ModelFamilies {
  std::vector<Family> families;
  double start = 0;  // of the parameter
  std::vector<model::Diagnostic> diagnostics;
};
/// Follows the families over the range of the parameter.
[[nodiscard]] ModelFamilies families_of_model(const std::shared_ptr<const model::ModelProgram>& program,
                                              const model::Experiment& experiment, const FamilyRequest& request);

}  // namespace continuo::studies
