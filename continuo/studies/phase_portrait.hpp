// The plane of a system of two equations that do not depend on time: direction field, nullclines, equilibria, the
// separatrices of saddles, and motions from given or spread starts.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include <continuo/solve/outcome.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies {

/// The values of the two states.
using PlanePoint = std::array<double, 2>;
/// A curve as points, one after the other.
using PlaneCurve = std::vector<PlanePoint>;

/// The part of the plane, and how finely it is looked at.
struct PhasePlane {
  PlanePoint low, high;              // the part of the plane that is looked at
  std::vector<PlanePoint> starts{};  // of motions; empty: `spread` of them on a grid
  std::size_t spread = 16;
  double duration = 50;     // of each motion, forwards and backwards
  std::size_t arrows = 24;  // along each side
  std::size_t cells = 160;  // along each side, for the nullclines
  double t = 0;             // where f depends on time: at this one
  double rtol = 1e-7;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // from 0 to 1
};

/// An arrow of the direction field.
struct FieldArrow {
  PlanePoint at, direction;  // of length 1 where each side of the part is 1
  double speed;              // |f| in the same measure
};

/// The parts of a portrait.
struct PhasePortrait {
  std::vector<FieldArrow> field;
  std::array<std::vector<PlaneCurve>, 2> nullclines;  // where x' = 0 and where y' = 0, in short pieces
  std::vector<Equilibrium> equilibria;                // inside
  std::vector<PlaneCurve> separatrices, motions;
  bool complete = false;  // not interrupted
};

/// The system must have two components.
[[nodiscard]] PhasePortrait phase_portrait(const ParametricSystem& system, const PhasePlane& plane);

}  // namespace continuo::studies
