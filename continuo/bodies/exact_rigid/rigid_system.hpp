// The motion of bodies that joints and lasting contacts connect, as one system of differential equations for an
// integrator. In every evaluation the forces of joints and contacts are those with which the constraints keep their
// second derivatives; after every step the state is moved onto the constraints.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/bodies/constrained/constrained_system.hpp>
#include <continuo/bodies/contacts/minimum_norm.hpp>
#include <continuo/bodies/exact_rigid/constraint_equations.hpp>
#include <continuo/bodies/exact_rigid/contact_feature.hpp>
#include <continuo/bodies/exact_rigid/contact_tangents.hpp>
#include <continuo/bodies/exact_rigid/joint_constraints.hpp>
#include <continuo/bodies/exact_rigid/joint_springs.hpp>
#include <continuo/bodies/exact_rigid/reduced_contacts.hpp>
#include <continuo/bodies/forces.hpp>

namespace continuo {

/// How a contact rubs: it does not slip, or b slips against a along the direction across the normal, or against it. In
/// space, where slip has any direction, it is always forwards.
enum class Rubbing : std::uint8_t { none, sticks, forwards, backwards };

/// A contact that lasts.
template <class Real, int Dim>
struct ActingContact {
  ContactFeature<Real, Dim> feature{};
  std::uint32_t a = 0, b = 0;  // bodies
  std::uint32_t pair = 0;      // of parts, by whatever number its owner gives
  Rubbing rubbing = Rubbing::none;
  Real friction{};
  bool is_first = true;  // of its pair: in the plane it has the row that sticks
  // In space, of a contact that slips:
  Vector<Real, Dim>
      slip{};           // the direction of the slip at the end of the last step, or against it once it has passed 0
  Real steady_below{};  // up to this slip friction keeps its direction: below, that of a slip is not sure
  Real ends_below{};    // a slip that falls to this is at its end but for errors
};

/// The state: of each moving body position, velocity, orientation and angular momentum; then the impulse of each
/// contact since the beginning.
template <class Real, int Dim>
class RigidSystem {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using O = Orientation<Real, Dim>;
  using X = std::vector<Real>;
  using Row = MotionRow<Real, Dim>;
  using Body = ExactBody<Real, Dim>;
  static constexpr std::size_t stride = 2 * V::size() + O::size() + S::size();

  /// Of the bodies with these numbers, which move; `all` has every body of the world at time t, and last the world
  /// itself. `whole`: forces couple the bodies, which are then all that move.
  RigidSystem(const World<Real, Dim>& world, std::span<const Body> all, std::vector<std::uint32_t> moving,
              const Real& t, bool whole)
      : world_(&world), numbers_(std::move(moving)), moving_(numbers_.size()), begin_(t), whole_(whole) {
    for (const std::uint32_t i : numbers_) bodies_.push_back(all[i]);
    if (world.has_traits())
      for (std::uint32_t k = 0; k < moving_; ++k) note_locks(k, all);
    if (!whole) return;
    x_.resize(world.size()), v_.resize(world.size()), force_all_.resize(world.size());
    orientation_.resize(world.size()), spin_.resize(world.size()), torque_all_.resize(world.size());
    for (std::uint32_t i = 0; i < world.size(); ++i)
      if (all[i].is_fixed()) static_cast<void>(local(i, all));
  }
  /// Adds a joint or a contact, whose bodies have their numbers in the world.
  /// @{
  void add(ActingJoint<Real, Dim> joint, std::span<const Body> all) {
    joint.a = local(joint.a, all), joint.b = local(joint.b, all);
    joints_.push_back(std::move(joint));
  }
  void add(ActingContact<Real, Dim> contact, std::span<const Body> all) {
    contact.a = local(contact.a, all), contact.b = local(contact.b, all);
    contacts_.push_back(contact);
  }
  /// @}

  /// The number here of a body with this number in the world; one that does not move is added where it is not here yet.
  [[nodiscard]] std::uint32_t local(std::uint32_t number, std::span<const Body> all) {
    const auto at = std::ranges::find(numbers_, number);
    if (at != numbers_.end()) return static_cast<std::uint32_t>(at - numbers_.begin());
    numbers_.push_back(number);
    bodies_.push_back(all[number]), start_.push_back(all[number]);
    return static_cast<std::uint32_t>(numbers_.size() - 1);
  }

