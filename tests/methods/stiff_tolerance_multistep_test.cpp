#include "stiff_tolerance.hpp"
#include <continuo/methods/bdf.hpp>

namespace continuo::promises {
namespace {

using Methods = ::testing::Types<Bdf>;
INSTANTIATE_TYPED_TEST_SUITE_P(Multistep, StiffTolerance, Methods, NameOfStiffMethod);

}  // namespace
}  // namespace continuo::promises
