// tests/hybrid/generator.hpp
// Random hybrid models. The same seed gives the same model everywhere.
#pragma once
#include <cstdint>

#include <tests/hybrid/hybrid_model.hpp>

namespace continuo::hybrid {

/// The kinds of models that a method can solve.
struct Ability {
  bool algebraic = false;  // unknowns
  bool stiff = false;      // decays of 1e3 to 1e5 on a slow path
  bool any_rate = true;    // false: a fixed step of 1e-3, to which 3 rad/s are 2e-11 in ten seconds
};

HybridModel random_model(std::uint64_t seed, const Ability& ability);

}  // namespace continuo::hybrid
