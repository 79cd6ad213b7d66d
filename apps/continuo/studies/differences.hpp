// Difference schemes for the derivative of a function that is given as text.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <continuo/results/figure.hpp>
#include <continuo/studies/difference_schemes.hpp>

namespace continuo::app {

/// An expression of the model language in x. Says what is wrong with it.
std::optional<std::vector<studies::DifferenceErrors>> study_differences(const std::string& expression, double at);

std::string differences_text(const std::vector<studies::DifferenceErrors>& study, bool in_float);
results::Figure differences_figure(const std::vector<studies::DifferenceErrors>& study, bool in_float,
                                   const std::string& title);

}  // namespace continuo::app
