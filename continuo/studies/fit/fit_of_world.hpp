// The checks that a fit of a world of bodies needs, since its motion has kinks and jumps. Internal to fit.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/status/status.hpp>
#include <continuo/studies/least_squares.hpp>

namespace continuo::studies::detail {

/// Whether a quantity (a state, or a node) reads what jumps where bodies meet: there it has no derivative by what moves
/// the instant.
[[nodiscard]] bool jumps_at_impacts(const model::Model& model, const std::vector<std::uint32_t>& variables);

/// Intervals are as honest as the slopes behind them: these are taken anew, over the width of the interval of each
/// unknown (`set_increments`), and the search ended with them. Where the intervals come out as others the motion is no
/// smooth function of that unknown, which is a failure.
[[nodiscard]] Status judge_slopes(LeastSquares& least, const LeastSquaresOptions& options,
                                  const std::vector<std::string>& names,
                                  const std::function<void(std::vector<double>)>& set_increments,
                                  LeastSquaresResult& result);

}  // namespace continuo::studies::detail
