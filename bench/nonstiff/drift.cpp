#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>

#include <bench/nonstiff/drift.hpp>
#include <bench/problems/kepler.hpp>
#include <bench/report.hpp>

#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>
#include <continuo/methods/symplectic/yoshida6.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using State = std::array<double, Kepler::size>;

double energy(const State& x) {
  return (x[2] * x[2] + x[3] * x[3]) / 2 - 1 / std::sqrt(x[0] * x[0] + x[1] * x[1]);
}

template <class M>
Drift drift(bool symplectic, std::size_t evaluations_per_step) {
  constexpr double year = 2 * std::numbers::pi;
  constexpr std::size_t parts = 100, evaluations_per_orbit = 720;
  Drift result{M::name, symplectic, 0, std::vector<double>(parts)};
  const double step = year * static_cast<double>(evaluations_per_step) / static_cast<double>(evaluations_per_orbit);
  const double end = orbits * year, start_energy = energy(Kepler::start());
  Save<State> every_step{.kind = Save<State>::Kind::steps};
  every_step.callback = [&](double t, const State& x) {
    const auto part = std::min(parts - 1, static_cast<std::size_t>(t / end * static_cast<double>(parts)));
    result.worst[part] = std::max(result.worst[part], std::abs(energy(x) / start_energy - 1));
  };
  const auto solution =
      solve(Kepler{}, Kepler::start(), {0, end}, M{},
            {.step = step, .max_steps = static_cast<std::size_t>(2 * end / step), .save = every_step});
  result.evaluations_per_orbit = static_cast<double>(solution.statistics.evaluations) / orbits;
  return result;
}

}  // namespace

double Drift::worst_of(std::size_t first, std::size_t last) const {
  return *std::max_element(worst.begin() + static_cast<std::ptrdiff_t>(first),
                           worst.begin() + static_cast<std::ptrdiff_t>(last));
}

std::vector<Drift> measure_drift() {
  return {drift<VelocityVerlet>(true, 1),
          drift<McLachlanAtela4>(true, McLachlanAtela4::tableau.stages),
          drift<Yoshida6>(true, Yoshida6::tableau.stages - 1),  // the last kick of a step is the first of the next
          drift<KahanLi8>(true, KahanLi8::tableau.stages - 1),
          drift<Rk4>(false, 4),
          drift<DormandPrinceNystrom8>(false, 8),
          drift<Dop853>(false, 12)};
}

void write_drift(const std::string& folder, const std::vector<Drift>& drifts) {
  const std::string stem = folder + "/energy_drift";
  std::ofstream table(stem + ".csv"), plot(stem + ".gp");
  table << "method,orbits,worst\n";
  plot << "set terminal svg size 800,560 background 'white'\nset output '" << stem
       << ".svg'\nset title 'Kepler, e = 0.5, 100,000 orbits'\nset logscale y\nset format y '10^{%T}'\n"
       << "set xlabel 'orbits'\nset ylabel 'largest relative error of the energy in a hundredth of the run'\nset grid\n"
       << "set key outside right\nset datafile separator ','\nplot ";
  std::size_t shown = 0;
  for (const Drift& drift : drifts) {
    for (std::size_t i = 0; i < drift.worst.size(); ++i)
      table << drift.method << ',' << orbits * static_cast<double>(i + 1) / static_cast<double>(drift.worst.size())
            << ',' << drift.worst[i] << '\n';
    plot << "'" << stem << ".csv' using (strcol(1) eq '" << drift.method << "' ? $2 : NaN):3 with lines "
         << (drift.symplectic ? "lw 2 " : "lw 1.5 ") << line_of(shown++, !drift.symplectic) << " title '"
         << drift.method << "' noenhanced, ";
  }
  plot << '\n';
}

}  // namespace continuo::bench
