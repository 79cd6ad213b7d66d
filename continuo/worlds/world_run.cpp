// continuo/worlds/world_run.cpp
// Implements WorldRun for both dimensions, by the exact or the fast motion.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/snapshot.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/status/require.hpp>
#include <continuo/worlds/build_world.hpp>
#include <continuo/worlds/characters.hpp>
#include <continuo/worlds/coupled_equations.hpp>
#include <continuo/worlds/joint_states.hpp>
#include <continuo/worlds/motor_laws.hpp>
#include <continuo/worlds/world_run.hpp>
#include <continuo/worlds/world_shapes.hpp>

namespace continuo::worlds {

namespace {

std::optional<ForceIntegrator> integrator_named(std::string_view name) {
  if (name == "semi_implicit_euler") return ForceIntegrator::semi_implicit_euler;
  if (name == "symplectic_euler_position_first") return ForceIntegrator::symplectic_euler_position_first;
  if (name == "implicit_euler") return ForceIntegrator::implicit_euler;
  if (name == "central_difference") return ForceIntegrator::central_difference;
  if (name == "explicit_euler") return ForceIntegrator::explicit_euler;
  return std::nullopt;
}

template <int Dim>
Vector<double, Dim> vector_of(const Point& point) {
  Vector<double, Dim> v;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = point[i];
  return v;
}

template <int Dim>
class Moving final : public WorldRun {
 public:
  using V = Vector<double, Dim>;

  Moving(std::shared_ptr<const model::ModelProgram> program, WorldOptions options, std::span<const double> variables)
      : program_(std::move(program)),
        options_(std::move(options)),
        variables_(variables.begin(), variables.end()),
        coupled_(*program_, variables),
        drives_(*program_, variables),
        motor_laws_(*program_, variables),
        characters_(*program_, variables),
        start_(variables[model::Layout::time]) {
    const auto first = variables.begin() + static_cast<std::ptrdiff_t>(model().layout.states);
    state_.assign(first, first + static_cast<std::ptrdiff_t>(model().states.size()));
    find_starts();
    const auto z = state_.begin() + static_cast<std::ptrdiff_t>(coupled_.first());
    companions_.state.assign(z, z + static_cast<std::ptrdiff_t>(coupled_.states()));
    companions_.absolute_tolerance = options_.tolerance * 1e-3;
    companions_.twists = coupled_.has_torques();
    companions_.law = [this](double t, const BodyStates<double, Dim>& at, std::span<const double> z_now,
                             std::span<V> force, std::span<Spin<double, Dim>> torque,
                             std::span<double> rate) { coupled_(world_, t, at, z_now, force, torque, rate); };
  }

  /// Builds the world from its parameters, and fails where these are invalid. Existing bodies keep their states, and
  /// joints where they hold them, in the frames of the bodies.
  Status build() {
    const bool is_first = world_.size() == 0;
    BuiltWorld<Dim> built = build_world<Dim>(model(), is_first ? variables_ : variables_of_start());
    if (!built.status) return built.status;
    if (Status status = characters_.measure(model(), variables_, built.world); !status) return status;
    if (!is_first) {
      built.world.position = world_.position, built.world.velocity = world_.velocity;
      built.world.orientation = world_.orientation, built.world.spin = world_.spin;
      built.world.time = world_.time;
      for (std::size_t k = 0; k < joints_.size(); ++k)
        if (const auto* const old = world_.find(joints_[k]))
          built.world.find(built.joints[k])->is_broken = old->is_broken;
    }
    world_ = std::move(built.world);
    joints_ = std::move(built.joints);
    shapes_ = shapes_of<Dim>(world_, joints_, *model().world);
    make_motion();
    return {};
  }

  int dimension() const override { return Dim; }
  double time() const override { return world_.time; }
  double step() const override { return is_free() ? 0 : options_.step; }

