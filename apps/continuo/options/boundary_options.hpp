// apps/continuo/options/boundary_options.hpp
// What `continuo run` is asked of models whose conditions stand at several times.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include <CLI/App.hpp>
#include <apps/continuo/options/experiment_options.hpp>

#include <continuo/boundary/boundary_of_model.hpp>

namespace continuo::app {

struct BoundaryOptions {
  std::size_t solution = 1;
  std::string along, guess;  // "eps=1..1e-3", a file
  std::string family, of;    // "eps=0..1", a state

  /// The solution that the model's own guesses lead to, by its own parameters.
  bool as_written() const { return solution == 1 && along.empty(); }
};

/// --solution, --along, --guess, and --family with --of.
void add_boundary(CLI::App& verb, BoundaryOptions& options);
/// Nothing, and said, where they do not fit the model.
std::optional<boundary::BoundaryRequest> read_boundary(const BoundaryOptions& options, const Prepared& prepared);
/// The range of --family, as `from` and `to`. Nothing, and said, where it is none.
std::optional<boundary::BoundaryRequest::Along> read_family(const BoundaryOptions& options, const Prepared& prepared);

}  // namespace continuo::app
