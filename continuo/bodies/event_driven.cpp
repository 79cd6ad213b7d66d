#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <continuo/bodies/contact_time.hpp>
#include <continuo/bodies/event_queue.hpp>
#include <continuo/bodies/exact_engine.hpp>
#include <continuo/bodies/flight_bytes.hpp>
#include <continuo/bodies/flights.hpp>
#include <continuo/bodies/impulse.hpp>
#include <continuo/bodies/resting.hpp>

namespace continuo {

namespace {

template <class Real, int Dim>
class EventDriven final : public ExactEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;

  EventDriven(World<Real, Dim>& world, const ExactOptions<Real>& options)
      : ExactEngine<Real, Dim>(options),
        world_(world),
        options_(options),
        contact_time_(options.contact_time ? *options.contact_time : usual_contact_time(world)),
        flights_(world) {
    sort();
    for (std::uint32_t i = 0; i < flights_.paths.size(); ++i) predict(i);
  }

  std::string advance_to(const Real& t) override {
    std::size_t events = 0;
    while (queue_.time() <= t) {
      if (++events > options_.most_events) {
        synchronize(flights_.now);
        return "more events than `most_events`: bodies may be caught between others";
      }
      if (events % 1024 == 0 && options_.is_interrupted()) {
        synchronize(flights_.now);
        return "interrupted";
      }
      flights_.now = std::max(flights_.now, queue_.time());
      handle(queue_.first());
      if (crossings_since_sort_ > 4 * flights_.paths.size()) sort();
    }
    synchronize(t);
    for (std::size_t i = 0; i < world_.size(); ++i)
      if (!is_finite(world_.position[i]) || !is_finite(world_.velocity[i]))
        return "a body's motion is no longer finite: a speed or gravity is too large for the numbers";
    return {};
  }

  void save(ByteWriter& writer) override {
    writer(contact_time_), writer(flights_.grid.edge());
    for (const std::uint32_t k : places()) {
      Plan<Real, Dim> plan = flights_.plans[k];
      if (plan.partner < first_wall) plan.partner = flights_.plans[plan.partner].number;
      transfer_flight(writer, flights_.paths[k], plan, flights_.marks[k]);
    }
  }
  void load(ByteReader& reader) override {
    Real edge{};
    reader(contact_time_), reader(edge);
    reader.expect(contact_time_ >= Real(0) && edge > Real(0) && edge < std::numeric_limits<Real>::infinity(),
                  "a contact time or cells of no size");
    const std::vector<std::uint32_t> place = places();
    for (std::uint32_t i = 0; i < place.size() && reader.ok(); ++i) {
      Path<Real, Dim>& path = flights_.paths[place[i]];
      Plan<Real, Dim>& plan = flights_.plans[place[i]];
      Mark& mark = flights_.marks[place[i]];
      transfer_flight(reader, path, plan, mark);
      if (const char* fault = fault_of_flight(world_, path, plan, mark))
        reader.fail("body " + std::to_string(i) + ": " + fault);
    }
    if (!reader.ok()) return;
    for (auto& plan : flights_.plans)
      if (plan.partner < first_wall) plan.partner = place[plan.partner];
    flights_.grid = CellGrid<Real, Dim>(edge, place.size());
    sort();
  }

  using ExactEngine<Real, Dim>::statistics;
  using ExactEngine<Real, Dim>::contacts;

