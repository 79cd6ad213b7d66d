// tests/hybrid/shrink.hpp
// Reduces a failing model to a smaller one with the same failure, so that a person can read it.
#pragma once
#include <functional>

#include <tests/hybrid/hybrid_model.hpp>

namespace continuo::hybrid {

/// Removes events, actions, comparisons, equations and time as long as `fails` is true.
HybridModel shrink(HybridModel model, const std::function<bool(const HybridModel&)>& fails);

}  // namespace continuo::hybrid
