// Finds the loops in a list of equal computations: members of a family that differ by the numbers they read and write
// alone, whose addresses advance evenly along the rows, planes, ... of a grid.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace continuo::model {

/// Members of a list as loops in each other.
struct LoopNest {
  struct Dimension {
    std::size_t count = 0;
    std::size_t member_step = 0;      // along the list
    std::vector<std::int32_t> steps;  // by which each address advances
  };
  std::size_t member = 0;             // the first
  std::vector<Dimension> dimensions;  // innermost first

  [[nodiscard]] std::size_t size() const;
};

struct Loops {
  std::vector<LoopNest> nests;
  std::vector<std::size_t> alone;  // members in no loop, ascending
};

/// The addresses of member m are `width` numbers from addresses[m*width] on. Each member is in one loop or alone.
[[nodiscard]] Loops loops_of(std::span<const std::int32_t> addresses, std::size_t width);

/// Of the loops' variables in C, the innermost first.
inline constexpr std::string_view loop_variables = "ijkl";
/// begin + ... + steps[1]*j + steps[0]*i.
[[nodiscard]] std::string sum_text(std::int64_t begin, std::span<const std::int64_t> steps);

}  // namespace continuo::model
