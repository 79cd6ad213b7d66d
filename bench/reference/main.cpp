// Computes the end values of the non-stiff problems, in bench/reference/end_values.hpp and in their headers: each
// problem twice, with different order and tolerance, and the largest difference of the two. Constants that a header
// keeps as doubles are those doubles here too, so what a solver in double precision misses is its own error and nothing
// else.
#include <cstdio>
#include <ios>

#include <bench/problems/arenstorf.hpp>
#include <bench/problems/brusselator.hpp>
#include <bench/problems/henon_heiles.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/problems/lorenz.hpp>
#include <bench/problems/lotka_volterra.hpp>
#include <bench/problems/outer_planets.hpp>
#include <bench/problems/pendulum.hpp>
#include <bench/problems/pleiades.hpp>
#include <bench/reference/extrapolation.hpp>

namespace continuo::bench {

template <class Problem>
void print() {
  const auto x = reference_end<14, Problem>(1e-27), other = reference_end<12, Problem>(1e-25);
  Quad difference = 0;
  std::printf("%s %.17g", Problem::name.data(), static_cast<double>(Problem::duration));
  for (std::size_t i = 0; i < Problem::size; ++i) {
    difference = std::max<Quad>(difference, abs(Quad(x[i] - other[i])));
    std::printf(" %s", x[i].str(29, std::ios::scientific).c_str());
  }
  std::printf("\n# the two runs differ by at most %.1e\n", static_cast<double>(difference));
  std::fflush(stdout);
}

}  // namespace continuo::bench

int main() {
  using namespace continuo::bench;
  print<LotkaVolterra<Quad>>();
  print<Brusselator<Quad>>();
  print<Pendulum<Quad>>();
  print<HenonHeiles<Quad>>();
  print<Lorenz>();
  print<Arenstorf>();
  print<Kepler>();
  print<Pleiades>();
  print<OuterPlanets>();
  print<OuterPlanetsMillennium>();
}
