// What studies give, as JSON objects for programs: names and numbers, nothing rounded. What is no number is null.
#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <continuo/studies/compare.hpp>
#include <continuo/studies/converge.hpp>
#include <continuo/studies/difference_schemes.hpp>
#include <continuo/studies/phase_portrait.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::app {

/// The rows with every state and its derivatives, and the events with those of their times.
nlohmann::json sensitivity_json(const model::Model& model, const studies::SensitivityRun& run,
                                const std::vector<studies::Influence>& influences);
nlohmann::json comparison_json(const studies::Comparison& comparison);
nlohmann::json convergence_json(const studies::Convergence& study);
/// `continuo converge --derivative`.
nlohmann::json differences_json(const std::vector<studies::DifferenceErrors>& study, const std::string& expression,
                                double at);
nlohmann::json portrait_json(const model::Model& model, const studies::PhasePortrait& portrait,
                             const studies::PhasePlane& plane);

}  // namespace continuo::app
