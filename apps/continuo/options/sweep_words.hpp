// The sweep of a model with what the command line says of it, in the words of the language: --vary "k from 1 to 10
// count 50", --keep "x at end", --runs "10000 sobol seed 7".
#pragma once
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <apps/continuo/options/models.hpp>

#include <continuo/language/load.hpp>

namespace continuo::app {

struct SweepWords {
  std::vector<std::string> vary{}, keep{};
  std::string runs{};
  bool is_wanted = false;  // a sweep is made, so that --set holds for its values as well

  bool empty() const { return vary.empty() && keep.empty() && runs.empty(); }
};

/// --vary and --runs; of a study also --keep.
void add_sweep_words(CLI::App& verb, SweepWords& words, bool with_keep);

/// Loads the model as if its sweep said all that: an axis takes the place of that of the same name, or comes to the
/// others, kept quantities and the number of runs take the place of those in the model. What is wrong is shown under
/// the option that has it, or in the model; only messages of the latter are among the diagnostics of what is loaded.
model::Loaded load_with_sweep(const std::string& path, const SweepWords& words);

}  // namespace continuo::app
