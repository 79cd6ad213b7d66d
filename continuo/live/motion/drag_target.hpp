// continuo/live/motion/drag_target.hpp
// A point of the drawing in the hand of somebody: the states it depends on are moved so that it comes as near to the
// hand as it can.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/simulation/program/evaluation.hpp>

namespace continuo::live {

struct DragTarget {
  std::vector<std::size_t> positions;   // the states that are moved
  std::vector<std::size_t> velocities;  // those that are 0 meanwhile
  std::size_t dimension = 2;
  std::vector<model::NodeId> nodes;  // the point, then its derivatives by the positions, row by row

  /// Both, ascending: what stands still while it is held.
  std::vector<std::size_t> held() const;
};

/// Of a point that depends on states. Velocities move nothing, unless the point is made of nothing else.
DragTarget make_drag_target(model::Model& model, std::span<const model::NodeId> point);

/// x with the point at, or as near as can be to `target`, and the velocities 0. `evaluation` is of the drag_target's
/// nodes. Levenberg's and Marquardt's iteration; each step is the smallest change of states that gains what is to be
/// gained.
std::vector<double> pull(const DragTarget& drag_target, model::Evaluation& evaluation, double t, std::vector<double> x,
                         std::span<const double> target);

}  // namespace continuo::live
