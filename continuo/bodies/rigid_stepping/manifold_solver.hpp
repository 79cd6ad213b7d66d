// Solves the contacts of large islands by sweeps, as many manifolds at once as the registers of the machine have lanes,
// colour by colour, each colour by all threads. The results do not depend on the width of registers, nor on threads.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/manifold_kernels/contact_colours.hpp>
#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>
#include <continuo/bodies/manifold_kernels/solver_states.hpp>
#include <continuo/bodies/rigid_stepping/island_groups.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contacts.hpp>
#include <continuo/bodies/support/large_array.hpp>
#include <continuo/bodies/support/prefetch.hpp>
#include <continuo/bodies/support/thread_team.hpp>

namespace continuo {

template <class Real, int Dim>
class ManifoldSolver {
 public:
  using V = Vector<Real, Dim>;
  using At = ManifoldLayout<Dim>;
  using Bodies = std::span<RigidBody<Real, Dim>>;

  explicit ManifoldSolver(ThreadTeam& team,
                          const ManifoldKernels<Real, Dim>& kernels = manifold_kernels<Real, Dim>().back())
      : team_(team), kernels_(kernels) {}

  /// Takes the bodies, and the contacts with numbers `which`, at the beginning of a step; `heads` are those of all, and
  /// `are_same` tells that these, the numbers, what moves and the groups are those of the last step. Contacts of groups
  /// of islands wait for `advance_groups`.
  void begin(Bodies bodies, std::span<const PartContact<Real, Dim>> contacts, std::span<const ContactHead> heads,
             std::span<const std::uint32_t> which, const IslandGroups& groups = {}, bool are_same = false) {
    take_bodies(bodies, groups.size());
    if (!are_same) colour(heads, which, groups);
    heads_.assign(lanes_.batches(), {});
    least_separation_.assign(lanes_.batches(), std::numeric_limits<Real>::infinity());
    task_ = {
        .bodies = states_.data(), .values = value(0, 0, 0), .heads = heads_.data(), .a = a_.data(), .b = b_.data()};
    const BatchRun all = lanes_.batches(0);
    team_.for_each(all.first, all.last, 4,
                   [&](std::size_t from, std::size_t to) { fill({from, to}, contacts, which); });
  }
  /// How contacts are held apart in the substeps of the step, and how those with bodies that never move.
  void set_hardness(const Real& h, const Softness<Real>& soft, const Softness<Real>& soft_at_fixed,
                    const Real& fastest_push) {
    task_.h = h;
    task_.soft = soft, task_.soft_at_fixed = soft_at_fixed;
    task_.fastest_push = fastest_push;
  }
  /// From which overlap on points are deep.
  void set_deep(const Real& overlap) {
    task_.deep = overlap;
    is_deep_ = mark_deep(lanes_.batches(0));
  }
  /// Whether there are any, apart from groups.
  [[nodiscard]] bool is_deep() const { return is_deep_; }
  /// A kernel may take several batches at once, but not of the shared colour.
  void sweep(ManifoldPass pass) {
    for (const BatchRun& run : lanes_.runs(0))
      if (run.is_shared) {
        apply(pass, run);
      } else {
        team_.for_each(run.first, run.last, 4, [&](std::size_t from, std::size_t to) { apply(pass, {from, to}); });
      }
  }
  /// Likewise for the contacts of groups.
  void sweep_groups(ManifoldPass pass) {
    for_each_group([&](std::size_t group) {
      for (const BatchRun& run : lanes_.runs(group)) apply(pass, run);
    });
  }
  /// Takes bodies that move with their spins and velocities, in `move`, and those of groups.
  void set_movers(std::span<const std::uint32_t> bodies, const IslandGroups& groups = {}) {
    movers_.clear(), first_mover_.assign(1, 0);
    for (std::size_t group = 0; group < groups.size(); ++group) {
      const auto of_group = group == 0 ? bodies : groups.bodies(group);
      movers_.insert(movers_.end(), of_group.begin(), of_group.end());
      // Fills the last batch. Each group has its own, as they are moved by several threads at once.
      const auto spare = static_cast<std::uint32_t>(moves_.size() + 1 + group);
      movers_.resize((movers_.size() + kernels_.lanes - 1) / kernels_.lanes * kernels_.lanes, spare);
      first_mover_.push_back(movers_.size() / kernels_.lanes);
    }
  }
  /// Moves these bodies for h, apart from groups.
  void move(const Real& h) {
    const MotionTask<Real, Dim> task = motion(h);
    team_.for_each(0, first_mover_[1], std::max<std::size_t>(256 / kernels_.lanes, 1),
                   [&](std::size_t from, std::size_t to) { kernels_.move(task, from, to); });
  }
  /// Moves the bodies of groups through so many substeps, each group by one thread, so that it stays in the cache: with
  /// constant accelerations of the bodies, soft contacts, and further sweeps of what is deep. Gives back the impulses
  /// of the last substep, and the greatest ones.
  void advance_groups(std::span<PartContact<Real, Dim>> contacts, std::span<const std::uint32_t> which,
                      const IslandGroups& groups, std::span<const V> acceleration, int substeps, int sweeps_of_deep) {
    for_each_group([&](std::size_t group) {
      const BatchRun all = lanes_.batches(group);
      fill(all, contacts, which);
      const bool has_deep = mark_deep(all);
      const MotionTask<Real, Dim> task = motion(task_.h);
      const auto solve = [&](ManifoldPass pass) {
        for (const BatchRun& run : lanes_.runs(group)) apply(pass, run);
      };
      for (int k = 0; k < substeps; ++k) {
        for (const std::uint32_t i : groups.bodies(group)) states_[i].set_v(states_[i].v() + acceleration[i] * task_.h);
        solve(ManifoldPass::begin);
        solve(ManifoldPass::push);
        kernels_.move(task, first_mover_[group], first_mover_[group + 1]);
        solve(ManifoldPass::relax);
        for (int n = 0; has_deep && n < sweeps_of_deep; ++n) solve(ManifoldPass::relax_deep);
      }
      store_impulses(all, contacts, which);
    });
  }
  [[nodiscard]] SolverState<Real, Dim>& state(std::size_t body) { return states_[body]; }
  [[nodiscard]] SolverState<Real, Dim>* states() { return states_.data(); }
  /// The angle in the plane by which a body has turned since the step began.
  [[nodiscard]] Real& angle(std::size_t body) { return angles_[body]; }
  [[nodiscard]] std::size_t colours() const { return colours_.size(); }

