// tests/hybrid/brute_force.hpp
// A second referee, as simple as possible: the equations and guards as written, in steps of a thousandth in long
// double; a change within a step is located by halving the step. It is less exact (an error of 1e-8 in times) and
// cannot slide; it shares neither the closed forms nor the derivatives with the first.
#pragma once
#include <tests/hybrid/hybrid_model.hpp>
#include <tests/hybrid/referee.hpp>

namespace continuo::hybrid {

Expected brute_force(const HybridModel& model);

}  // namespace continuo::hybrid
