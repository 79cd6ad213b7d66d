// What events cost: thirty bounces of a ball (h0 = 10, e = 0.9) against one flight of as many steps without events.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using X = std::array<double, 2>;
constexpr double gravity = 9.81, height = 10, restitution = 0.9;
constexpr int bounces = 30;

/// Between the thirtieth bounce and the next.
double end_time() {
  const double first = std::sqrt(2 * height / gravity);
  double t = first;
  for (int n = 1; n < bounces; ++n) t += 2 * std::pow(restitution, n) * first;
  return t + std::pow(restitution, bounces) * first;
}

void fall(double, const X& x, X& dxdt) {
  dxdt = {x[1], -gravity};
}

template <class M>
void compare(M method) {
  const double end = end_time();
  const auto bounce = [&] {
    return solve(fall, X{height, 0}, {0, end}, method,
                 {.rtol = 1e-10,
                  .atol = 1e-12,
                  .events = {falls<X>(
                      "floor", [](double, const X& x) { return x[0]; },
                      [](EventAction<X>& now) { now.x = {0, -restitution * now.before[1]}; })},
                  .save = Save<X>::only_end()});
  };
  const auto steps = static_cast<double>(bounce().statistics.steps);
  // The same error control, held to as many steps; the last of them goes to the end of the interval.
  const auto fly = [&] {
    return solve(fall, X{height, 0}, {0, end}, method,
                 {.rtol = 1e-10, .atol = 1e-12, .max_step = end / steps, .save = Save<X>::only_end()});
  };
  double with = std::numeric_limits<double>::infinity(), without = with;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    with = std::min(with, bounce().statistics.seconds);
    without = std::min(without, fly().statistics.seconds);
  }
  const auto bounced = bounce(), flown = fly();
  std::printf("| %s | %zu | %zu, %zu | %zu, %zu | **%.2f** |\n", std::string(M::name).c_str(), bounced.events.size(),
              bounced.statistics.steps, flown.statistics.steps, bounced.statistics.evaluations,
              flown.statistics.evaluations, with / without);
}

}  // namespace
}  // namespace continuo::bench

int main() {
  std::puts("| Method | Bounces | Steps with, without | Evaluations with, without | Time, with : without |");
  std::puts("|---|---|---|---|---|");
  continuo::bench::compare(continuo::Tsitouras5{});
  continuo::bench::compare(continuo::Dop853{});
}
