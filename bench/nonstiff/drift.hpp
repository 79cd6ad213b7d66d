// bench/nonstiff/drift.hpp
// What becomes of the energy of a planet in a hundred thousand orbits: of symplectic methods, and of some that are not.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::bench {

struct Drift {
  std::string_view method;
  bool symplectic;
  double evaluations_per_orbit;
  /// The largest |E - E0| / |E0| of each hundredth of the run.
  std::vector<double> worst;

  double in_first_tenth() const { return worst_of(0, worst.size() / 10); }
  double in_last_tenth() const { return worst_of(worst.size() - worst.size() / 10, worst.size()); }

 private:
  double worst_of(std::size_t first, std::size_t last) const;
};

inline constexpr double orbits = 1e5;

/// Kepler with e = 0.5, about as many evaluations an orbit for every method.
std::vector<Drift> measure_drift();

/// FOLDER/energy_drift.csv and a script for gnuplot that makes the .svg beside it.
void write_drift(const std::string& folder, const std::vector<Drift>& drifts);

}  // namespace continuo::bench
