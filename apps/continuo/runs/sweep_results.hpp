// What a sweep leaves: one table, one picture, one object, and a summary with a line for each run.
#pragma once
#include <vector>

#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/runs/sweep.hpp>
#include <apps/continuo/runs/sweep_table.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

/// Writes and prints what is wanted. The exit code is that of the worst member.
ExitCode tell_sweep(const Sweep& sweep, const std::vector<SweepMember>& members, const Prepared& base,
                    const RunOutputs& outputs, SweepTable& table, const std::string& hash);

}  // namespace continuo::app
