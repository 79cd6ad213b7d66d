// What a sweep of runs for Sobol' indices, or for the screening of Morris, says of what was varied: as text, as JSON,
// and as panels of a picture.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::app {

class SweepIndices {
 public:
  /// The sweep must outlive this object. Of other sweeps it keeps nothing and says nothing.
  explicit SweepIndices(const studies::PreparedSweep& sweep);

  /// The outcomes of the runs in their order.
  void add(const studies::SweepOutcome& outcome);

  std::string text() const;
  /// Null where there is nothing to say.
  nlohmann::ordered_json json() const;
  std::vector<results::Panel> panels() const;

 private:
  /// A number of which indices are told: of a series the last one.
  struct Outcome {
    std::string quantity, name;  // without and with its unit: a part of a variance has none
    std::size_t place = 0;       // among all that is kept
    std::vector<double> values{};
  };
  std::string indices_text(const Outcome& outcome) const;
  std::string screening_text(const Outcome& outcome) const;

  const studies::PreparedSweep& sweep_;
  std::vector<std::string> names_;  // of what is varied
  std::vector<Outcome> outcomes_;
};

}  // namespace continuo::app
