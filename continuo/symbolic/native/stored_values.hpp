// Which values of a tape are stored where it is written as C; all others are part of the expressions that read them.
#pragma once
#include <vector>

#include <continuo/symbolic/native/tape_values.hpp>

namespace continuo::model {

/// By value. A value that is read more than once is stored, unless computing it again costs less than the way through
/// memory. What is stored in a register that another value takes before it is read is left to those who read it: where
/// a register has been taken, what was computed from it is stored itself.
[[nodiscard]] std::vector<char> values_to_store(const TapeValues& values);

}  // namespace continuo::model
