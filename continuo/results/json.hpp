// continuo/results/json.hpp
// A run as JSON: the manifest that every result file points to, and the object of `--json`.
//
// Numbers read back as the same double; what is not finite is null.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include <continuo/language/model.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::results {

/// What was run and how it ended: version, model text and hash, parameters, method, tolerances, statistics.
/// `seed` is null: nothing in a run is drawn by chance.
[[nodiscard]] std::string manifest(const model::Model& model, const model::Run& run, std::string_view version);

/// The hash of all that determines a run, which is known with its first row: the version, the model's text, the plan,
/// and the states at its start. Equal hashes, equal results.
[[nodiscard]] std::string manifest_hash(const model::Model& model, const model::Plan& plan,
                                        std::span<const double> first_state, std::string_view version);

/// One object: outcome, t, state by name, events, statistics, energy, checks. Ends with a line end.
[[nodiscard]] std::string run_json(const model::Run& run);

}  // namespace continuo::results
