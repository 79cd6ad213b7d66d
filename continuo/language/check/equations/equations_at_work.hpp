// continuo/language/check/equations/equations_at_work.hpp
// The equations of one mode while they are solved for the highest derivatives. Only equations/ reads this.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::model::detail {

struct EquationAtWork {
  NodeId residual;                          // left - right; not valid where there is a solution
  NodeId solution;                          // right, where the left is the only highest derivative, alone
  std::uint32_t first_held = 0, holds = 0;  // ModeAtWork::held_by
  std::uint32_t open = 0;                   // how many of these no equation has determined yet
  bool used = false;
  bool bad = false;  // reported already; it still counts as an equation
  Span span;
};

struct ModeAtWork {
  std::size_t mode;
  std::vector<EquationAtWork> equations;
  std::vector<std::uint32_t> held;  // by the equations, one after the other
  std::vector<NodeId> solved;       // per base
  std::vector<std::size_t> by;      // per base: the equation that determines it, npos while open
  struct Undetermined {
    std::vector<std::size_t> members;
    std::vector<std::uint32_t> open;
  };
  std::vector<Undetermined> undetermined;

  /// The highest derivatives in an equation, as indices of bases, ascending.
  [[nodiscard]] std::span<const std::uint32_t> held_by(const EquationAtWork& equation) const {
    return std::span(held).subspan(equation.first_held, equation.holds);
  }
};

}  // namespace continuo::model::detail
