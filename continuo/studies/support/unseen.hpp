// The features of a model that a study of x' = f(x) alone ignores, so that it can report them: events, the time, jumps.
//
//   if (const auto unseen = unseen_of(program, mode)) refuse(unseen->span, unseen->what);
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <continuo/simulation/program/model_program.hpp>

namespace continuo::studies {

/// What an equation-by-equation study would not see of a model in one of its modes: an event or a scheduled one that
/// changes something, and where it stands; an equation that jumps, and where its state begins. Nothing where x' = f(t,
/// x, p) is all there is.
struct Unseen {
  model::Span span;
  std::string what;  // "an event changes the motion"
};
[[nodiscard]] std::optional<Unseen> unseen_of(const model::ModelProgram& program, std::size_t mode);

/// The first state of the mode whose equation depends on t, or on an input that a file moves.
[[nodiscard]] std::optional<std::size_t> depends_on_time(const model::ModelProgram& program, std::size_t mode);

/// A jump of the mode's equations that this state lies at, to nine digits, as it is written: "sign(x)". There no
/// derivative says what happens nearby.
[[nodiscard]] std::optional<std::string> jump_at(const model::ModelProgram& program, std::size_t mode,
                                                 std::span<const double> x, const model::Overrides& parameters = {});

/// Whether actions set a state or go to a mode, in some branch.
[[nodiscard]] bool changes_something(const model::Block& block);
/// The first event of a mode, at set times or not, that changes something.
[[nodiscard]] std::optional<model::Span> changes_by_event(const model::Model& model, std::size_t mode);
/// The first one at set times.
[[nodiscard]] std::optional<model::Span> changes_at_set_times(const model::Model& model);

}  // namespace continuo::studies
