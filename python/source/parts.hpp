// The parts of the module _continuo: each adds its classes and functions.
#pragma once
#include <pybind11/pybind11.h>

void add_continued_run(pybind11::module_& module);
void add_dense_solution(pybind11::module_& module);
void add_light_state(pybind11::module_& module);
void add_native(pybind11::module_& module);
void add_run(pybind11::module_& module);
void add_solve_bvp(pybind11::module_& module);
namespace continuo::python {

void add_model(pybind11::module_& module);

}  // namespace continuo::python
void add_right_hand_side(pybind11::module_& module);
void add_world(pybind11::module_& module);
