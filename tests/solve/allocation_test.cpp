// Counts calls of operator new: a state of fixed size costs no heap allocation per step.
#include <array>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <numbers>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>

namespace {
std::size_t allocations = 0;  // of the whole program
}  // namespace

// Not to be inlined: g++ would see malloc meet delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace continuo::allocation_test {
namespace {

using X = std::array<double, 2>;

void spring(double, const X& x, X& dxdt) {
  dxdt = {x[1], -x[0]};
}

/// Heap allocations of a run from 0 to `end`, and its steps.
struct Count {
  std::size_t allocations, steps;
};
template <class M>
Count count(double end, const Options<X>& options) {
  Integrator integrator(spring, X{1, 0}, {0.0, end}, M{}, options);
  const std::size_t before = ::allocations;
  while (integrator.advance()) {
  }
  const std::size_t after = ::allocations;
  return {after - before, integrator.statistics().steps};
}

TEST(Allocation, StepsOfFixedSizeStatesAllocateNothing) {
  for_each_method<ExplicitMethods>([]<class M>() {
    if constexpr (!M::second_order) {
      Options<X> options{.rtol = 1e-8, .atol = 1e-8};
      if (M::error_order == 0) options.step = 0.01;
      const Count taken = count<M>(100, options);
      EXPECT_EQ(taken.allocations, 0U) << M::name;
      EXPECT_GT(taken.steps, 50U) << M::name;
    }
  });
}

// Ten times the steps and the roots, not one allocation more: buffers are made once.
TEST(Allocation, WatchingAnEventAllocatesNothingPerStep) {
  Options<X> options{.rtol = 1e-8, .atol = 1e-8};
  std::size_t seen = 0;
  options.events = {
      falls<X>("through zero", [](double, const X& x) { return x[0]; }, [&seen](EventAction<X>&) { ++seen; })};
  const Count brief = count<Dop853>(20 * std::numbers::pi, options);
  const std::size_t first = seen;
  const Count lasting = count<Dop853>(200 * std::numbers::pi, options);
  EXPECT_GT(lasting.steps, 9 * brief.steps);
  EXPECT_GT(seen - first, 9 * first);
  EXPECT_LE(lasting.allocations, brief.allocations);
}

TEST(Allocation, TheEndOfARunNeedsAHandful) {
  const std::size_t before = allocations;
  const auto solution = solve(spring, X{1, 0}, {0, 100}, Tsitouras5{}, {.save = Save<X>::only_end()});
  const std::size_t after = allocations;
  EXPECT_LE(after - before, 8U);  // the last time and state, and buffers of the driver
  EXPECT_GT(solution.statistics.steps, 50U);
}

}  // namespace
}  // namespace continuo::allocation_test