  Status advance_to(double t) override {
    contacts_.clear();
    if (is_free()) return t > world_.time ? exact_advance(t) : Status{};
    // Takes no further step where only rounding would remain of it.
    while (world_.time < t - 1e-9 * options_.step) {
      if (options_.interrupt != nullptr && options_.interrupt->load())
        return {.ending = Ending::interrupted, .message = "interrupted"};
      if (Status status = exact_ ? exact_step() : fast_step(); !status) return status;
    }
    return {};
  }

  const std::vector<BodyShape>& bodies() const override { return shapes_.bodies; }
  const std::vector<WallShape>& walls() const override { return shapes_.walls; }
  const std::vector<StaticMeshShape>& meshes() const override { return shapes_.meshes; }
  const std::vector<SpringShape>& springs() const override { return shapes_.springs; }
  const std::vector<BodyForm>& forms() const override { return shapes_.forms; }
  const std::vector<JointShape>& joints() const override { return shapes_.joints; }
  Point position(std::size_t i) const override { return point_of<Dim>(world_.position[i]); }
  Point velocity(std::size_t i) const override { return point_of<Dim>(world_.velocity[i]); }
  Point spin(std::size_t i) const override {
    if constexpr (Dim == 2) {
      return {0, 0, world_.spin[i][0]};
    } else {
      return point_of<Dim>(world_.spin[i]);
    }
  }
  std::array<double, 4> orientation(std::size_t i) const override {
    if constexpr (Dim == 2) {
      const double half = world_.orientation[i][0] / 2;
      return {std::cos(half), 0, 0, std::sin(half)};
    } else {
      return world_.orientation[i].components;
    }
  }
  double kinetic_energy() const override { return continuo::kinetic_energy(world_); }
  double potential_energy() const override { return continuo::potential_energy(world_); }
  const std::vector<Contact>& contacts() const override { return contacts_; }

  const std::vector<double>& state() override {
    const std::size_t per_body = model::WorldDescription::states_of_body(Dim);
    for (std::size_t i = 0; i < world_.size(); ++i)
      write_body<Dim>(state_.data() + i * per_body, world_.position[i], world_.velocity[i], world_.orientation[i],
                      world_.spin[i]);
    std::ranges::copy(companions_.state, state_.begin() + static_cast<std::ptrdiff_t>(coupled_.first()));
    double* measure = state_.data() + model().world->first_measure;
    *measure++ = kinetic_energy();
    *measure++ = potential_energy();
    for (const double component : momentum(world_).components) *measure++ = component;
    *measure = static_cast<double>(collisions());
    write_joints<Dim>(world_, joints_, *model().world, state_);
    characters_.write(state_);
    return state_;
  }

  void set_state(std::span<const double> state) override {
    const double* at = state.data();
    for (std::size_t i = 0; i < world_.size(); ++i) {
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        world_.position[i][axis] = *at++;
        world_.velocity[i][axis] = *at++;
      }
      Orientation<double, Dim> orientation;
      for (std::size_t k = 0; k < orientation.size(); ++k) orientation[k] = *at++;
      // An action may have changed a component of the quaternion, so it is normalized.
      if (Dim == 2 || length(orientation) > 0) world_.orientation[i] = turned(orientation, {}, 0.0);
      for (std::size_t k = 0; k < world_.spin[i].size(); ++k) world_.spin[i][k] = *at++;
    }
    for (double& z : companions_.state) z = *at++;
    renew();
  }
  void place(double t, std::span<const double> state) override {
    world_.time = t;
    set_state(state);
    contacts_.clear();
    make_motion();
    collisions_apart_ += static_cast<std::size_t>(model::collisions_of(*model().world, state)) - collisions();
  }
  bool is_rigid() const override { return !joints_.empty() || world_.has_solids() || world_.has_meshes(); }
  void pull(std::optional<std::pair<std::size_t, Point>> body_and_target) override {
    if (!body_and_target) return drop_hand();
    const auto& [body, target] = *body_and_target;
    if (world_.is_fixed(body)) return;
    if (exact_) return pull_by_spring(body, vector_of<Dim>(target));
    Joint<double, Dim>* joint = world_.find(hand_);
    if (joint && joint->b != world_.handle(body)) {
      drop_hand();
      joint = nullptr;
    }
    if (!joint) {
      hand_ = require(world_.add_joint(definition_of_hand(body)));
      joint = world_.find(hand_);
    }
    joint->target = vector_of<Dim>(target);
  }
  void set_body(std::size_t body, const Point& position, const Point& velocity) override {
    world_.position[body] = vector_of<Dim>(position);
    world_.velocity[body] = vector_of<Dim>(velocity);
    renew();
  }

