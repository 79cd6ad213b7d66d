// The evaluation along a motion, compiled once.
#include <continuo/symbolic/tape/tape_run.hpp>
#include <continuo/symbolic/tape/tape_taylor.hpp>

namespace continuo::model {

template void Tape::prepare(std::span<TapeSeries>) const;
template void Tape::evaluate(std::span<TapeSeries>, std::span<TapeSeries>) const;

}  // namespace continuo::model
