// Computes the end values that bench/reference/end_values.hpp keeps: each problem twice, with different order and
// tolerance, and the largest difference of the two. The constants are the double nearest to the published ones, so what
// a solver in double precision misses is its own error and nothing else.
#include <cstdio>
#include <string>

#include <bench/problems/arenstorf.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/outer_planets.hpp>
#include <bench/problems/pleiades.hpp>
#include <bench/reference/extrapolation.hpp>

namespace continuo::bench {

template <class Problem>
void print() {
  const auto x = reference_end<11, Problem>(1e-24), other = reference_end<13, Problem>(1e-22);
  Quad difference = 0;
  std::printf("%s\n", std::string(Problem::name).c_str());
  for (std::size_t i = 0; i < Problem::size; ++i) {
    difference = std::max<Quad>(difference, abs(x[i] - other[i]));
    std::printf("  %.20Le\n", static_cast<long double>(x[i]));
  }
  std::printf("  the two runs differ by at most %.1e\n", static_cast<double>(difference));
}

}  // namespace continuo::bench

int main() {
  using namespace continuo::bench;
  print<Lorenz>();
  print<Arenstorf>();
  print<Kepler>();
  print<Pleiades>();
  print<OuterPlanets>();
}