  Status set(std::uint32_t variable, double value) override {
    const std::vector<double> before = variables_;
    const model::Layout& layout = model().layout;
    const bool is_parameter = variable >= layout.parameters && variable < layout.inputs;
    variables_[variable] = value;
    set_everywhere(variable, value);
    if (!is_parameter) {
      renew();
      return {};
    }
    set_.push_back(variable);
    for (const std::size_t i : model().parameter_order) {
      const model::Parameter& parameter = model().parameters[i];
      if (parameter.independent || std::ranges::find(set_, parameter.variable) != set_.end()) continue;
      variables_[parameter.variable] = evaluate(model(), parameter.expression, variables_);
      set_everywhere(parameter.variable, variables_[parameter.variable]);
    }
    Status status = build();
    if (!status) {
      variables_ = before;
      set_.pop_back();
      for (const model::Parameter& parameter : model().parameters)
        set_everywhere(parameter.variable, variables_[parameter.variable]);
    }
    return status;
  }

  std::span<const double> variables() override {
    variables_[model::Layout::time] = world_.time;
    std::ranges::copy(state(), variables_.begin() + static_cast<std::ptrdiff_t>(model().layout.states));
    return variables_;
  }
  std::size_t mode() const override { return coupled_.mode(); }
  void go(std::size_t mode) override {
    coupled_.go(mode);
    renew();
  }

  Snapshot snapshot() const override {
    return {.bodies = exact_ ? continuo::snapshot(world_, *exact_) : continuo::snapshot(world_, *fast_),
            .equations = companions_.state,
            .variables = variables_,
            .characters = characters_.saved(),
            .time = world_.time,
            .start = start_,
            .steps = steps_,
            .collisions = collisions(),
            .mode = coupled_.mode(),
            .method = options_.method,
            .step = options_.step};
  }
  Status check(const Snapshot& saved) const override {
    World<double, Dim> found = world_;
    if (Status status = continuo::restore(saved.bodies, found); !status) return status;
    if (found.size() != world_.size() || found.walls().size() != world_.walls().size() ||
        found.meshes().size() != world_.meshes().size() || found.has_meshes() != world_.has_meshes() ||
        found.springs.size() < model().world->springs.size() || found.joint_count() < world_.joint_count())
      return invalid_input("it has other bodies, walls, meshes, springs or joints");
    if (found.time != saved.time) return invalid_input("its bodies are at another time");
    if (!std::ranges::all_of(saved.equations, [](double z) { return std::isfinite(z); }))
      return invalid_input("a state of its equations is not finite");
    if (!characters_.fits(saved.characters)) return invalid_input("its characters are others, or nowhere");
    const double ahead = saved.start + static_cast<double>(saved.steps) * options_.step - saved.time;  // in its step
    const bool is_one = is_free() || std::abs(ahead - options_.step / 2) <= options_.step * 0.51;
    return is_one ? Status{} : invalid_input("its time is none of its steps");
  }
  Status restore(const Snapshot& saved) override {
    if (saved.equations.size() != companions_.state.size() || saved.variables.size() != variables_.size() ||
        !characters_.fits(saved.characters))
      return invalid_input("a snapshot of another model");
    if (saved.method != options_.method || saved.step != options_.step)
      return invalid_input("a snapshot of another motion");
    Status status =
        exact_ ? continuo::restore(saved.bodies, world_, *exact_) : continuo::restore(saved.bodies, world_, *fast_);
    if (!status) return status;
    drop_hand();
    companions_.state = saved.equations;
    characters_.restore(saved.characters);
    start_ = saved.start;
    steps_ = saved.steps;
    collisions_apart_ = saved.collisions - counted();
    for (std::uint32_t i = model().layout.parameters; i < model().layout.samples; ++i) {
      if (variables_[i] != saved.variables[i]) set_everywhere(i, saved.variables[i]);
    }
    variables_ = saved.variables;
    coupled_.go(saved.mode);
    contacts_.clear();
    shapes_ = shapes_of<Dim>(world_, joints_, *model().world);
    return {};
  }

