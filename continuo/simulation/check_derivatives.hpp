// The derivatives of a model along a run of it: how large and how full df/dx is, whether the exact df/dx and df/dt
// agree with differences of f, and where f has no derivative.
//
//   std::vector<Diagnostic> problems;
//   const auto report = check_derivatives(program, {}, problems);
//   if (report) fmt::print("{} of {} places\n", report->entries, report->states * report->states);
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::model {

/// An entry of df/dx or df/dt at a time of the run.
struct DerivativeEntry {
  std::string name;  // "d(x')/d(y)"
  std::string mode;  // empty where the model has no modes
  double t;
  double exact, measured;
  double below, above;  // slopes to either side
  double apart;         // in parts of the greatest entry of the row, each times its variable
};

/// What a comparison along a run has found.
struct DerivativeReport {
  std::size_t states = 0, entries = 0;  // entries of the pattern of df/dx, all modes together
  SparsePattern::Bandwidth band{};
  std::size_t points = 0;  // how many moments of the run were looked at
  double from = 0, to = 0;
  bool interrupted = false;
  std::size_t compared = 0;                 // entries of all points
  std::vector<DerivativeEntry> wrong;       // each entry once, where it is worst
  std::vector<DerivativeEntry> kinks;       // f has no derivative there; each entry once, where it is met first
  std::vector<DerivativeEntry> undecided;   // f is not finite nearby, or too rough; each entry once
  std::optional<DerivativeEntry> furthest;  // of those that agree

  /// Whether no entry is wrong.
  [[nodiscard]] bool agrees() const { return wrong.empty(); }
};

/// The run is as the model says, or the experiment in its place, but for the method and no longer than some thousand
/// steps. Empty where there can be none; `problems` says why.
[[nodiscard]] std::optional<DerivativeReport> check_derivatives(const std::shared_ptr<const ModelProgram>& program,
                                                                const Experiment& experiment,
                                                                std::vector<Diagnostic>& problems);

}  // namespace continuo::model
