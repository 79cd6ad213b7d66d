// The module _continuo: what Python calls in C++, a part from each of the other sources.
#include "gil.hpp"
#include "parts.hpp"

PYBIND11_MODULE(_continuo, module) {
  module.doc() = "What the package continuo calls in C++.";
  continuo::python::add_model(module);
  module.attr("__version__") = CONTINUO_VERSION;
  continuo::python::wait_for_visits_at_exit();
  add_continued_run(module);
  add_dense_solution(module);
  add_light_state(module);
  add_native(module);
  add_run(module);
  add_solve_bvp(module);
  add_right_hand_side(module);
  add_world(module);
}
