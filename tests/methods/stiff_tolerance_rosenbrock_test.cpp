#include "stiff_tolerance.hpp"
#include <continuo/methods/rodas4.hpp>
#include <continuo/methods/rodas5p.hpp>
#include <continuo/methods/rosenbrock23.hpp>

namespace continuo::promises {
namespace {

using Methods = ::testing::Types<Rosenbrock23, Rodas4, Rodas5P>;
INSTANTIATE_TYPED_TEST_SUITE_P(Rosenbrock, StiffTolerance, Methods, NameOfStiffMethod);

}  // namespace
}  // namespace continuo::promises