 private:
  const model::Model& model() const { return program_->model; }

  /// Remembers which bodies begin elsewhere than the model says.
  void find_starts() {
    if (model().world->joints.empty()) return;
    const std::size_t count = model().world->body_states();
    std::vector<model::NodeId> nodes;
    for (std::size_t i = 0; i < count; ++i) nodes.push_back(model().states[i].initial);
    const std::vector<double> starts = evaluate(model(), nodes, variables_);
    for (std::size_t i = 0; i < count; ++i)
      if (starts[i] != state_[i]) starts_elsewhere_.emplace_back(i, state_[i]);
  }
  /// With the present parameters and the bodies where they begin: there joints hold them.
  std::vector<double> variables_of_start() const {
    std::vector<double> variables = variables_;
    if (model().world->joints.empty()) return variables;
    const std::size_t count = model().world->body_states();
    std::vector<model::NodeId> nodes;
    for (std::size_t i = 0; i < count; ++i) nodes.push_back(model().states[i].initial);
    const std::vector<double> starts = evaluate(model(), nodes, variables_);
    std::ranges::copy(starts, variables.begin() + static_cast<std::ptrdiff_t>(model().layout.states));
    for (const auto& [i, value] : starts_elsewhere_) variables[model().layout.states + i] = value;
    return variables;
  }
  /// Strong enough to lift ten times all bodies that move, and to bring this one across itself in a tenth of a unit of
  /// time: a hand that is stronger tears at joints.
  JointDefinition<double, Dim> definition_of_hand(std::size_t body) const {
    constexpr double damping = 1;
    double mass = 0;
    for (std::size_t i = 0; i < world_.size(); ++i) mass += world_.is_fixed(i) ? 0 : world_.mass[i];
    const double acceleration = 10 * length(world_.gravity) + 100 * world_.radius[body];
    return {.kind = JointKind::pull,
            .b = world_.handle(body),
            .anchor = world_.position[body],
            .spring = JointSpring<double>{.hertz = hertz_of_hand, .damping = damping},
            .breaks_at = mass * acceleration};
  }
  /// The exact motion, which knows no joints that pull, has a spring of that frequency and a damping ratio of 1.
  void pull_by_spring(std::size_t body, const V& target) {
    const double rate = 2 * std::numbers::pi * hertz_of_hand, mass = world_.mass[body];
    drop_hand();
    world_.springs.push_back({.a = world_.handle(body),
                              .b = target,
                              .rest_length = 0,
                              .stiffness = mass * rate * rate,
                              .damping = 2 * mass * rate});
    renew();
  }
  /// Also that of a snapshot, which may have been taken while a hand pulled.
  void drop_hand() {
    const std::size_t of_model = model().world->springs.size();
    if (world_.springs.size() > of_model) {
      world_.springs.resize(of_model);
      renew();
    }
    for (const JointHandle handle : world_.joints())
      if (std::ranges::find(joints_, handle) == joints_.end()) world_.remove_joint(handle);
    hand_ = {};
  }
  void set_everywhere(std::uint32_t variable, double value) {
    coupled_.set(variable, value);
    if (!drives_.is_empty()) drives_.set(variable, value);
    motor_laws_.set(variable, value);
    characters_.set(variable, value);
  }

