// What the tolerances of a run leave open of quantities that are computed from its states: how much they change where
// every state is off by its tolerance. Pictures magnify nothing that is smaller.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <continuo/simulation/experiment.hpp>

namespace continuo::results {

/// The largest change of quantities by the tolerances of the states, over the instants that it has looked at.
class QuantityTolerance {
 public:
  /// Writes the quantities of a state.
  using Quantities = std::function<void(std::span<const double> x, std::span<double> values)>;

  /// Of a run with this plan.
  QuantityTolerance(const model::Plan& plan, std::size_t states, std::size_t quantities);

  /// Looks at one state of the motion, where the quantities have these values.
  void see(std::span<const double> x, std::span<const double> values, const Quantities& quantities);
  /// The largest change so far of each quantity.
  [[nodiscard]] double operator[](std::size_t quantity) const { return largest_[quantity]; }

 private:
  std::vector<double> rtol_, atol_;  // of each state
  std::vector<double> size_;         // the largest absolute value so far
  std::vector<double> moved_, values_, largest_;
};

}  // namespace continuo::results
