// The Brusselator as it stands in the gallery: equations on the tape, the Jacobian from their graph. The benchmark runs
// in the root of the repository (bench/compare.sh goes there).
#include <cstddef>
#include <cstdio>
#include <memory>
#include <utility>

#include <bench/stiff/measure.hpp>

#include <continuo/language/load.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::bench {
namespace {

using X = std::vector<double>;

struct Typed {
  model::ModelSystem system;
  X start;
};

/// The model's states are u[1], v[1], u[2], ...: in the order of BrusselatorLine.
template <class M>
Solver model_solver(const std::shared_ptr<const Typed>& typed) {
  const auto run = [typed](double tolerance) {
    return solve(
        typed->system, typed->start, {0, BrusselatorLine<>::duration}, M{},
        Options<X>{
            .rtol = tolerance, .atol = tolerance * absolute_part<BrusselatorLine<>>, .save = Save<X>::only_end()});
  };
  return {"model " + std::string(M::name), true,
          [run](double tolerance) {
            const auto solution = run(tolerance);
            if (!solution.outcome) return Answer{};
            return judged<BrusselatorLine<>>(solution.final_state(), tolerance, solution.statistics.evaluations);
          },
          [run](double tolerance) { return timed([&] { return run(tolerance).final_state(); }); }};
}

}  // namespace

std::vector<Solver> our_brusselator_model_solvers() {
  const BrusselatorLine<> problem;
  model::CheckOptions options;
  options.overrides = {{"N", static_cast<double>(problem.points)}};
  const model::Loaded loaded = model::load("models/brusselator_line.sim", options);
  if (!loaded.model) {
    std::fputs(loaded.text().c_str(), stderr);
    return {};
  }
  model::ModelSystem system(model::compile(*loaded.model), model::start_values(*loaded.model));
  system.jacobian_pattern();  // differentiates; a copy has it
  const auto typed = std::make_shared<const Typed>(std::move(system), problem.start());
  return {model_solver<Rodas4>(typed), model_solver<Radau>(typed), model_solver<Bdf>(typed)};
}

}  // namespace continuo::bench
