// What is wanted of a picture of a motion: plots, each with its axes.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::results {

/// A plot of a motion, as the model or a caller asks for it.
struct PlotRequest {
  model::Plot plot;
  bool logarithmic_x = false, logarithmic_y = false;
  /// Not empty: a profile. The curves' values at each of these times are one curve, over their number or over as many
  /// values of `places`.
  std::vector<double> times{};
  std::vector<model::Series> places{};
  double first_place = 1;       // the number of the first curve where there are no places
  std::string profile_label{};  // "u[1..20]"
};

/// The model's `plot` statements; empty where there are none.
[[nodiscard]] std::vector<PlotRequest> plot_requests(const model::Model& model);

/// The states that a picture shows where no plot says what to draw: up to eight, none of a body that is fixed.
[[nodiscard]] std::vector<std::size_t> states_to_plot(const model::Model& model);

}  // namespace continuo::results
