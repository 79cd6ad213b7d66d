// continuo/language/check/equations/equations_at_work.hpp
// The equations of one mode while they are solved for the highest derivatives. Only equations/ reads this.
#pragma once
#include <cstdint>
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::model::detail {

struct EquationAtWork {
  NodeId residual;                   // left - right; not valid where there is a solution
  NodeId solution;                   // right, where the left is the only highest derivative, alone
  std::vector<std::uint32_t> holds;  // the highest derivatives in it, as indices of bases, ascending
  std::size_t open = 0;              // how many of these no equation has determined yet
  bool used = false;
  bool bad = false;  // reported already; it still counts as an equation
  Span span;
};

struct ModeAtWork {
  std::size_t mode;
  std::vector<EquationAtWork> equations;
  std::vector<NodeId> solved;   // per base
  std::vector<std::size_t> by;  // per base: the equation that determines it, npos while open
  struct Undetermined {
    std::vector<std::size_t> members;
    std::vector<std::uint32_t> open;
  };
  std::vector<Undetermined> undetermined;
};

}  // namespace continuo::model::detail
