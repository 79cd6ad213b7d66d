// Solves the rows of one island in a substep: together, where its graph is thin (direct_solver.hpp), and by sweeps of
// soft contacts elsewhere (constraint_rows.hpp), whose cost grows with the number of rows only.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/direct_solver.hpp>
#include <continuo/bodies/rigid_stepping/rigid_islands.hpp>

namespace continuo {

template <class Real, int Dim>
class IslandSolver {
 public:
  using Bodies = std::span<RigidBody<Real, Dim>>;

  /// Takes an island at the beginning of a step. The rows of joints change in it, and those of contacts where they
  /// turn.
  void begin(const RigidIslands& islands, std::size_t island, const Constraints<Real, Dim>& all,
             std::span<const RigidBody<Real, Dim>> bodies, bool contacts_turn) {
    members_ = islands.bodies(island), blocks_ = islands.blocks(island);
    const std::size_t bodies_before = analysed_bodies_, most_before = most_updates_;
    pairs_before_.swap(pairs_);
    pairs_.clear();
    has_joints_ = false, is_free_ = true;
    std::size_t rows = 0;
    for (const std::uint32_t k : blocks_) {
      const RowBlock& block = all.blocks[k];
      const auto place = [&](std::uint32_t body) {
        return bodies[body].is_fixed() ? DirectSolver<Dim>::fixed : islands.place(body);
      };
      pairs_.push_back({place(block.a), place(block.b)});
      has_joints_ |= block.points == 0;
      is_free_ &= !bodies[block.a].is_fixed() && !bodies[block.b].is_fixed();
      rows += block.rows;
    }
    do_rows_change_ = has_joints_ || contacts_turn;
    // A product of blocks costs as much as some ten rows of a sweep, of which a step has two for each substep.
    analysed_bodies_ = members_.size(), most_updates_ = rows / 2 + 100;
    // The same graph as in the last step has the same pattern.
    if (analysed_bodies_ != bodies_before || most_updates_ != most_before || pairs_ != pairs_before_)
      is_thin_ = direct_.analyse(members_.size(), pairs_, most_updates_);
    is_direct_ = is_thin_;
    is_loaded_ = false;
    sweeps_ = 1;
  }
  [[nodiscard]] bool is_direct() const { return is_direct_; }

  /// Removes what the rows forbid from the velocities after the forces of a substep have acted.
  void push(Constraints<Real, Dim>& all, Bodies bodies) {
    if (is_direct_) {
      direct_.template load_bodies<Real>(members_, bodies, RowPass::push, is_inertia_of_now());
      if (do_rows_change_ || !is_loaded_) {
        direct_.template load_rows<Real>(blocks_, all, bodies);
      } else {
        direct_.template load_biases<Real>(blocks_, all);
      }
      is_loaded_ = true;
      if (solve_directly(RowPass::push, all, bodies)) return;
      is_direct_ = false;  // sweeps go on for the rest of this step
      sweeps_ = sweeps_instead;
    }
    if (sweeps_ > 1) soften(all);
    begin_with_impulses(all, bodies);
    sweep_all(RowPass::push, all, bodies);
  }
  /// The same for other biases of the same rows, from where the last call has begun. False where that fails.
  [[nodiscard]] bool push_again(Constraints<Real, Dim>& all, Bodies bodies) {
    direct_.template load_biases<Real>(blocks_, all);
    direct_.begin_as_before_push();
    return solve_directly(RowPass::push, all, bodies);
  }
  /// Removes the velocity that correcting positions gave.
  void relax(Constraints<Real, Dim>& all, Bodies bodies) {
    if (!is_direct_) return sweep_all(RowPass::relax, all, bodies);
    if (do_rows_change_) {
      direct_.template load_bodies<Real>(members_, bodies, RowPass::relax, is_inertia_of_now());
      direct_.template load_rows<Real>(blocks_, all, bodies);
      direct_.remove_impulses();
    } else {
      direct_.template load_biases<Real>(blocks_, all);
    }
    direct_.begin_as_before_push();
    if (solve_directly(RowPass::relax, all, bodies)) return;
    is_direct_ = false;
    sweeps_ = sweeps_instead;
    sweep_all(RowPass::relax, all, bodies);
  }
  /// Adds what impacts give: the rows begin without impulses.
  void rebound(Constraints<Real, Dim>& all, Bodies bodies) {
    if (is_direct_) {
      direct_.template load_bodies<Real>(members_, bodies, RowPass::relax, is_inertia_of_now());
      direct_.template load_rows<Real>(blocks_, all, bodies);
      if (solve_directly(RowPass::relax, all, bodies)) return;
    }
    sweeps_ = sweeps_instead;
    sweep_all(RowPass::relax, all, bodies);
  }

