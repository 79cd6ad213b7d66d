// Solves the contacts of large islands by sweeps, as many manifolds at once as the registers of the machine have lanes,
// colour by colour, each colour by all threads. The results do not depend on the width of registers, nor on threads.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/manifold_kernels/contact_colours.hpp>
#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>
#include <continuo/bodies/manifold_kernels/solver_states.hpp>
#include <continuo/bodies/rigid_stepping/heavy_bodies.hpp>
#include <continuo/bodies/rigid_stepping/island_groups.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contacts.hpp>
#include <continuo/bodies/support/large_array.hpp>
#include <continuo/bodies/support/prefetch.hpp>
#include <continuo/bodies/support/thread_team.hpp>

namespace continuo {

/// The contacts of a step that are swept.
template <class Real, int Dim>
struct SweptContacts {
  std::span<PartContact<Real, Dim>> all{};
  std::span<const ContactHead> heads{};                                           // of all
  std::span<const typename RigidContacts<Real, Dim>::Separations> separations{};  // of all, where heads are as before
  std::span<const std::uint32_t> which{};                                         // of all are swept
};

template <class Real, int Dim>
class ManifoldSolver {
 public:
  using V = Vector<Real, Dim>;
  using At = ManifoldLayout<Dim>;
  using Bodies = std::span<RigidBody<Real, Dim>>;
  using Contacts = std::span<PartContact<Real, Dim>>;

  explicit ManifoldSolver(ThreadTeam& team,
                          const ManifoldKernels<Real, Dim>& kernels = manifold_kernels<Real, Dim>().back())
      : team_(team), kernels_(kernels) {}

