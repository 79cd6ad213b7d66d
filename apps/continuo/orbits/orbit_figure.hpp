// A closed orbit as a picture.
#pragma once
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/results/figure.hpp>

namespace continuo::app {

/// The first two states against each other, where there are two, and the first over one period. `times` from 0 on.
results::Figure orbit_figure(const model::Model& model, const std::vector<double>& times,
                             const std::vector<std::vector<double>>& states);

}  // namespace continuo::app