  void operator()(Real t, const X& state, X& rate) {
    unpack(t, state);
    accelerate(t);
    for (std::size_t k = 0; k < moving_; ++k) {
      auto to = rate.begin() + static_cast<std::ptrdiff_t>(k * stride);
      const auto put = [&](const auto& vector) { to = std::ranges::copy(vector.components, to).out; };
      put(bodies_[k].v), put(V(force_[k] * bodies_[k].inverse_mass));
      put(rate_of_orientation(bodies_[k].orientation, bodies_[k].spin)), put(torque_[k]);
    }
    for (std::size_t k = 0; k < contacts_.size(); ++k) rate[moving_ * stride + k] = press(k);
  }
  /// Finds the forces of joints and contacts in a state.
  void evaluate(Real t, const X& state) {
    unpack(t, state);
    accelerate(t);
  }
  /// Moves positions and velocities onto the constraints; within a step, whose polynomial is less exact than its end,
  /// by more than at its end.
  bool project(Real t, X& state, bool is_within_step = false) {
    unpack(t, state);
    for (std::size_t k = 0; k < moving_; ++k) normalize(bodies_[k]);
    project_positions();
    project_velocities();
    const Real more(is_within_step ? 1000 : 1);
    for (std::size_t k = 0; k < moving_; ++k) keep_energy(k, more * greatest_turn_);
    if (!is_within_step) note_slips();
    pack(state);
    return true;
  }
  /// To be called before the first step, with the tolerance of the orientations: moves the bodies onto the constraints,
  /// and chooses the equations that are solved, which do not depend on each other.
  void begin(const Real& tolerance) {
    greatest_turn_ = 4 * tolerance;
    for (std::size_t k = 0; k < moving_; ++k) normalize(bodies_[k]);
    project_positions();
    begins_ = true;
    project_velocities();
    begins_ = false;
    kept_.clear();
    find_rows(false);
    if (!rows_.empty() && !rubs_in_space()) {
      factor(rows_);
      kept_.assign(system_.independent().begin(), system_.independent().end());
      std::ranges::sort(kept_);
    }
    note_free_bodies();
    for (std::size_t k = 0; k < moving_; ++k) keep_energy(k, greatest_turn_);
  }

  [[nodiscard]] X pack() const {
    X state(moving_ * stride + contacts_.size());
    pack(state);
    return state;
  }
  void unpack(Real t, const X& state) {
    for (std::size_t k = 0; k < moving_; ++k) {
      auto from = state.begin() + static_cast<std::ptrdiff_t>(k * stride);
      const auto take = [&](auto& vector) {
        std::copy_n(from, vector.size(), vector.components.begin());
        from += static_cast<std::ptrdiff_t>(vector.size());
      };
      Body& body = bodies_[k];
      take(body.x), take(body.v), take(body.orientation), take(body.momentum);
      body.turn_with_momentum();
    }
    for (std::size_t k = moving_; k < bodies_.size(); ++k) drive(bodies_[k], start_[k - moving_], t - begin_);
    for (auto& joint : joints_) joint.follow_law(t);
  }
  /// Where a fixed body is after a time: one that is driven moves on with its velocity and spin.
  static void drive(Body& body, const Body& start, const Real& duration) {
    if (start.v == V{} && start.spin == S{}) return;
    body.x = start.x + start.v * duration;
    body.orientation = turned(start.orientation, start.spin, duration);
    body.axes = rotation(body.orientation);
  }

