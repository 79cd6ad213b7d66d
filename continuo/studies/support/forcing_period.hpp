// The period of a model's explicit dependence on time: `cos(omega*t)`, `mod(t, 2)`, `every 0.5 { ... }`. It
// is proven from the text: t may stand only in what a period of a function takes out again.
//
//   const Forcing forcing = forcing_of(program);
//   if (forcing.status && forcing.period) fmt::print("period {}\n", *forcing.period);
#pragma once
#include <optional>
#include <span>
#include <string>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/status/status.hpp>

namespace continuo::studies {

struct Forcing {
  std::optional<double> period;  // nothing where nothing depends on the time
  Status status;                 // a failure where there is one that is not known
  model::Span span;              // of what the failure is about
};

[[nodiscard]] Forcing forcing_of(const model::ModelProgram& program, const model::Overrides& parameters = {});

/// The least common multiple of periods; nothing where two of them have no ratio of small whole numbers.
[[nodiscard]] std::optional<double> common_period(std::span<const double> periods);

/// Whether the equations and guards have the same values a period later, at many times and states near these: what can
/// be said of a period that somebody gives where nothing is proven. `low`, `high`: of the states.
[[nodiscard]] bool repeats_after(const model::ModelProgram& program, double period, std::span<const double> low,
                                 std::span<const double> high, const model::Overrides& parameters = {});

}  // namespace continuo::studies
