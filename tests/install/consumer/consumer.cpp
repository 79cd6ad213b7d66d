#include <array>
#include <cmath>

#include <continuo/continuo.hpp>
#include <continuo/results/netcdf.hpp>
#include <continuo/studies/least_squares.hpp>

int main() {
  const auto decay = [](double, const std::array<double, 1>& x) { return std::array{-x[0]}; };
  const auto solution = continuo::solve(decay, std::array{1.0}, {0.0, 1.0}, continuo::Tsitouras5{}, {.rtol = 1e-9});
  const auto loaded = continuo::model::load(
      continuo::model::Source("decay.sim", "model Decay\nparam T = 1 [s]\nx' = -x/T\nx(0) = 1\nrun 0..1 [s]\n"));
  if (!loaded) return 1;
  const auto simulated = continuo::model::simulate(*loaded.model, {.rtol = 1e-9});
  const double exact = std::exp(-1.0);
  const bool same =
      std::abs(solution.final_state()[0] - exact) < 1e-8 && std::abs(simulated.run->final_state()[0] - exact) < 1e-8;
  if (!same) return 2;

  // The modules that the command loads on demand are linked into a program that uses the library.
  const auto found = continuo::studies::least_squares(
      {.start = {1},
       .residuals = 1,
       .evaluate = [](std::span<const double> p, std::span<double> r, std::span<double> rows) {
         r[0] = p[0] - 2;
         if (!rows.empty()) rows[0] = 1;
         return true;
       }});
  if (!found.found || std::abs(found.p[0] - 2) > 1e-8) return 3;
  return continuo::results::write_netcdf(*loaded.model, *simulated.run, "decay.nc", "") ? 0 : 4;
}