  void make_motion() {
    const std::size_t before = exact_ || fast_ ? collisions() : 0;
    exact_.reset();
    fast_.reset();
    start_ = world_.time;
    steps_ = 0;
    choose_motion();
    collisions_apart_ = before - counted();
  }
  void choose_motion() {
    const model::WorldMode& mode = model().world->mode;
    const auto number = [&](model::NodeId node, double otherwise) {
      return node.valid() ? evaluate(model(), node, variables_) : otherwise;
    };
    if (options_.method == "exact" || options_.method == "dop853" || options_.method == "rk4") {
      ExactOptions<double> options{.tolerance = options_.tolerance,
                                   .contact_events = options_.most_contacts,
                                   .motors = motor_laws_.laws(joints_),
                                   .interrupt = options_.interrupt};
      if (mode.contact_time.valid()) options.contact_time = evaluate(model(), mode.contact_time, variables_);
      if (options_.method == "rk4") options.step = options_.step;
      // The exact motion of shapes and joints has no companions; what acts without equations are laws of the world.
      const bool has_laws = model().world->is_rigid() && companions_.state.empty();
      if (has_laws) set_laws();
      if (has_laws || coupled_.is_empty()) {
        exact_.emplace(world_, options);
      } else {
        exact_.emplace(world_, options, companions_);
      }
      return;
    }
    FastOptions<double> options{.step = options_.step, .substeps = mode.substeps};
    options.hertz = number(mode.hertz, options.hertz);
    options.sleep_after = number(mode.sleep_after, options.sleep_after);
    options.sleep_speed = number(mode.sleep_speed, options.sleep_speed);
    options.threads = mode.threads;
    options.contact_events = options_.most_contacts;
    options.integrator = *integrator_named(options_.method == "fast" ? mode.integrator : options_.method);
    set_laws();
    fast_.emplace(world_, options);
  }
  /// Forces and torques of the model; in the exact motion also the force of a hand.
  void set_laws() {
    world_.force_laws.clear(), world_.torque_laws.clear();
    if (coupled_.has_forces())
      world_.force_laws.push_back(
          [this](const World<double, Dim>& world, double t, std::span<const V> x, std::span<const V> v,
                 std::span<V> force) { coupled_(world, t, {x, v, {}, {}}, companions_.state, force, {}, {}); });
    if (coupled_.has_torques())
      world_.torque_laws.push_back(
          [this](const World<double, Dim>& world, double t, const BodyStates<double, Dim>& at,
                 std::span<Spin<double, Dim>> torque) { coupled_(world, t, at, companions_.state, {}, torque, {}); });
  }
  void renew() {
    if (exact_) exact_->refresh();
  }

  /// Whether the method has no steps of its own, so that an advance can end at any time.
  bool is_free() const { return options_.method == "exact" || options_.method == "dop853"; }

  Status exact_advance(double t) {
    Status status = exact_->advance_to(t);
    note(*exact_);
    return status;
  }
  Status exact_step() {
    ++steps_;
    return exact_advance(start_ + static_cast<double>(steps_) * options_.step);
  }
  Status fast_step() {
    const double from = world_.time;
    if (Status status = move_equations(from, from + options_.step / 2); !status) return status;
    if (!drives_.is_empty())
      if (Status status = drives_.drive(from, state(), joints_, world_); !status) return status;
    if (!characters_.is_empty()) characters_.prepare(from, state(), world_);
    if (Status status = fast_->advance(); !status) return status;
    if (!characters_.is_empty())
      if (Status status = characters_.walk(world_, options_.step); !status) return status;
    ++steps_;
    world_.time = start_ + static_cast<double>(steps_) * options_.step;  // a million steps do not drift
    note(*fast_);
    return move_equations(from + options_.step / 2, world_.time);
  }
  /// Integrates the equations, with the bodies fixed in their states.
  Status move_equations(double from, double to) {
    if (companions_.state.empty()) return {};
    using Others = std::vector<double>;
    const auto rates = [this](double t, const Others& z, Others& rate) {
      coupled_(world_, t, {world_.position, world_.velocity, {}, {}}, z, {}, {}, rate);
    };
    Options<Others> options{.rtol = std::max(options_.tolerance, 1e-13), .atol = companions_.absolute_tolerance};
    options.save = Save<Others>::only_end();
    Integrator integrator(rates, companions_.state, Interval<double>{from, to}, Dop853{}, options);
    while (integrator.advance()) {
    }
    if (!succeeded(integrator.outcome().ending))
      return {.ending = integrator.outcome().ending,
              .message = "the equations beside the bodies: " + describe(integrator.outcome())};
    companions_.state = integrator.x();
    return {};
  }

