// Where a parametric system takes a state, and how that depends on the state and on the constants: integration from the
// start, the method chosen by tolerance and size, compiled once for all studies.
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/solve/options.hpp>
#include <continuo/solve/solution.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// A run with the constants p.
[[nodiscard]] Solution<std::vector<double>> run_flow(const ParametricSystem& system, Values p, std::vector<double> x0,
                                                     Interval<double> interval,
                                                     const Options<std::vector<double>>& options = {});

/// The system with its variational equations: behind x stand the columns of S = dx/dx(0), n of them, and with
/// `by_constants` those of dx/dp, m more: S' = (df/dx) S (+ df/dp). Each begins as `variational_start` says.
[[nodiscard]] ParametricSystem with_variations(const ParametricSystem& system, bool by_constants = false);
/// x0, the columns of the identity, zeros.
[[nodiscard]] std::vector<double> variational_start(const ParametricSystem& system, Values x0,
                                                    bool by_constants = false);

}  // namespace continuo::studies
