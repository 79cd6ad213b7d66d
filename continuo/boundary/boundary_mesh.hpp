// The mesh of a boundary-value problem: where it begins, and how it follows what the solution needs. Internal to
// boundary_value.
#pragma once
#include <span>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>

namespace continuo::boundary {

/// The mesh to begin with, every time of a condition in it.
[[nodiscard]] std::vector<double> first_mesh(const BoundaryValueProblem& problem, const BoundaryValueOptions& options);

/// A new mesh whose density is, over the interval k of the old one, wanted[k] / h. The times `fixed` stay.
[[nodiscard]] std::vector<double> remeshed(const std::vector<double>& mesh, std::span<const double> wanted,
                                           std::span<const double> fixed);

/// How many intervals are to take the place of each, for its residual to come below `goal`: it falls with the fourth
/// power of the interval. The mesh grows to four times at most, since the residuals of a coarse one are no guide to
/// more.
[[nodiscard]] std::vector<double> wanted_intervals(std::span<const double> residuals, double goal);

/// The same for the error of the motion, which is to become `factor` times what it is: the intervals' shares in it,
/// which fall with the fifth power of the interval, are to be alike.
[[nodiscard]] std::vector<double> wanted_for_error(std::span<const double> shares, double factor);

}  // namespace continuo::boundary
