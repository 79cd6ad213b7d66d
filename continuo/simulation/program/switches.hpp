// Where the right-hand sides of a mode jump or bend: the comparisons of `if`, sign, floor and mod, and the corners of
// abs, min and max. A run locates the instants at which the motion crosses there; between them the equations are
// smooth: each such place is a switch whose value is held by a variable of its own.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

struct ModelProgram;

/// One place where an expression switches. `surface` is zero there: of a relation, which is 1 where surface > 0 and
/// else 0; of sign, which is -1 or 1; of floor it is the argument, and every whole number is a surface.
struct Switch {
  enum class Kind : unsigned char { relation, sign, floor };
  Kind kind;
  bool closed = false;     // of a relation: it holds on the surface as well
  NodeId surface;          // other switches in it are held, too
  std::uint32_t variable;  // stands for the value
};

/// The switches of one mode and its equations with each of them held.
struct SwitchedEquations {
  std::vector<Switch> switches;
  std::vector<NodeId> guards;       // by switch: zero on its surface; of floor positive between two whole numbers
  std::vector<NodeId> derivatives;  // as in Mode
  std::shared_ptr<const Tape> rates, surfaces, approach;  // of derivatives, surfaces, d surface/dt along the motion
  bool slides = false;                                    // a surface depends on states: the motion may slide along it

  [[nodiscard]] bool empty() const { return switches.empty(); }
};

/// Finds the switches of a mode and rewrites its equations. What depends on the unknowns of algebraic equations, or on
/// nothing that moves, stays as it is, and so does all of a mode with more than `most_switches` of them, as on a grid:
/// there error control sees to the jumps. `program` lends its graph, which grows.
[[nodiscard]] SwitchedEquations switched_equations(ModelProgram& program, std::size_t mode);

/// Whether an operation jumps where its arguments meet something.
[[nodiscard]] bool is_jump(Op op);

/// Above as many switches a mode is left as it is, above as many corners their part.
inline constexpr std::size_t most_switches = 64, most_corners = 8;

}  // namespace continuo::model
