// continuo/bodies/pair_list.hpp
// The broad phase of the fast motion: which bodies may touch before they have moved further than they were listed for.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_list.hpp>

namespace continuo {

template <class Real, int Dim>
class PairList {
 public:
  using V = Vector<Real, Dim>;
  using Body = SolverBody<Real, Dim>;

  /// order[k] is the number in the world of the body at place k; that of the world where nothing is listed yet.
  const std::vector<std::uint32_t>& order(const World<Real, Dim>& world) {
    if (order_.size() != world.size()) {
      order_.resize(world.size());
      for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
    }
    return order_;
  }

  ColouredContacts<Real, Dim>& pair_contacts() { return pairs_; }
  const ColouredContacts<Real, Dim>& pair_contacts() const { return pairs_; }
  /// a is a body, b the number of a wall.
  std::vector<Contact<Real, Dim>>& wall_contacts() { return wall_contacts_; }
  const std::vector<Contact<Real, Dim>>& wall_contacts() const { return wall_contacts_; }
  std::size_t walls() const { return walls_; }
  std::size_t lists() const { return lists_; }
  /// Whether any contact bounces.
  bool has_restitution() const { return has_restitution_; }

  const Material<Real>& material(const World<Real, Dim>& world, std::size_t place) const {
    return world.material[order_[place]];
  }

  /// Whether a body may come further in the next step than the list is good for.
  template <class StepReach>
  bool is_outdated(const std::vector<Body>& bodies, const StepReach& step_reach) const {
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (!(length(bodies[k].x - bodies[k].x_of_list) + step_reach(bodies[k]) <= reach_[k])) return true;
    return false;
  }

  /// Sorts the bodies and lists the pairs anew; contacts that stay keep their impulses. Body k may move reach(body).
  template <class Reach>
  void list(const World<Real, Dim>& world, std::vector<Body>& bodies, const Reach& reach) {
    ++lists_;
    remember();
    sort(world, bodies);
    walls_ = world.walls().size();
    reach_.resize(bodies.size());
    Real widest(0);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      bodies[k].x_of_list = bodies[k].x;
      reach_[k] = bodies[k].inverse_mass > Real(0) ? reach(bodies[k]) : Real(0);
      // What reaches far looks for others itself and need not be looked for.
      if (!is_far(k, bodies)) widest = std::max(widest, bodies[k].radius + reach_[k]);
    }
    list_pairs(world, bodies, widest);
    list_walls(world, bodies);
    recall();
    const auto bounces = [](const Contact<Real, Dim>& contact) { return contact.restitution > Real(0); };
    has_restitution_ = std::ranges::any_of(pairs_.contacts, bounces) || std::ranges::any_of(wall_contacts_, bounces);
  }

  /// visit(place, material) for the bodies that the one at place i may meet if it moves by `way` from where it is.
  template <class Visit>
  void for_each_neighbour(const World<Real, Dim>& world, const std::vector<Body>& bodies, std::size_t i,
                          const Real& way, Visit&& visit) const {
    const Body& body = bodies[i];
    const auto meet = [&](std::uint32_t j) {
      if (j == i || !world.collide(order_[i], order_[j])) return;
      visit(j, combined(material(world, i), material(world, j)));
    };
    const Real out = body.radius + way + usual_;
    for_each_in_box(V(body.x - all(out)), V(body.x + all(out)), meet);
    for (const std::uint32_t j : far_) meet(j);
  }

 private:
  static V all(const Real& value) {
    V v;
    for (std::size_t axis = 0; axis < V::size(); ++axis) v[axis] = value;
    return v;
  }
  /// Larger or faster than cells are made for.
  bool is_far(std::size_t k, const std::vector<Body>& bodies) const {
    return bodies[k].radius + reach_[k] > 4 * median_;
  }

  void sort(const World<Real, Dim>& world, std::vector<Body>& bodies) {
    std::vector<Real> radii = world.radius;
    if (radii.empty()) return;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    median_ = *middle;
    std::vector<V> x(bodies.size());
    std::vector<Body> of_world(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      x[order_[k]] = bodies[k].x;
      of_world[order_[k]] = bodies[k];
    }
    cells_.sort(x, Real(2.3) * median_, order_);
    for (std::size_t k = 0; k < bodies.size(); ++k) bodies[k] = of_world[order_[k]];
  }

