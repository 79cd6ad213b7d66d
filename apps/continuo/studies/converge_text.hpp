// A study of convergence as people read it: a table, a picture.
#pragma once
#include <string>
#include <vector>

#include <continuo/results/figure.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/studies/converge.hpp>

namespace continuo::app {

/// False, and said which, where a name is no method for models of this kind.
bool known_methods(const std::vector<std::string>& names, const runs::Kind& kind = {});

/// Ends a line of a table, without blanks at its end.
void end_line(std::string& text);

/// A line per method; with `all_points` every step of each below it.
std::string convergence_text(const studies::Convergence& study, const model::Model& model, bool in_float,
                             bool in_long_double, bool all_points);
results::Figure convergence_figure(const studies::Convergence& study, const std::string& title);

}  // namespace continuo::app
