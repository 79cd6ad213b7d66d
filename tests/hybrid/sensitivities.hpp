// Sensitivities through events and jumps against differences of the referee's closed forms.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <tests/hybrid/hybrid_model.hpp>

namespace continuo::hybrid {

/// Many derivatives: of the final state with respect to one number of the model, an initial value or a rate.
struct SensitivityAttack {
  std::size_t asked = 0, failed = 0, through_events = 0, through_slides = 0, not_zero = 0;
  std::map<std::string, std::size_t> left_out{};  // by reason
  std::map<std::string, std::size_t> refused{};   // by the library, with its reason
  std::vector<std::string> failures{};            // the first of them: text, expected and found
};
/// Continues until `count` derivatives have been compared or refused.
SensitivityAttack attack_sensitivities(std::size_t count, std::uint64_t seed, std::size_t failures_to_tell);

}  // namespace continuo::hybrid
