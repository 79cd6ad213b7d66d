#include <array>
#include <cstdio>

#include <continuo/numerics/state.hpp>

int main() {
  std::array<double, 3> x{};
  std::printf("%zu components\n", continuo::dimension(x));
  return continuo::dimension(x) == 3 ? 0 : 1;
}
