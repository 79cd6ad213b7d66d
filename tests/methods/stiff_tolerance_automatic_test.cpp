#include "stiff_tolerance.hpp"
#include <continuo/methods/automatic.hpp>

namespace continuo::promises {
namespace {

using Methods = ::testing::Types<Tsitouras5Rodas5P, Dop853Radau, Tsitouras5Bdf>;
INSTANTIATE_TYPED_TEST_SUITE_P(Automatic, StiffTolerance, Methods, NameOfStiffMethod);

}  // namespace
}  // namespace continuo::promises
