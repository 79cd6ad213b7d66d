// df/dx and df/dt of a model, exact, in every mode, as tapes: found once for any number of runs.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

struct DerivativeTapes {
  struct OfMode {
    std::shared_ptr<const Tape> entries;  // of the pattern, zero where this mode has none
    std::vector<std::uint32_t> moving;    // the components whose derivative by time is not zero
    std::shared_ptr<const Tape> by_time;  // of those
  };
  SparsePattern pattern;  // where df/dx may differ from zero in any mode
  std::vector<OfMode> modes;
};

/// `held`: of the equations with their switches held (SwitchedEquations), whose pattern is full where the motion may
/// slide and the matrix is small.
[[nodiscard]] DerivativeTapes derivative_tapes(const ModelProgram& program, bool held);

}  // namespace continuo::model
