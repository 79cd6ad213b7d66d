// A step of the fast motion in worlds with bodies of any shape, or with joints: the substeps of "temporal Gauss-Seidel"
// (M. Macklin et al., "Small steps in physics simulation", SCA 2019; E. Catto, "Solver2D", 2024), where thin islands
// are solved directly.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/manifold_kernels/chosen_kernels.hpp>
#include <continuo/bodies/rigid_stepping/collision_partners.hpp>
#include <continuo/bodies/rigid_stepping/continuous_collision.hpp>
#include <continuo/bodies/rigid_stepping/energy_bounds.hpp>
#include <continuo/bodies/rigid_stepping/island_solver.hpp>
#include <continuo/bodies/rigid_stepping/joint_rows.hpp>
#include <continuo/bodies/rigid_stepping/jointed_islands.hpp>
#include <continuo/bodies/rigid_stepping/manifold_solver.hpp>
#include <continuo/bodies/rigid_stepping/point_joint_solver.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contacts.hpp>
#include <continuo/bodies/rigid_stepping/rigid_sleep.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/time_stepping/fast_options_check.hpp>
#include <continuo/bodies/time_stepping/step_time.hpp>
#include <continuo/bodies/time_stepping/touch_log.hpp>

namespace continuo {

template <class Real, int Dim>
class RigidStepper {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;

  RigidStepper(World<Real, Dim>& world, const FastOptions<Real>& options)
      : log(options.contact_events),
        world_(world),
        options_(options),
        team_(options.threads),
        kernels_(chosen_kernels<Real, Dim>(options.registers)) {}

  void renew() {
    is_stale_ = true;
    contacts_.clear();
    manifolds_.forget_impulses();
    sleep_ = {};
  }
  /// Of the same step, substeps, integrator, threads, registers and records.
  void set_options(const FastOptions<Real>& options) { options_ = options; }
  [[nodiscard]] Status advance() {
    Status status;
    team_.run([&] { status = step(); });
    return status;
  }
  [[nodiscard]] Real deepest_overlap() const {
    Real deepest(0);
    for (const auto& found : contacts_.all())
      for (const auto& point : found.contact.all())
        deepest = std::max(deepest, -separation(found.contact, point, bodies_[found.a], bodies_[found.b]));
    return deepest;
  }
  [[nodiscard]] std::size_t memory() const {
    return bodies_.capacity() * sizeof(bodies_[0]) + pairs_.memory() + contacts_.memory() + manifolds_.memory() +
           points_.memory() + rows_.rows.capacity() * sizeof(rows_.rows[0]) +
           rows_.blocks.capacity() * sizeof(RowBlock);
  }

  /// The impulses of contacts and joints, and what sleeps.
  /// @{
  void save(ByteWriter& writer) const { const_cast<RigidStepper*>(this)->transfer(writer); }
  void load(ByteReader& reader) {
    manifolds_.take_all_impulses(contacts_.all());
    auto before = std::tuple(contacts_, joints_, touches_, sleep_);
    transfer(reader);
    reader.expect(sleep_.fits(world_.size()), "the sleep of other bodies");
    reader.expect_end();
    if (!reader.ok()) return void(std::tie(contacts_, joints_, touches_, sleep_) = std::move(before));
    begin();
    // Bodies are where the last step has left them: otherwise those that sleep would pass for moved, and wake.
    for (std::size_t i = 0; i < world_.size(); ++i)
      bodies_[i].x = world_.position[i], bodies_[i].orientation = world_.orientation[i];
  }
  /// @}

  FastStatistics statistics{};
  ContactLog<Real, Dim> log;

 private:
  /// The stages of a step.
  [[nodiscard]] Status step() {
    if (Status fault = check_world(); !fault) return fault;
    load();
    if (Status fault = find_contacts(); !fault) return fault;
    gather_blocks();
    find_islands();
    choose_solvers();
    gather_rows();
    begin_islands();
    begin_swept();
    find_jointed();
    const Real h = substep();
    if (has_groups()) advance_groups();
    for (int k = 0; k < options_.substeps; ++k) move_substep(world_.time + h * static_cast<Real>(k), h);
    if (has_restitution_ || log.is_kept()) manifolds_.store_impulses(contacts_.all());
    keep_point_joints();
    take_states();
    rebound();
    for_each_island([this](std::size_t k) { limit_swept(k); });
    if (!all_finite()) {
      is_stale_ = true;
      return {.ending = Ending::not_finite,
              .message = "a body's motion is no longer finite: a force or a mass is too large for the step"};
    }
    stop_fast_bodies();
    store();
    return {};
  }

  [[nodiscard]] Status check_world() const {
    if (Status fault = check(options_, world_); !fault) return fault;
    if (!kernels_) return kernels_.status();
    if (options_.integrator != ForceIntegrator::semi_implicit_euler)
      return invalid_input("bodies other than balls, joints and static meshes need semi-implicit Euler");
    for (const Material<Real>& material : world_.material)
      if (material.rolling_resistance > Real(0))
        return invalid_input("rolling resistance exists only in worlds of balls without joints and static meshes");
    for (const JointHandle handle : world_.joints()) {
      const Joint<Real, Dim>& joint = *world_.find(handle);
      if (!world_.contains(joint.b) || (joint.a != BodyHandle{} && !world_.contains(joint.a)))
        return invalid_input("a joint connects a body that the world does not contain");
    }
    return {};
  }

  [[nodiscard]] Softness<Real> softness_of_joints() const { return softness(1 / (4 * substep()), Real(2), substep()); }
  [[nodiscard]] Real hertz() const { return std::min(options_.hertz, 1 / (8 * substep())); }
  [[nodiscard]] Softness<Real> softness_of_contacts() const { return softness(hertz(), options_.damping, substep()); }
  /// What holds a heap bears all of it by few points, and does not give way: with twice the frequency, so a quarter of
  /// the overlap, as in Box2D v3.
  [[nodiscard]] Softness<Real> softness_of_contacts_at_fixed() const {
    return softness(2 * hertz(), options_.damping, substep());
  }
  [[nodiscard]] Real substep() const { return options_.step / static_cast<Real>(options_.substeps); }
  [[nodiscard]] bool moves(std::size_t body) const { return moves_[body] != 0; }
  [[nodiscard]] std::uint32_t number_of(BodyHandle handle) const {
    return handle == BodyHandle{} ? static_cast<std::uint32_t>(bodies_.size() - 1)
                                  : static_cast<std::uint32_t>(world_.index(handle));
  }