  /// The size of the acceleration by gravity.
  [[nodiscard]] Real gravity() const { return length(world_->gravity); }
  [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }
  [[nodiscard]] std::span<const Body> bodies() const { return bodies_; }
  [[nodiscard]] std::span<Body> bodies() { return bodies_; }
  /// The number of bodies that move, which are the first ones.
  [[nodiscard]] std::size_t moving() const { return moving_; }
  [[nodiscard]] std::size_t size_of_bodies() const { return moving_ * stride; }
  [[nodiscard]] Real impulse(const X& state, std::size_t k) const { return state[moving_ * stride + k]; }
  [[nodiscard]] std::span<const ActingJoint<Real, Dim>> joints() const { return joints_; }
  [[nodiscard]] std::span<const ActingContact<Real, Dim>> contacts() const { return contacts_; }
  /// After `evaluate`: where the equations do not determine the forces, as those along the floor of two feet that stick
  /// to it, finds those of contacts and limits that are the shortest, as where these were chosen.
  void share_forces() {
    if (rubs_in_space() || kept_.empty() || kept_.size() == rows_.size()) return;
    ConstraintEquations<Real> shortest;
    std::vector<Real> matrix;
    find_shared_forces(matrix, shortest);
  }
  /// Whether some rows depend on others, and are kept only where they agree with these.
  [[nodiscard]] bool has_dependent_rows() const { return !kept_.empty() && kept_.size() < rows_.size(); }
  /// After `evaluate`: the greatest acceleration of a row that the forces leave, in units of the greatest without them;
  /// that of rounding, or of errors of the state, where the rows agree.
  [[nodiscard]] Real disagreement() {
    Real greatest(0), left(0);
    for (const Row& row : rows_) greatest = std::max(greatest, std::abs(free_acceleration(row)));
    find_accelerations();
    for (const Row& row : rows_) left = std::max(left, std::abs(free_acceleration(row)));
    return greatest > Real(0) ? left / greatest : Real(0);
  }
  /// Likewise, of the rates that rows want in the present state, in units of the greatest.
  [[nodiscard]] Real disagreement_of_rates() const {
    Real greatest(0), left(0);
    for (const Row& row : rows_) {
      const Real rate = row.rate_of(bodies_[row.a], bodies_[row.b]);
      greatest = std::max({greatest, std::abs(row.rate), std::abs(rate)});
      left = std::max(left, std::abs(row.rate - rate));
    }
    return greatest > Real(0) && std::ranges::any_of(rows_, [](const Row& row) { return row.rate != Real(0); })
               ? left / greatest
               : Real(0);
  }
  /// Finds how the bodies would move without the forces of joints and contacts.
  void find_free_motion(Real t) {
    find_forces(t);
    find_accelerations();
  }
  /// The acceleration of a row in the free motion.
  [[nodiscard]] Real free_acceleration(const Row& row) const {
    return dot(row.direction, linear_[row.b] - linear_[row.a]) + dot(row.lever_b, angular_[row.b]) -
           dot(row.lever_a, angular_[row.a]) + row.drift;
  }
  [[nodiscard]] V linear(std::uint32_t k) const { return linear_[k]; }
  void set_motor(std::size_t j, MotorMode mode) { joints_[j].motor = mode; }
  /// The rows of the joints in the present state.
  [[nodiscard]] std::vector<Row> joint_rows() const {
    std::vector<Row> rows;
    for (const auto& joint : joints_)
      JointConstraints<Real, Dim>(joint, bodies_[joint.a], bodies_[joint.b], rows).add();
    add_locks(rows);
    return rows;
  }
  /// Those that answer impulses: a motor with a greatest force has none.
  [[nodiscard]] std::vector<Row> struck_joint_rows() const {
    std::vector<Row> rows;
    for (ActingJoint<Real, Dim> joint : joints_) {
      if (joint.motor != MotorMode::none && std::isfinite(joint.joint.motor->most)) joint.motor = MotorMode::none;
      JointConstraints<Real, Dim>(joint, bodies_[joint.a], bodies_[joint.b], rows).add();
    }
    add_locks(rows);
    return rows;
  }
  /// The row of a limit: see JointConstraints.
  [[nodiscard]] Row limit_row(const JointLimit& of) const {
    const auto& joint = joints_[of.joint];
    std::vector<Row> none;
    return JointConstraints<Real, Dim>(joint, bodies_[joint.a], bodies_[joint.b], none).limit(of.side);
  }

