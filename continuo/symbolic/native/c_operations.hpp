// The operations of a tape as expressions of C.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <continuo/symbolic/tape/tape_code.hpp>

namespace continuo::model {

/// A number as C reads it again to the bit; in brackets if it is negative.
[[nodiscard]] std::string number_text(double value);

/// One operation on operands that are names, numbers or expressions; `in_lanes`: on the type `lanes` of c_lane_helpers.
[[nodiscard]] std::string operation_text(tape::Code code, std::array<std::string, 4> operand, bool in_lanes);
/// The same, where it has a sum and a product, as one fused operation: that is rounded once. Else empty.
[[nodiscard]] std::string fused_operation_text(tape::Code code, std::array<std::string, 4> operand, bool in_lanes);
/// a*b + c, rounded once.
[[nodiscard]] std::string fused_text(std::string_view a, std::string_view b, std::string_view c, bool in_lanes);
/// A table or its slope at x.
[[nodiscard]] std::string table_text(tape::Code code, std::uint32_t table, std::string_view x, bool in_lanes);

}  // namespace continuo::model