  /// Takes the bodies, and the contacts with numbers `which`, at the beginning of a step; `heads` and `separations` are
  /// those of all, and `are_same` tells that the heads, the numbers, what moves and the groups are those of the last
  /// step. Contacts of groups of islands wait for `advance_groups`.
  void begin(Bodies bodies, const SweptContacts<Real, Dim>& contacts, const IslandGroups& groups = {},
             bool are_same = false) {
    are_new_ = !are_same || held_in_.size() != contacts.all.size();
    if (are_new_) {
      take_all_impulses(contacts.all);
      colour(bodies, contacts, groups);
    }
    take_bodies(bodies);
    task_ = {
        .bodies = states_.data(), .values = value(0, 0, 0), .heads = heads_.data(), .a = a_.data(), .b = b_.data()};
    const BatchRun all = lanes_.batches(0);
    team_.for_each(all.first, all.last, 4, [&](std::size_t from, std::size_t to) { fill({from, to}, contacts); });
  }
  /// How contacts are held apart in the substeps of the step, and how those with bodies that never move.
  void set_hardness(const Real& h, const Softness<Real>& soft, const Softness<Real>& soft_at_fixed,
                    const Real& fastest_push) {
    task_.h = h;
    task_.soft = soft, task_.soft_at_fixed = soft_at_fixed;
    task_.fastest_push = fastest_push;
  }
  /// From which overlap on points are deep, and from which on they are pressed.
  void set_deep(const Real& overlap, const Real& pressed) {
    task_.deep = overlap, task_.pressed = pressed;
    deep_runs_.clear(), pressed_runs_.clear();
    for (const BatchRun& run : lanes_.runs(0)) {
      const MarkedRuns marked = mark(run);
      if (marked.deep.first < marked.deep.last) deep_runs_.push_back(marked.deep);
      if (marked.pressed.first < marked.pressed.last) pressed_runs_.push_back(marked.pressed);
    }
  }
  /// Whether there are any, apart from groups.
  [[nodiscard]] bool is_deep() const { return !deep_runs_.empty(); }
  /// Whether there are any, likewise.
  [[nodiscard]] bool is_pressed() const { return !pressed_runs_.empty(); }
  void sweep(ManifoldPass pass) {
    heavy_.spread(states_.data(), copies());
    for (const BatchRun& run : runs_of(pass))
      if (run.is_shared) {
        apply(pass, run);
      } else {
        team_.for_each(run.first, run.last, contacts_of_thread / kernels_.lanes,
                       [&](std::size_t from, std::size_t to) { apply(pass, {from, to}); });
      }
    heavy_.gather(states_.data(), copies());
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
      const auto spare = static_cast<std::uint32_t>(inertias_.size() + 1 + group);
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
  /// constant accelerations of the bodies, soft contacts, and further sweeps of what is deep.
  void advance_groups(const SweptContacts<Real, Dim>& contacts, const IslandGroups& groups,
                      std::span<const V> acceleration, int substeps, int sweeps_of_deep) {
    for_each_group([&](std::size_t group) {
      const BatchRun all = lanes_.batches(group);
      fill(all, contacts);
      const MarkedRuns marked = mark(all);
      const MotionTask<Real, Dim> task = motion(task_.h);
      const auto solve = [&](ManifoldPass pass) {
        for (const BatchRun& run : lanes_.runs(group)) apply(pass, run);
      };
      for (int k = 0; k < substeps; ++k) {
        for (const std::uint32_t i : groups.bodies(group)) states_[i].set_v(states_[i].v() + acceleration[i] * task_.h);
        solve(ManifoldPass::begin);
        solve(ManifoldPass::push);
        if (marked.pressed.first < marked.pressed.last) solve(ManifoldPass::push_pressed);
        kernels_.move(task, first_mover_[group], first_mover_[group + 1]);
        solve(ManifoldPass::relax);
        for (int n = 0; marked.deep.first < marked.deep.last && n < sweeps_of_deep; ++n)
          solve(ManifoldPass::relax_deep);
      }
    });
  }
  [[nodiscard]] SolverState<Real, Dim>& state(std::size_t body) { return states_[body]; }
  [[nodiscard]] SolverState<Real, Dim>* states() { return states_.data(); }
  /// The angle in the plane by which a body has turned since the step began.
  [[nodiscard]] Real& angle(std::size_t body) { return angles_[body]; }
  [[nodiscard]] std::size_t colours() const { return colours_.size(); }

  /// The impulses of the last substep, and the greatest ones, stay in the lanes, and so do the contacts as long as
  /// nothing of them changes but their separations. Gives them to all contacts as well.
  void store_impulses(Contacts contacts) {
    for_each_contact(contacts, [this](std::size_t k, auto& contact) {
      if (held_in_[k] != HeldIn::lane) return;
      store(k, contact);
      held_in_[k] = HeldIn::both;
    });
  }
  /// Gives them to a contact that is about to change, of the list of the last step.
  void take_impulses(std::size_t k, RigidContact<Real, Dim>& contact) {
    if (k >= held_in_.size()) return;
    if (held_in_[k] == HeldIn::lane) store(k, contact);
    held_in_[k] = HeldIn::contact;
  }
  /// Gives them to all contacts, whose list is about to change.
  void take_all_impulses(Contacts contacts) {
    for_each_contact(contacts, [this](std::size_t k, auto& contact) { take_impulses(k, contact); });
    held_in_.clear();
  }
  /// The contacts have got other impulses.
  void forget_impulses() { std::ranges::fill(held_in_, HeldIn::contact); }

  /// Prepares passes that give contacts the normal velocities speed_of(contact, point), in islands with impacts: others
  /// are left alone. The contacts have their impulses.
  template <class IsMeant, class SpeedOf>
  void prepare_rebound(const SweptContacts<Real, Dim>& contacts, IsMeant&& is_meant, SpeedOf&& speed_of) {
    for (BatchHead& head : heads_) head.is_meant = false;
    for (const std::uint32_t k : contacts.which) {
      const auto& contact = contacts.all[k].contact;
      const std::size_t batch = slot_[k] / kernels_.lanes, lane = slot_[k] % kernels_.lanes;
      const bool acts = is_meant(contacts.all[k]);
      heads_[batch].is_meant |= acts;
      for (std::size_t p = 0; p < contact.size; ++p) {
        const Real speed = speed_of(contact, contact.points[p]);
        for (std::size_t i = 0; i < Dim; ++i) *value(batch, lane, row(p, At::impulse + i)) = Real(0);
        *value(batch, lane, row(p, At::separation)) = speed;
        if (!acts || (speed == Real(0) && contact.points[p].impulse == Real(0)))
          for (std::size_t i = 0; i < Dim; ++i) *value(batch, lane, row(p, At::mass + i)) = Real(0);
      }
    }
    forget_impulses();
  }
  [[nodiscard]] std::size_t memory() const {
    return values_.capacity() * sizeof(Line) + states_.capacity() * sizeof(states_[0]) +
           (a_.capacity() + b_.capacity() + slot_.capacity()) * sizeof(a_[0]) + heads_.capacity() * sizeof(heads_[0]) +
           held_in_.capacity();
  }

 private:
  using LaneInertia = std::array<Real, At::of_inertia>;
  /// Where the impulses of a contact are. Its lane is filled anew where they are in the contact alone.
  enum class HeldIn : std::uint8_t { contact, lane, both };
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

  void colour(Bodies bodies, const SweptContacts<Real, Dim>& contacts, const IslandGroups& groups) {
    const std::size_t count = contacts.which.size(), lanes = kernels_.lanes;
    const auto head = [&](std::size_t k) -> const ContactHead& { return contacts.heads[contacts.which[k]]; };
    heavy_.find(std::span<const RigidBody<Real, Dim>>(bodies), count, head,
                [&](std::uint32_t i) { return groups.of(i) == 0; });
    coloured_.resize(count), group_of_.resize(groups.size() > 1 ? count : 0);
    const auto mover = [&](std::uint32_t i) {
      return bodies[i].is_fixed() || heavy_.is_heavy(i) ? ColouredContact::none : i;
    };
    for (std::size_t k = 0; k < count; ++k) coloured_[k] = {mover(head(k).a), mover(head(k).b), head(k).points};
    for (std::size_t k = 0; k < group_of_.size(); ++k)
      group_of_[k] = groups.of(bodies[head(k).a].is_fixed() ? head(k).b : head(k).a);
    const bool have_other_colours = colours_.find(coloured_, bodies.size());
    if (have_other_colours || group_of_ != group_of_before_) lanes_.find(colours_, lanes, group_of_, groups.size());
    group_of_before_ = group_of_;
    groups_ = groups.size();
    const std::size_t batches = lanes_.batches();
    const auto spare = static_cast<std::uint32_t>(bodies.size());  // a body that never moves
    a_.assign(batches * lanes, spare), b_.assign(batches * lanes, spare);
    values_.resize((batches * lanes * At::rows * sizeof(Real) + sizeof(Line) - 1) / sizeof(Line) + 1);
    heads_.resize(batches), least_separation_.resize(batches);
    held_in_.assign(contacts.all.size(), HeldIn::contact);
    slot_.resize(contacts.all.size());
    for (std::uint32_t slot = 0; slot < lanes_.members().size(); ++slot)
      if (const std::uint32_t member = lanes_.members()[slot]; member != LanesOfColours::none)
        slot_[contacts.which[member]] = slot;
  }
  /// Behind them, one that never moves for lanes without a contact, for each group one for lanes without a mover, and
  /// the copies of heavy bodies.
  void take_bodies(Bodies bodies) {
    first_copy_ = bodies.size() + 1 + groups_;
    const std::size_t size = first_copy_ + heavy_.copied().size();
    states_.resize(size), has_other_mass_.resize(size), inertias_.resize(bodies.size());
    angles_.assign(Dim == 2 ? size : 0, Real(0));
    std::fill(states_.begin() + static_cast<std::ptrdiff_t>(bodies.size()), states_.end(), SolverState<Real, Dim>{});
    team_.for_each(0, bodies.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        SolverState<Real, Dim> state;
        state.set_v(bodies[i].v), state.set_spin(bodies[i].spin);
        state.set_inverse_mass(bodies[i].inverse_mass);
        if constexpr (Dim == 3) state.set_turn({{1, 0, 0, 0}});
        const LaneInertia inertia = lane_numbers(bodies[i].inverse_inertia_now);
        has_other_mass_[i] = inertia != inertias_[i] || states_[i].inverse_mass() != bodies[i].inverse_mass ? 1 : 0;
        states_[i] = state, inertias_[i] = inertia;
      }
    });
    for (std::size_t n = 0; n < heavy_.copied().size(); ++n)
      has_other_mass_[first_copy_ + n] = has_other_mass_[heavy_.copied()[n]];
  }
  [[nodiscard]] SolverState<Real, Dim>* copies() { return states_.data() + first_copy_; }
  /// The contacts of a batch are anywhere in a list that may be larger than the caches.
  void prefetch_contacts(std::size_t batch, const SweptContacts<Real, Dim>& contacts) const {
    for_each_lane(batch, [&](std::size_t, std::uint32_t member) {
      const auto* const bytes = reinterpret_cast<const char*>(&contacts.all[contacts.which[member]]);
      for (std::size_t line = 0; line < sizeof(PartContact<Real, Dim>); line += 64) prefetch(bytes + line);
    });
  }
  /// Takes the contacts of batches, and what is the same in all substeps.
  void fill(const BatchRun& run, const SweptContacts<Real, Dim>& contacts) {
    bool is_kept = false, is_next_kept = run.first < run.last && stays(run.first, contacts);
    for (std::size_t batch = run.first; batch < run.last; ++batch) {
      is_kept = std::exchange(is_next_kept, batch + 1 == run.last || stays(batch + 1, contacts));
      if (!is_next_kept) prefetch_contacts(batch + 1, contacts);
      is_kept ? renew_separations(batch, contacts) : fill(batch, contacts);
    }
  }
  /// Whether nothing of a batch has changed since the last step but separations.
  [[nodiscard]] bool stays(std::size_t batch, const SweptContacts<Real, Dim>& contacts) const {
    if (are_new_) return false;
    bool does = true;
    for_each_lane(batch, [&](std::size_t lane, std::uint32_t member) {
      const std::size_t slot = batch * kernels_.lanes + lane;
      does &= held_in_[contacts.which[member]] != HeldIn::contact && has_other_mass_[a_[slot]] == 0 &&
              has_other_mass_[b_[slot]] == 0;
    });
    return does;
  }
  void renew_separations(std::size_t batch, const SweptContacts<Real, Dim>& contacts) {
    const std::size_t lanes = kernels_.lanes;
    heads_[batch].is_meant = true;
    Real least = std::numeric_limits<Real>::infinity();
    for_each_lane(batch, [&](std::size_t lane, std::uint32_t member) {
      const auto& separations = contacts.separations[contacts.which[member]];
      for (std::size_t p = 0; p < coloured_[member].points; ++p) {
        *value(batch, lane, row(p, At::separation)) = separations[p];
        least = std::min(least, separations[p]);
      }
      held_in_[contacts.which[member]] = HeldIn::lane;
    });
    least_separation_[batch] = least;
    for (std::size_t p = 0; p < At::most_points; ++p)
      std::fill_n(value(batch, 0, row(p, At::greatest_impulse)), lanes, Real(0));
  }
  void fill(std::size_t batch, const SweptContacts<Real, Dim>& contacts) {
    if (!are_new_)
      for_each_lane(batch, [&](std::size_t, std::uint32_t member) {
        take_impulses(contacts.which[member], contacts.all[contacts.which[member]].contact);
      });
    std::fill_n(value(batch, 0, 0), At::rows * kernels_.lanes, Real(0));
    least_separation_[batch] = std::numeric_limits<Real>::infinity();
    BatchHead& head = heads_[batch] = {};
    std::size_t filled = 0;
    for_each_lane(batch, [&](std::size_t lane, std::uint32_t member) {
      const PartContact<Real, Dim>& found = contacts.all[contacts.which[member]];
      head.points = std::max(head.points, static_cast<std::uint8_t>(found.contact.size));
      head.is_a_fixed |= coloured_[member].a == ColouredContact::none;
      head.is_b_fixed |= coloured_[member].b == ColouredContact::none;
      const std::uint32_t copy_of_a = heavy_.copy_of_a(member), copy_of_b = heavy_.copy_of_b(member);
      const auto first_copy = static_cast<std::uint32_t>(first_copy_);
      a_[batch * kernels_.lanes + lane] = copy_of_a == heavy_.none ? found.a : first_copy + copy_of_a;
      b_[batch * kernels_.lanes + lane] = copy_of_b == heavy_.none ? found.b : first_copy + copy_of_b;
      head.is_round |= found.contact.rounding_a + found.contact.rounding_b > Real(0);
      fill_lane(batch, lane, found.contact, inertias_[found.a], inertias_[found.b]);
      held_in_[contacts.which[member]] = HeldIn::lane;
      ++filled;
    });
    if (filled < kernels_.lanes) head.is_a_fixed = head.is_b_fixed = true;
    kernels_.apply(task_, ManifoldPass::prepare, batch, batch + 1);  // which changes no body
  }
  void fill_lane(std::size_t batch, std::size_t lane, const RigidContact<Real, Dim>& contact,
                 const LaneInertia& inertia_a, const LaneInertia& inertia_b) {
    const std::size_t lanes = kernels_.lanes;
    Real* const rows = value(batch, lane, 0);
    const auto put = [&](std::size_t at, const auto& vector) {
      for (std::size_t i = 0; i < vector.size(); ++i) rows[(at + i) * lanes] = vector[i];
    };
    const HeldFrame frame(contact);
    put(At::normal, frame.normal);
    if constexpr (Dim == 3) put(At::across, directions_across(frame.normal)[0]);
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
      for (std::size_t i = 0; i < point.friction.size(); ++i)
        rows[row(p, At::impulse_across + i) * lanes] = point.friction[i];
    }
  }
  void store(std::size_t k, RigidContact<Real, Dim>& contact) {
    const std::size_t batch = slot_[k] / kernels_.lanes, lane = slot_[k] % kernels_.lanes;
    for (std::size_t p = 0; p < contact.size; ++p) {
      auto& point = contact.points[p];
      point.impulse = *value(batch, lane, row(p, At::impulse));
      point.greatest_impulse = *value(batch, lane, row(p, At::greatest_impulse));
      for (std::size_t i = 0; i < point.friction.size(); ++i)
        point.friction[i] = *value(batch, lane, row(p, At::impulse_across + i));
    }
  }
  /// From the first to the last of the batches that have deep points, and pressed ones.
  struct MarkedRuns {
    BatchRun deep, pressed;
  };
  MarkedRuns mark(const BatchRun& run) {
    const BatchRun none{run.last, run.first, run.is_shared};
    MarkedRuns marked{none, none};
    const auto take = [](BatchRun& all, std::size_t batch) {
      all.first = std::min(all.first, batch), all.last = batch + 1;
    };
    for (std::size_t batch = run.first; batch < run.last; ++batch) {
      heads_[batch].is_deep = least_separation_[batch] < -task_.deep;
      heads_[batch].is_pressed = least_separation_[batch] < -task_.pressed;
      if (heads_[batch].is_deep) take(marked.deep, batch);
      if (heads_[batch].is_pressed) take(marked.pressed, batch);
    }
    return marked;
  }
  [[nodiscard]] std::span<const BatchRun> runs_of(ManifoldPass pass) const {
    if (pass == ManifoldPass::relax_deep) return deep_runs_;
    if (pass == ManifoldPass::push_pressed) return pressed_runs_;
    return lanes_.runs(0);
  }
  /// A kernel may take several batches at once, but not of the shared colour.
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
  /// act(lane, member) for the contacts `which[member]` of a batch.
  template <class Act>
  void for_each_lane(std::size_t batch, Act&& act) const {
    const auto members = lanes_.members().subspan(batch * kernels_.lanes, kernels_.lanes);
    for (std::size_t lane = 0; lane < members.size(); ++lane)
      if (members[lane] != LanesOfColours::none) act(lane, members[lane]);
  }
  /// act(k, contact) for those of the list of the last step.
  template <class Act>
  void for_each_contact(Contacts contacts, Act&& act) {
    team_.for_each(0, std::min(held_in_.size(), contacts.size()), 128, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) act(k, contacts[k].contact);
    });
  }

  /// A pass over fewer takes no longer than it takes for another thread to get their bodies.
  static constexpr std::size_t contacts_of_thread = Dim == 2 ? 512 : 256;

  ThreadTeam& team_;
  ManifoldKernels<Real, Dim> kernels_;
  ManifoldTask<Real, Dim> task_;
  SolverStates<Real, Dim> states_;  // of all bodies, and spare ones
  std::vector<Real> angles_;
  std::vector<ColouredContact> coloured_;
  HeavyBodies<Real, Dim> heavy_;
  std::size_t first_copy_ = 0;  // of them, among the states
  ContactColours colours_;
  LanesOfColours lanes_;
  LargeArray<Line> values_;  // see manifold_layout.hpp
  std::vector<BatchHead> heads_;
  std::vector<Real> least_separation_;              // of the points of each batch when the step began
  std::vector<BatchRun> deep_runs_, pressed_runs_;  // of each colour, from the first batch with such points to the last
  std::vector<LaneInertia> inertias_;               // the inverse, of all bodies
  std::vector<std::uint32_t> movers_;               // see set_movers; whole batches
  std::vector<std::size_t> first_mover_{0, 0};      // the first batch of them of each group
  std::vector<std::uint32_t> group_of_, group_of_before_;  // each contact
  std::size_t groups_ = 1;
  bool are_new_ = true;                       // all contacts: none is in its lane from the last step
  std::vector<std::uint32_t> a_, b_;          // bodies of each lane
  std::vector<HeldIn> held_in_;               // of each contact of the list, if any were swept
  std::vector<std::uint32_t> slot_;           // the lane of each of them that is swept: batch * lanes + lane
  std::vector<std::uint8_t> has_other_mass_;  // whether each body has another mass or inertia than in the last step
};

}  // namespace continuo