 private:
  /// Where the body of each number is.
  std::vector<std::uint32_t> places() const {
    std::vector<std::uint32_t> place(flights_.plans.size());
    for (std::uint32_t k = 0; k < place.size(); ++k) place[flights_.plans[k].number] = k;
    return place;
  }
  /// Brings the bodies into the order of their cells. Nothing but places changes.
  void sort() {
    crossings_since_sort_ = 0;
    auto& plans = flights_.plans;
    auto& grid = flights_.grid;
    const std::size_t n = plans.size();
    std::vector<std::uint32_t> order(n), place(n), numbers(n);
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::size_t> key(n);
    for (std::size_t i = 0; i < n; ++i)
      key[i] = plans[i].is_large ? std::numeric_limits<std::size_t>::max() : grid.list_of(plans[i].cell);
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(key[i], plans[i].number); });
    for (std::uint32_t k = 0; k < n; ++k) place[order[k]] = k;
    const auto arrange = [&](auto& values) {
      auto old = values;
      for (std::size_t k = 0; k < n; ++k) values[k] = old[order[k]];
    };
    arrange(flights_.paths), arrange(plans), arrange(flights_.marks);
    for (auto& plan : plans)
      if (plan.partner < first_wall) plan.partner = place[plan.partner];
    flights_.large.clear();
    grid = CellGrid<Real, Dim>(grid.edge(), n);
    for (std::size_t k = 0; k < n; ++k) numbers[k] = plans[k].number;
    queue_ = EventQueue<Real>(std::move(numbers));
    for (std::uint32_t k = 0; k < n; ++k) {
      schedule(k);
      if (plans[k].is_large) {
        flights_.large.push_back(k);
      } else {
        grid.insert(k, plans[k].cell);
      }
    }
  }

  void synchronize(const Real& t) {
    for (std::size_t i = 0; i < flights_.paths.size(); ++i) {
      Path<Real, Dim> at = flights_.paths[i];
      Plan<Real, Dim>& plan = flights_.plans[i];
      Flights<Real, Dim>::advance(at, plan.acceleration, t);
      world_.position[plan.number] = at.x;
      world_.velocity[plan.number] = at.v;
      turn_to(plan, t);
      world_.spin[plan.number] = spin_at(plan, t);
    }
    world_.time = flights_.now = t;
  }
  static S spin_at(const Plan<Real, Dim>& plan, const Real& t) {
    return plan.spin + plan.spin_rate * (t - plan.spun_since);
  }
  /// Its orientation. A spin that changes evenly turns by its mean.
  void turn_to(Plan<Real, Dim>& plan, const Real& t) {
    const Real from = plan.spun_to;
    plan.spun_to = t;
    if (!(t > from) || (plan.spin == S{} && plan.spin_rate == S{})) return;
    auto& orientation = world_.orientation[plan.number];
    orientation = turned(orientation, spin_at(plan, Real(from + (t - from) / 2)), Real(t - from));
  }

  void schedule(std::uint32_t i) {
    queue_.set(i, std::min(flights_.plans[i].collision_time, flights_.plans[i].crossing_time));
  }
  void predict(std::uint32_t i) {
    flights_.predict(i);
    schedule(i);
  }

  void handle(std::uint32_t i) {
    const Plan<Real, Dim>& plan = flights_.plans[i];
    const std::uint32_t j = plan.partner;
    if (plan.crossing_time <= plan.collision_time) return cross(i);
    if (j >= first_wall && j < look_again) return hit_wall(i, j - first_wall);
    if (plan.path_end <= flights_.now) return go_on(i);
    if (j == look_again || flights_.marks[j].collisions != plan.collisions_of_partner) {
      ++statistics.outdated;
      return predict(i);
    }
    plan.number < flights_.plans[j].number ? hit(i, j) : hit(j, i);
  }

  /// It slips no more, or rolls no more, or otherwise: on another path until the next time.
  void go_on(std::uint32_t i) {
    bring(i);
    ++flights_.marks[i].collisions;
    go_on_along(flights_, i, contact_time_);
    predict(i);
  }

  void cross(std::uint32_t i) {
    ++statistics.crossings;
    ++crossings_since_sort_;
    Plan<Real, Dim>& plan = flights_.plans[i];
    flights_.grid.remove(i, plan.cell);
    flights_.move_to_now(i);
    if (!flights_.grid.has_cell(flights_.paths[i].x)) {  // it has left where cells have numbers
      plan.is_large = true;
      flights_.large.push_back(i);
      return predict(i);
    }
    plan.cell[plan.axis] += plan.direction;
    flights_.grid.insert(i, plan.cell);
    if (plan.partner == look_again) return predict(i);
    flights_.look_ahead(i);
    schedule(i);
  }

  // Where bodies are squeezed between others, or wedged in by friction, collisions of one instant may never end. Where
  // one that loses energy has had so many that no free body has, it bounces no more, and then it moves no more.
  static constexpr std::uint8_t many_at_once = 64, most_at_once = 128;

  std::uint8_t at_once(std::uint32_t i) const {
    const Plan<Real, Dim>& plan = flights_.plans[i];
    return plan.last_collision == flights_.now ? plan.at_once : std::uint8_t{0};
  }
  static bool loses(const Material<Real>& material) {
    return material.restitution < Real(1) || material.friction > Real(0);
  }
  Material<Real> at_this_instant(Material<Real> material, std::uint32_t i, std::uint32_t j) const {
    const bool is_squeezed = loses(material) && std::max(at_once(i), at_once(j)) >= many_at_once;
    if (is_squeezed) {
      material.restitution = Real(0);
    } else if (is_held(i) || is_held(j)) {
      material.restitution = Real(1);
    }
    return material;
  }
  bool is_caught(const Material<Real>& material, std::uint32_t i) const {
    return loses(material) && at_once(i) >= most_at_once;
  }
  /// It lies where it is, carried by all round it, until something hits it.
  void freeze(std::uint32_t i) {
    if (flights_.marks[i].act == Act::is_fixed) return;
    flights_.paths[i].v = flights_.plans[i].acceleration = {};
    flights_.plans[i].spin = flights_.plans[i].spin_rate = {};
    flights_.plans[i].path_end = Flights<Real, Dim>::never;
    flights_.plans[i].support_count = 0;
    flights_.plans[i].rests_since = flights_.now;
    flights_.marks[i].act = Act::rests;
  }
  bool is_still(std::uint32_t i) const {
    return flights_.marks[i].act == Act::is_fixed ||
           (flights_.marks[i].act == Act::rests && flights_.plans[i].support_count == 0);
  }
  /// Two that are caught go on as one, or not at all where one is held fast.
  void stop(std::uint32_t i, std::uint32_t j) {
    const bool is_held_fast = is_still(i) || is_still(j);
    note_collision(i);
    note_collision(j);
    if (is_held_fast) {
      freeze(i);
      freeze(j);
      return;
    }
    const Mover<Real, Dim> a = mover(i), b = mover(j);
    const V change = b.velocity - a.velocity;
    a.velocity += change * (a.inverse_mass / (a.inverse_mass + b.inverse_mass));
    b.velocity = a.velocity;
    a.spin = b.spin = {};
  }

  bool is_held(std::uint32_t i) const { return flights_.now - flights_.plans[i].last_collision < contact_time_; }
  void bring(std::uint32_t i) {
    Plan<Real, Dim>& plan = flights_.plans[i];
    flights_.move_to_now(i);
    turn_to(plan, flights_.now);
    plan.spin = spin_at(plan, flights_.now);
    plan.spun_since = flights_.now;
  }
  Mover<Real, Dim> mover(std::uint32_t i) {
    Path<Real, Dim>& path = flights_.paths[i];
    Plan<Real, Dim>& plan = flights_.plans[i];
    return {path.v, plan.spin, path.radius, plan.inverse_mass, plan.inverse_inertia};
  }

  void hit(std::uint32_t i, std::uint32_t j) {
    ++statistics.collisions;
    bring(i);
    bring(j);
    const Path<Real, Dim>&a = flights_.paths[i], &b = flights_.paths[j];
    const Material<Real> own = combined(world_.meeting, flights_.plans[i].material, flights_.plans[j].material);
    const Material<Real> material = at_this_instant(own, i, j);
    const V apart = b.x - a.x;
    const Real distance = length(apart);
    V normal = distance > Real(0) ? apart * (1 / distance) : V{};
    if (!(distance > Real(0))) normal[0] = Real(1);
    Real impulse(0);
    if (dot(b.v - a.v, normal) < Real(0)) impulse = collide(mover(i), mover(j), normal, material);
    if (is_caught(own, i) || is_caught(own, j)) {
      stop(i, j);
    } else {
      part_where_pressed(i, j, normal);
      note_collision(i);
      note_collision(j);
    }
    if (contacts.is_kept() && impulse > Real(0))
      contacts.add({.a = handle_of(i),
                    .b = handle_of(j),
                    .point = a.x + normal * a.radius,
                    .normal = normal,
                    .impulse = impulse,
                    .time = flights_.now});
    predict(i);
    predict(j);
  }

  /// On a sphere nobody rests for good: the path would be no parabola. No flight is shorter than the contact time,
  /// then, and what lies bounces by less than one sees.
  void part_where_pressed(std::uint32_t i, std::uint32_t j, const V& normal) {
    const Real press = dot(flights_.plans[i].acceleration - flights_.plans[j].acceleration, normal);
    const Mover<Real, Dim> a = mover(i), b = mover(j);
    const Real missing = press * contact_time_ / 2 - dot(b.velocity - a.velocity, normal);
    if (!(press > Real(0)) || !(missing > Real(0))) return;
    const Real impulse = missing / (a.inverse_mass + b.inverse_mass);
    a.velocity -= normal * (impulse * a.inverse_mass);
    b.velocity += normal * (impulse * b.inverse_mass);
  }

  void hit_wall(std::uint32_t i, std::uint32_t w) {
    ++statistics.wall_collisions;
    bring(i);
    const Wall<Real, Dim> wall = facing(world_.walls()[w], flights_.paths[i].x);
    const Material<Real> own = combined(world_.meeting, flights_.plans[i].material, wall.material);
    const Material<Real> material = at_this_instant(own, i, i);
    V no_velocity{};
    S no_spin{};
    const Mover<Real, Dim> of_wall{no_velocity, no_spin, Real(0), Real(0), Real(0)};
    Real impulse(0);
    if (dot(flights_.paths[i].v, wall.normal) < Real(0))
      impulse = collide(mover(i), of_wall, V(-wall.normal), material);
    const bool caught = is_caught(own, i);
    note_collision(i);
    if (contacts.is_kept() && impulse > Real(0)) note_wall(i, w, ContactChange::impact, impulse);
    if (caught) {
      freeze(i);
    } else if (rest_on_walls(flights_, i, w, contact_time_) && contacts.is_kept())
      for (std::uint32_t k = 0; k < flights_.plans[i].support_count; ++k)
        note_wall(i, flights_.plans[i].supports[k], ContactChange::begin, Real(0));
    predict(i);
  }

  /// Its path is another one now; what it lay on it lies on no more, until it touches it again.
  void note_collision(std::uint32_t i) {
    Plan<Real, Dim>& plan = flights_.plans[i];
    ++flights_.marks[i].collisions;
    plan.at_once = plan.last_collision == flights_.now ? static_cast<std::uint8_t>(std::min(254, int{plan.at_once}) + 1)
                                                       : std::uint8_t{0};
    plan.last_collision = flights_.now;
    if (flights_.marks[i].act != Act::rests) return;
    if (contacts.is_kept()) {
      const auto forces = support_forces(flights_, i);
      for (std::uint32_t k = 0; k < plan.support_count; ++k)
        note_wall(i, plan.supports[k], ContactChange::end, Real(forces[k] * (flights_.now - plan.rests_since)));
    }
    flights_.marks[i].act = Act::falls;
    plan.acceleration = world_.gravity;
    plan.spin_rate = {};
    plan.path_end = Flights<Real, Dim>::never;
  }

  BodyHandle handle_of(std::uint32_t i) const { return world_.handle(flights_.plans[i].number); }
  void note_wall(std::uint32_t i, std::uint32_t w, ContactChange change, const Real& impulse) {
    const Path<Real, Dim>& path = flights_.paths[i];
    const V normal = -facing(world_.walls()[w], path.x).normal;
    contacts.add({.change = change,
                  .a = handle_of(i),
                  .wall = w,
                  .point = path.x + normal * path.radius,
                  .normal = normal,
                  .impulse = impulse,
                  .time = flights_.now});
  }

  World<Real, Dim>& world_;
  ExactOptions<Real> options_;
  Real contact_time_;
  Flights<Real, Dim> flights_;
  EventQueue<Real> queue_;
  std::size_t crossings_since_sort_ = 0;
};

}  // namespace

template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> event_driven(World<Real, Dim>& world, const ExactOptions<Real>& options) {
  return std::make_unique<EventDriven<Real, Dim>>(world, options);
}

template std::unique_ptr<ExactEngine<float, 2>> event_driven(World<float, 2>&, const ExactOptions<float>&);
template std::unique_ptr<ExactEngine<float, 3>> event_driven(World<float, 3>&, const ExactOptions<float>&);
template std::unique_ptr<ExactEngine<double, 2>> event_driven(World<double, 2>&, const ExactOptions<double>&);
template std::unique_ptr<ExactEngine<double, 3>> event_driven(World<double, 3>&, const ExactOptions<double>&);

}  // namespace continuo
