// Bounds for the motion of bodies: within a step, until pairs are listed again, and for the pairs that may touch in a
// step.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <continuo/bodies/contact_solver/solver_body.hpp>
#include <continuo/bodies/support/thread_team.hpp>

namespace continuo {

/// How far a body of this radius may move before pairs are listed again, if it is no faster than the others.
template <class Real>
[[nodiscard]] Real skin(const Real& radius) {
  return Real(0.22) * radius;
}
/// Up to so many of these bodies may search for their own partners before that costs more than it saves.
[[nodiscard]] inline std::size_t few(std::size_t bodies) {
  return static_cast<std::size_t>(std::sqrt(2 * static_cast<double>(bodies)));
}

/// How far the body at place k may move in one step.
template <class Real, int Dim>
[[nodiscard]] Real step_reach(const SolverBodies<Real, Dim>& bodies, std::size_t k, const Real& step) {
  return length(bodies.v(k)) * step + length(bodies.acceleration(k)) * step * step / 2;
}

/// The reach of each body: a list of pairs is valid until a body has moved further than its reach. It is at least the
/// skin. Where all bodies move fast, it is 4.5 present steps, enough for four while gravity makes them faster, but no
/// more than 0.6 of the radius or 1.7 steps, whichever is greater. Where few bodies are fast, their reach is as many
/// steps, up to 12, as leave only few bodies beyond their skin: otherwise a ball that rolls over a heap at rest would
/// have all pairs listed again every other step.
template <class Real>
class SweptBounds {
 public:
  template <int Dim>
  SweptBounds(const SolverBodies<Real, Dim>& bodies, const Real& step) : reach_(bodies.size()) {
    constexpr auto fewest = static_cast<Real>(1.7), four = static_cast<Real>(4.5), most = static_cast<Real>(12);
    std::vector<Real> steps(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      reach_[k] = step_reach(bodies, k, step);
      steps[k] = bodies.moves(k) ? skin(bodies.radius(k)) / reach_[k] : most;
    }
    Real ahead = most;
    if (const std::size_t limit = few(steps.size()); limit < steps.size()) {
      const auto last = steps.begin() + static_cast<std::ptrdiff_t>(limit);
      std::nth_element(steps.begin(), last, steps.end());
      ahead = std::clamp(*last, fewest, most);
    }
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Real radius = bodies.radius(k), short_way = std::min(four * reach_[k], Real(0.6) * radius);
      reach_[k] = std::max({skin(radius), ahead * reach_[k], short_way});
    }
  }
  Real operator()(std::size_t k) const { return reach_[k]; }

 private:
  std::vector<Real> reach_;
};

/// How near two bodies must be for their contact to be solved in a step: their gap is no more than they may approach.
template <class Real>
struct BlockSweptBounds {
  Real step{};   // of time
  Real extra{};  // beyond the approach by their velocities
};

/// The bounds of every block. Beyond the approach by their own velocities, two bodies may approach by gravity, and by
/// the speed that a third one gives them, which is at most that of the fastest body in this block and its two
/// neighbours.
template <class Real, int Dim>
[[nodiscard]] std::vector<BlockSweptBounds<Real>> swept_bounds_of_blocks(ThreadTeam& team,
                                                                         const SolverBodies<Real, Dim>& bodies,
                                                                         const Real& step) {
  using std::sqrt;
  struct Most {
    Real square_of_speed{}, radius{};
  };
  const ContactBlocks& blocks = bodies.blocks;
  std::vector<Most> most(blocks.count + 2);  // none before the first block, none behind the last
  team.share(blocks.count, [&](std::size_t block) {
    Most of_block;
    for (std::size_t k = blocks.first(block); k < blocks.last(block, bodies.size()); ++k) {
      of_block.square_of_speed = std::max(of_block.square_of_speed, squared(bodies.v(k)));
      of_block.radius = std::max(of_block.radius, bodies.radius(k));
    }
    most[block + 1] = of_block;
  });
  Real widest(0);
  for (const Most& of_block : most) widest = std::max(widest, of_block.radius);
  const Real fall = length(bodies.gravity) * step * step;
  std::vector<BlockSweptBounds<Real>> result;
  for (std::size_t block = 0; block < blocks.count; ++block) {
    Real square(0);
    for (std::size_t near = block; near < block + 3; ++near) square = std::max(square, most[near].square_of_speed);
    result.push_back({step, std::min(Real(0.1) * widest, Real(sqrt(square) * step)) + fall});
  }
  return result;
}

}  // namespace continuo
