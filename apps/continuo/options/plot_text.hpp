// What --plot says besides the name of a file: plots of the motion in the words of the language.
//
//   y against x                              one panel for each unit
//   u[1..N] against index at 0, 1, 5         profiles of a family at times
//   c1, c2 against t log xy                  logarithmic axes
//   h; h' against h                          one panel below the other
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/continuo/options/experiment_options.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/plot_request.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::app {

/// Whether a value of --plot is the name of a file, by its ending; else it is the text of plots.
bool names_picture(const std::string& value);

/// Plots, and the program that their expressions belong to: the model's, with the plots as if it contained them.
struct AskedPlots {
  std::shared_ptr<const model::ModelProgram> program;
  std::vector<results::PlotRequest> plots;
};

/// The plots that the texts ask for, or those of the model where there are none. Nothing where a text is wrong, which
/// has been said, with the place in it.
std::optional<AskedPlots> read_plots(const std::vector<std::string>& texts, const Prepared& prepared);

/// "1280x720"; nothing where the text is no size from 100 to 10000 pixels.
std::optional<results::PictureSize> read_size(const std::string& text);

}  // namespace continuo::app
