// A step of a method as its dense output has it, one component at a time.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/numerics/enclosure.hpp>
#include <continuo/numerics/polynomial_enclosure.hpp>

namespace continuo::model {

/// x(begin + theta*size) = sum_j coefficients[j] theta^j for theta in 0..1.
struct Step {
  double begin, size;
  std::span<const std::vector<double>> coefficients;

  [[nodiscard]] Enclosure<double> time(double from, double to) const {
    return Enclosure<double>(begin) + Enclosure<double>(from, to) * Enclosure<double>(size);
  }
};

/// The coefficients of one component, side by side.
class StepComponent {
 public:
  StepComponent() : coefficients_(greatest_enclosed_degree + 1) {}
  /// Until the next call.
  [[nodiscard]] std::span<const double> of(const Step& step, std::size_t i) {
    for (std::size_t j = 0; j < step.coefficients.size(); ++j) coefficients_[j] = step.coefficients[j][i];
    return std::span<const double>(coefficients_).first(step.coefficients.size());
  }

 private:
  std::vector<double> coefficients_;
};

}  // namespace continuo::model
