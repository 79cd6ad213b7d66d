// A fit as it is printed, as JSON and as a picture.
#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/studies/fit.hpp>

namespace continuo::app {

std::string fit_text(const studies::FitRequest& request, const studies::Fit& fit,
                     const std::vector<studies::Profile>& profiles);

nlohmann::json fit_json(const studies::FitRequest& request, const studies::Fit& fit,
                        const std::vector<studies::Profile>& profiles);

/// Measurements, fit and band; below them residuals over their deviations, and profiles.
results::Figure fit_figure(const studies::FitRequest& request, const studies::Fit& fit,
                           const std::vector<studies::Profile>& profiles);

}  // namespace continuo::app
