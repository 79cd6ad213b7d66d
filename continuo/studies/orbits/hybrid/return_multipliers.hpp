// Multipliers of a closed orbit from the derivative of the flow over one period. Internal to hybrid_orbit.
#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace continuo::studies::detail {

/// Of M with a forcing: its eigenvalues, by descending size. `family`: at least one of them is known to be 1.
[[nodiscard]] std::vector<std::complex<double>> multipliers_of_flow(const Eigen::MatrixXd& m, bool family);
/// Without one: that of the shift along the orbit, in the direction of f = x', is 1. The others are those of the return
/// to a plane x_s = const, dP = (1 - f e_s^T / f_s) M without row and column s, which keeps the digits of small ones.
[[nodiscard]] std::vector<std::complex<double>> multipliers_of_flow(const Eigen::MatrixXd& m, const Eigen::VectorXd& f,
                                                                    bool family);

}  // namespace continuo::studies::detail
