// Parameters and states by the names that a command line gives.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <apps/continuo/options/experiment_options.hpp>

#include <continuo/language/model.hpp>
#include <continuo/studies/sensitivity/influence.hpp>

namespace continuo::app {

/// Says which name is unknown, or that there are none.
std::optional<std::vector<studies::Influence>> influences_named(const model::Model& model,
                                                                const std::vector<std::string>& parameters,
                                                                const std::vector<std::string>& initial);

/// Derivatives are integrated along with the motion, by a method for both that is chosen by size and tolerance:
/// --method and --step are refused with this reason.
void refuse_methods(CLI::App& verb);
/// Says so where the model's `run` has a step: errors that `continuo run` shows with it are missing here.
void say_step_has_no_part(const Prepared& prepared);

/// "there is no ...; did you mean `k`?", or all the names there are.
std::string no_such(const std::string& kind, const std::string& name, const std::vector<std::string>& names);

}  // namespace continuo::app
