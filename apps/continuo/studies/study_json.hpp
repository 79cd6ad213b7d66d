// What studies give, as JSON objects for programs: names and numbers, nothing rounded. What is no number is null.
#pragma once
#include <string>
#include <vector>

#include <continuo/studies/compare.hpp>
#include <continuo/studies/converge.hpp>
#include <continuo/studies/phase_portrait.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::app {

/// The rows with every state and its derivatives, and the events with those of their times.
std::string sensitivity_json(const model::Model& model, const studies::SensitivityRun& run,
                             const std::vector<studies::Influence>& influences);
std::string comparison_json(const studies::Comparison& comparison);
std::string convergence_json(const studies::Convergence& study);
std::string portrait_json(const model::Model& model, const studies::PhasePortrait& portrait,
                          const studies::PhasePlane& plane);

}  // namespace continuo::app
