#include "stiff_tolerance.hpp"
#include <continuo/methods/radau.hpp>

namespace continuo::promises {
namespace {

using Methods = ::testing::Types<Radau5, Radau>;
INSTANTIATE_TYPED_TEST_SUITE_P(Collocation, StiffTolerance, Methods, NameOfStiffMethod);

}  // namespace
}  // namespace continuo::promises
