// Where the equations of a model jump, located or not: what `switches.hpp` finds to be located is a part of it.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::model {

/// A jump in the equation of a state.
struct Jump {
  std::size_t state;
  NodeId node, first, second;  // of the jump, and its arguments; without a second one the first again
};
[[nodiscard]] std::vector<Jump> jumps_of(const Model& model, std::size_t mode);

/// How far the arguments of a jump are from where it is: a difference, or a part of a whole number.
[[nodiscard]] double distance_to(Op op, double a, double b);

/// "1 < x"
[[nodiscard]] std::string text_of(const Model& model, const Jump& jump);

}  // namespace continuo::model
