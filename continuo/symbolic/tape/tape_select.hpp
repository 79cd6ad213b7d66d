// continuo/symbolic/tape/tape_select.hpp
// From expressions to operations: which nodes become one instruction. Internal to the tape.
#pragma once
#include <cstdint>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/tape/tape_code.hpp>
#include <continuo/symbolic/tape/tape_steady.hpp>

namespace continuo::model::tape {

/// One operation to be placed: `result` is the node it computes, `operand` the nodes it reads.
struct Selected {
  Code code = Code::add;
  NodeId result;
  NodeId operand[4] = {};
  std::uint32_t table = 0;  // of interpolate
  bool steady = false;      // belongs to the preparation
};

/// The operations that compute the outputs, operands before their use. A product used once goes into the sum that
/// uses it, a sum used once into the product; comparisons go into the choices they decide.
[[nodiscard]] std::vector<Selected> select_operations(const Prepared& prepared);

}  // namespace continuo::model::tape
