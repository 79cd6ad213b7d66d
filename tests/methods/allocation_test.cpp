// No method allocates after its workspace is made: every operator new of the program is counted here.
#include <array>
#include <cstdlib>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/methods/rodas4.hpp>
#include <continuo/methods/rodas5p.hpp>
#include <continuo/methods/rosenbrock23.hpp>

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace continuo {
namespace {

/// The allocations of ten steps with error and interpolant.
template <class M, class X>
std::size_t allocations_in_steps(X x) {
  auto f = second_order([](double, const auto& q, const auto& v, auto& a) {
    for (std::size_t i = 0; i < q.size(); ++i) a[i] = -q[i] - v[i];
  });
  X x_new = x;
  auto work = M::workspace(x);
  Interpolant<X, M::dense_degree> interpolant(x);
  const std::size_t before = allocations;
  for (int i = 0; i < 10; ++i) {
    M::step(f, 0.1 * i, x, 0.1, i == 0, work, x_new);
    EXPECT_GE(M::error_norm(work, 0.1, x, x_new, Tolerance<double>{1e-6, 1e-6}), 0);
    M::interpolate(f, 0.1 * i, x, 0.1, x_new, work, interpolant);
    M::accept(work);
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = x_new[j];
  }
  return allocations - before;
}

TEST(Allocation, NoStepAllocates) {
  const std::size_t before = allocations;
  const std::vector<int> seen(3);
  ASSERT_GT(allocations, before) << "the count works";
  for_each_method<ExplicitMethods>([]<class M>() {
    EXPECT_EQ((allocations_in_steps<M>(std::array<double, 4>{1, 2, 3, 4})), 0U) << M::name;
    EXPECT_EQ((allocations_in_steps<M>(std::vector<double>{1, 2, 3, 4})), 0U) << M::name;
  });
}

/// Of an implicit method, whose first step learns the structure of the system.
template <class M, class X>
std::size_t allocations_in_implicit_steps(X x) {
  const auto f = [](double t, const X& at, X& slope) {
    for (std::size_t i = 0; i < at.size(); ++i) slope[i] = t - 100 * at[i] * at[i];
  };
  X x_new = x;
  auto work = M::workspace(x);
  Interpolant<X, M::dense_degree> interpolant(x);
  std::size_t before = allocations;
  for (int i = 0; i < 10; ++i) {
    M::step(f, 0.01 * i, x, 0.01, i == 0, work, x_new);
    EXPECT_GE(M::error_norm(work, 0.01, x, x_new, Tolerance<double>{1e-6, 1e-6}), 0);
    M::interpolate(f, 0.01 * i, x, 0.01, x_new, work, interpolant);
    M::accept(work);
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = x_new[j];
    if (i == 0 && !detail::FixedSize<X>) before = allocations;
  }
  return allocations - before;
}

TEST(Allocation, NoImplicitStepAllocatesAfterTheFirst) {
  const auto expect_none = []<class M>(M) {
    EXPECT_EQ((allocations_in_implicit_steps<M>(std::array<double, 4>{1, 2, 3, 4})), 0U) << M::name;
    EXPECT_EQ((allocations_in_implicit_steps<M>(std::vector<double>{1, 2, 3, 4})), 0U) << M::name;
  };
  expect_none(Rosenbrock23{});
  expect_none(Rodas4{});
  expect_none(Rodas5P{});
}

}  // namespace
}  // namespace continuo
