// `continuo orbit` of a model in which more happens than its equations say: events, modes, jumps, the time.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include <apps/continuo/exit_codes.hpp>
#include <apps/continuo/studied_model.hpp>

namespace continuo::app {

struct HybridOrbitRequest {
  double settle, duration, tolerance;
  bool patient = false;  // no time was named: longer ones may be tried
  std::optional<double> forcing{};
  std::size_t turns = 0;
  bool json = false;
  std::string plot{};
};

ExitCode show_hybrid_orbit(const Studied& studied, const HybridOrbitRequest& request);

}  // namespace continuo::app
