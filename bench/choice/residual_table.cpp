// The largest residual of algebraic equations over a thousand instants of a run, in tolerances, by every method that is
// algebraic: of rtol = atol = 1e-3 ... 1e-10, as far as the order of the method reaches; - where none of these runs
// comes to its end. Exits with 1 above 10.
#include <algorithm>
#include <cmath>

#include <bench/choice/residual.hpp>
#include <fmt/format.h>

namespace {

using namespace continuo;

constexpr double most_tolerances = 10;

/// The powers of ten that a method comes to in less than a million steps.
int strictest_power(int order) {
  return order < 2 ? 4 : order < 3 ? 6 : 10;
}

}  // namespace

int main() {
  const auto methods = bench::algebraic_methods();
  fmt::print("| Problem |");
  for (const auto& method : methods) fmt::print(" {} |", method.name);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < methods.size(); ++i) fmt::print("---|");
  fmt::print("\n");
  bool wrong = false;
  for (const auto& problem : bench::choice_problems()) {
    if (problem.kind != "dae") continue;
    const auto loaded = bench::load_with_residuals(problem);
    if (!loaded) {
      fmt::print("{}: {}\n", problem.name, loaded.text());
      return 2;
    }
    fmt::print("| {} |", problem.name);
    for (const auto& method : methods) {
      double worst = -1;
      for (int power = 3; power <= strictest_power(method.order); ++power) {
        const auto largest =
            bench::largest_residual(*loaded.model, problem.duration, method.name, std::pow(10.0, -power));
        if (largest) worst = std::max(worst, *largest);
      }
      wrong = wrong || worst > most_tolerances;
      worst < 0 ? fmt::print(" - |") : fmt::print(" {:.1g} |", worst);
    }
    fmt::print("\n");
  }
  return wrong ? 1 : 0;
}