  /// Gives back the impulses of the last substep, and the greatest ones, apart from groups.
  void store_impulses(std::span<PartContact<Real, Dim>> contacts, std::span<const std::uint32_t> which) {
    const BatchRun all = lanes_.batches(0);
    team_.for_each(all.first, all.last, 8,
                   [&](std::size_t from, std::size_t to) { store_impulses({from, to}, contacts, which); });
  }
  /// Prepares passes that give contacts the normal velocities speed_of(contact, point), in islands with impacts: others
  /// are left alone.
  template <class IsMeant, class SpeedOf>
  void prepare_rebound(std::span<const PartContact<Real, Dim>> contacts, std::span<const std::uint32_t> which,
                       IsMeant&& is_meant, SpeedOf&& speed_of) {
    for (BatchHead& head : heads_) head.is_meant = false;
    for_each_lane({0, heads_.size()}, which, [&](std::size_t batch, std::size_t lane, std::uint32_t k) {
      const auto& contact = contacts[k].contact;
      const bool acts = is_meant(contacts[k]);
      heads_[batch].is_meant |= acts;
      for (std::size_t p = 0; p < contact.size; ++p) {
        const Real speed = speed_of(contact, contact.points[p]);
        for (std::size_t i = 0; i < Dim; ++i) *value(batch, lane, row(p, At::impulse + i)) = Real(0);
        *value(batch, lane, row(p, At::separation)) = speed;
        if (!acts || (speed == Real(0) && contact.points[p].impulse == Real(0)))
          for (std::size_t i = 0; i < Dim; ++i) *value(batch, lane, row(p, At::mass + i)) = Real(0);
      }
    });
  }
  [[nodiscard]] std::size_t memory() const {
    return values_.capacity() * sizeof(Line) + states_.capacity() * sizeof(states_[0]) +
           (a_.capacity() + b_.capacity()) * sizeof(a_[0]) + heads_.capacity() * sizeof(heads_[0]);
  }

 private:
  using LaneInertia = std::array<Real, At::of_inertia>;
  /// Numbers that begin where a register may be loaded.
  struct alignas(64) Line {
    std::array<Real, 64 / sizeof(Real)> numbers;
  };
  [[nodiscard]] static constexpr std::size_t row(std::size_t point, std::size_t of_point) {
    return At::points + point * At::of_point + of_point;
  }
  [[nodiscard]] Real* value(std::size_t batch, std::size_t lane, std::size_t row_number) {
    return values_.data()->numbers.data() + (batch * At::rows + row_number) * kernels_.lanes + lane;
  }

