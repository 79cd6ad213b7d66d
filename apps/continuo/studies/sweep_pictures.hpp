// The picture of a sweep: fans of the series that were kept, a plane for a grid of two quantities, else the outcomes
// over what was varied.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <apps/continuo/studies/sweep_report.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::app {

class SweepPictures {
 public:
  /// The sweep must outlive this object.
  explicit SweepPictures(const studies::PreparedSweep& sweep);

  /// The outcome of a run, of which it keeps no more than a picture shows.
  void add(std::uint64_t run, const studies::SweepOutcome& outcome);

  /// `report` has had the same outcomes.
  std::vector<results::Panel> panels(const SweepReport& report) const;

 private:
  /// One number that is kept of each run, and where it stands.
  struct Number {
    std::string label;
    std::size_t place = 0;
    std::vector<double> values{};
  };
  std::vector<results::Panel> planes() const;
  std::vector<results::Panel> scatter() const;

  const studies::PreparedSweep& sweep_;
  std::uint64_t step_ = 1;  // of so many runs one is drawn
  bool is_plane_ = false;
  std::vector<Number> numbers_;
  std::vector<std::vector<double>> varied_;  // of each axis
};

}  // namespace continuo::app
