// continuo/solve/choice.cpp
#include <continuo/solve/choice.hpp>

namespace continuo {

namespace {

// From here on a high order is the cheaper one: bench/ compares tsitouras5 with dop853, and rodas5p with radau.
constexpr double high_order_below = 1e-8;
// Above, decomposing a matrix dominates a stiff step, and one matrix per step is the fewest there can be.
constexpr std::size_t large = 100;

}  // namespace

Choice choose_method(const SystemTraits& system) {
  const bool strict = system.rtol < high_order_below;
  if (system.algebraic && system.size > large)
    return {"bdf", "algebraic equations need an implicit method, and one matrix a step suits a large system"};
  if (system.algebraic && strict)
    return {"radau", "algebraic equations need an implicit method, and a strict tolerance one of high order"};
  if (system.algebraic) return {"rodas5p", "algebraic equations need an implicit method"};
  if (system.size > large)
    return {
        "tsitouras5_bdf",
        "explicit while accuracy bounds the steps; where stability would, one with a single matrix a step, as suits "
        "a large system"};
  if (strict)
    return {
        "dop853_radau",
        "a strict tolerance asks for high order: explicit while accuracy bounds the steps, implicit where stability "
        "would"};
  return {"tsitouras5_rodas5p",
          "a moderate tolerance: explicit while accuracy bounds the steps, implicit where stability would"};
}

}  // namespace continuo