  void colour(std::span<const ContactHead> heads, std::span<const std::uint32_t> which, const IslandGroups& groups) {
    coloured_.resize(which.size()), group_of_.resize(which.size());
    const auto mover = [&](std::uint32_t i) { return moves_[i] != 0 ? i : ColouredContact::none; };
    for (std::size_t k = 0; k < which.size(); ++k) {
      const ContactHead& head = heads[which[k]];
      coloured_[k] = {mover(head.a), mover(head.b), head.points};
      group_of_[k] = groups.of(moves_[head.a] != 0 ? head.a : head.b);
    }
    const std::size_t lanes = kernels_.lanes;
    const bool have_other_colours = colours_.find(coloured_, moves_.size());
    if (have_other_colours || group_of_ != group_of_before_) lanes_.find(colours_, lanes, group_of_, groups.size());
    group_of_before_ = group_of_;
    groups_ = groups.size();
    const std::size_t batches = lanes_.batches();
    const auto spare = static_cast<std::uint32_t>(moves_.size());  // a body that never moves
    a_.assign(batches * lanes, spare), b_.assign(batches * lanes, spare);
    values_.resize((batches * lanes * At::rows * sizeof(Real) + sizeof(Line) - 1) / sizeof(Line) + 1);
  }
  /// Behind them, one that never moves for lanes without a contact, and for each group one for lanes without a mover.
  void take_bodies(Bodies bodies, std::size_t groups) {
    const std::size_t size = bodies.size() + 1 + groups;
    states_.resize(size), inertias_.resize(bodies.size()), moves_.resize(bodies.size());
    angles_.assign(Dim == 2 ? size : 0, Real(0));
    std::fill(states_.begin() + static_cast<std::ptrdiff_t>(bodies.size()), states_.end(), SolverState<Real, Dim>{});
    team_.for_each(0, bodies.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        SolverState<Real, Dim> state;
        state.set_v(bodies[i].v), state.set_spin(bodies[i].spin);
        state.set_inverse_mass(bodies[i].inverse_mass);
        if constexpr (Dim == 3) state.set_turn({{1, 0, 0, 0}});
        states_[i] = state;
        moves_[i] = bodies[i].is_fixed() ? 0 : 1;
        inertias_[i] = lane_numbers(bodies[i].inverse_inertia_now);
      }
    });
  }
  /// The contacts of a batch are anywhere in a list that may be larger than the caches.
  void prefetch_contacts(std::size_t batch, std::span<const PartContact<Real, Dim>> contacts,
                         std::span<const std::uint32_t> which) const {
    for (std::size_t k = batch * kernels_.lanes; k < std::min((batch + 1) * kernels_.lanes, lanes_.members().size());
         ++k) {
      if (lanes_.members()[k] == LanesOfColours::none) continue;
      const auto* const bytes = reinterpret_cast<const char*>(&contacts[which[lanes_.members()[k]]]);
      for (std::size_t line = 0; line < sizeof(PartContact<Real, Dim>); line += 64) prefetch(bytes + line);
    }
  }
  /// Takes the contacts of batches, and what is the same in all substeps.
  void fill(const BatchRun& run, std::span<const PartContact<Real, Dim>> contacts,
            std::span<const std::uint32_t> which) {
    for (std::size_t batch = run.first; batch < run.last; ++batch) {
      prefetch_contacts(batch + 1, contacts, which);
      fill(batch, contacts, which);
    }
    kernels_.apply(task_, ManifoldPass::prepare, run.first, run.last);  // which changes no body
  }
  void fill(std::size_t batch, std::span<const PartContact<Real, Dim>> contacts, std::span<const std::uint32_t> which) {
    std::fill_n(value(batch, 0, 0), At::rows * kernels_.lanes, Real(0));
    BatchHead& head = heads_[batch];
    for (std::size_t lane = 0; lane < kernels_.lanes; ++lane) {
      const std::uint32_t member = lanes_.members()[batch * kernels_.lanes + lane];
      if (member == LanesOfColours::none) {
        head.is_a_fixed = head.is_b_fixed = true;
        continue;
      }
      const PartContact<Real, Dim>& found = contacts[which[member]];
      head.points = std::max(head.points, static_cast<std::uint8_t>(found.contact.size));
      head.is_a_fixed |= coloured_[member].a == ColouredContact::none;
      head.is_b_fixed |= coloured_[member].b == ColouredContact::none;
      a_[batch * kernels_.lanes + lane] = found.a, b_[batch * kernels_.lanes + lane] = found.b;
      head.is_round |= found.contact.rounding_a + found.contact.rounding_b > Real(0);
      fill_lane(batch, lane, found.contact, inertias_[found.a], inertias_[found.b]);
    }
  }
  void fill_lane(std::size_t batch, std::size_t lane, const RigidContact<Real, Dim>& contact,
                 const LaneInertia& inertia_a, const LaneInertia& inertia_b) {
    const std::size_t lanes = kernels_.lanes;
    Real* const rows = value(batch, lane, 0);
    const auto put = [&](std::size_t at, const auto& vector) {
      for (std::size_t i = 0; i < vector.size(); ++i) rows[(at + i) * lanes] = vector[i];
    };
    const HeldFrame frame(contact);
    const auto across = directions_across(frame.normal);
    put(At::normal, frame.normal);
    if constexpr (Dim == 3) put(At::across, across[0]);
    rows[At::friction * lanes] = contact.friction;
    put(At::inertia_a, inertia_a), put(At::inertia_b, inertia_b);
    rows[At::rounding_a * lanes] = contact.rounding_a, rows[At::rounding_b * lanes] = contact.rounding_b;
    for (std::size_t p = 0; p < contact.size; ++p) {
      const auto& point = contact.points[p];
      const V arm_a = frame.arm_a(point);
      put(row(p, At::arm_a), arm_a), put(row(p, At::arm_b), arm_a + frame.from_b_to_a);
      rows[row(p, At::separation) * lanes] = point.separation;
      least_separation_[batch] = std::min(least_separation_[batch], point.separation);
      rows[row(p, At::mass) * lanes] = Real(1);  // the point exists
      rows[row(p, At::impulse) * lanes] = point.impulse;
      for (std::size_t i = 0; i < across.size(); ++i)
        rows[row(p, At::impulse_across + i) * lanes] = dot(point.friction, across[i]);
    }
  }
  void store_impulses(const BatchRun& run, std::span<PartContact<Real, Dim>> contacts,
                      std::span<const std::uint32_t> which) {
    for_each_lane(run, which, [&](std::size_t batch, std::size_t lane, std::uint32_t k) {
      if (lane == 0) prefetch_contacts(batch + 1, contacts, which);
      auto& contact = contacts[k].contact;
      const auto across = directions_across(HeldFrame(contact).normal);
      for (std::size_t p = 0; p < contact.size; ++p) {
        auto& point = contact.points[p];
        point.impulse = *value(batch, lane, row(p, At::impulse));
        point.greatest_impulse = *value(batch, lane, row(p, At::greatest_impulse));
        point.friction = {};
        for (std::size_t i = 0; i < across.size(); ++i)
          point.friction += across[i] * *value(batch, lane, row(p, At::impulse_across + i));
      }
    });
  }
  /// Returns whether some of the batches have deep points.
  bool mark_deep(const BatchRun& run) {
    bool has_deep = false;
    for (std::size_t batch = run.first; batch < run.last; ++batch)
      has_deep |= heads_[batch].is_deep = least_separation_[batch] < -task_.deep;
    return has_deep;
  }
  void apply(ManifoldPass pass, const BatchRun& run) {
    if (!run.is_shared) return kernels_.apply(task_, pass, run.first, run.last);
    for (std::size_t batch = run.first; batch < run.last; ++batch) kernels_.apply(task_, pass, batch, batch + 1);
  }
  [[nodiscard]] MotionTask<Real, Dim> motion(const Real& h) {
    return {states_.data(), angles_.data(), movers_.data(), h};
  }
  template <class Act>
  void for_each_group(Act&& act) {
    team_.for_each(1, groups_, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t group = from; group < to; ++group) act(group);
    });
  }
  template <class Act>
  void for_each_lane(const BatchRun& run, std::span<const std::uint32_t> which, Act&& act) {
    for (std::size_t batch = run.first; batch < run.last; ++batch)
      for (std::size_t lane = 0; lane < kernels_.lanes; ++lane)
        if (const std::uint32_t member = lanes_.members()[batch * kernels_.lanes + lane];
            member != LanesOfColours::none)
          act(batch, lane, which[member]);
  }

  ThreadTeam& team_;
  ManifoldKernels<Real, Dim> kernels_;
  ManifoldTask<Real, Dim> task_;
  SolverStates<Real, Dim> states_;  // of all bodies, and spare ones
  std::vector<Real> angles_;
  std::vector<ColouredContact> coloured_;
  ContactColours colours_;
  LanesOfColours lanes_;
  LargeArray<Line> values_;  // see manifold_layout.hpp
  std::vector<BatchHead> heads_;
  std::vector<Real> least_separation_;                     // of the points of each batch when the step began
  bool is_deep_ = false;                                   // whether one of them is
  std::vector<LaneInertia> inertias_;                      // the inverse, of all bodies
  std::vector<std::uint8_t> moves_;                        // whether each of the bodies does
  std::vector<std::uint32_t> movers_;                      // see set_movers; whole batches
  std::vector<std::size_t> first_mover_{0, 0};             // the first batch of them of each group
  std::vector<std::uint32_t> group_of_, group_of_before_;  // each contact
  std::size_t groups_ = 1;
  std::vector<std::uint32_t> a_, b_;  // bodies of each lane
};

}  // namespace continuo