  /// The forces that were found last: of contact k along its normal; what the row across its pair does; of a joint on
  /// b, and of its motor.
  /// @{
  [[nodiscard]] Real press(std::size_t k) const { return force_of_row_[normal_of_[k]]; }
  [[nodiscard]] Real stick(std::size_t k) const { return force_of_row_[normal_of_[k] + 1]; }
  /// In space: along both tangents.
  [[nodiscard]] std::array<Real, 2> hold(std::size_t k) const {
    return {force_of_row_[normal_of_[k] + 1], force_of_row_[normal_of_[k] + 2]};
  }
  /// Whether the least give in the contacts would leave these forces what they are: see FrictionModes, and of forces in
  /// space FrictionCones.
  [[nodiscard]] bool is_stable() const {
    if (rows_.empty()) return true;
    if (!rubs_in_space()) return system_.determinant_sign() >= 0;
    constexpr Real lift = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-6);
    const auto n = static_cast<std::size_t>(std::ranges::count(one_sided_rows(), true));
    std::vector<Real> lifted = matrix_;
    for (std::size_t i = 0; i < n; ++i) lifted[i * n + i] *= 1 + lift;
    MinimumNorm<Real> system;
    system.factor(n, lifted);
    return system.determinant_sign() >= 0;
  }
  /// The slip of a contact in space.
  [[nodiscard]] V slip(const ActingContact<Real, Dim>& contact) const
    requires(Dim == 3)
  {
    const Body &a = bodies_[contact.a], &b = bodies_[contact.b];
    return slip_velocity(place_of(contact.feature, a, b), a, b);
  }
  /// How fast a force parts two bodies at a contact that slips, of how fast it would without its friction: the least of
  /// all contacts, 1 where none slips. No joints count. At 0 and below, friction jams the bodies.
  [[nodiscard]] Real least_parting() const {
    Real least(1);
    for (const std::size_t r : normal_of_) {
      Row smooth = rows_[r];
      smooth.rub = {}, smooth.rub_lever_a = {}, smooth.rub_lever_b = {};
      const Real free = response(smooth, smooth, bodies_.data());
      if (free > Real(0)) least = std::min(least, Real(response(rows_[r], rows_[r], bodies_.data()) / free));
    }
    return least;
  }
  struct JointLoad {
    V force{};
    S torque{};
    Real motor{};
  };
  [[nodiscard]] JointLoad load_of(std::size_t j) const {
    JointLoad load;
    const std::size_t first = first_row_of_[j], last = first_row_of_[j + 1];
    const bool has_motor_row = joints_[j].motor == MotorMode::keeps_speed;
    for (std::size_t r = first; r < last; ++r) {
      load.force += rows_[r].direction * force_of_row_[r];
      if (rows_[r].direction == V{}) load.torque += rows_[r].lever_b * force_of_row_[r];
    }
    if (has_motor_row) load.motor = force_of_row_[last - 1];
    const auto add = [&load](const Row& row, const Real& effort) {
      load.force += row.direction * effort;
      if (row.direction == V{}) load.torque += row.lever_b * effort;
    };
    if (const Real effort = driving_effort(joints_[j]); effort != Real(0)) {
      add(driven_row(joints_[j]), effort);
      load.motor = effort;
    }
    push_by_springs(joints_[j], bodies_.data(), add);
    return load;
  }
  /// What a joint bears, of what it can.
  [[nodiscard]] Real strain(std::size_t j) const {
    const Joint<Real, Dim>& joint = joints_[j].joint;
    const JointLoad load = load_of(j);
    const auto share = [](const Real& of, const Real& most) {
      return most > Real(0) ? of / most : of > Real(0) ? std::numeric_limits<Real>::infinity() : Real(0);
    };
    return std::max(share(length(load.force), joint.breaks_at), share(length(load.torque), joint.breaks_at_torque));
  }
  /// With what force the limit of a joint pushes that holds it on one side.
  [[nodiscard]] Real push_of_limit(std::size_t j) const { return force_of_row_[row_of_limit(j)]; }
  /// @}
  /// Finds all forces anew, with the shortest of all where they are not determined.
  void find_shortest_forces(Real t, const X& state) {
    const std::vector<std::size_t> kept = std::exchange(kept_, {});
    evaluate(t, state);
    kept_ = kept;
  }
  /// The row of the coordinate that a motor drives.
  [[nodiscard]] Row driven_row(const ActingJoint<Real, Dim>& joint) const {
    std::vector<Row> none;
    return JointConstraints<Real, Dim>(joint, bodies_[joint.a], bodies_[joint.b], none).driven();
  }
  [[nodiscard]] Real motor_rate(std::size_t j) const {
    return driven_row(joints_[j]).rate_of(bodies_[joints_[j].a], bodies_[joints_[j].b]);
  }

