// Measurements in the units of the model that they are compared with.
#pragma once
#include <string>

#include <continuo/studies/fit.hpp>

namespace continuo::app {

/// Of a state, output, let or energy; empty where it has none.
std::string unit_of_quantity(const model::Model& model, const std::string& name);

/// Times, values and deviations from the units of their headings to the model's. False after saying which unit does
/// not fit.
bool to_units_of_model(studies::FitRequest& request);

}  // namespace continuo::app
