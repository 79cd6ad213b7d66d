// The order in which the kernels of contact_solver/ pass over all contacts in a substep (docs/contact_solver.md):
//
//   push    bodies take up their forces; contacts are prepared, start warm, and are solved: overlaps are undone;
//   again   those are solved again whose bodies the last sweep disturbed, until nothing is disturbed;
//   relax   bodies move; contacts are solved without the velocity that undid overlaps.
//
// Each pass goes block by block (contact_blocks.hpp). The thread that solves the contacts within a block also does the
// work on its bodies before the pass, and solves the block's contacts with fixed bodies and walls that belong to the
// pass before.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <continuo/bodies/contact_solver/batch_loops.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/time_stepping/contact_list.hpp>
#include <continuo/bodies/time_stepping/wavefront.hpp>

namespace continuo {

template <class Real, int Dim>
class ContactPasses {
 public:
  ContactPasses(ThreadTeam& team, ContactList<Real, Dim>& contacts, SolverBodies<Real, Dim>& bodies)
      : team_(team), contacts_(contacts), bodies_(bodies), blocks_(contacts.blocks) {}

  /// Calls push_body(k) for all bodies, warm starts the contacts and runs the pass `push`.
  template <class Push>
  void push(const ContactStep<Real>& step, const Push& push_body) {
    run_pushing({starting(push_body), solve<ContactPass::push>(step)}, step);
  }
  /// Calls move_body(k) for all bodies and runs the pass `relax`.
  template <class Move>
  void relax(const ContactStep<Real>& step, const Move& move_body) {
    run(std::array{relaxing(step, move_body)});
  }
  /// The end of a substep and the next one's beginning.
  template <class Move, class Push>
  void relax_and_push(const ContactStep<Real>& step, const Move& move_body, const Push& push_body) {
    run_pushing({relaxing(step, move_body), starting(push_body), solve<ContactPass::push>(step)}, step);
  }

 private:
  /// One pass over all contacts: before(block), then the contacts between moving bodies group by group, and at last
  /// at_border(block), the contacts with fixed bodies and walls.
  struct Pass {
    std::function<void(std::size_t)> before, in_group, at_border;
  };

  template <class Act>
  [[nodiscard]] Pass pass_of(const Act& act) {
    return {[](std::size_t) {}, [this, act](std::size_t group) { contacts_.in_group(group, act); },
            [this, act](std::size_t block) { contacts_.at_border(block, act); }};
  }
  template <ContactPass pass>
  [[nodiscard]] auto act_of(const ContactStep<Real>& step) {
    return [this, &step](auto kind, auto& batches, std::size_t group) {
      solve_batches<kind(), pass>(batches, group, bodies_, step);
    };
  }
  template <ContactPass pass>
  [[nodiscard]] Pass solve(const ContactStep<Real>& step) {
    return pass_of(act_of<pass>(step));
  }
  template <class Push>
  [[nodiscard]] Pass starting(const Push& push_body) {
    Pass pass = pass_of(
        [this](auto kind, auto& batches, std::size_t group) { start_batches<kind()>(batches, group, bodies_); });
    pass.before = [this, &push_body](std::size_t block) {
      bodies_.disturbances.forget(block, bodies_.size());
      for_each_body(block, push_body);
    };
    return pass;
  }
  template <class Move>
  [[nodiscard]] Pass relaxing(const ContactStep<Real>& step, const Move& move_body) {
    Pass pass = solve<ContactPass::relax>(step);
    pass.before = [this, &move_body](std::size_t block) { for_each_body(block, move_body); };
    return pass;
  }

  /// Runs these passes together with the first sweeps that push again, block by block, while a block is in the cache.
  /// That does not pay with several threads, since each further sweep leaves more blocks over at the ends of their
  /// chunks; nor where sweeps wait for the contacts of the rest; nor where blocks are so few that they stay in the
  /// cache anyway.
  void run_pushing(std::vector<Pass> passes, const ContactStep<Real>& step) {
    const bool pays = team_.is_alone() && !contacts_.has_rest() && blocks_.count >= 4;
    std::vector<ContactStep<Real>> again(pays ? 10 : 0, step);
    std::uint8_t sweep = step.sweep;
    for (ContactStep<Real>& next : again) {
      next.sweep = ++sweep;
      Pass& pass = passes.emplace_back(solve<ContactPass::push_again>(next));
      pass.before = [this](std::size_t block) { bodies_.disturbances.begin_sweep(block); };
    }
    run(passes);
    ContactStep<Real> rest = step;
    rest.sweep = sweep;
    push_again(rest);
  }
  void run(std::span<const Pass> passes) {
    std::vector<Sweep> sweeps;
    for (std::size_t i = 0; i <= passes.size(); ++i) {
      const Pass* const last = i > 0 ? &passes[i - 1] : nullptr;
      const Pass* const pass = i < passes.size() ? &passes[i] : nullptr;
      Sweep& sweep = sweeps.emplace_back();
      sweep.within = [last, pass](std::size_t block) {
        if (last) last->at_border(block);
        if (!pass) return;
        pass->before(block);
        pass->in_group(block);
      };
      if (!pass) break;
      sweep.across = [this, pass](std::size_t block) { pass->in_group(blocks_.across(block)); };
      if (contacts_.has_rest()) sweep.rest = [this, pass] { pass->in_group(blocks_.rest()); };
    }
    run_sweeps(team_, blocks_.count, sweeps);
  }

  template <class Act>
  void for_each_body(std::size_t block, const Act& act) {
    for (std::uint32_t k = blocks_.first(block); k < blocks_.last(block, bodies_.size()); ++k) act(k);
  }

  /// An impact on a ball in a pile needs many sweeps over all contacts until its impulse has reached the supports of
  /// the pile, and the speed that remains after the last sweep becomes overlap. Only few contacts take part: those of
  /// disturbed bodies, whose velocity a contact has just changed by a lot. These are pushed again until no body is
  /// disturbed.
  void push_again(ContactStep<Real> step) {
    constexpr std::uint8_t most_sweeps = 20;  // a bound: bodies squeezed between others may never settle
    const auto again = act_of<ContactPass::push_again>(step);
    Disturbances& disturbances = bodies_.disturbances;
    const auto share = [&](std::size_t first_half, const auto& act) {  // over blocks with disturbed bodies
      meant_.clear();
      for (std::size_t block = 0; block < blocks_.count; ++block)
        if (disturbances.any_from(2 * block + first_half)) meant_.push_back(block);
      team_.share(meant_.size(), [&](std::size_t i) { act(meant_[i]); });
    };
    while (disturbances.any_now() && step.sweep < most_sweeps) {
      ++step.sweep;
      for (std::size_t block = 0; block < blocks_.count; ++block) disturbances.begin_sweep(block);
      share(0, [&](std::size_t block) { contacts_.in_group(block, again); });
      share(1, [&](std::size_t block) { contacts_.in_group(blocks_.across(block), again); });
      contacts_.in_group(blocks_.rest(), again);
      share(0, [&](std::size_t block) { contacts_.at_border(block, again); });
    }
  }

  ThreadTeam& team_;
  ContactList<Real, Dim>& contacts_;
  SolverBodies<Real, Dim>& bodies_;
  const ContactBlocks blocks_;
  std::vector<std::size_t> meant_;
};

}  // namespace continuo
