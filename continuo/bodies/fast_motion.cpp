// continuo/bodies/fast_motion.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/impacts.hpp>
#include <continuo/bodies/touch_log.hpp>

namespace continuo {

template <class Real, int Dim>
class FastMotion<Real, Dim>::Stepper {
 public:
  using V = Vector<Real, Dim>;

  Stepper(World<Real, Dim>& world, const FastOptions<Real>& options)
      : log(options.contact_events), world_(world), options_(options) {
    refresh();
  }

  void refresh() {
    list_ = {};
    contacts_ = {};
    list_.begin(world_);
    load();
    make_list();
  }

  std::string advance() {
    if (!(options_.step > Real(0)) || !(options_.step < std::numeric_limits<Real>::infinity()))
      return "the step must be greater than 0, and finite";
    if (options_.substeps < 1) return "a step has at least one substep";
    if (world_.size() != bodies_.size() || world_.walls().size() != list_.walls()) refresh();
    load();
    if (!std::exchange(is_restored_, false)) contacts_.keep();
    place_before_.clear();
    if (list_.is_outdated(bodies_, step_reach())) make_list();
    activate();
    const Real h = options_.step / static_cast<Real>(options_.substeps);
    log.clear();
    for (int k = 0; k < options_.substeps; ++k) substep(world_.time + h * static_cast<Real>(k), h);
    Real sum(0);
    for (std::size_t k = 0; k < bodies_.size(); ++k)
      for (std::size_t axis = 0; axis < V::size(); ++axis)
        sum += Real(0) * (bodies_.place[k].x_and_radius[axis] + bodies_.motion[k].linear[axis]);
    if (sum != Real(0)) return "a body's motion is no longer finite: a force or a mass is too large for the step";
    store();
    world_.time += options_.step;
    if (log.is_kept()) note_touching();
    ++statistics.steps;
    statistics.lists = list_.lists();
    statistics.contacts = contacts_.active();
    statistics.colours = contacts_.between_movers.colours;
    return {};
  }

  Real deepest_overlap() const {
    Real deepest(0);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      for (const auto& entry : contacts_.pairs.row(k))
        deepest = std::max(
            deepest, bodies_.radius(k) + bodies_.radius(entry.other) - length(bodies_.x(entry.other) - bodies_.x(k)));
      for (const auto& entry : contacts_.walls.row(k)) {
        const Wall<Real, Dim>& wall = world_.walls()[entry.other];
        deepest = std::max(deepest, bodies_.radius(k) + wall.offset - dot(wall.normal, bodies_.x(k)));
      }
    }
    return deepest;
  }

  /// Whatever outlives a step and is not in the world. The list is made again, from where the bodies were then.
  void save(ByteWriter& writer) const {
    const bool is_listed = list_.x_of_list().size() == world_.size() && list_.walls() == world_.walls().size();
    writer(is_listed);
    if (!is_listed) return;
    std::vector<V> x(world_.size());
    std::vector<Real> reach(world_.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[list_.order()[k]] = list_.x_of_list()[k];
      reach[list_.order()[k]] = list_.reach_of_list()[k];
    }
    writer(x), writer(reach);
    ContactList<Real, Dim> contacts = contacts_;
    if (!is_restored_) contacts.keep();
    contacts.transfer_kept(writer);
    writer(touches_);
  }
  void load(ByteReader& reader) {
    bool is_listed = false;
    reader(is_listed);
    std::vector<V> x;
    std::vector<Real> reach;
    ContactList<Real, Dim> contacts;
    TouchLog<Real, Dim> touches;
    if (is_listed) {
      reader(x), reader(reach);
      contacts.transfer_kept(reader);
      reader(touches);
      reader.expect(x.size() == world_.size() && reach.size() == x.size(), "a list of other bodies");
      for (std::size_t i = 0; i < x.size() && reader.ok(); ++i)
        reader.expect(is_finite(x[i]) && reach[i] >= Real(0), "a list that is not finite");
      reader.expect(contacts.kept_fits(world_.size(), world_.walls().size()), "contacts of other bodies");
    }
    reader.expect_end();
    if (!reader.ok()) return;
    refresh();
    touches_ = std::move(touches);
    if (!is_listed) return;
    std::swap(world_.position, x);
    list_.sort(world_, place_before_);
    load();
    contacts_ = std::move(contacts);
    list_within([&](std::size_t k) { return reach[list_.order()[k]]; });
    std::swap(world_.position, x);
    load();
    is_restored_ = true;
  }

  FastStatistics statistics{};
  ContactLog<Real, Dim> log;

