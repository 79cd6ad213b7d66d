// What `continuo fit` was asked for, from the words of the command line.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <apps/continuo/options/experiment_options.hpp>

#include <continuo/studies/fit.hpp>

namespace continuo::app {

struct FitOptions {
  ExperimentOptions experiment;
  std::vector<std::string> data, parameters, initial, columns, deviations, errors, bounds, settings, priors,
      logarithmic;
  std::string loss = "squares", likelihood = "restricted", plot;
  std::optional<std::size_t> starts;
  std::size_t iterations = 500;
  bool json = false, profile = false, one_deviation = false;
};

/// Nothing after saying what is wrong.
std::optional<studies::FitRequest> fit_request(const FitOptions& options, const Prepared& prepared);

}  // namespace continuo::app
