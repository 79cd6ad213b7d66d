// Computes the reference states in the headers of the stiff problems: each twice in binary128, with different order and
// tolerance. Prints the states and the largest difference of the two runs, relative to each component.
// Published values differ from these by at most (F. Mazzia and others, Test Set for IVP Solvers; the last one E. Hairer
// and G. Wanner): Robertson 2e-14, HIRES 3e-15 (the end of the run is the double nearest to 321.8122 here), Oregonator
// 2e-13, van der Pol 2e-14, pollution 4e-16, the line of Brusselators 3e-14.
//
//   reference_values_stiff                all of them
//   reference_values_stiff robertson      one of them
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <bench/problems/brusselator_line.hpp>
#include <bench/problems/hires.hpp>
#include <bench/problems/oregonator.hpp>
#include <bench/problems/pollution.hpp>
#include <bench/problems/robertson.hpp>
#include <bench/problems/van_der_pol.hpp>
#include <bench/reference/collocation.hpp>
#include <boost/multiprecision/float128.hpp>

namespace continuo::bench {
namespace {

using Quad = boost::multiprecision::float128;
using States = std::vector<std::vector<Quad>>;

/// What one run is made with.
struct Effort {
  std::size_t stages;
  double tolerance;
};
constexpr std::array<Effort, 2> small{{{24, 1e-18}, {28, 1e-20}}}, large{{{12, 1e-12}, {15, 1e-14}}};

template <class Problem>
States states_at(const std::vector<double>& times, const Effort& effort) {
  Collocation<Problem, Quad> solver(Problem{}, effort.stages, effort.tolerance);
  States states;
  for (const double t : times) {
    solver.advance(Quad(t));
    states.push_back(solver.x());
  }
  std::printf("# %s, order %zu: %zu steps\n", Problem::name.data(), 2 * effort.stages - 1, solver.steps());
  return states;
}

/// Every `stride`-th component, a line a time.
template <class Problem>
void print(const std::vector<double>& times, const std::array<Effort, 2>& efforts, std::size_t stride = 1) {
  const States others = states_at<Problem>(times, efforts[0]), states = states_at<Problem>(times, efforts[1]);
  Quad worst = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    std::printf("%s %.17g", Problem::name.data(), times[i]);
    for (std::size_t c = 0; c < states[i].size(); ++c) {
      const Quad& x = states[i][c];
      worst = std::max<Quad>(worst, abs(Quad((x - others[i][c]) / x)));
      if (c % stride == 0) std::printf(" %s", x.str(29, std::ios::scientific).c_str());
    }
    std::printf("\n");
  }
  std::printf("# %s: the two runs differ by at most %.1e\n", Problem::name.data(), static_cast<double>(worst));
  std::fflush(stdout);
}

template <template <class> class Problem>
void print_reference() {
  std::vector<double> times;
  for (const auto& reference : Problem<double>::reference()) times.push_back(reference.t);
  print<Problem<Quad>>(times, small);
}

/// When Robertson's component passes `level`: Newton's method on the end of the run.
void print_event(std::size_t component, const Quad& level, Quad t) {
  using Exact = Robertson<Quad>;
  std::vector<Quad> x, slope(Exact::size);
  for (int iteration = 0; iteration < 4; ++iteration) {
    Collocation<Exact, Quad> solver(Exact{}, small[1].stages, small[1].tolerance);
    solver.advance(t);
    x = solver.x();
    Exact{}(t, x, slope);
    t -= (x[component] - level) / slope[component];
  }
  std::printf("# robertson: x[%zu] = %.4g at t = %s\n", component, static_cast<double>(level),
              t.str(29, std::ios::scientific).c_str());
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const auto wanted = [&](std::string_view name) { return count < 2 || arguments[1] == name; };
  if (wanted(Robertson<>::name)) {
    print_reference<Robertson>();
    print_event(2, Quad(1) / 100, Quad(0.264));
    print_event(0, Quad(1) / 10000, Quad(2.08e7));
  }
  if (wanted(Hires<>::name)) print_reference<Hires>();
  if (wanted(Oregonator<>::name)) print_reference<Oregonator>();
  if (wanted(VanDerPol<>::name)) print_reference<VanDerPol>();
  if (wanted(VanDerPolScaled<>::name)) print_reference<VanDerPolScaled>();
  if (wanted(Pollution<>::name)) print_reference<Pollution>();
  if (wanted(BrusselatorLine<>::name)) print<BrusselatorLine<Quad>>({10}, large);
}
