// continuo/language/sweep.cpp
// The words of a sweep.
#include <continuo/language/sweep.hpp>

namespace continuo::model {

std::string_view to_string(SweepSampling sampling) {
  switch (sampling) {
    case SweepSampling::grid:
      return "grid";
    case SweepSampling::sobol:
      return "sobol";
    case SweepSampling::latin_hypercube:
      return "latin_hypercube";
    case SweepSampling::monte_carlo:
      return "monte_carlo";
    case SweepSampling::indices:
      return "indices";
    case SweepSampling::morris:
      return "morris";
  }
  return "";
}

std::string_view to_string(SweepDistribution::Kind kind) {
  switch (kind) {
    case SweepDistribution::Kind::uniform:
      return "uniform";
    case SweepDistribution::Kind::normal:
      return "normal";
    case SweepDistribution::Kind::lognormal:
      return "lognormal";
    case SweepDistribution::Kind::triangular:
      return "triangular";
  }
  return "";
}

}  // namespace continuo::model
