// continuo/results/json.hpp
// A run as JSON: the manifest that every result file points to, and the object of `--json`.
//
// Numbers read back as the same double; what is not finite is null.
#pragma once
#include <string>
#include <string_view>

#include <continuo/results/record.hpp>

namespace continuo::results {

/// What was run and how it ended: version, model text and hash, parameters, method, tolerances, seed, statistics.
std::string manifest(const Record& record, std::string_view version);

/// The hash of a manifest without what differs from run to run of the same thing (wall time): equal hashes, equal
/// results.
std::string manifest_hash(const Record& record, std::string_view version);

/// One object: outcome, t, state by name, events, statistics, energy, checks. Ends with a line end.
std::string run_json(const Record& record);

}  // namespace continuo::results
