// The derivatives of residuals, each over the deviation of its row: what they tell of the unknowns and what they do
// not. Internal to fit.
#pragma once
#include <Eigen/Dense>
#include <span>

#include <continuo/studies/fit/variance_components.hpp>

namespace continuo::studies::detail {

/// J = Q S V^T D of the rows over their deviations, D the lengths of the columns: what can be told and what cannot.
struct Decomposed {
  Eigen::MatrixXd q;         // orthonormal, rows by rank
  Eigen::MatrixXd back;      // D^-1 V S^-1: from coordinates along q to unknowns
  Eigen::MatrixXd null;      // D^-1 V of the rest: moves without any effect
  Eigen::VectorXd leverage;  // of each row
};

/// An unknown whose move by its own size (where `sizes` are given) is seen no better than the accuracy is not seen.
[[nodiscard]] Decomposed decomposed(const VarianceComponents& noise, std::span<const double> jacobian, double accuracy,
                                    std::span<const double> sizes = {});

}  // namespace continuo::studies::detail