  [[nodiscard]] static std::size_t bodies_of(const World<Real, Dim>& world) {
    return world.size() + world.walls().size() + 1;
  }
  /// Whether the world still has the bodies, the walls and the shapes of the last step: else all wake.
  [[nodiscard]] bool is_of_world() const { return bodies_.size() == bodies_of(world_) && pairs_.is_of(world_); }
  void begin() {
    bodies_.assign(bodies_of(world_), {});
    moves_.assign(bodies_.size(), 0);
    pairs_.begin(world_);
    rules_.ignored = world_.ignored_groups();
    is_stale_ = false;
  }
  /// Takes the bodies of the world; after them, one that never moves for each wall, and one for the world itself. What
  /// sleeps is fixed for this step.
  void load() {
    const bool have_other_partners = !pairs_.has_meshes_of(world_) || rules_.ignored != world_.ignored_groups();
    const bool are_others = !is_of_world();
    if (!is_stale_ && (have_other_partners || are_others)) sleep_ = {};
    if (!is_stale_ && are_others) contacts_.find_anew();
    if (is_stale_ || are_others) begin();
    sleep_.wake_changed(world_, bodies_);
    load_bodies();
    joint_handles_ = world_.joints();
    joints_.resize(joint_handles_.size());
    for (std::size_t k = 0; k < joint_handles_.size(); ++k)
      if (joints_[k].handle != joint_handles_[k]) joints_[k] = {.handle = joint_handles_[k]};
    joined_before_.swap(joined_pairs_);
    joined_pairs_.clear();
    for (const JointHandle handle : joint_handles_) {
      const Joint<Real, Dim>& joint = *world_.find(handle);
      if (joint.collide || joint.is_broken || joint.a == BodyHandle{}) continue;
      const std::uint32_t a = number_of(joint.a), b = number_of(joint.b);
      joined_pairs_.emplace_back(std::min(a, b), std::max(a, b));
    }
    if (joined_pairs_ != joined_before_) {
      apart_ = joined_pairs_;
      std::ranges::sort(apart_);
    }
    take_rules();
  }
  /// Bodies that may collide from now on, as where a joint has been removed or a mask has changed, are no pair yet, and
  /// others, as where groups ignore each other from now on, should be none any more.
  void take_rules() {
    Rules now{.ignored = world_.ignored_groups(), .apart = apart_};
    now.are_fixed.reserve(world_.size());
    for (std::size_t i = 0; i < world_.size(); ++i) now.are_fixed.push_back(world_.is_fixed(i));
    if (world_.has_traits()) now.masks.reserve(world_.size());
    for (std::size_t i = 0; world_.has_traits() && i < world_.size(); ++i)
      now.masks.push_back({world_.traits(i).category, world_.traits(i).mask});
    if (world_.has_ignored_groups()) now.groups.reserve(world_.size());
    for (std::size_t i = 0; world_.has_ignored_groups() && i < world_.size(); ++i)
      now.groups.push_back(world_.group(i));
    if (now == rules_) return;
    pairs_.find_all(bodies_with_partners(world_));
    rules_ = std::move(now);
  }
  void load_bodies() {
    turns_far_.resize(world_.size());
    team_.for_each(0, world_.size(), 64, [this](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) load(i);
    });
  }
  void load(std::size_t i) {
    RigidBody<Real, Dim>& body = bodies_[i];
    body.x = body.x_before = world_.position[i], body.v = world_.velocity[i];
    body.orientation = body.orientation_before = world_.orientation[i], body.spin = world_.spin[i];
    body.moved = {}, body.stiffening = {}, body.lag = {};
    const bool is_still = world_.is_fixed(i) || sleep_.is_asleep(i);
    if (world_.is_fixed(i) && !world_.traits(i).is_driven) body.v = {}, body.spin = {};
    body.inverse_mass = is_still ? Real(0) : world_.inverse_mass[i];
    moves_[i] = body.is_fixed() ? 0 : 1;
    body.inertia = world_.inertia(i);
    body.is_ball = world_.solid(i) == nullptr || is_isotropic(body.inertia);
    body.inverse_inertia = is_still ? Inertia<Real, Dim>{} : inverse(body.inertia);
    body.update_axes();
    turns_far_[i] = !body.is_fixed() && squared(body.spin) > square(far_turn / options_.step) ? 1 : 0;
  }
  [[nodiscard]] static Real square(const Real& value) { return value * value; }