  template <class Motion>
  void note(const Motion& motion) {
    for (const ContactEvent<double, Dim>& event : motion.contact_events()) {
      if (contacts_.size() >= options_.most_contacts) return;
      contacts_.push_back({.change = event.change,
                           .a = world_.index(event.a),
                           .b = event.with_wall() || event.with_mesh() ? model::no_body : world_.index(event.b),
                           .wall = event.with_wall() ? event.wall : model::no_body,
                           .mesh = event.with_mesh() ? event.mesh : model::no_body,
                           .point = point_of<Dim>(event.point),
                           .impulse = event.impulse,
                           .time = event.time});
    }
  }
  /// The number of collisions since the start of the world, in all motions.
  std::size_t collisions() const { return counted() + collisions_apart_; }
  std::size_t counted() const {
    if (exact_) return exact_->statistics().collisions + exact_->statistics().wall_collisions;
    return fast_->statistics().impacts;
  }

  std::shared_ptr<const model::ModelProgram> program_;
  WorldOptions options_;
  std::vector<double> variables_;
  std::vector<std::uint32_t> set_;  // parameters that were set
  CoupledEquations<Dim> coupled_;
  JointDrives drives_;
  MotorLaws motor_laws_;
  Characters<Dim> characters_;
  World<double, Dim> world_;
  static constexpr double hertz_of_hand = 5;
  JointHandle hand_{};                                            // that pulls
  std::vector<JointHandle> joints_;                               // of the model
  std::vector<std::pair<std::size_t, double>> starts_elsewhere_;  // states of bodies
  Companions<double, Dim> companions_;                            // the equations
  std::optional<ExactMotion<double, Dim>> exact_;
  std::optional<FastMotion<double, Dim>> fast_;
  double start_;                      // of the steps
  std::uint64_t steps_ = 0;           // since then
  std::size_t collisions_apart_ = 0;  // collisions that earlier motions have counted
  Shapes shapes_;
  std::vector<Contact> contacts_;
  std::vector<double> state_;
};

template <int Dim>
Result<std::unique_ptr<WorldRun>> start(std::shared_ptr<const model::ModelProgram> program, const WorldOptions& options,
                                        std::span<const double> variables) {
  auto run = std::make_unique<Moving<Dim>>(std::move(program), options, variables);
  Status status = run->build();
  if (!status) return status;
  return std::unique_ptr<WorldRun>(std::move(run));
}

}  // namespace

WorldOptions options_of(const model::Plan& plan) {
  return {.method = plan.method, .step = plan.step, .tolerance = plan.rtol};
}

std::string WorldRun::name_of(const Contact& contact) const {
  const std::string& other = contact.b != model::no_body      ? bodies()[contact.b].name
                             : contact.mesh != model::no_body ? meshes()[contact.mesh].name
                                                              : walls()[contact.wall].name;
  return bodies()[contact.a].name + (contact.change == ContactChange::end ? " leaves " : " meets ") + other;
}

Result<std::unique_ptr<WorldRun>> start_world(std::shared_ptr<const model::ModelProgram> program,
                                              const WorldOptions& options, std::span<const double> variables) {
  const int dimension = program->model.world->dimension;
  if (dimension == 2) return start<2>(std::move(program), options, variables);
  return start<3>(std::move(program), options, variables);
}

}  // namespace continuo::worlds
