// Lists of whole numbers as loops of C: where the Jacobian of a grid has its entries.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace continuo::model {

struct CList {
  std::string_view name;
  std::span<const std::uint32_t> numbers;
};

/// Statements that fill arrays of these names, all of one length; nothing where the numbers follow no rule, so that an
/// initialised array is as short.
[[nodiscard]] std::optional<std::string> c_loops(std::span<const CList> lists);

}  // namespace continuo::model
