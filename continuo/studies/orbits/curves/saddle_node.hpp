// A saddle-node near by: an equilibrium with an eigenvalue zero, for one value of a constant. Internal to
// homoclinic_curve, which needs one where a closed orbit of long period has passed the place where it is about to be.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include <continuo/system/parametric_system.hpp>

namespace continuo::studies::detail {

struct SaddleNode {
  std::vector<double> x{};
  std::vector<double> constants{};  // all of the system's
  std::size_t stable = 0;           // eigenvalues on the left, beside the one that is zero
};

/// By Newton's method from x and the constants p, of which one may change. Components count in `sizes`, the constant in
/// `size_of_constant`. Nothing where it does not converge, or leaves by more than a tenth of these.
[[nodiscard]] std::optional<SaddleNode> saddle_node_near(const ParametricSystem& system, std::size_t constant,
                                                         const Values& x, const Values& p, const Values& sizes,
                                                         double size_of_constant);

}  // namespace continuo::studies::detail