 private:
  /// What is free keeps its angular momentum.
  [[nodiscard]] bool is_inertia_of_now() const { return has_joints_ || (do_rows_change_ && is_free_); }
  [[nodiscard]] bool solve_directly(RowPass pass, Constraints<Real, Dim>& all, Bodies bodies) {
    if (!direct_.solve(pass)) return false;
    direct_.template store_bodies<Real>(members_, bodies);
    direct_.template store_impulses<Real>(blocks_, all);
    return true;
  }
  /// Sweeps begin with the impulses of the last substep, those of contacts only if they take energy: those that stopped
  /// a hard hit may be thousands of times what the velocities mean now, and 20 sweeps would not undo them.
  void begin_with_impulses(Constraints<Real, Dim>& all, Bodies bodies) const {
    const auto apply = [&](bool to_contacts, const Real& factor) {
      for (const std::uint32_t k : blocks_)
        for (const auto& row : all.of(all.blocks[k]))
          if (row.impulse != Real(0) && (all.blocks[k].points > 0) == to_contacts)
            row.apply(row.impulse * factor, bodies[all.blocks[k].a], bodies[all.blocks[k].b]);
    };
    apply(false, Real(1));
    Real power = power_of_contacts(all, bodies);
    apply(true, Real(1));
    power += power_of_contacts(all, bodies);
    if (!(power > Real(0))) return;
    apply(true, Real(-1));
    for (const std::uint32_t k : blocks_)
      if (all.blocks[k].points > 0)
        for (auto& row : all.of(all.blocks[k])) row.impulse = Real(0);
  }
  /// Impulses times velocities: the sum before and after the impulses act is twice the energy that they give.
  [[nodiscard]] Real power_of_contacts(Constraints<Real, Dim>& all, Bodies bodies) const {
    Real power(0);
    for (const std::uint32_t k : blocks_)
      if (const RowBlock& block = all.blocks[k]; block.points > 0)
        for (const auto& row : all.of(block)) power += row.impulse * row.velocity(bodies[block.a], bodies[block.b]);
    return power;
  }
  /// Sweeps do not get along with joints that undo all of an error at once, nor with rigid contacts that push fast:
  /// where bodies overlap, those may contradict each other.
  void soften(Constraints<Real, Dim>& all) const {
    for (const std::uint32_t k : blocks_)
      for (auto& row : all.of(all.blocks[k])) {
        const bool is_free = row.least == -row.most && !(row.most < std::numeric_limits<Real>::infinity());
        const bool is_contact = all.blocks[k].points > 0;
        if (is_contact && row.bias < Real(0)) row.bias *= Real(0.1);
        if (is_contact || !is_free || row.softness > Real(0) || !(row.mass > Real(0))) continue;
        row.bias *= Real(0.1);
        row.softness = Real(0.1) / row.mass;
      }
  }
  void sweep_all(RowPass pass, Constraints<Real, Dim>& all, Bodies bodies) {
    for (int sweep_number = 0; sweep_number < sweeps_; ++sweep_number)
      for (const std::uint32_t k : blocks_) {
        const RowBlock& block = all.blocks[k];
        sweep<Real, Dim>(all.of(block), block, pass, bodies[block.a], bodies[block.b]);
      }
  }

  static constexpr int sweeps_instead = 20;  // where an island was to be solved directly, but could not

  DirectSolver<Dim> direct_;
  std::span<const std::uint32_t> members_, blocks_;
  std::vector<typename DirectSolver<Dim>::Pair> pairs_, pairs_before_;
  std::size_t analysed_bodies_ = 0, most_updates_ = 0;
  bool is_thin_ = false;                       // whether the graph can be factorized
  bool has_joints_ = false, is_free_ = false;  // free: touches nothing that is fixed
  bool is_direct_ = false, do_rows_change_ = false, is_loaded_ = false;
  int sweeps_ = 1;
};

}  // namespace continuo
