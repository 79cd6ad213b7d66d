// continuo/results/summary.hpp
// A run in a few lines for the terminal: how it ended, final state, events, energy drift, checks, cost.
#pragma once
#include <string>

#include <continuo/model/model.hpp>
#include <continuo/model/run.hpp>

namespace continuo::results {

std::string summary(const model::Model& model, const model::Run& run);

/// Six digits, as people read numbers: 0.451524, 1.2e-11, 60.
std::string short_number(double value);

/// "12.3 ms", "1.20 s".
std::string duration(double seconds);

}  // namespace continuo::results
