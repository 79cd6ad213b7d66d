// apps/continuo/verbs.hpp
// Every verb adds itself with its options to the command line; when it is chosen it leaves its exit code in `exit`.
#pragma once
#include <CLI/App.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

class SweepRanks;

// Of the program continuo.
void add_replay(CLI::App& app, ExitCode& exit);
void add_resume(CLI::App& app, ExitCode& exit);
void add_view(CLI::App& app, ExitCode& exit);
void add_check(CLI::App& app, ExitCode& exit);
void add_info(CLI::App& app, ExitCode& exit);
void add_verify(CLI::App& app, ExitCode& exit);
void add_report(CLI::App& app, ExitCode& exit);
void add_methods(CLI::App& app, ExitCode& exit);
void add_explain(CLI::App& app, ExitCode& exit);
void add_export(CLI::App& app, ExitCode& exit);
void add_new(CLI::App& app, ExitCode& exit);

// Of the program continuo-studies.
void add_compare(CLI::App& app, ExitCode& exit);
void add_converge(CLI::App& app, ExitCode& exit);
void add_stability(CLI::App& app, ExitCode& exit);
void add_steady(CLI::App& app, ExitCode& exit);
void add_linearize(CLI::App& app, ExitCode& exit);
void add_phase(CLI::App& app, ExitCode& exit);
void add_orbit(CLI::App& app, ExitCode& exit);
void add_explore(CLI::App& app, ExitCode& exit);
void add_sense(CLI::App& app, ExitCode& exit);
/// `ranks`: processes that make the sweep together; null where there is one.
void add_sweep(CLI::App& app, ExitCode& exit, SweepRanks* ranks = nullptr);
void add_fit(CLI::App& app, ExitCode& exit);

// Of both; `run` is in verbs/run.hpp.
void add_help(CLI::App& app, ExitCode& exit);

}  // namespace continuo::app
