// The passes over all contacts in a substep, block by block, see contact_blocks.hpp: what is done to a block's bodies
// before a pass, and what its border does after the pass before, is done by the thread that has the block anyway.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_list.hpp>
#include <continuo/bodies/contact_solver.hpp>
#include <continuo/bodies/team.hpp>

namespace continuo {

template <class Real, int Dim>
class ContactPasses {
 public:
  ContactPasses(Team& team, ContactList<Real, Dim>& contacts, SolverBodies<Real, Dim>& bodies)
      : team_(team), contacts_(contacts), bodies_(bodies), blocks_(contacts.blocks) {}

  /// push_body(k) for all bodies, then contacts begin and push.
  template <class Push>
  void push(ContactStep<Real> step, const Push& push_body) {
    const auto begin = [this](auto kind, auto& packs, std::size_t group) {
      begin_packs<kind()>(packs, group, bodies_);
    };
    pass(begin, [&](std::size_t block) {
      forget_disturbances(block);
      for_each_body(block, push_body);
    });
    const auto push = solve<ContactPass::push>(step);
    pass(push, [&](std::size_t block) { contacts_.at_border(block, begin); });
    team_.share(blocks_.count, [&](std::size_t block) { contacts_.at_border(block, push); });
    push_again(step);
  }

  template <class Move>
  void relax(const ContactStep<Real>& step, const Move& move_body) {
    const auto relax = solve<ContactPass::relax>(step);
    pass(relax, [&](std::size_t block) { for_each_body(block, move_body); });
    team_.share(blocks_.count, [&](std::size_t block) { contacts_.at_border(block, relax); });
  }

 private:
  template <ContactPass pass>
  auto solve(const ContactStep<Real>& step) {
    return [this, &step](auto kind, auto& packs, std::size_t group) {
      solve_packs<kind(), pass>(packs, group, bodies_, step);
    };
  }
  /// All contacts between bodies that move; before(block) comes before those within a block.
  template <class Act, class Before>
  void pass(const Act& act, const Before& before) {
    team_.share(blocks_.count, [&](std::size_t block) {
      before(block);
      contacts_.in_group(block, act);
    });
    team_.share(blocks_.count, [&](std::size_t block) { contacts_.in_group(blocks_.across(block), act); });
    contacts_.in_group(blocks_.rest(), act);
  }
  template <class Act>
  void for_each_body(std::size_t block, const Act& act) {
    for (std::uint32_t k = blocks_.first(block); k < blocks_.last(block, bodies_.size()); ++k) act(k);
  }

  /// An impact on a ball that others hold takes many turns round all contacts until it has come through to what holds
  /// them up, and the speed that is left after the last becomes overlap. Few contacts take part: those of bodies whose
  /// velocities their contacts have just changed by a lot. These are pushed again until nothing is disturbed.
  void push_again(ContactStep<Real>& step) {
    constexpr std::uint8_t most_sweeps = 20;  // a bound: what is squeezed between others may never settle
    const auto again = solve<ContactPass::push_again>(step);
    auto& halves = bodies_.disturbances;
    const auto share = [&](std::size_t first_half, const auto& act) {
      meant_.clear();
      for (std::size_t block = 0; block < blocks_.count; ++block)
        if (halves[2 * block + first_half].any() != 0 || halves[2 * block + first_half + 1].any() != 0)
          meant_.push_back(block);
      team_.share(meant_.size(), [&](std::size_t i) { act(meant_[i]); });
    };
    const auto is_disturbed = [](const Disturbances& half) { return half.now != 0; };
    while (std::ranges::any_of(halves, is_disturbed) && step.sweep < most_sweeps) {
      ++step.sweep;
      for (Disturbances& half : halves) half = {half.now, 0};
      share(0, [&](std::size_t block) { contacts_.in_group(block, again); });
      share(1, [&](std::size_t block) { contacts_.in_group(blocks_.across(block), again); });
      contacts_.in_group(blocks_.rest(), again);
      share(0, [&](std::size_t block) { contacts_.at_border(block, again); });
    }
  }
  void forget_disturbances(std::size_t block) {
    for_each_body(block, [&](std::uint32_t k) { bodies_.disturbed[k] = 0; });
    for (std::size_t half = 2 * block; half < 2 * block + 2; ++half) bodies_.disturbances[half] = {};
  }

  Team& team_;
  ContactList<Real, Dim>& contacts_;
  SolverBodies<Real, Dim>& bodies_;
  const ContactBlocks blocks_;
  std::vector<std::size_t> meant_;
};

}  // namespace continuo
