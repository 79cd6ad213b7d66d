// What is told of a sweep when it ends: the statistics of everything that was kept, and the runs that failed. It takes
// the outcomes as they come, in the order of the runs, and keeps none of them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <continuo/studies/sweep/outcome_summary.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::app {

class SweepReport {
 public:
  /// The sweep must outlive this object.
  explicit SweepReport(const studies::PreparedSweep& sweep);

  void add(std::uint64_t run, const studies::SweepOutcome& outcome);

  std::uint64_t runs() const { return runs_; }
  std::uint64_t failed() const { return failed_; }
  /// Of one of the numbers that are kept.
  const studies::OutcomeSummary& summary(std::size_t place) const { return summaries_[place]; }

  /// A table of the statistics. Of a series the first, some times between, and the last are shown.
  std::string text() const;
  /// How many runs failed, and the first of them with their values; empty where none has failed.
  std::string failures_text() const;
  nlohmann::ordered_json json() const;

 private:
  struct Failure {
    std::uint64_t run;
    std::string message;
  };
  std::string label(std::uint64_t run) const;

  const studies::PreparedSweep& sweep_;
  std::vector<studies::OutcomeSummary> summaries_;  // of every number that is kept
  std::uint64_t runs_ = 0, failed_ = 0;
  std::vector<std::uint64_t> endings_;  // by Ending
  std::vector<Failure> failures_;       // the first
};

}  // namespace continuo::app
