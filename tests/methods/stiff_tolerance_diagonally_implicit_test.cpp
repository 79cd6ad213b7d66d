#include "stiff_tolerance.hpp"
#include <continuo/methods/implicit_euler.hpp>
#include <continuo/methods/kencarp4.hpp>
#include <continuo/methods/kvaerno5.hpp>
#include <continuo/methods/tr_bdf2.hpp>

namespace continuo::promises {
namespace {

using Methods = ::testing::Types<ImplicitEuler, TrBdf2, KenCarp4, Kvaerno5>;
INSTANTIATE_TYPED_TEST_SUITE_P(DiagonallyImplicit, StiffTolerance, Methods, NameOfStiffMethod);

}  // namespace
}  // namespace continuo::promises
