// No method allocates after its workspace is made: every operator new of the program is counted here.
#include <array>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "equations.hpp"
#include <continuo/methods/all.hpp>
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/implicit_midpoint.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/multistep/bdf2.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom6.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/methods/structural/generalized_alpha.hpp>
#include <continuo/methods/structural/newmark.hpp>
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>

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

namespace continuo::allocation_test {
namespace {

testing::Equations damped() {
  return {[](double, std::span<const double> x, std::span<double> dxdt) {
    const std::size_t n = x.size() / 2;
    for (std::size_t i = 0; i < n; ++i) dxdt[i] = x[n + i], dxdt[n + i] = -x[i] - x[n + i];
  }};
}
auto planar() {
  return second_order([](double, const auto& q, auto& a) {
    for (std::size_t i = 0; i < q.size(); ++i) a[i] = -q[i] * q[i];
  });
}

/// The allocations of ten steps with error and interpolant.
template <class M, class X, class System>
std::size_t allocations_in_steps(X x, System f) {
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
    EXPECT_EQ((allocations_in_steps<M>(std::array<double, 2>{1, 2}, damped())), 0U) << M::name;
    EXPECT_EQ((allocations_in_steps<M>(std::vector<double>{1, 2}, damped())), 0U) << M::name;
  });
}

TEST(Allocation, NoStepOfAccelerationsAllocates) {
  const auto expect_none = []<class M>(M) {
    EXPECT_EQ((allocations_in_steps<M>(std::array<double, 4>{1, 2, 3, 4}, planar())), 0U) << M::name;
    EXPECT_EQ((allocations_in_steps<M>(std::vector<double>{1, 2, 3, 4}, planar())), 0U) << M::name;
  };
  expect_none(Adams{});
  expect_none(Odex{});
  expect_none(DormandPrinceNystrom6{});
  expect_none(DormandPrinceNystrom8{});
  expect_none(McLachlanAtela4{});
  expect_none(KahanLi8{});
}

/// Of an implicit method, whose first step learns the structure of the system.
template <class M, class X, class System>
std::size_t allocations_in_implicit_steps(X x, System f) {
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
    const auto f = [](double t, const auto& x, auto& slope) {
      for (std::size_t i = 0; i < x.size(); ++i) slope[i] = t - 100 * x[i] * x[i];
    };
    EXPECT_EQ((allocations_in_implicit_steps<M>(std::array<double, 4>{1, 2, 3, 4}, f)), 0U) << M::name;
    EXPECT_EQ((allocations_in_implicit_steps<M>(std::vector<double>{1, 2, 3, 4}, f)), 0U) << M::name;
  };
  expect_none(Rosenbrock23{});
  expect_none(Rodas4{});
  expect_none(Rodas5P{});
  expect_none(ImplicitEuler{});
  expect_none(ImplicitMidpoint{});
  expect_none(Trapezoidal{});
  expect_none(Bdf2{});
  expect_none(TrBdf2{});
  expect_none(KenCarp4{});
  expect_none(Kvaerno5{});
  expect_none(Seulex{});
}

TEST(Allocation, NoStructuralStepAllocatesAfterTheFirst) {
  const auto expect_none = []<class M>(M) {
    EXPECT_EQ((allocations_in_implicit_steps<M>(std::array<double, 2>{1, 2}, damped())), 0U) << M::name;
    EXPECT_EQ((allocations_in_implicit_steps<M>(std::vector<double>{1, 2}, damped())), 0U) << M::name;
  };
  expect_none(Newmark{});
  expect_none(GeneralizedAlpha{});
}

}  // namespace
}  // namespace continuo::allocation_test
