// continuo run FILE --sweep-run N: one run of a sweep alone.
#pragma once
#include <cstdint>

#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

/// Gives the experiment the values of this run of the model's sweep. Says why where there is no such run.
ExitCode take_sweep_run(Prepared& prepared, std::uint64_t run);

}  // namespace continuo::app
