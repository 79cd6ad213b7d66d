// continuo/results/run_tables.hpp
// The two tables of a run as files.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/simulation/run.hpp>
#include <continuo/status/status.hpp>

namespace continuo::results {

/// `t`, states, outputs: an event stands as two rows of equal t, the state before it and after it.
/// The ending of the name says the format (table_file.hpp).
/// Each returns what went wrong, if anything; "-" is standard output.
Status write_motion(const model::Run& run, const std::string& path, std::string_view manifest_hash);

/// `event,t`, where bodies met `impulse`, then `before h` for each state, then `after h`.
Status write_events(const model::Run& run, const std::string& path, std::string_view manifest_hash);

}  // namespace continuo::results