  template <class Visit>
  void for_each_in_box(const V& lower, const V& upper, Visit&& visit) const {
    cells_.for_each_row(lower, upper, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t j = first; j < last; ++j)
        if (!is_far_[j]) visit(j);
    });
  }

  void list_pairs(const World<Real, Dim>& world, const std::vector<Body>& bodies, const Real& widest) {
    std::vector<Contact<Real, Dim>> found;
    found.reserve(4 * bodies.size());
    usual_ = widest;
    far_.clear();
    is_far_.assign(bodies.size(), 0);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (!is_far(k, bodies)) continue;
      is_far_[k] = 1;
      far_.push_back(static_cast<std::uint32_t>(k));
    }
    const auto consider = [&](std::uint32_t a, std::uint32_t b) {
      const Real near = bodies[a].radius + bodies[b].radius + reach_[a] + reach_[b];
      if (squared(bodies[b].x - bodies[a].x) < near * near && world.collide(order_[a], order_[b]))
        found.push_back(contact(a, b, combined(material(world, a), material(world, b)), bodies[a], bodies[b]));
    };
    for (std::uint32_t k = 0; k < bodies.size(); ++k) {
      if (is_far_[k]) continue;
      const Real out = bodies[k].radius + reach_[k] + widest;
      for_each_in_box(V(bodies[k].x - all(out)), V(bodies[k].x + all(out)), [&](std::uint32_t j) {
        if (j > k) consider(k, j);
      });
    }
    for (const std::uint32_t k : far_) {
      const Real out = bodies[k].radius + reach_[k] + widest;
      for_each_in_box(V(bodies[k].x - all(out)), V(bodies[k].x + all(out)),
                      [&](std::uint32_t j) { consider(std::min(j, k), std::max(j, k)); });
      for (const std::uint32_t j : far_)
        if (j > k) consider(k, j);
    }
    pairs_ = coloured(std::move(found), bodies.size(), std::span<const Body>(bodies));
  }

  void list_walls(const World<Real, Dim>& world, const std::vector<Body>& bodies) {
    wall_contacts_.clear();
    for (std::uint32_t w = 0; w < world.walls().size(); ++w) {
      const Wall<Real, Dim>& wall = world.walls()[w];
      for (std::uint32_t k = 0; k < bodies.size(); ++k) {
        const Real gap = dot(wall.normal, bodies[k].x) - wall.offset - bodies[k].radius;
        if (gap > reach_[k] || !(bodies[k].inverse_mass > Real(0))) continue;
        const Material<Real> both = combined(material(world, k), wall.material);
        wall_contacts_.push_back(contact(k, w, both, bodies[k], Body{}));
      }
    }
  }

  /// Between p and q; of a wall, q is a stand-in that nothing moves.
  static Contact<Real, Dim> contact(std::uint32_t a, std::uint32_t b, const Material<Real>& both, const Body& p,
                                    const Body& q) {
    const Real inverse = p.inverse_mass + q.inverse_mass;
    Contact<Real, Dim> found{.a = a, .b = b};
    found.restitution = both.restitution;
    found.friction = both.friction;
    found.rolling_resistance = both.rolling_resistance;
    found.normal_mass = 1 / inverse;
    found.tangent_mass =
        1 / (inverse + p.radius * p.radius * p.inverse_inertia + q.radius * q.radius * q.inverse_inertia);
    return found;
  }

  // The contacts of the last list by the numbers that their bodies have in the world, and what a list keeps of them.

  struct Kept {
    std::uint32_t other;
    Contact<Real, Dim> contact;
  };
  void remember() {
    kept_.assign(order_.size(), {});
    kept_of_walls_.assign(order_.size(), {});
    for (const auto& contact : pairs_.contacts)
      if (contact.normal_impulse > Real(0)) kept_[order_[contact.a]].push_back({order_[contact.b], contact});
    for (const auto& contact : wall_contacts_)
      if (contact.normal_impulse > Real(0)) kept_of_walls_[order_[contact.a]].push_back({contact.b, contact});
  }
  void recall() {
    for (auto& contact : pairs_.contacts) {
      take_impulses(kept_[order_[contact.a]], order_[contact.b], contact, Real(1));
      take_impulses(kept_[order_[contact.b]], order_[contact.a], contact, Real(-1));  // the other way round then
    }
    for (auto& contact : wall_contacts_) take_impulses(kept_of_walls_[order_[contact.a]], contact.b, contact, Real(1));
  }
  static void take_impulses(const std::vector<Kept>& kept, std::uint32_t other, Contact<Real, Dim>& contact,
                            const Real& direction) {
    for (const Kept& old : kept) {
      if (old.other != other) continue;
      contact.normal_impulse = old.contact.normal_impulse;
      contact.friction_impulse = old.contact.friction_impulse * direction;
      contact.rolling_impulse = old.contact.rolling_impulse * direction;
    }
  }

  std::vector<std::uint32_t> order_, far_;
  std::vector<Real> reach_;
  std::vector<char> is_far_;
  Real median_ = Real(1), usual_ = Real(0);
  std::size_t walls_ = 0, lists_ = 0;
  bool has_restitution_ = false;
  SortedCells<Real, Dim> cells_;
  ColouredContacts<Real, Dim> pairs_;
  std::vector<Contact<Real, Dim>> wall_contacts_;
  std::vector<std::vector<Kept>> kept_, kept_of_walls_;
};

}  // namespace continuo
