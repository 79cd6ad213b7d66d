// Finds the runs in lanes of a method by its name, and its numbers.
#include <array>

#include <continuo/ensembles/lanes/pair_of_lane.hpp>
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/simulation/program/step_formula.hpp>
#include <continuo/simulation/together/explicit_part.hpp>
#include <continuo/simulation/together/integrate_together.hpp>

namespace continuo::model {

namespace {

struct LanesOfMethod {
  std::string_view name;
  void (*integrate)(const TogetherRuns& runs);
  CStepFormula (*formula)();
  bool is_part_of_pair, is_stiff;
};

/// Of a stiff method no steps are compiled.
template <class M>
CStepFormula formula_of() {
  if constexpr (continuo::detail::is_implicit<M>()) {
    return {};
  } else {
    return step_formula_of<M>();
  }
}

template <class... M>
constexpr auto lanes_of =
    std::array{LanesOfMethod{M::name, integrate_together_by<M>, formula_of<M>, continuo::detail::PartOfPair<M>,
                             continuo::detail::is_implicit<M>()}...};

constexpr auto methods_with_lanes =
    lanes_of<BogackiShampine3, DormandPrince5, Dop853, Rk4, Rodas5P, Tsitouras5, Verner7, Verner9,
             ExplicitPart<Tsitouras5Rodas5P, Tsitouras5>, ExplicitPart<Dop853Radau, Dop853>>;

const LanesOfMethod* find(std::string_view method) {
  for (const LanesOfMethod& one : methods_with_lanes)
    if (one.name == method) return &one;
  return nullptr;
}

}  // namespace

bool has_lanes(std::string_view method, const RunTraits& runs) {
  const LanesOfMethod* const found = find(method);
  if (!found) return false;
  if (found->is_stiff) return runs.states < least_sparse_size;
  return !(runs.has_fixed_steps && found->is_part_of_pair);
}

bool asks_for_derivatives(std::string_view method) {
  return find(method)->is_stiff;
}

CStepFormula step_formula(std::string_view method) {
  return find(method)->formula();
}

void integrate_together(std::string_view method, const TogetherRuns& runs) {
  find(method)->integrate(runs);
}

}  // namespace continuo::model