  [[nodiscard]] Status find_contacts() {
    const auto collide = [this](std::uint32_t i, std::uint32_t j) {
      return world_.collide(i, j) &&
             (apart_.empty() || !std::ranges::binary_search(apart_, std::pair(std::min(i, j), std::max(i, j))));
    };
    for (;;) {
      const bool are_others = pairs_.update(team_, world_, bodies_, options_.step, collide);
      statistics.lists += are_others ? 1 : 0;
      if (Status fault = pairs_.check_number(); !fault) {
        is_stale_ = true;
        return fault;
      }
      const auto is_active = [this](std::uint32_t a, std::uint32_t b) { return moves(a) || moves(b); };
      contacts_.find(team_, world_, pairs_, bodies_, options_.step, is_active, manifolds_);
      if (!sleep_.wake_touched(contacts_.all(), bodies_, world_.radius, options_.sleep_speed)) return {};
      load_bodies();
    }
  }
  /// The blocks of contacts, still without rows, and those of joints.
  void gather_blocks() {
    const bool all_push = !world_.has_traits() && !world_.may_push;
    const bool have_other_heads = contacts_.take_change_of_heads();
    are_same_contacts_ = !have_other_heads && all_push && moves_ == moves_before_;
    blocks_before_ = rows_.blocks.size();
    if (!are_same_contacts_) gather_contacts(all_push);
    // What may push is not known before each contact has been asked.
    if (all_push) {
      moves_before_ = moves_;
    } else {
      moves_before_.clear();
    }
    rows_.rows.clear();
    rows_.blocks.resize(active_.size());
    contact_rows_ = 0;
    find_acting_joints();
    gather_joints(Dim);
  }
  void gather_contacts(bool all_push) {
    const auto heads = contacts_.heads();
    rows_.blocks.resize(heads.size()), active_.resize(heads.size());
    has_restitution_ = false;
    std::size_t count = 0;
    for (std::uint32_t k = 0; k < heads.size(); ++k) {
      const ContactHead& head = heads[k];
      if (head.points == 0 || (!moves(head.a) && !moves(head.b)) || !(all_push || pushes(head, k))) continue;
      rows_.blocks[count] = {
          .a = head.a, .b = head.b, .rows = static_cast<std::uint16_t>(head.points * Dim), .points = head.points};
      active_[count++] = k;
      has_restitution_ |= head.has_restitution;
    }
    rows_.blocks.resize(count), active_.resize(count);
  }
  /// Where contacts and bodies that move are those of the last step, and there are no joints, so are the islands.
  void find_islands() {
    const std::size_t contacts = active_.size();
    are_same_islands_ = are_same_contacts_ && blocks_before_ == contacts && rows_.blocks.size() == contacts;
    if (!are_same_islands_) islands_.find(bodies_.size(), rows_.blocks, [this](std::uint32_t i) { return moves(i); });
  }
  /// Joints that are to act in this step.
  void find_acting_joints() {
    acting_joints_.clear();
    for (std::uint32_t k = 0; k < joints_.size(); ++k) {
      const Joint<Real, Dim>& joint = *world_.find(joints_[k].handle);
      const std::uint32_t a = number_of(joint.a), b = number_of(joint.b);
      if (!joint.is_broken && (moves(a) || moves(b)))
        acting_joints_.push_back({&joint, k, a, b, is_point_joint(joint)});
    }
  }
  /// Islands are solved directly where that is cheap: those that are as thin as a stack, and small ones, unless the
  /// world is crowded. In others contacts are swept, several at once, and joints one by one between them.
  void choose_solvers() {
    solvers_.resize(islands_.size());
    is_swept_before_.swap(is_swept_);
    const bool is_crowded = std::ssize(active_) > most_contacts_of_thick_islands;
    is_swept_.assign(islands_.size(), false);
    for_each_island([&](std::size_t k) {
      const auto blocks = islands_.blocks(k), joints = joints_of(k);
      const auto contacts = std::ssize(blocks) - std::ssize(joints);
      const bool has_joints = !joints.empty();
      const bool is_thin = 4 * blocks.size() <= 5 * islands_.bodies(k).size();
      const bool is_cheap = is_thin || (!is_crowded && blocks.size() <= most_blocks_of_small_islands);
      // That of a heap is too thick anyway: to find that out in each step takes as long as a sweep.
      const bool is_heap = contacts > most_contacts_of_thick_islands &&
                           4 * static_cast<std::size_t>(contacts) > 5 * islands_.bodies(k).size();
      if (is_cheap || (has_joints && !is_heap)) {
        const bool contacts_turn = std::ranges::any_of(blocks, [&](auto block) { return turns_far(block); });
        solvers_[k].begin(islands_, k, rows_, bodies_, contacts_turn);
      }
      const auto in_lanes =
          contacts + std::ranges::count_if(joints, [this](std::uint32_t block) { return may_be_in_lanes(block); });
      const bool is_large = static_cast<std::size_t>(in_lanes) > most_blocks_of_small_islands;
      if (has_joints ? is_large && (is_heap || !solvers_[k].is_direct()) : !is_cheap) is_swept_[k] = 1;
    });
    is_in_lanes_.assign(world_.size(), 0);
    for (std::size_t k = 0; k < islands_.size(); ++k)
      if (is_swept_[k])
        for (const std::uint32_t i : islands_.bodies(k)) is_in_lanes_[i] = 1;
    const auto acts = [this](const RowBlock& block) {
      return (block.a < world_.size() && is_in_lanes_[block.a] != 0) ||
             (block.b < world_.size() && is_in_lanes_[block.b] != 0);
    };
    are_same_in_lanes_ = are_same_islands_ && is_swept_ == is_swept_before_;
    if (!are_same_in_lanes_) {
      manifolds_.take_all_impulses(contacts_.all());
      swept_.resize(active_.size());
      std::size_t count = 0;
      for (std::uint32_t block = 0; block < active_.size(); ++block) {
        swept_[count] = active_[block];
        count += acts(rows_.blocks[block]) ? 1 : 0;
      }
      swept_.resize(count);
    }
    swept_joints_.clear();
    for (auto block = static_cast<std::uint32_t>(active_.size()); block < rows_.blocks.size(); ++block) {
      const bool is_point = may_be_in_lanes(block), is_acting = acts(rows_.blocks[block]);
      if (is_point) {
        acting_joints_[block - active_.size()].is_in_lanes = is_acting;
      } else if (is_acting)
        swept_joints_.push_back(block);
    }
    find_bodies_of_swept_joints();
  }
  /// Whether a block may be swept in lanes: that of a contact, or of a joint that keeps two points together.
  [[nodiscard]] bool may_be_in_lanes(std::uint32_t block) const {
    if (block < active_.size()) return true;
    return block < active_.size() + acting_joints_.size() && acting_joints_[block - active_.size()].is_in_lanes;
  }
  void find_bodies_of_swept_joints() {
    joined_.clear();
    for (const std::uint32_t block : swept_joints_)
      for (const std::uint32_t i : {rows_.blocks[block].a, rows_.blocks[block].b})
        if (i < world_.size() && is_in_lanes_[i] != 0) joined_.push_back(i);
    std::ranges::sort(joined_);
    const auto rest = std::ranges::unique(joined_);
    joined_.erase(rest.begin(), rest.end());
  }
  /// Rows of contacts that are not swept come first: they stay the same during a step, unless bodies turn far in it;
  /// those of joints follow the bodies.
  void gather_rows() {
    rows_.rows.clear();
    scalar_.clear();
    rows_.blocks.resize(active_.size());
    for (std::size_t k = 0; k < islands_.size(); ++k)
      if (!is_swept_[k])
        for (const std::uint32_t block : islands_.blocks(k))
          if (block < active_.size()) scalar_.push_back(block);
    std::ranges::sort(scalar_);
    for (const std::uint32_t k : scalar_) {
      const auto& found = contacts_.all()[active_[k]];
      rows_.blocks[k] = add_rows(found.contact, found.a, found.b, bodies_[found.a], bodies_[found.b], rows_.rows);
    }
    contact_rows_ = rows_.rows.size();
    turning_.clear();
    std::ranges::copy_if(scalar_, std::back_inserter(turning_), [this](std::uint32_t k) { return turns_far(k); });
    gather_joints();
  }
  /// Whether a body of a block turns far in the step, or two that move go far past each other.
  [[nodiscard]] bool turns_far(std::uint32_t block) const {
    const auto [a, b] = std::pair(rows_.blocks[block].a, rows_.blocks[block].b);
    const auto turns = [this](std::uint32_t i) { return i < turns_far_.size() && turns_far_[i] != 0; };
    if (turns(a) || turns(b)) return true;
    if (!moves(a) || !moves(b)) return false;
    const Real far = std::min(world_.radius[a], world_.radius[b]) * far_way / options_.step;
    return squared(bodies_[a].v - bodies_[b].v) > far * far;
  }
  [[nodiscard]] bool pushes(const ContactHead& head, std::uint32_t contact) const {
    if (head.b >= world_.size()) return !world_.has_traits() || !world_.traits(head.a).is_sensor;
    if (world_.has_traits() && (world_.traits(head.a).is_sensor || world_.traits(head.b).is_sensor)) return false;
    return !world_.may_push || world_.may_push(world_, head.a, head.b, contacts_.all()[contact].contact.normal);
  }
  /// Those in lanes have blocks without rows; before it is known whether they are, blocks for so many rows to come.
  void gather_joints(std::size_t rows_in_lanes = 0) {
    rows_.rows.resize(contact_rows_), rows_.blocks.resize(active_.size());
    joint_rows_.clear();
    if (joints_.empty() && !world_.has_traits()) return;
    for (const ActingJoint& acting : acting_joints_) bodies_[acting.a].stiffening = bodies_[acting.b].stiffening = {};
    const Real h = substep();
    const Softness<Real> soft = softness_of_joints();
    const JointHardness<Real> direct{.h = h, .rate = 1 / h, .softness = Real(0), .fastest_push = options_.fastest_push};
    const JointHardness<Real> swept{
        .h = h, .rate = soft.rate, .softness = soft.of_impulse / soft.of_mass, .fastest_push = options_.fastest_push};
    for (const ActingJoint& acting : acting_joints_) {
      const auto [joint, k, a, b, is_in_lanes] = acting;
      if (is_in_lanes) {
        rows_.blocks.push_back({.a = a, .b = b, .rows = static_cast<std::uint16_t>(rows_in_lanes)});
        continue;
      }
      add_rows(*joint, joints_[k].impulses, a, b, bodies_[a], bodies_[b], joints_[k].is_swept ? swept : direct, rows_,
               joint_rows_);
      // Impulses are forces times h.
      const V force = joints_[k].linear;
      add_stiffening(V(bodies_[a].axes * joint->anchor_a), V(-force), h, bodies_[a].stiffening);
      add_stiffening(V(bodies_[b].axes * joint->anchor_b), force, h, bodies_[b].stiffening);
    }
    for (std::uint32_t i = 0; world_.has_traits() && i < world_.size(); ++i)
      if (const Locked locked = world_.traits(i).locked; locked != Locked::none && moves(i)) add_locks(i, locked);
  }
  /// A row to the world for each direction in which a body is held.
  void add_locks(std::uint32_t i, Locked locked) {
    const auto world_body = static_cast<std::uint32_t>(bodies_.size() - 1);
    RowBlock block{.a = world_body, .b = i, .first = static_cast<std::uint32_t>(rows_.rows.size())};
    const auto add = [&](Locked bit, auto member, std::size_t axis) {
      if (!has(locked, bit)) return;
      ConstraintRow<Real, Dim>& row = rows_.rows.emplace_back();
      (row.*member)[axis] = Real(1);
      set_mass(row, bodies_[world_body], bodies_[i]);
    };
    using Row = ConstraintRow<Real, Dim>;
    add(Locked::x, &Row::direction, 0), add(Locked::y, &Row::direction, 1);
    if constexpr (Dim == 3) {
      add(Locked::z, &Row::direction, 2);
      add(Locked::turn_x, &Row::lever_b, 0), add(Locked::turn_y, &Row::lever_b, 1),
          add(Locked::turn_z, &Row::lever_b, 2);
    } else {
      add(Locked::turn_z, &Row::lever_b, 0);
    }
    block.rows = static_cast<std::uint16_t>(rows_.rows.size() - block.first);
    if (block.rows > 0) rows_.blocks.push_back(block);
  }
  void begin_islands() {
    is_alone_.assign(world_.size(), 1);
    for (std::size_t k = 0; k < islands_.size(); ++k)
      for (const std::uint32_t i : islands_.bodies(k)) is_alone_[i] = 0;
    hardness_.clear();
    const Real h = substep();
    const auto hardness = [&](const Softness<Real>& soft) {
      return ContactHardness<Real>{h, soft.rate, soft.of_impulse / soft.of_mass, options_.fastest_push};
    };
    statistics.hertz = static_cast<double>(hertz());
    hardness_.assign(rows_.blocks.size(), hardness(softness_of_contacts()));
    for (std::size_t k = 0; k < islands_.size(); ++k)
      for (const std::uint32_t block : is_swept_[k] ? joints_of(k) : islands_.blocks(k))
        if (block >= active_.size() + acting_joints_.size()) {
          continue;
        } else if (block >= active_.size()) {
          joints_[acting_joints_[block - active_.size()].number].is_swept = is_swept_[k] || !solvers_[k].is_direct();
        } else if (solvers_[k].is_direct()) {
          hardness_[block] = {h, Real(0.2) / h, Real(0), options_.fastest_push};
        } else if (!moves(rows_.blocks[block].a) || !moves(rows_.blocks[block].b))
          hardness_[block] = hardness(softness_of_contacts_at_fixed());
  }
  /// The blocks of an island, in increasing order, that are none of contacts.
  [[nodiscard]] std::span<const std::uint32_t> joints_of(std::size_t island) const {
    const auto blocks = islands_.blocks(island);
    return {std::ranges::lower_bound(blocks, static_cast<std::uint32_t>(active_.size())), blocks.end()};
  }
  void begin_swept() {
    in_lanes_.clear(), easy_.clear(), easy_alone_.clear();
    is_easy_.assign(world_.size(), 0);
    gather_point_joints();
    if (has_lanes()) begin_lanes();
    apart_from_lanes_.clear(), not_easy_.clear();
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      if (is_in_lanes_[i] == 0) apart_from_lanes_.push_back(i);
      if (is_easy_[i] == 0 && moves(i)) not_easy_.push_back(i);
    }
  }
  void begin_lanes() {
    const Real h = substep();
    const Softness<Real> soft = softness_of_contacts();
    find_easy_bodies();
    const bool are_same_groups = group_islands();
    manifolds_.begin(bodies_, swept_contacts(), groups_, are_same_in_lanes_ && are_same_groups);
    points_.begin(bodies_, manifolds_.states(), point_joints_);
    points_.set_hardness(h, softness_of_joints(), options_.fastest_push);
    manifolds_.set_hardness(h, soft, softness_of_contacts_at_fixed(), options_.fastest_push);
    // One sweep leaves bodies that are deep in each other a part of the speed at which they are pushed apart.
    const Real deep = options_.fastest_push / (8 * soft.rate);
    // One sweep tells each contact what those swept before it do: the lowest of a heap hear of its weight only from
    // step to step, walls of boxes lean, and their corners overlap. In the plane they do so less than elsewhere.
    manifolds_.set_deep(deep, Dim == 3 ? deep / 32 : std::numeric_limits<Real>::infinity());
    statistics.colours = manifolds_.colours();
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      if (groups_.of(i) != 0 || !(is_in_lanes_[i] != 0 || is_driven(i))) continue;
      is_easy_[i] != 0 ? easy_.push_back(i) : in_lanes_.push_back(i);
      if (is_easy_[i] != 0 && is_alone_[i] != 0) easy_alone_.push_back(i);
    }
    manifolds_.set_movers(easy_, groups_);
  }
  [[nodiscard]] SweptContacts<Real, Dim> swept_contacts() {
    return {contacts_.all(), contacts_.heads(), contacts_.separations(), swept_};
  }
  /// Bodies without contacts are in lanes as well.
  void find_easy_bodies() {
    const bool is_simple = only_gravity(world_) && world_.torque_laws.empty();
    for (std::size_t i = 0; i < world_.size(); ++i) {
      const RigidBody<Real, Dim>& body = bodies_[i];
      if (!body.is_fixed() && is_alone_[i] != 0) is_in_lanes_[i] = 1;
      is_easy_[i] = is_in_lanes_[i] != 0 && is_simple && body.is_ball && !is_damped(i) ? 1 : 0;
    }
  }
  /// Islands of which nothing is asked but gravity, contacts and motion go through all substeps together. Returns
  /// whether these are those of the last step.
  bool group_islands() {
    std::vector<std::uint8_t> drives(world_.size());
    for (std::uint32_t i = 0; i < world_.size(); ++i) drives[i] = is_driven(i) ? 1 : 0;
    const bool has_driven = std::ranges::find(drives, 1) != drives.end();
    const auto touches_driven = [&](std::uint32_t k) {
      const auto drives_body = [&](std::uint32_t i) { return i < drives.size() && drives[i] != 0; };
      return drives_body(rows_.blocks[k].a) || drives_body(rows_.blocks[k].b);
    };
    return groups_.find(islands_, world_.size(), [&](std::size_t k) {
      return is_swept_[k] && joints_of(k).empty() &&
             std::ranges::all_of(islands_.bodies(k), [this](std::uint32_t i) { return is_easy_[i] != 0; }) &&
             !(has_driven && std::ranges::any_of(islands_.blocks(k), touches_driven));
    });
  }
  [[nodiscard]] bool is_damped(std::size_t i) const {
    if (!world_.has_traits()) return false;
    const BodyTraits<Real> traits = world_.traits(i);
    return traits.damping > Real(0) || traits.spin_damping > Real(0);
  }
  [[nodiscard]] bool has_lanes() const { return !swept_.empty() || !point_joints_.empty(); }
  void gather_point_joints() {
    acting_points_.clear();
    for (std::uint32_t n = 0; n < acting_joints_.size(); ++n)
      if (acting_joints_[n].is_in_lanes) acting_points_.push_back(n);
    point_joints_.resize(acting_points_.size());
    for_each_point_joint([this](std::size_t n, const ActingJoint& acting) {
      point_joints_[n] = {.a = acting.a,
                          .b = acting.b,
                          .arm_a = bodies_[acting.a].axes * acting.joint->anchor_a,
                          .arm_b = bodies_[acting.b].axes * acting.joint->anchor_b,
                          .impulse = joints_[acting.number].linear};
    });
  }
  template <class Act>
  void for_each_point_joint(Act&& act) {
    team_.for_each(0, acting_points_.size(), 128, [&](std::size_t from, std::size_t to) {
      for (std::size_t n = from; n < to; ++n) act(n, acting_joints_[acting_points_[n]]);
    });
  }
  template <class Act>
  void for_each_island(Act&& act) {
    team_.for_each(0, islands_.size(), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) act(k);
    });
  }

  [[nodiscard]] bool has_groups() const { return has_lanes() && groups_.size() > 1; }
  void advance_groups() {
    find_accelerations(world_.time);
    manifolds_.advance_groups(swept_contacts(), groups_, acceleration_, options_.substeps, sweeps_of_deep_contacts);
  }
  void move_substep(const Real& now, const Real& h) {
    note_spin_energies();
    accelerate(now, h);
    for (const std::uint32_t i : joined_) take_state(i);
    if (are_joints_apart_) gather_joints();
    aim_contacts();
    note_free_velocities();
    for_each_island([this, h](std::size_t k) {
      if (is_jointed_[k] != 0) return move_jointed(k, h);
      if (!is_swept_[k]) solvers_[k].push(rows_, bodies_);
      limit_energy(k, RowPass::push);
    });
    for (const std::uint32_t i : apart_from_lanes_)
      if (is_in_jointed_[i] == 0) move(i, h);
    if (has_lanes()) push_swept(h);
    keep_joints();
    for (const std::uint32_t i : joined_) take_state(i);
    if (are_joints_apart_) gather_joints();  // velocities are to be along where the joints are now
    aim_contacts();
    for_each_island([this](std::size_t k) {
      if (is_jointed_[k] != 0) return;
      if (!is_swept_[k]) solvers_[k].relax(rows_, bodies_);
      limit_energy(k, RowPass::relax);
    });
    if (has_lanes()) relax_swept(ManifoldPass::relax);
    for (int k = 0; has_lanes() && manifolds_.is_deep() && k < sweeps_of_deep_contacts; ++k)
      relax_swept(ManifoldPass::relax_deep);
    note_greatest_impulses();
    keep_contacts();
    keep_joints();  // without what corrects positions: where that contradicts itself it would add up
  }
  /// Which islands move by their joints (jointed_islands.hpp): those that are solved directly, and that nothing drives
  /// or locks.
  void find_jointed() {
    is_jointed_.assign(islands_.size(), 0), is_in_jointed_.assign(world_.size(), 0);
    for (std::size_t k = 0; k < islands_.size(); ++k) {
      if (is_swept_[k] || !has_joints(k) || !solvers_[k].is_direct()) continue;
      const bool is_apart = std::ranges::any_of(islands_.blocks(k), [this](std::uint32_t block) {
        return is_driven(rows_.blocks[block].a) || is_driven(rows_.blocks[block].b) ||
               block >= active_.size() + acting_joints_.size();
      });
      const bool only_pulls = !is_apart && std::ranges::all_of(joints_of(k), [this](std::uint32_t block) {
        return acting_joints_[block - active_.size()].joint->kind == JointKind::pull;
      });
      if (is_apart || only_pulls) continue;
      is_jointed_[k] = 1;
      for (const std::uint32_t i : islands_.bodies(k)) is_in_jointed_[i] = 1;
    }
    are_joints_apart_ = false;
    for (std::size_t block = active_.size(); block < rows_.blocks.size(); ++block) {
      const auto is_in = [this](std::uint32_t i) { return i < world_.size() && is_in_jointed_[i] != 0; };
      if (rows_.blocks[block].rows > 0)
        are_joints_apart_ |= !is_in(rows_.blocks[block].a) && !is_in(rows_.blocks[block].b);
    }
  }
  void move_jointed(std::size_t k, const Real& h) {
    std::vector<JointOfIsland<Real, Dim>> joints;
    for (const std::uint32_t block : joints_of(k))
      if (block < active_.size() + acting_joints_.size())
        joints.push_back({acting_joints_[block - active_.size()].joint, block});
    JointedIsland<Real, Dim> island(islands_.bodies(k), islands_.blocks(k), std::move(joints), rows_, bodies_,
                                    solvers_[k], options_.fastest_push);
    const auto contacts = islands_.blocks(k).first(islands_.blocks(k).size() - joints_of(k).size());
    island.advance(
        h, acceleration_, free_, [&](const Real& part) { aim_contacts(contacts, h / part); },
        [&] { note_greatest_impulses(contacts); }, [&] { return given_energy(k); });
  }
  /// Whether the kinetic energy of an island may only fall by what its contacts do.
  [[nodiscard]] bool only_loses(std::size_t island) const {
    return std::ranges::all_of(islands_.blocks(island), [this](std::uint32_t k) {
      return k < active_.size() && !is_driven(rows_.blocks[k].a) && !is_driven(rows_.blocks[k].b);
    });
  }
  /// The energy with which bodies turn, before a substep: free turning does not change it.
  void note_spin_energies() {
    spin_energy_.resize(world_.size()), free_.resize(world_.size());
    for_each_in_scalar_islands([this](std::uint32_t i) { spin_energy_[i] = spin_energy(bodies_[i]); });
  }
  void note_free_velocities() {
    for_each_in_scalar_islands([this](std::uint32_t i) {
      free_[i] = {bodies_[i].v, bodies_[i].spin};
      if (!world_.torque_laws.empty()) spin_energy_[i] = std::max(spin_energy_[i], spin_energy(bodies_[i]));
    });
  }
  template <class Act>
  void for_each_in_scalar_islands(Act&& act) {
    for_each_island([&](std::size_t k) {
      if (is_swept_[k]) return;
      for (const std::uint32_t i : islands_.bodies(k)) act(i);
    });
  }
  [[nodiscard]] bool is_driven(std::uint32_t i) const {
    return bodies_[i].is_fixed() && (bodies_[i].v != V{} || bodies_[i].spin != S{});
  }
  [[nodiscard]] bool has_joints(std::size_t island) const { return !joints_of(island).empty(); }
  /// The energy that rows may have given to the bodies of an island: motors, springs and driven bodies do work.
  [[nodiscard]] Real given_energy(std::size_t island) const {
    Real given(0);
    for (const std::uint32_t k : islands_.blocks(island)) {
      const RowBlock& block = rows_.blocks[k];
      const bool is_by_driven = is_driven(block.a) || is_driven(block.b);
      if (block.points > 0 && !is_by_driven) continue;
      for (const auto& row : std::span(rows_.rows).subspan(block.first, block.rows)) {
        if (holds_rigidly(row) && !is_by_driven) continue;
        Real way(0);
        if (!bodies_[block.b].is_fixed())
          way += dot(row.direction, bodies_[block.b].v + free_[block.b].v) +
                 dot(row.lever_b, bodies_[block.b].spin + free_[block.b].spin);
        if (!bodies_[block.a].is_fixed())
          way -= dot(row.direction, bodies_[block.a].v + free_[block.a].v) +
                 dot(row.lever_a, bodies_[block.a].spin + free_[block.a].spin);
        given += std::max(row.impulse * way / 2, Real(0));
      }
    }
    return given;
  }
  /// Constraints give no energy beyond that with which they undo overlaps and that of motors, springs and driven
  /// bodies. Where joints turn with their bodies in a substep, what they hold changes the energy a little, to and fro.
  void limit_energy(std::size_t k, RowPass pass) {
    if (is_swept_[k]) return;
    EnergyOfChange<Real> energy;
    Real before(0), of_fast(0);
    const Real fast = Real(0.5) / options_.step, push = pass == RowPass::push ? 2 * options_.fastest_push : Real(0);
    const auto is_fast = [&](const RigidBody<Real, Dim>& body) { return squared(body.spin) > fast * fast; };
    for (const std::uint32_t i : islands_.bodies(k)) {
      energy.add(bodies_[i], free_[i]);
      before += 2 * spin_energy_[i] + (squared(free_[i].v) + push * push) / bodies_[i].inverse_mass;
    }
    const Real gain = has_joints(k) ? gain_of_turning_joints : 1 + 64 * std::numeric_limits<Real>::epsilon();
    if (!(energy.at(Real(1)) > before * gain)) return;
    before += 2 * given_energy(k);
    if (!(energy.at(Real(1)) > before * gain)) return;
    const Real part = energy.part_within(before);
    for (const std::uint32_t i : islands_.bodies(k)) {
      take_part(bodies_[i], free_[i], part);
      if (is_fast(bodies_[i])) of_fast += 2 * spin_energy(bodies_[i]);
    }
    for (const std::uint32_t block : islands_.blocks(k))
      for (auto& row : rows_.of(rows_.blocks[block])) row.impulse *= part;
    // What is left is due to how far the fast ones turned.
    const Real excess = energy.at(part) - before;
    if (!(excess > Real(0)) || !(of_fast > Real(0))) return;
    const Real factor = std::sqrt(std::max(1 - excess / of_fast, Real(0)));
    for (const std::uint32_t i : islands_.bodies(k))
      if (is_fast(bodies_[i])) bodies_[i].spin *= factor;
  }
  void move(std::size_t i, const Real& h) {
    RigidBody<Real, Dim>& body = bodies_[i];
    body.move(h);
    if (body.is_fixed()) {
      if (body.v != V{} || body.spin != S{}) body.update_axes();
      return;
    }
    if (is_alone_[i] != 0) body.x -= acceleration_[i] * (h * h / 2);  // its parabola, exactly
    turns_far_[i] != 0 ? body.update_axes() : void(body.axes = rotation(body.orientation));
  }
  /// Constraints push, and bodies move.
  void push_swept(const Real& h) {
    manifolds_.sweep(ManifoldPass::begin);
    points_.sweep(ManifoldPass::begin);
    for_each_swept_joint([this](const RowBlock& block, auto& a, auto& b) {
      for (const auto& row : rows_.of(block))
        if (row.impulse != Real(0)) row.apply(row.impulse, a, b);
    });
    sweep_joints(RowPass::push);
    points_.sweep(ManifoldPass::push);
    manifolds_.sweep(ManifoldPass::push);
    if (manifolds_.is_pressed()) manifolds_.sweep(ManifoldPass::push_pressed);
    team_.for_each(0, in_lanes_.size(), 128, [&](std::size_t from, std::size_t to) {
      for (const std::uint32_t i : std::span(in_lanes_).subspan(from, to - from)) move_state(i, bodies_[i].lag, h);
    });
    manifolds_.move(h);
    for (const std::uint32_t i : easy_alone_) follow_parabola(i, h);
  }
  void relax_swept(ManifoldPass pass) {
    sweep_joints(RowPass::relax);
    points_.sweep(pass);
    manifolds_.sweep(pass);
  }
  void sweep_joints(RowPass pass) {
    for_each_swept_joint(
        [&](const RowBlock& block, auto& a, auto& b) { sweep<Real, Dim>(rows_.of(block), block, pass, a, b); });
  }
  /// Joints of islands whose contacts are swept in lanes: act(block, a, b) changes the velocities of both bodies.
  template <class Act>
  void for_each_swept_joint(Act&& act) {
    for (const std::uint32_t k : swept_joints_) {
      const RowBlock& block = rows_.blocks[k];
      for (const std::uint32_t i : {block.a, block.b})
        bodies_[i].v = manifolds_.state(i).v(), bodies_[i].spin = manifolds_.state(i).spin();
      act(block, bodies_[block.a], bodies_[block.b]);
      for (const std::uint32_t i : {block.a, block.b})
        manifolds_.state(i).set_v(bodies_[i].v), manifolds_.state(i).set_spin(bodies_[i].spin);
    }
  }
  void move_state(std::uint32_t i, const S& lag, const Real& h) {
    auto& state = manifolds_.state(i);
    if constexpr (Dim == 2) {
      continuo::move(state, S(state.spin() + lag), h, manifolds_.angle(i));
    } else {
      continuo::move(state, S(state.spin() + lag), h);
    }
    if (i < is_alone_.size() && is_alone_[i] != 0 && !bodies_[i].is_fixed()) follow_parabola(i, h);
  }
  /// What is alone has moved at its velocity at the end of h; its parabola is known.
  void follow_parabola(std::uint32_t i, const Real& h) {
    manifolds_.state(i).set_moved(manifolds_.state(i).moved() - acceleration_[i] * (h * h / 2));
  }
  void take_states() {
    if (!has_lanes()) return;
    team_.for_each(0, world_.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i)
        if (is_in_lanes_[i] != 0) take_state(i);
    });
  }
  /// The state of a body in lanes after a substep or a step.
  void take_state(std::size_t i) {
    RigidBody<Real, Dim>& body = bodies_[i];
    const auto& state = manifolds_.state(i);
    body.v = state.v(), body.spin = state.spin();
    body.moved = state.moved(), body.x = body.x_before + body.moved;
    if constexpr (Dim == 2) {
      body.orientation[0] = body.orientation_before[0] + manifolds_.angle(i);
    } else {
      const Orientation<Real, Dim> turned = product(state.turn(), body.orientation_before);
      body.orientation = turned * (1 / length(turned));
    }
    body.axes = rotation(body.orientation);
  }
  [[nodiscard]] bool has_joint_rows() const { return rows_.blocks.size() > active_.size() + point_joints_.size(); }
  /// Without those by damping, which depend on the substep.
  void find_accelerations(const Real& now) {
    const std::size_t n = world_.size();
    acceleration_.resize(n);
    if (only_gravity(world_)) {
      for (std::size_t i = 0; i < n; ++i) acceleration_[i] = world_.gravity;
    } else {
      std::vector<V> x(n), v(n);
      for (std::size_t i = 0; i < n; ++i) x[i] = bodies_[i].x, v[i] = bodies_[i].v;
      forces<Real, Dim>(world_, now, x, v, acceleration_);
      for (std::size_t i = 0; i < n; ++i) acceleration_[i] *= world_.inverse_mass[i];
    }
    for (std::size_t i = 0; world_.has_traits() && i < n; ++i)
      acceleration_[i] += world_.gravity * (world_.traits(i).gravity_scale - 1);
  }
  void accelerate(const Real& now, const Real& h) {
    for (const std::uint32_t i : in_lanes_)
      if (!bodies_[i].is_fixed()) take_state(i);
    find_accelerations(now);
    std::vector<S> torque;
    if (!world_.torque_laws.empty()) torque = torques_now(now);
    for (const std::uint32_t i : not_easy_) {
      RigidBody<Real, Dim>& body = bodies_[i];
      body.v += acceleration_[i] * h;
      is_in_jointed_[i] == 0 ? turn_freely(body, h) : void(body.lag = {});
      if (!torque.empty()) body.spin += body.inverse_inertia_now * torque[i] * h;
      if (!world_.has_traits()) continue;
      const BodyTraits<Real> traits = world_.traits(i);
      body.v *= 1 / (1 + h * traits.damping);
      body.spin *= 1 / (1 + h * traits.spin_damping);
      if (traits.damping != Real(0)) is_alone_[i] = 0;
    }
    for (const std::uint32_t i : in_lanes_)
      manifolds_.state(i).set_v(bodies_[i].v), manifolds_.state(i).set_spin(bodies_[i].spin);
    team_.for_each(0, easy_.size(), 256, [&](std::size_t from, std::size_t to) {
      for (const std::uint32_t i : std::span(easy_).subspan(from, to - from))
        manifolds_.state(i).set_v(manifolds_.state(i).v() + acceleration_[i] * h);
    });
  }
  [[nodiscard]] std::vector<S> torques_now(const Real& now) const {
    const std::size_t n = world_.size();
    std::vector<V> x(n), v(n);
    std::vector<Orientation<Real, Dim>> orientation(n);
    std::vector<S> spin(n), torque(n);
    for (std::size_t i = 0; i < n; ++i)
      x[i] = bodies_[i].x, v[i] = bodies_[i].v, orientation[i] = bodies_[i].orientation, spin[i] = bodies_[i].spin;
    torques<Real, Dim>(world_, now, {x, v, orientation, spin}, torque);
    return torque;
  }
  void aim_contacts() {
    for (const std::uint32_t k : turning_) turn_levers(k);
    for (const std::uint32_t k : scalar_) aim(k, hardness_[k]);
  }
  /// Those of an island, in a substep that is cut into so many parts.
  void aim_contacts(std::span<const std::uint32_t> blocks, const Real& parts) {
    for (const std::uint32_t k : blocks) {
      if (turns_far(k)) turn_levers(k);
      ContactHardness<Real> hardness = hardness_[k];
      hardness.h /= parts, hardness.rate *= parts;
      aim(k, hardness);
    }
  }
  void turn_levers(std::uint32_t k) {
    const auto& found = contacts_.all()[active_[k]];
    continuo::turn_levers(found.contact, rows_.of(rows_.blocks[k]), bodies_[found.a], bodies_[found.b]);
  }
  void aim(std::uint32_t k, const ContactHardness<Real>& hardness) {
    const auto& found = contacts_.all()[active_[k]];
    continuo::aim(found.contact, rows_.of(rows_.blocks[k]), bodies_[found.a], bodies_[found.b], hardness);
  }
  /// Keeps the impulses of a substep.
  /// @{
  void keep_contacts() {
    for (const std::uint32_t k : scalar_)
      keep_impulses<Real, Dim>(contacts_.all()[active_[k]].contact, rows_.of(rows_.blocks[k]));
  }
  void keep_joints() {
    if (!has_joint_rows()) return;
    for (std::size_t k = 0, r = 0; k < acting_joints_.size(); ++k) {
      if (acting_joints_[k].is_in_lanes) continue;
      KeptJoint& joint = joints_[acting_joints_[k].number];
      const RowBlock& block = rows_.blocks[active_.size() + k];
      joint.impulses = {}, joint.linear = {}, joint.angular = {};
      for (const auto& row : rows_.of(block)) {
        joint.impulses[static_cast<std::size_t>(joint_rows_[r++])] = row.impulse;
        joint.linear += row.direction * row.impulse;
        if (row.direction == V{}) joint.angular += row.lever_b * row.impulse;
      }
    }
  }
  /// Those of the last substep, of joints in lanes. Their rows would be along the axes of a.
  void keep_point_joints() {
    for_each_point_joint([this](std::size_t n, const ActingJoint& acting) {
      KeptJoint& kept = joints_[acting.number];
      kept.impulses = {}, kept.angular = {};
      kept.linear = points_.impulse(n);
      const Matrix<Real, Dim> axes = bodies_[acting.a].axes * acting.joint->axes_a;
      for (std::size_t i = 0; i < Dim; ++i) kept.impulses[i] = dot(axes[i], kept.linear);
    });
  }
  /// @}
  void note_greatest_impulses() { note_greatest_impulses(scalar_); }
  void note_greatest_impulses(std::span<const std::uint32_t> blocks) {
    for (const std::uint32_t k : blocks) {
      auto& contact = contacts_.all()[active_[k]].contact;
      const auto rows = rows_.of(rows_.blocks[k]);
      for (std::size_t i = 0; i < contact.size; ++i)
        contact.points[i].greatest_impulse = std::max(contact.points[i].greatest_impulse, rows[i].impulse);
    }
  }

  /// What came in fast leaves with its restitution: all impacts of an island together.
  void rebound() {
    if (!has_restitution_) return;
    const Real threshold = Real(2) * length(world_.gravity) * options_.step;
    std::vector<bool> rebounds(islands_.size());
    for (std::size_t island = 0; island < islands_.size(); ++island)
      for (const std::uint32_t k : islands_.blocks(island)) {
        if (k >= active_.size()) continue;
        const auto& contact = contacts_.all()[active_[k]].contact;
        for (const auto& point : contact.all())
          if (does_rebound(contact, point, threshold)) rebounds[island] = true;
      }
    if (std::ranges::find(rebounds, true) == rebounds.end()) return;
    before_impacts_.resize(world_.size());
    for (std::size_t i = 0; i < world_.size(); ++i) before_impacts_[i] = {bodies_[i].v, bodies_[i].spin};
    rebound_swept(rebounds, threshold);
    for_each_island([&](std::size_t island) {
      if (!rebounds[island] || is_swept_[island]) return;
      for (const std::uint32_t k : islands_.blocks(island)) prepare_rebound(k, threshold);
      solvers_[island].rebound(rows_, bodies_);
    });
    take_states();
    for_each_island([&](std::size_t island) {
      if (rebounds[island] && only_loses(island)) limit_impacts(island);
    });
  }
  /// Sweeps in lanes use levers and moments of inertia of the beginning of the step, along which a slender body that
  /// turns far in it gains energy where it rubs. Such an island leaves a step with no more energy than it had and than
  /// gravity gave it: what is too much is taken from the spins of what turns far, and else from all.
  void limit_swept(std::size_t k) {
    const auto members = islands_.bodies(k);
    const Real far = square(far_turn / options_.step);
    const auto turns_far = [&](std::uint32_t i) { return turns_far_[i] != 0 || squared(bodies_[i].spin) > far; };
    if (is_swept_[k] == 0 || std::ranges::none_of(members, turns_far) || !only_gravity_gives(k)) return;
    Real came(0), work(0), of_far(0);
    for (const std::uint32_t i : members) {
      came += came_with(i), work += 2 * dot(acceleration_[i], bodies_[i].moved) / bodies_[i].inverse_mass;
      if (turns_far(i)) of_far += 2 * spin_energy(bodies_[i]);
    }
    const Real now = twice_kinetic_energy<Real, Dim>(members, bodies_), most = came + std::max(work, Real(0));
    if (!(now > most)) return;
    const Real factor = std::sqrt(std::max(1 - (now - most) / of_far, Real(0)));
    for (const std::uint32_t i : members)
      if (turns_far(i)) bodies_[i].spin *= factor;
    if (factor == Real(0)) set_energy<Real, Dim>(most, false, members, bodies_);
  }
  /// Whether nothing but gravity does work on an island: it has no joints but those that keep two points together.
  [[nodiscard]] bool only_gravity_gives(std::size_t island) const {
    return only_gravity(world_) && world_.torque_laws.empty() &&
           std::ranges::all_of(islands_.blocks(island), [this](std::uint32_t k) {
             return may_be_in_lanes(k) && !is_driven(rows_.blocks[k].a) && !is_driven(rows_.blocks[k].b);
           });
  }
  /// Twice the kinetic energy of a body when the step began.
  [[nodiscard]] Real came_with(std::uint32_t i) const {
    RigidBody<Real, Dim> then = bodies_[i];
    then.axes = rotation(then.orientation_before);
    const BodyVelocity<Real, Dim> first{world_.velocity[i], world_.spin[i]};
    return kinetic_product(then, first, first);
  }
  /// An island leaves its impacts with no more energy than it had when the step began and its forces gave it on its
  /// way, and with just that where nothing takes any: its motion up to now is that of the impacts, whatever overlaps
  /// were undone.
  void limit_impacts(std::size_t island) {
    EnergyOfChange<Real> energy;
    Real came(0);
    for (const std::uint32_t i : islands_.bodies(island)) {
      const RigidBody<Real, Dim>& body = bodies_[i];
      energy.add(body, before_impacts_[i]);
      came += came_with(i) + 2 * dot(acceleration_[i], body.moved) / body.inverse_mass;
    }
    const Real part =
        is_elastic(island) ? energy.part_to(came) : energy.part_within(std::max(energy.at(Real(0)), came));
    for (const std::uint32_t i : islands_.bodies(island))
      if (part != Real(1)) take_part(bodies_[i], before_impacts_[i], part);
    // What substeps may have given before the impacts, as bodies turned, is taken from what is free as well.
    const bool is_free = std::ranges::all_of(islands_.blocks(island), [this](std::uint32_t k) {
      return moves(rows_.blocks[k].a) && moves(rows_.blocks[k].b);
    });
    if (is_free && twice_kinetic_energy<Real, Dim>(islands_.bodies(island), bodies_) > came && came > Real(0))
      set_energy<Real, Dim>(came, true, islands_.bodies(island), bodies_);
  }
  [[nodiscard]] bool is_elastic(std::size_t island) const {
    return std::ranges::all_of(islands_.blocks(island), [this](std::uint32_t k) {
      const auto& contact = contacts_.all()[active_[k]].contact;
      return contact.restitution == Real(1) && contact.friction == Real(0);
    });
  }
  void rebound_swept(const std::vector<bool>& rebounds, const Real& threshold) {
    std::vector<bool> is_meant(bodies_.size());
    bool acts = false;
    for (std::size_t k = 0; k < islands_.size(); ++k) {
      if (!rebounds[k] || !is_swept_[k]) continue;
      acts = true;
      for (const std::uint32_t i : islands_.bodies(k)) is_meant[i] = true;
    }
    if (!acts) return;
    manifolds_.prepare_rebound(
        swept_contacts(), [&](const auto& found) { return is_meant[found.a] || is_meant[found.b]; },
        [&](const auto& contact, const auto& point) {
          return does_rebound(contact, point, threshold) ? contact.restitution * point.approach : Real(0);
        });
    for (const std::uint32_t block : swept_joints_) {
      const auto rows = rows_.of(rows_.blocks[block]);
      for (auto& row : rows) row.impulse = Real(0), row.bias_at_end = Real(0);
      if (rows_.blocks[block].is_bounded) give_nothing(rows);
    }
    points_.clear_impulses();
    for (int k = 0; k < sweeps_of_impacts; ++k) {
      sweep_joints(RowPass::relax);
      points_.sweep(ManifoldPass::rebound);
      manifolds_.sweep(ManifoldPass::rebound);
      manifolds_.sweep_groups(ManifoldPass::rebound);
    }
  }
  [[nodiscard]] static bool does_rebound(const RigidContact<Real, Dim>& contact,
                                         const RigidContactPoint<Real, Dim>& point, const Real& threshold) {
    return contact.restitution > Real(0) && point.greatest_impulse > Real(0) && point.approach < -threshold;
  }
  /// An impact takes no time, so that a force that is bounded gives it no impulse.
  static void give_nothing(std::span<ConstraintRow<Real, Dim>> rows) {
    for (auto& row : rows) row.least = row.most = Real(0);
  }
  void prepare_rebound(std::uint32_t k, const Real& threshold) {
    const auto rows = rows_.of(rows_.blocks[k]);
    for (auto& row : rows) row.impulse = Real(0), row.bias_at_end = Real(0);
    if (rows_.blocks[k].is_bounded) give_nothing(rows);
    if (k >= active_.size()) return;
    const auto& contact = contacts_.all()[active_[k]].contact;
    for (std::size_t i = 0; i < contact.size; ++i) {
      const auto& point = contact.points[i];
      if (does_rebound(contact, point, threshold)) {
        rows[i].bias_at_end = contact.restitution * point.approach;
      } else if (point.impulse == Real(0)) {
        rows[i].mass = Real(0);  // it is open
      }
    }
  }

  [[nodiscard]] bool all_finite() {
    std::atomic<bool> are_finite = true;
    team_.for_each(0, world_.size(), 128, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i)
        if (!is_finite(bodies_[i].x) || !is_finite(bodies_[i].v) || !is_finite(bodies_[i].spin) ||
            !is_finite(bodies_[i].orientation))
          are_finite.store(false, std::memory_order_relaxed);
    });
    return are_finite;
  }
  void stop_fast_bodies() {
    statistics.impacts += continuo::stop_fast_bodies<Real, Dim>(team_, world_, pairs_, contacts_.without_meshes(),
                                                                apart_, options_.step, bodies_);
  }

  void store() {
    team_.for_each(0, world_.size(), 128, [this](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        world_.position[i] = bodies_[i].x, world_.orientation[i] = bodies_[i].orientation;
        if (!moves(i)) continue;
        world_.velocity[i] = bodies_[i].v, world_.spin[i] = bodies_[i].spin;
      }
    });
    store_joints();
    world_.time = time_after_step(world_.time, options_.step);
    note_contacts();
    if (options_.sleep_after > Real(0)) settle();
    ++statistics.steps;
    statistics.contacts = active_.size();
    statistics.asleep = sleep_.asleep();
  }
  void store_joints() {
    const Real h = substep();
    for (const ActingJoint& acting : acting_joints_) {
      const std::uint32_t k = acting.number;
      Joint<Real, Dim>& joint = *world_.find(joints_[k].handle);
      joint.force = joints_[k].linear * (1 / h), joint.torque = joints_[k].angular * (1 / h);
      joint.motor_effort = joints_[k].impulses[static_cast<std::size_t>(JointRow::motor)] / h;
      if (joint.kind == JointKind::pull) continue;
      if (length(joint.force) > joint.breaks_at || length(joint.torque) > joint.breaks_at_torque)
        joint.is_broken = true;
    }
  }
  [[nodiscard]] bool is_sensor(const PartContact<Real, Dim>& found) const {
    return world_.has_traits() &&
           (world_.traits(found.a).is_sensor || (found.b < world_.size() && world_.traits(found.b).is_sensor));
  }
  [[nodiscard]] bool touches(const PartContact<Real, Dim>& found) const {
    return std::ranges::any_of(found.contact.all(), [&](const auto& point) {
      return separation(found.contact, point, bodies_[found.a], bodies_[found.b]) <= Real(0);
    });
  }
  void note_contacts() {
    log.clear();
    if (!log.is_kept()) return;
    for (const auto& found : contacts_.all()) {
      ContactEvent<Real, Dim> event{.a = world_.handle(found.a)};
      for (const auto& point : found.contact.all()) {
        event.impulse += point.impulse * static_cast<Real>(options_.substeps);
        event.point += (bodies_[found.a].x + bodies_[found.a].axes * point.local_a) * point.impulse;
      }
      const bool is_sensed = is_sensor(found) && touches(found);
      if (!(event.impulse > Real(0)) && !is_sensed) continue;
      if (is_sensed) {
        event.point = bodies_[found.a].x + bodies_[found.a].axes * found.contact.points[0].local_a;
      } else
        event.point *= static_cast<Real>(options_.substeps) / event.impulse;
      event.normal = found.contact.normal;
      if (found.parts.b >= pairs_.first_mesh()) {
        event.mesh = found.parts.b - pairs_.first_mesh();
      } else if (found.b >= world_.size()) {
        event.wall = static_cast<std::uint32_t>(found.b - world_.size());
      } else {
        event.b = world_.handle(found.b);
      }
      touches_.touch(event);
    }
    touches_.end_step(world_.time, log);
  }
  void settle() {
    std::vector<std::uint32_t> alone;
    for (std::uint32_t i = 0; i < world_.size(); ++i)
      if (is_alone_[i] != 0 && moves(i)) alone.push_back(i);
    sleep_.settle(world_, islands_, alone, options_.step, options_.sleep_after, options_.sleep_speed);
    for (std::size_t i = 0; i < world_.size(); ++i) bodies_[i].x = world_.position[i];
  }

  /// Which bodies collide.
  struct Rules {
    std::array<std::uint32_t, 32> ignored{};                       // groups
    std::vector<std::pair<std::uint32_t, std::uint32_t>> apart{};  // by joints
    std::vector<bool> are_fixed{};
    std::vector<std::array<std::uint64_t, 2>> masks{};
    std::vector<std::uint32_t> groups{};
    friend bool operator==(const Rules&, const Rules&) = default;
  };
  /// A joint of this step.
  struct ActingJoint {
    const Joint<Real, Dim>* joint = nullptr;
    std::uint32_t number = 0;    // among the kept ones
    std::uint32_t a = 0, b = 0;  // bodies
    bool is_in_lanes = false;    // before it is known whether its island is: whether it may be
  };
  struct KeptJoint {
    JointHandle handle{};
    JointImpulses<Real> impulses{};  // of the last substep
    bool is_swept = false;           // not solved directly
    V linear{};
    S angular{};
  };
  template <class Archive>
  void transfer(Archive& archive) {
    if constexpr (!Archive::reads) manifolds_.store_impulses(contacts_.all());
    // What the caller has changed since the last step has the effect that it would have in the next one.
    const bool are_others = !Archive::reads && !is_of_world();
    if (are_others) contacts_.find_anew();
    if (!Archive::reads && !are_others) sleep_.wake_changed(world_, bodies_);
    contacts_.transfer(archive, bodies_of(world_));
    auto joints = static_cast<std::uint64_t>(joints_.size());
    archive(joints);
    if constexpr (Archive::reads) {
      if (joints > archive.left()) return archive.fail("a list longer than the bytes that are left");
      joints_.assign(static_cast<std::size_t>(joints), {});
    }
    for (KeptJoint& joint : joints_)
      archive(joint.handle.slot), archive(joint.handle.generation), archive(joint.impulses), archive(joint.linear),
          archive(joint.is_swept);
    archive(touches_);
    RigidSleep<Real, Dim> none;
    archive(are_others ? none : sleep_);
  }

  static constexpr Real gain_of_turning_joints = Real(1.05);  // in a substep that turns them by a fifth of a radian
  static constexpr Real far_turn = Real(0.1);                 // of a body in a step, in radians
  static constexpr Real far_way = Real(0.01);                 // of two bodies in a step, over the radius of the smaller
  static constexpr int sweeps_of_impacts = 20, sweeps_of_deep_contacts = 3;
  static constexpr std::ptrdiff_t most_contacts_of_thick_islands = 500;
  static constexpr std::size_t most_blocks_of_small_islands = 100;

  World<Real, Dim>& world_;
  FastOptions<Real> options_;
  ThreadTeam team_;
  Result<ManifoldKernels<Real, Dim>> kernels_;
  ManifoldSolver<Real, Dim> manifolds_{team_, kernels_ ? *kernels_ : ManifoldKernels<Real, Dim>{}};
  PointJointSolver<Real, Dim> points_{team_, kernels_ ? *kernels_ : ManifoldKernels<Real, Dim>{}};
  IslandGroups groups_;                                     // of those that are swept
  std::vector<std::uint32_t> swept_;                        // the contacts of islands that are swept
  std::vector<std::uint32_t> swept_joints_;                 // their blocks of joints and locks
  std::vector<std::uint32_t> joined_;                       // the bodies of these
  std::vector<std::uint8_t> is_swept_, is_swept_before_;    // of each island
  std::vector<std::uint8_t> is_in_lanes_;                   // bodies of those islands, and bodies without contacts
  std::vector<std::uint8_t> is_easy_;                       // those that keep their spin, in gravity alone
  std::vector<std::uint32_t> easy_, in_lanes_;              // these, and the others, with driven ones
  std::vector<std::uint32_t> easy_alone_;                   // those of the easy ones without contacts and joints
  std::vector<std::uint32_t> apart_from_lanes_, not_easy_;  // all bodies, and all that move, but those
  std::vector<std::uint32_t> scalar_;                       // the blocks of all other contacts
  std::vector<std::uint32_t> turning_;                      // of these, of those of bodies that turn far in a step
  std::vector<std::uint8_t> turns_far_;                     // bodies that do, when the step begins
  std::vector<RigidBody<Real, Dim>> bodies_;
  std::vector<std::uint8_t> moves_;  // whether each of them does: what goes through all contacts asks for no more
  std::vector<std::uint8_t> moves_before_;  // when contacts were gathered; empty where that is to be done again
  RigidPairs<Real, Dim> pairs_;
  RigidContacts<Real, Dim> contacts_;
  Constraints<Real, Dim> rows_;
  std::vector<std::uint32_t> active_;                          // the contact of each block of rows
  bool has_restitution_ = false;                               // whether one of them has
  bool are_same_contacts_ = false;                             // that act, as in the last step
  bool are_same_islands_ = false, are_same_in_lanes_ = false;  // likewise
  std::size_t blocks_before_ = 0;                              // in the last step
  std::size_t contact_rows_ = 0;
  std::vector<JointHandle> joint_handles_;
  std::vector<KeptJoint> joints_;
  std::vector<ActingJoint> acting_joints_;           // of each block after those of contacts
  std::vector<std::uint32_t> acting_points_;         // those of them that are in lanes
  std::vector<PointJoint<Real, Dim>> point_joints_;  // those in lanes
  std::vector<JointRow> joint_rows_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> apart_;  // pairs of bodies that joints keep from colliding
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_pairs_, joined_before_;  // the same as the joints come
  Rules rules_;                                                                        // of the pairs
  RigidIslands islands_;
  std::vector<IslandSolver<Real, Dim>> solvers_;
  std::vector<ContactHardness<Real>> hardness_;  // of each block
  std::vector<std::uint8_t> is_alone_;           // bodies without contacts and joints
  bool are_joints_apart_ = false;  // whether some have rows and are not in islands that move by their joints
  std::vector<std::uint8_t> is_jointed_, is_in_jointed_;  // islands that move by their joints, and their bodies
  std::vector<V> acceleration_;
  std::vector<Real> spin_energy_;                               // of the bodies before a substep
  std::vector<BodyVelocity<Real, Dim>> free_, before_impacts_;  // after its forces have acted; at the end of the last
  TouchLog<Real, Dim> touches_;
  RigidSleep<Real, Dim> sleep_;
  bool is_stale_ = true;
};

}  // namespace continuo
