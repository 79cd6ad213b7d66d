// continuo/solve/choice.cpp
// Chooses the default method by the form and size of a system and the tolerance.
#include <continuo/solve/choice.hpp>

namespace continuo {

namespace {

// Below this tolerance a high order is cheaper: bench/ compares tsitouras5 with dop853, dprkn8 with dprkn12, and
// rodas5p with radau. The three meet between 1e-6 and 1e-7.
constexpr double high_order_below = 1e-6;
// rodas5p solves algebraic equations more accurately than its tolerance requires, radau only as accurately as required.
// As long as their costs hardly differ, rodas5p is chosen.
constexpr double high_order_of_algebraic_below = 1e-8;
// Above this size the factorization of a matrix dominates the cost of a stiff step, so that one matrix should serve
// several steps.
constexpr std::size_t large = 100;

}  // namespace

Choice choose_method(const SystemTraits& system) {
  const bool strict = system.rtol < (system.algebraic ? high_order_of_algebraic_below : high_order_below);
  // A sparse matrix is so cheap that the fewer steps of a high order pay; a banded matrix costs less than the rest of a
  // step.
  const bool few_matrices = system.size > large && !system.banded && !(system.sparse && strict);
  if (system.algebraic && few_matrices)
    return {"bdf",
            "algebraic equations need an implicit method, and one matrix for several steps suits a large system"};
  if (system.algebraic && strict)
    return {"radau", "algebraic equations need an implicit method, and a strict tolerance one of high order"};
  if (system.algebraic) return {"rodas5p", "algebraic equations need an implicit method"};
  if (system.accelerations && strict)
    return {
        "dprkn12_radau",
        "x'' = a(t, x) and a strict tolerance ask for a Nystrom method of high order; an implicit one where stiffness "
        "holds its steps"};
  if (system.accelerations)
    return {"dprkn8_radau", "x'' = a(t, x) asks for a Nystrom method; an implicit one where stiffness holds its steps"};
  if (few_matrices)
    return {"tsitouras5_bdf",
            "explicit while accuracy bounds the steps; where stability would, one with a matrix for several steps, as "
            "suits "
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
