// tests/hybrid/comparison.hpp
// Compares library and referee on one model.
#pragma once
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tests/hybrid/generator.hpp>
#include <tests/hybrid/hybrid_model.hpp>
#include <tests/hybrid/referee.hpp>

namespace continuo::hybrid {

/// The method and its settings, such that its own error is well below the errors allowed for times and final states.
struct Asked {
  std::string_view method;  // empty: the default one
  double tolerance = 1e-12;
  double step = 0;  // > 0: in place of the tolerance
  Ability ability{};
  double time_error = 1e-9, end_error = 1e-8;
};

std::span<const Asked> asked_methods();

/// The differences between library and referee, with both lists of events; empty where they agree.
std::string difference(const HybridModel& model, const Expected& expected, const Asked& asked);

/// Many models by one method.
struct Attack {
  std::size_t asked = 0, rejected = 0, events = 0, with_slides = 0, with_cascades = 0, with_simultaneous = 0;
  std::map<std::string, std::size_t> reasons{};  // of the rejected
  std::size_t failed = 0;
  std::vector<std::string> failures{};  // the first of them, shrunk: text, expected and found
};
/// Compares library and referee on `count` models that the referee accepts.
Attack attack(const Asked& asked, std::size_t count, std::uint64_t seed, std::size_t failures_to_tell);

}  // namespace continuo::hybrid
