// A tape's expressions as truncated Taylor series along a motion, each coefficient with a bound of its rounding.
#pragma once
#include <span>

#include <continuo/numerics/taylor.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

using TapeSeries = Taylor<Rounded<double>, 3>;

extern template void Tape::prepare(std::span<TapeSeries>) const;
extern template void Tape::evaluate(std::span<TapeSeries>, std::span<TapeSeries>) const;

}  // namespace continuo::model
