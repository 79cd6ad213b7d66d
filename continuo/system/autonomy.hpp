// A system that is made from another says of the time what that one says.
#pragma once
#include <type_traits>

#include <continuo/system/system.hpp>

namespace continuo::detail {

struct SaysNothingOfTime {};
struct SaysIfAutonomous {
  bool autonomous = false;
};
/// `autonomous` where f has it: a system that says nothing is not one that depends on time.
template <class F>
using AutonomyOf = std::conditional_t<KnowsAutonomous<F>, SaysIfAutonomous, SaysNothingOfTime>;

}  // namespace continuo::detail
