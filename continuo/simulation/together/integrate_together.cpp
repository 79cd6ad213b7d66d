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
#include <continuo/simulation/program/step_formula.hpp>
#include <continuo/simulation/together/explicit_part.hpp>
#include <continuo/simulation/together/integrate_together.hpp>

namespace continuo::model {

namespace {

struct LanesOfMethod {
  std::string_view name;
  void (*integrate)(const TogetherRuns& runs);
  CStepFormula (*formula)();
  bool is_part_of_pair;
};

template <class... M>
constexpr auto lanes_of = std::array{
    LanesOfMethod{M::name, integrate_together_by<M>, step_formula_of<M>, continuo::detail::PartOfPair<M>}...};

constexpr auto methods_with_lanes =
    lanes_of<BogackiShampine3, DormandPrince5, Dop853, Rk4, Tsitouras5, Verner7, Verner9,
             ExplicitPart<Tsitouras5Rodas5P, Tsitouras5>, ExplicitPart<Dop853Radau, Dop853>>;

const LanesOfMethod* find(std::string_view method) {
  for (const LanesOfMethod& one : methods_with_lanes)
    if (one.name == method) return &one;
  return nullptr;
}

}  // namespace

bool has_lanes(std::string_view method, bool has_fixed_steps) {
  const LanesOfMethod* const found = find(method);
  return found && !(has_fixed_steps && found->is_part_of_pair);
}

CStepFormula step_formula(std::string_view method) {
  return find(method)->formula();
}

void integrate_together(std::string_view method, const TogetherRuns& runs) {
  find(method)->integrate(runs);
}

}  // namespace continuo::model
