// continuo/results/summary.hpp
// A run in a few lines for the terminal: how it ended, final state, events, energy drift, checks, cost.
#pragma once
#include <string>

#include <continuo/language/model.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::results {

/// Checks judge the model as its file has it. Where the run is of another one (`as_written` is false: a parameter or
/// a method was set), the summary says so and names the checks that failed or could not be evaluated.
[[nodiscard]] std::string summary(const model::Model& model, const model::Run& run, bool as_written = true);

/// Which check, and why it failed or was not evaluated: "check x(2) = 0 within 1e-9 does not hold: it is -0.65 m".
[[nodiscard]] std::string failed_check(const model::CheckResult& check);

/// Six digits, as people read numbers: 0.451524, 1.2e-11, 60.
[[nodiscard]] std::string short_number(double value);

/// "12.3 ms", "1.20 s".
[[nodiscard]] std::string duration(double seconds);

}  // namespace continuo::results
