// df/dx and df/dt of a model for eight runs at once, and for one: both to the same bits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/simulation/program/derivative_tapes.hpp>
#include <continuo/simulation/together/lane_tape.hpp>

namespace continuo::model {

class LaneDerivatives {
 public:
  using Wide = LaneTape::Wide;

  /// Of this mode. `code`: the machine code of the entries of df/dx, or null.
  LaneDerivatives(std::shared_ptr<const DerivativeTapes> tapes, std::shared_ptr<NativeFunction> code,
                  std::size_t mode = 0);

  /// df/dx row by row; Real is a number or lanes of them. p as for LaneTape.
  template <class Real>
  void jacobian(const Real& t, std::span<const Real> x, std::span<Real> rows, std::span<const Real> p);
  template <class Real>
  void time_derivative(const Real& t, std::span<const Real> x, std::span<Real> dfdt, std::span<const Real> p);

 private:
  template <class Real>
  [[nodiscard]] std::vector<Real>& values();

  std::shared_ptr<const DerivativeTapes> tapes_;
  std::span<const std::uint32_t> moving_;
  LaneTape entries_, by_time_;
  std::vector<double> values_;
  std::vector<Wide> wide_values_;
};

extern template void LaneDerivatives::jacobian(const double&, std::span<const double>, std::span<double>,
                                               std::span<const double>);
extern template void LaneDerivatives::jacobian(const Wide&, std::span<const Wide>, std::span<Wide>,
                                               std::span<const Wide>);
extern template void LaneDerivatives::time_derivative(const double&, std::span<const double>, std::span<double>,
                                                      std::span<const double>);
extern template void LaneDerivatives::time_derivative(const Wide&, std::span<const Wide>, std::span<Wide>,
                                                      std::span<const Wide>);

}  // namespace continuo::model
