// The headers of the programs in mistakes.cpp, precompiled once for all of them.
#pragma once
#include <array>
#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_dec_float.hpp>

#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/linear_solver.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>
#include <continuo/methods/with_solver.hpp>
#include <continuo/sensitivities/adjoint.hpp>
#include <continuo/sensitivities/forward_sensitivities.hpp>
#include <continuo/solve/automatic.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/second_order.hpp>
#include <continuo/system/with_mass.hpp>
