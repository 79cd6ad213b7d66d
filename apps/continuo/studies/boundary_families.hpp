// continuo run FILE --family NAME=LOW..HIGH: how the solutions of a boundary-value problem move with a parameter, where
// they turn round and which families cross.
#pragma once
#include <string>

#include <apps/continuo/options/boundary_options.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

/// Prints, draws and writes what `outputs` asks for; `of` names the state to draw, the first where it is empty.
ExitCode show_families(const Prepared& prepared, const boundary::BoundaryRequest& request,
                       const boundary::BoundaryRequest::Along& range, const std::string& of, const RunOutputs& outputs);

}  // namespace continuo::app