 private:
  void pack(X& state) const {
    for (std::size_t k = 0; k < moving_; ++k) {
      auto to = state.begin() + static_cast<std::ptrdiff_t>(k * stride);
      const auto put = [&](const auto& vector) { to = std::ranges::copy(vector.components, to).out; };
      put(bodies_[k].x), put(bodies_[k].v), put(bodies_[k].orientation), put(bodies_[k].momentum);
    }
  }
  [[nodiscard]] std::size_t row_of_limit(std::size_t j) const {
    const bool has_motor_row = joints_[j].motor == MotorMode::keeps_speed;
    return first_row_of_[j + 1] - (has_motor_row ? 2 : 1);
  }
  static void normalize(Body& body) {
    body.orientation = turned(body.orientation, S{}, Real(0));
    body.turn_with_momentum();
  }

  // Forces.

  void find_loads(Real t) {
    force_.assign(bodies_.size(), {}), torque_.assign(bodies_.size(), {});
    if (whole_) find_all_forces(t);
    for (std::size_t k = 0; k < moving_; ++k) {
      const std::uint32_t i = numbers_[k];
      force_[k] = whole_ ? force_all_[i] : V(world_->mass[i] * world_->gravity + world_->constant_force[i]);
      if (whole_) torque_[k] = torque_all_[i];
      if (!world_->has_traits()) continue;
      const BodyTraits<Real> traits = world_->traits(i);
      force_[k] += (world_->gravity * (traits.gravity_scale - 1) - bodies_[k].v * traits.damping) * world_->mass[i];
      torque_[k] -= bodies_[k].momentum * traits.spin_damping;
    }
  }
  void find_all_forces(Real t) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const std::uint32_t i = numbers_[k];
      if (i >= world_->size()) continue;  // the world itself
      x_[i] = bodies_[k].x, v_[i] = bodies_[k].v, orientation_[i] = bodies_[k].orientation, spin_[i] = bodies_[k].spin;
    }
    forces<Real, Dim>(*world_, t, x_, v_, force_all_);
    torques<Real, Dim>(*world_, t, {x_, v_, orientation_, spin_}, torque_all_);
  }
  [[nodiscard]] static Real driving_effort(const ActingJoint<Real, Dim>& joint) {
    if (joint.motor == MotorMode::forwards) return joint.joint.motor->most;
    return joint.motor == MotorMode::backwards ? -joint.joint.motor->most : Real(0);
  }
  void push(const Row& row, const Real& force) {
    const V along = (row.direction + row.rub) * force;
    force_[row.b] += along, force_[row.a] -= along;
    torque_[row.b] += (row.lever_b + row.rub_lever_b) * force;
    torque_[row.a] -= (row.lever_a + row.rub_lever_a) * force;
  }
  /// Forces and torques without those of joints and contacts, but with those of springs, and of motors that do not keep
  /// their speed.
  void find_forces(Real t) {
    find_loads(t);
    for (const auto& joint : joints_) {
      if (const Real effort = driving_effort(joint); effort != Real(0)) push(driven_row(joint), effort);
      push_by_springs(joint, bodies_.data(), [this](const Row& row, const Real& force) { push(row, force); });
    }
  }
  void find_accelerations() {
    linear_.assign(bodies_.size(), {}), angular_.assign(bodies_.size(), {});
    for (std::size_t k = 0; k < moving_; ++k) {
      linear_[k] = force_[k] * bodies_[k].inverse_mass;
      angular_[k] = bodies_[k].inverse_inertia_now * torque_[k] + free_turning(bodies_[k]);
    }
  }
  void accelerate(Real t) {
    find_forces(t);
    find_rows(true);
    force_of_row_.assign(rows_.size(), Real(0));
    if (rows_.empty()) return;
    find_accelerations();
    if (rubs_in_space()) {
      find_shared_forces(matrix_, system_);
      for (std::size_t r = 0; r < rows_.size(); ++r) push(rows_[r], force_of_row_[r]);
      return;
    }
    std::vector<Row>& solved = chosen_;
    solved.clear();
    if (kept_.empty()) {
      solved = rows_;
    } else {
      for (const std::size_t r : kept_) solved.push_back(rows_[r]);
    }
    factor(solved);
    wanted_.clear();
    for (const Row& row : solved) wanted_.push_back(-free_acceleration(row));
    system_.solve(wanted_);
    for (std::size_t k = 0; k < solved.size(); ++k) {
      force_of_row_[kept_.empty() ? k : kept_[k]] = wanted_[k];
      push(solved[k], wanted_[k]);
    }
  }
  /// The rows that only push: of contacts, and of limits that hold a joint on one side.
  [[nodiscard]] std::vector<bool> one_sided_rows() const {
    std::vector<bool> is_one_sided(rows_.size(), false);
    if (!normal_of_.empty())
      std::fill(is_one_sided.begin() + static_cast<std::ptrdiff_t>(normal_of_.front()),
                is_one_sided.end() - static_cast<std::ptrdiff_t>(locks_.size()), true);
    for (std::size_t j = 0; j < joints_.size(); ++j)
      if (is_held_on_one_side(joints_[j])) is_one_sided[row_of_limit(j)] = true;
    return is_one_sided;
  }
  /// Of forces that are not determined, the least of contacts and limits that hold, whatever the joints do: as those
  /// with which the contacts were chosen. `matrix` becomes that of the rows that only push, decomposed in `shortest`.
  void find_shared_forces(std::vector<Real>& matrix, ConstraintEquations<Real>& shortest) {
    const std::vector<bool> is_one_sided = one_sided_rows();
    std::vector<Row> joints, contacts;
    std::vector<Real> of_joints, of_contacts, forces;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      (is_one_sided[r] ? contacts : joints).push_back(rows_[r]);
      (is_one_sided[r] ? of_contacts : of_joints).push_back(free_acceleration(rows_[r]));
    }
    ReducedContacts<Real, Dim> reduced(bodies_.data(), joints, contacts);
    matrix.assign(reduced.matrix().begin(), reduced.matrix().end());
    for (const Real& rate : reduced.rates(of_joints, of_contacts)) forces.push_back(-rate);
    shortest.factor(contacts.size(), matrix);
    shortest.solve(forces);
    const std::vector<Real> answers = reduced.answers(of_joints, forces);
    for (std::size_t r = 0, joint = 0, contact = 0; r < rows_.size(); ++r)
      force_of_row_[r] = is_one_sided[r] ? forces[contact++] : answers[joint++];
  }

  // Constraints.

  /// The rows of joints, then those of contacts; with the friction of contacts that slip, or without.
  void find_rows(bool with_rubbing) {
    rows_.clear(), first_row_of_.clear(), normal_of_.clear();
    for (const auto& joint : joints_) {
      first_row_of_.push_back(rows_.size());
      JointConstraints<Real, Dim>(joint, bodies_[joint.a], bodies_[joint.b], rows_).add();
    }
    first_row_of_.push_back(rows_.size());
    for (const auto& contact : contacts_) {
      const Body &a = bodies_[contact.a], &b = bodies_[contact.b];
      const ContactPlace<Real, Dim> at = place_of(contact.feature, a, b);
      normal_of_.push_back(rows_.size());
      Row row = normal_row(at, a, b);
      row.a = contact.a, row.b = contact.b;
      if constexpr (Dim == 2) {
        Row across = across_row(at, a, b);
        across.a = contact.a, across.b = contact.b;
        const bool slips = contact.rubbing == Rubbing::forwards || contact.rubbing == Rubbing::backwards;
        if (slips && with_rubbing) {
          const Real share = contact.rubbing == Rubbing::forwards ? -contact.friction : contact.friction;
          row.rub = across.direction * share;
          row.rub_lever_a = across.lever_a * share, row.rub_lever_b = across.lever_b * share;
        }
        rows_.push_back(row);
        if (contact.rubbing == Rubbing::sticks && contact.is_first) rows_.push_back(across);
      } else {
        add_rows_in_space(contact, at, row, with_rubbing);
      }
    }
    add_locks(rows_);
  }
  [[nodiscard]] bool rubs_in_space() const {
    return Dim == 3 && std::ranges::any_of(contacts_, [](const auto& one) { return one.rubbing != Rubbing::none; });
  }
  /// A slip that begins is 0 at the beginning.
  void add_rows_in_space(const ActingContact<Real, 3>& contact, const ContactPlace<Real, 3>& at, Row row,
                         bool with_rubbing) {
    const Body &a = bodies_[contact.a], &b = bodies_[contact.b];
    const bool slips = contact.rubbing == Rubbing::forwards;
    if (slips && with_rubbing) {
      row.rub = direction_of_slip(contact, at, a, b) * -contact.friction;
      row.rub_lever_a = moment(V(at.place.value - a.x), row.rub);
      row.rub_lever_b = moment(V(at.place.value - b.x), row.rub);
    }
    rows_.push_back(row);
    if (contact.rubbing != Rubbing::sticks && !(slips && begins_ && contact.steady_below > Real(0))) return;
    for (Row& across : tangent_rows(at, a, b)) {
      across.a = contact.a, across.b = contact.b;
      rows_.push_back(across);
    }
  }
  /// Where a slip passes 0, friction keeps its direction, so that the motion is smooth until it ends there.
  [[nodiscard]] static V direction_of_slip(const ActingContact<Real, 3>& contact, const ContactPlace<Real, 3>& at,
                                           const Body& a, const Body& b) {
    const V slip = slip_velocity(at, a, b);
    const Real size = length(slip), ahead = dot(slip, contact.slip);
    const Real noise = 64 * std::numeric_limits<Real>::epsilon() *
                       (length(a.velocity_at(at.place.value)) + length(b.velocity_at(at.place.value)));
    if (contact.steady_below > Real(0) || !(size > noise)) {
      const V across = contact.slip - at.normal.value * dot(at.normal.value, contact.slip);
      return across * (1 / length(across));
    }
    return slip * ((ahead < Real(0) ? Real(-1) : Real(1)) / size);
  }
  void note_slips() {
    if constexpr (Dim == 3) {
      for (auto& contact : contacts_) {
        if (contact.rubbing != Rubbing::forwards) continue;
        const Body &a = bodies_[contact.a], &b = bodies_[contact.b];
        contact.slip = direction_of_slip(contact, place_of(contact.feature, a, b), a, b);
      }
    }
  }
  /// A row to the world for each direction in which a body is held. What a body has left that way is taken from it.
  void note_locks(std::uint32_t k, std::span<const Body> all) {
    const Locked locked = world_->traits(numbers_[k]).locked;
    const auto note = [&](Locked bit, auto member, std::size_t axis) {
      if (!has(locked, bit)) return;
      Row& row = locks_.emplace_back();
      row.a = local(static_cast<std::uint32_t>(all.size() - 1), all), row.b = k;
      (row.*member)[axis] = Real(1);
    };
    note(Locked::x, &Row::direction, 0), note(Locked::y, &Row::direction, 1);
    if constexpr (Dim == 3) {
      note(Locked::z, &Row::direction, 2);
      note(Locked::turn_x, &Row::lever_b, 0), note(Locked::turn_y, &Row::lever_b, 1);
    }
    note(Locked::turn_z, &Row::lever_b, S::size() - 1);
  }
  void add_locks(std::vector<Row>& rows) const { rows.insert(rows.end(), locks_.begin(), locks_.end()); }
  void factor(std::span<const Row> rows) {
    const std::size_t n = rows.size();
    matrix_.resize(n * n);
    for (std::size_t column = 0; column < n; ++column)
      for (std::size_t row = 0; row < n; ++row)
        matrix_[column * n + row] = response(rows[row], rows[column], bodies_.data());
    system_.factor(n, matrix_);
  }
  /// Newton's method, with displacements in the metric of the masses.
  void project_positions() {
    constexpr int most_rounds = 8;
    Real before = std::numeric_limits<Real>::infinity();
    for (int round = 0; round < most_rounds; ++round) {
      find_rows(false);
      Real error(0);
      wanted_.clear();
      for (const Row& row : rows_) {
        wanted_.push_back(-row.error);
        error = std::max(error, std::abs(row.error));
      }
      if (!(error > Real(0)) || !(error < before / 2)) return;
      before = error;
      factor(rows_);
      system_.solve(wanted_);
      shift_.assign(bodies_.size(), {}), twist_.assign(bodies_.size(), {});
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const Row& row = rows_[r];
        shift_[row.b] += row.direction * wanted_[r], shift_[row.a] -= row.direction * wanted_[r];
        twist_[row.b] += row.lever_b * wanted_[r], twist_[row.a] -= row.lever_a * wanted_[r];
      }
      for (std::size_t k = 0; k < moving_; ++k) {
        Body& body = bodies_[k];
        body.x += shift_[k] * body.inverse_mass;
        body.orientation = turned(body.orientation, S(body.inverse_inertia_now * twist_[k]), Real(1));
        body.turn_with_momentum();
      }
    }
  }
  void project_velocities() {
    find_rows(false);
    if (rows_.empty()) return;
    factor(rows_);
    for (int round = 0; round < 2; ++round) {
      wanted_.clear();
      for (const Row& row : rows_) wanted_.push_back(row.rate - row.rate_of(bodies_[row.a], bodies_[row.b]));
      system_.solve(wanted_);
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const Row& row = rows_[r];
        const V along = row.direction * wanted_[r];
        bodies_[row.b].push(along, S(row.lever_b * wanted_[r]));
        bodies_[row.a].push(-along, S(row.lever_a * -wanted_[r]));
      }
    }
  }

  // Free bodies.

  /// A body that nothing turns keeps its energy of rotation. It is kept as the angular momentum is: without that the
  /// errors of the steps would add up.
  void note_free_bodies() {
    for (std::size_t k = 0; k < moving_; ++k) {
      std::optional<Real> known = std::exchange(bodies_[k].energy, std::nullopt);
      if (Dim == 2 || !world_->torque_laws.empty()) continue;
      if (world_->has_traits() && world_->traits(numbers_[k]).spin_damping != Real(0)) continue;
      const auto meets = [&](const auto& one) { return one.a == k || one.b == k; };
      if (std::ranges::any_of(joints_, meets) || std::ranges::any_of(contacts_, meets)) continue;
      if (std::ranges::any_of(locks_, meets)) continue;
      bodies_[k].energy = known.value_or(dot(bodies_[k].momentum, bodies_[k].spin));
    }
  }
  /// Turns the body on the shortest way to where its energy is that of the beginning: a turn by d changes L . w by
  /// 2 d . (w x L). About a principal axis, where rounding would ask for large turns, the rest is left for later.
  void keep_energy(std::size_t k, const Real& most) {
    if constexpr (Dim == 3) {
      Body& body = bodies_[k];
      if (!body.energy) return;
      for (int round = 0; round < 2; ++round) {
        const V steepest = moment(body.spin, body.momentum);  // the same in the world
        const Real steepness = squared(steepest), error = dot(body.momentum, body.spin) - *body.energy;
        constexpr Real rounding = std::numeric_limits<Real>::epsilon();
        if (!(steepness > rounding * squared(body.spin) * squared(body.momentum))) return;
        if (!(std::abs(error) > 2 * rounding * *body.energy)) return;
        const Real turn = std::clamp(Real(-error / (2 * std::sqrt(steepness))), Real(-most), most);
        body.orientation = turned(body.orientation, V(steepest * (turn / std::sqrt(steepness))), Real(1));
        body.turn_with_momentum();
      }
    }
  }

  const World<Real, Dim>* world_;
  std::vector<std::uint32_t> numbers_;  // in the world, of all bodies here: first those that move
  std::size_t moving_;
  std::vector<Body> bodies_, start_;  // start_: of those that do not move, at the time `begin_`
  Real begin_, greatest_turn_{};
  bool whole_;
  std::vector<ActingJoint<Real, Dim>> joints_;
  std::vector<ActingContact<Real, Dim>> contacts_;
  std::vector<Row> locks_;         // directions in which bodies are held
  std::vector<std::size_t> kept_;  // the rows that are solved; empty: all
  bool begins_ = false;
  // Of the present state:
  std::vector<Row> rows_, chosen_;
  std::vector<std::size_t> first_row_of_, normal_of_;  // of joints, of contacts
  std::vector<Real> force_of_row_, matrix_, wanted_;
  ConstraintEquations<Real> system_;
  std::vector<V> force_, linear_, shift_;
  std::vector<S> torque_, angular_, twist_;
  // Of the whole world:
  std::vector<V> x_, v_, force_all_;
  std::vector<O> orientation_;
  std::vector<S> spin_, torque_all_;
};

}  // namespace continuo