 private:
  void note_touching() {
    const auto handle = [&](std::uint32_t k) { return world_.handle(list_.order()[k]); };
    contacts_.for_each_touching([&](std::uint32_t k, std::uint32_t other, bool is_wall, const Real& impulse) {
      ContactEvent<Real, Dim> event{.a = handle(k)};
      event.impulse = impulse * static_cast<Real>(options_.substeps);
      if (is_wall) {
        event.wall = other;
        event.normal = -world_.walls()[other].normal;
      } else {
        event.b = handle(other);
        if (event.b.slot < event.a.slot) std::swap(event.a, event.b);
        const V apart = world_.position_of(event.b) - world_.position_of(event.a);
        if (const Real distance = length(apart); distance > Real(0)) event.normal = apart * (1 / distance);
      }
      event.point = world_.position_of(event.a) + event.normal * world_.radius[world_.index(event.a)];
      touches_.touch(event);
    });
    touches_.end_step(world_.time, log);
  }

  /// The bodies from the world, in the order of the list.
  void load() {
    const std::vector<std::uint32_t>& order = list_.order();
    bodies_.resize(order.size(), world_.walls().size());
    bodies_.gravity = world_.gravity;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      const Real radius = world_.radius[i];
      BodyMotion<Real>& motion = bodies_.motion[k];
      BodyPlace<Real>& place = bodies_.place[k];
      put(world_.position[i], place.x_and_radius);
      place.x_and_radius[3] = radius;
      put(world_.velocity[i], motion.linear);
      motion.linear[3] = world_.inverse_mass[i];
      put(Spin<Real, Dim>(world_.spin[i] * radius), motion.rim);
      motion.rim[3] = radius * radius * world_.inverse_inertia[i];
    }
    for (std::size_t w = 0; w < world_.walls().size(); ++w)
      put(V(world_.walls()[w].normal * world_.walls()[w].offset), bodies_.place[bodies_.wall(w)].x_and_radius);
    for (std::size_t lane = 0; lane < 2 * lanes_at_once<Real>; ++lane) {
      bodies_.place[bodies_.stand_in(lane)].x_and_radius[0] = static_cast<Real>(lane % 2);
      bodies_.motion[bodies_.stand_in(lane)].linear[3] = Real(1);
    }
    has_other_forces_ = !only_gravity(world_);
    if (!has_other_forces_) bodies_.accelerations.clear();
  }
  void store() {
    const std::vector<std::uint32_t>& order = list_.order();
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (!bodies_.moves(k)) continue;
      const std::size_t i = order[k];
      const Spin<Real, Dim> spin = vector_of<Spin<Real, Dim>::size()>(bodies_.motion[k].rim) * (1 / bodies_.radius(k));
      world_.orientation[i] = turned(world_.orientation[i], spin, options_.step);
      world_.position[i] = bodies_.x(k);
      world_.velocity[i] = bodies_.v(k);
      world_.spin[i] = spin;
    }
  }

  /// How far a body may come in one step.
  auto step_reach() const {
    return [this, dt = options_.step](std::size_t k) {
      return length(bodies_.v(k)) * dt + length(bodies_.acceleration(k)) * dt * dt / 2;
    };
  }
  void make_list() {
    list_.sort(world_, place_before_);
    load();
    // Pairs are listed for as long as nobody has come further than this.
    list_within([once = step_reach(), this](std::size_t k) {
      return std::max(Real(0.15) * bodies_.radius(k), Real(1.25) * once(k));
    });
  }
  template <class Reach>
  void list_within(const Reach& reach) {
    list_.list(world_, bodies_, reach, contacts_.pairs, contacts_.walls);
    may_bounce_ = any_material([](const Material<Real>& material) { return material.restitution > Real(0); });
    may_resist_ = any_material([](const Material<Real>& material) { return material.rolling_resistance > Real(0); });
  }

  template <class Is>
  bool any_material(const Is& is) const {
    return std::ranges::any_of(world_.material, is) ||
           std::ranges::any_of(world_.walls(), is, &Wall<Real, Dim>::material);
  }

  void activate() {
    using std::sqrt;
    const Real dt = options_.step;
    Real fastest(0), widest(0);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      fastest = std::max(fastest, squared(bodies_.v(k)));
      widest = std::max(widest, bodies_.radius(k));
    }
    const Real pull = length(world_.gravity);
    const Real extra = std::min(Real(0.2) * widest, Real(sqrt(fastest) * dt)) + pull * dt * dt;
    const auto material_of = [this, &order = list_.order()](std::uint32_t k) -> const Material<Real>& {
      return world_.material[order[k]];
    };
    contacts_.activate(bodies_, world_.walls(), material_of, may_bounce_ || may_resist_, ActiveReach<Real>{dt, extra},
                       place_before_);
  }

  void accelerate(const Real& t) {
    const std::vector<std::uint32_t>& order = list_.order();
    x_.resize(bodies_.size()), v_.resize(bodies_.size()), force_.resize(bodies_.size());
    for (std::size_t k = 0; k < order.size(); ++k) x_[order[k]] = bodies_.x(k), v_[order[k]] = bodies_.v(k);
    forces<Real, Dim>(world_, t, x_, v_, force_);
    bodies_.accelerations.resize(bodies_.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      bodies_.accelerations[k] = force_[order[k]] * bodies_.inverse_mass(k);
  }

  void substep(const Real& t, const Real& h) {
    if (has_other_forces_) accelerate(t);
    ContactStep<Real> step{.h = h,
                           .soft = softness(std::min(options_.hertz, Real(0.25) / h), options_.damping, h),
                           .fastest_push = options_.fastest_push};
    look_for_impacts(step);
    if (step.may_strike) {
      bodies_.impacts.assign(bodies_.size(), 0);
      statistics.impacts += impacts_.make(world_, list_, contacts_, bodies_, step, options_.step, t, log);
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      put(V(bodies_.v(k) + bodies_.acceleration(k) * h), bodies_.motion[k].linear);
      bodies_.touched[k] = 0;
    }
    contacts_.for_each_kind(
        [&](auto kind, auto& packs) { begin_packs<kind()>(packs, 0, packs.packs.size(), bodies_); });
    contacts_.for_each_kind([&](auto kind, auto& packs) {
      solve_packs<kind(), ContactPass::push>(packs, 0, packs.packs.size(), bodies_, step);
    });
    // Without a contact the path is a parabola: x + v_before h + a h^2 / 2.
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      V way = bodies_.v(k) * h;
      if (!bodies_.touched[k]) way -= bodies_.acceleration(k) * (h * h / 2);
      put(V(bodies_.x(k) + way), bodies_.place[k].x_and_radius);
    }
    contacts_.for_each_kind([&](auto kind, auto& packs) {
      solve_packs<kind(), ContactPass::relax>(packs, 0, packs.packs.size(), bodies_, step);
    });
  }

  /// Without restitution only what moves by half a radius in a substep strikes; most worlds at most times have neither.
  void look_for_impacts(ContactStep<Real>& step) const {
    using std::sqrt;
    Real pull(0), fastest(0);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      pull = std::max(pull, squared(bodies_.acceleration(k)));
      fastest = std::max(fastest, squared(bodies_.v(k)) / (bodies_.radius(k) * bodies_.radius(k)));
    }
    step.greatest_acceleration = sqrt(pull);
    step.may_strike = may_bounce_ || sqrt(fastest) * step.h > Real(0.2);  // of two that meet, and what gravity adds
  }

  World<Real, Dim>& world_;
  FastOptions<Real> options_;
  SolverBodies<Real, Dim> bodies_;
  PairList<Real, Dim> list_;
  ContactList<Real, Dim> contacts_;
  Impacts<Real, Dim> impacts_;
  TouchLog<Real, Dim> touches_;
  bool is_restored_ = false;  // the impulses of the last step have been kept already
  bool has_other_forces_ = false, may_bounce_ = false, may_resist_ = false;
  std::vector<std::uint32_t> place_before_;
  std::vector<V> x_, v_, force_;
};

