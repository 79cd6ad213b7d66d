// The components of a ComplexState: real and imaginary parts, in turn.
#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/numerics/state.hpp>
#include <continuo/system/complex_state.hpp>

namespace continuo::complex_state_test {
namespace {

template <class Container>
void has_parts(ComplexState<Container> x) {
  static_assert(State<ComplexState<Container>>);
  x[0] = {1, 2};
  x[1] = {3, 4};
  ASSERT_EQ(dimension(x), 4u);
  const auto& constant = x;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(constant.data()[i], static_cast<double>(i + 1));
  x.data()[3] = 5;
  EXPECT_EQ(constant[1], std::complex(3.0, 5.0));
  const auto copy = x;
  x.data()[0] = 0;
  EXPECT_EQ(copy[0], std::complex(1.0, 2.0));
}

TEST(ComplexState, HasRealAndImaginaryPartsAsComponents) {
  has_parts(ComplexState<std::array<std::complex<double>, 2>>{});
  has_parts(ComplexState<std::vector<std::complex<double>>>{std::vector<std::complex<double>>(2)});
  has_parts(ComplexState<Eigen::VectorXcd>{Eigen::VectorXcd(2)});
}

}  // namespace
}  // namespace continuo::complex_state_test
