// A closed orbit through all that happens on it, as a line, and how far it goes. Internal to hybrid_orbit.
#pragma once
#include <memory>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/stepping.hpp>

namespace continuo::studies::detail {

struct OrbitTrace {
  std::vector<double> t;  // both sides of an event
  std::vector<std::vector<double>> x;
  std::vector<double> low, high;  // of each state on the way
};

[[nodiscard]] OrbitTrace traced(const std::shared_ptr<const model::ModelProgram>& program,
                                const model::Experiment& exact, const model::Instant& start, double period);

}  // namespace continuo::studies::detail