template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(World<Real, Dim>& world, const FastOptions<Real>& options)
    : stepper_(std::make_unique<Stepper>(world, options)) {}
template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>& FastMotion<Real, Dim>::operator=(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>::~FastMotion() = default;
template <class Real, int Dim>
std::string FastMotion<Real, Dim>::advance() {
  return stepper_->advance();
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::refresh() {
  stepper_->refresh();
}
template <class Real, int Dim>
Real FastMotion<Real, Dim>::deepest_overlap() const {
  return stepper_->deepest_overlap();
}
template <class Real, int Dim>
const FastStatistics& FastMotion<Real, Dim>::statistics() const {
  return stepper_->statistics;
}

template <class Real, int Dim>
std::span<const ContactEvent<Real, Dim>> FastMotion<Real, Dim>::contact_events() const {
  return stepper_->log.events();
}
template <class Real, int Dim>
std::size_t FastMotion<Real, Dim>::lost_contact_events() const {
  return stepper_->log.lost();
}

template <class Real, int Dim>
void FastMotion<Real, Dim>::save(ByteWriter& writer) const {
  stepper_->save(writer);
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::load(ByteReader& reader) {
  stepper_->load(reader);
}

template class FastMotion<float, 2>;
template class FastMotion<float, 3>;
template class FastMotion<double, 2>;
template class FastMotion<double, 3>;

}  // namespace continuo
