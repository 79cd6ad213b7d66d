// The impulses of many contacts that act together, found in sweeps over them: the projected Gauss-Seidel iteration.
// Each contact in turn has its total impulse corrected for the present impulses of all others; no impulse pulls, and
// friction either stops the slip or has the size of the Coulomb limit (J. J. Moreau, in "Nonsmooth Mechanics and
// Applications", CISM 302, 1988; M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235-257). Without friction each
// correction lowers the energy as far as one contact can.
//
// Through a tall pile an impulse travels by one body per sweep, so that tall piles converge slowly. So after every two
// sweeps, forward and back, the iteration extrapolates in the direction in which the impulses change, as the method of
// conjugate gradients does. Where the changes grow, it restarts: M. Silcowitz, S. Niebe, K. Erleben, "A nonsmooth
// nonlinear conjugate gradient method for interactive contact force problems", The Visual Computer 26 (2010) 893-901.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/persistent_contact.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// The impulse of a contact on its second body; the first one gets the opposite.
template <class Real, int Dim>
struct ContactImpulse {
  Real press{};             // along the normal
  Vector<Real, Dim> rub{};  // across it
  Spin<Real, Dim> roll{};   // against rolling, over the smaller radius, as in PersistentContact

  ContactImpulse operator+(const ContactImpulse& other) const {
    return {press + other.press, rub + other.rub, roll + other.roll};
  }
  ContactImpulse operator-(const ContactImpulse& other) const {
    return {press - other.press, rub - other.rub, roll - other.roll};
  }
  ContactImpulse operator*(const Real& factor) const { return {press * factor, rub * factor, roll * factor}; }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(press), archive(rub), archive(roll);
  }
};

template <class Real, int Dim>
class ProjectedGaussSeidel {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using Impulse = ContactImpulse<Real, Dim>;
  struct Moving {
    V v{};
    S spin{};
    Real inverse_mass{}, turn{}, radius{};  // turn: radius over the inertia
  };
  struct Row {
    std::uint32_t a = 0, b = 0;  // places
    V normal{};
    Real friction{}, resistance{}, arm{};
    Real of_normal{}, of_slip{}, of_roll{};  // changes of speed by impulses of 1
    Real least{};                            // the least speed of separation
    Real compliance{};                       // by how much an impulse of 1 lowers that speed
    bool has_known_press = false;            // the impulse along the normal stays as it is
    Impulse impulse{};

    /// Starts with an earlier impulse, its tangential parts projected to be across the present normal.
    void begin_with(const Impulse& one) {
      impulse = one;
      impulse.rub -= normal * dot(one.rub, normal);
      impulse.roll = across_normal(one.roll, normal);
    }
  };

  void clear() {
    movers_.assign(1, {});
    rows_.clear();
  }
  /// Adds body i and returns its place.
  std::uint32_t add(const World<Real, Dim>& world, std::size_t i) {
    return add({world.velocity[i], world.spin[i], world.inverse_mass[i], world.radius[i] * world.inverse_inertia[i],
                world.radius[i]});
  }
  std::uint32_t add(const Moving& body) {
    movers_.push_back(body);
    return static_cast<std::uint32_t>(movers_.size() - 1);
  }
  /// Adds a contact, after its `place`, between the bodies at two places; place 0 is a wall.
  Row& add(const PersistentContact<Real, Dim>& contact, std::uint32_t at_a, std::uint32_t at_b) {
    Row& row = add(contact.normal, contact.slip.most, at_a, at_b);
    row.resistance = contact.roll.most, row.arm = contact.arm;
    row.of_roll = row.arm * row.arm * (over(movers_[at_a]) + over(movers_[at_b]));
    return row;
  }
  /// A contact without resistance to rolling.
  Row& add(const V& normal, const Real& friction, std::uint32_t at_a, std::uint32_t at_b) {
    Row row{.a = at_a, .b = at_b, .normal = normal, .friction = friction};
    const Moving &a = movers_[at_a], &b = movers_[at_b];
    row.of_normal = a.inverse_mass + b.inverse_mass;
    row.of_slip = row.of_normal + a.radius * a.turn + b.radius * b.turn;
    return rows_.emplace_back(row);
  }

  /// Applies the impulses of the rows, and sweeps until a sweep changes no speed by more than `least`, at most `most`
  /// times. Returns the greatest change of a speed by the last sweep.
  Real begin_and_sweep(const Real& least, int most) {
    for (const Row& row : rows_) push(row, row.impulse);
    return sweep(least, most);
  }
  /// Sweeps from the present state, until a sweep changes no speed by more than `least`, at most `most` times. Returns
  /// the greatest change of a speed by the last sweep: one above `least` tells that the impulses were not found.
  Real sweep(const Real& least, int most) {
    before_.resize(rows_.size()), way_.resize(rows_.size());
    Real size_before(0);  // of the changes by the last two sweeps
    Real greatest(0);     // the square of the greatest change of a speed
    for (int k = 0; k < most; k += 2) {
      for (std::size_t r = 0; r < rows_.size(); ++r) before_[r] = rows_[r].impulse;
      greatest = Real(0);
      for (Row& row : rows_) greatest = std::max(greatest, set_right(row));
      if (!(greatest > least * least)) break;
      greatest = Real(0);
      for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) greatest = std::max(greatest, set_right(*row));
      if (!(greatest > least * least)) break;
      if (k + 2 < most) size_before = go_on(size_before);
    }
    using std::sqrt;
    return sqrt(greatest);
  }
  /// By how much a speed of separation is wrong at most, of contacts without friction.
  [[nodiscard]] Real greatest_error() const {
    Real greatest(0);
    for (const Row& row : rows_) {
      const Real more = surplus(row, dot(V(movers_[row.b].v - movers_[row.a].v), row.normal));
      greatest = std::max({greatest, Real(-more), std::min(more, Real(row.impulse.press * row.of_normal))});
    }
    return greatest;
  }

  /// A bound of the kinetic energy of what the velocities are wrong by, about: the work that the impulses do on what
  /// violates the laws of contact. With the right impulses p* and velocities v*, and speeds u and u* that a normal
  /// impulse p answers, (v - v*) . M (v - v*) = (p - p*) . (u - u*) <= p . u - p* . u, since p* . u* = 0 and
  /// p . u* >= 0; p stands for p*. Where p is still too small, bodies approach, and at worst it is the heaviest one
  /// that does at that speed. Friction adds its work p . slip, less what it is in the law: -friction press |slip| (G.
  /// de Saxce, Z.-Q. Feng, Math. Comput. Modelling 28 (1998) 225-245).
  [[nodiscard]] Real greatest_error_energy() const {
    Real sum(0), approaches(0), least_inverse = std::numeric_limits<Real>::infinity();
    for (const Moving& one : movers_)
      if (one.inverse_mass > Real(0)) least_inverse = std::min(least_inverse, one.inverse_mass);
    for (const Row& row : rows_) {
      const Real press = row.impulse.press, parting = dot(V(movers_[row.b].v - movers_[row.a].v), row.normal),
                 more = surplus(row, parting);
      sum += press * std::abs(more);
      if (more < Real(0)) approaches += square(more);
      if (!(row.friction > Real(0))) continue;
      const V slip = slip_of(row, parting);
      sum += row.friction * press * length(slip) + dot(slip, row.impulse.rub);
      if (!(row.resistance > Real(0))) continue;
      const S rolling = rolling_of(row);
      sum += row.resistance * press * length(rolling) + dot(rolling, row.impulse.roll);
    }
    return sum + approaches / (2 * least_inverse);
  }

  [[nodiscard]] Real fastest() const {
    Real square(0);
    for (const Moving& one : movers_) square = std::max(square, squared(one.v));
    return std::sqrt(square);
  }

  [[nodiscard]] Moving& mover(std::size_t place) { return movers_[place]; }
  [[nodiscard]] const Moving& mover(std::size_t place) const { return movers_[place]; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  [[nodiscard]] Row& row(std::size_t k) { return rows_[k]; }
  /// Restores an earlier state of the movers and sets all impulses to 0.
  void restore(const std::vector<Moving>& movers) {
    movers_ = movers;
    for (Row& row : rows_) row.impulse = {};
  }
  /// Restores the state of the movers before any impulse, and applies these, of the rows.
  void apply(const std::vector<Moving>& free, std::span<const Impulse> impulses) {
    movers_ = free;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      rows_[k].impulse = impulses[k];
      push(rows_[k], impulses[k]);
    }
  }
  [[nodiscard]] const std::vector<Moving>& movers() const { return movers_; }
  /// Twice the kinetic energy.
  [[nodiscard]] Real energy() const {
    Real sum(0);
    for (const Moving& one : movers_)
      if (one.inverse_mass > Real(0)) sum += squared(one.v) / one.inverse_mass + squared(one.spin) / over(one);
    return sum;
  }

 private:
  [[nodiscard]] static Real over(const Moving& one) { return one.radius > Real(0) ? one.turn / one.radius : Real(0); }
  [[nodiscard]] static S across_normal(const S& spin, const V& normal) {
    if constexpr (Dim == 3) {
      return spin - normal * dot(spin, normal);
    } else {
      return spin;
    }
  }

  void push(const Row& row, const Impulse& by) {
    Moving &a = movers_[row.a], &b = movers_[row.b];
    const V impulse = row.normal * by.press + by.rub;
    a.v -= impulse * a.inverse_mass;
    b.v += impulse * b.inverse_mass;
    if (!(row.friction > Real(0))) return;
    const S twist = moment(row.normal, by.rub);
    a.spin -= twist * a.turn;
    b.spin -= twist * b.turn;
    if (!(row.resistance > Real(0))) return;
    a.spin -= by.roll * (row.arm * over(a));
    b.spin += by.roll * (row.arm * over(b));
  }
  [[nodiscard]] static Real square(const Real& value) { return value * value; }
  /// By how much the speed of separation is above the least one.
  [[nodiscard]] static Real surplus(const Row& row, const Real& parting) {
    return parting - row.least + row.compliance * row.impulse.press;
  }
  [[nodiscard]] V slip_of(const Row& row, const Real& parting) const {
    const Moving &a = movers_[row.a], &b = movers_[row.b];
    return b.v - a.v - (row.normal * parting + turning(S(a.spin * a.radius + b.spin * b.radius), row.normal));
  }
  [[nodiscard]] S rolling_of(const Row& row) const {
    return across_normal(S((movers_[row.b].spin - movers_[row.a].spin) * row.arm), row.normal);
  }
  /// Corrects the total impulse of one contact for those of all others. Returns the square of the greatest change of
  /// speed.
  [[nodiscard]] Real set_right(Row& row) {
    const Real parting = dot(V(movers_[row.b].v - movers_[row.a].v), row.normal);
    Impulse change;
    const Real press =
        row.has_known_press
            ? row.impulse.press
            : std::max(Real(0), Real(row.impulse.press - surplus(row, parting) / (row.of_normal + row.compliance)));
    if (press == Real(0) && row.impulse.press == Real(0)) return Real(0);  // as for most pairs: near, but apart
    change.press = press - row.impulse.press;
    row.impulse.press = press;
    Real greatest = square(change.press * row.of_normal);
    if (row.friction > Real(0)) {
      const V slip = slip_of(row, parting);
      const V rub = limited(V(row.impulse.rub - slip * (1 / row.of_slip)), Real(row.friction * press));
      change.rub = rub - row.impulse.rub;
      row.impulse.rub = rub;
      greatest = std::max(greatest, Real(squared(change.rub) * square(row.of_slip)));
      if (row.resistance > Real(0)) {
        const S rolling = rolling_of(row);
        const S roll = limited(S(row.impulse.roll - rolling * (1 / row.of_roll)), Real(row.resistance * press));
        change.roll = roll - row.impulse.roll;
        row.impulse.roll = roll;
        greatest = std::max(greatest, Real(squared(change.roll) * square(row.of_roll)));
      }
    }
    push(row, change);
    return greatest;
  }
  template <class W>
  [[nodiscard]] static W limited(const W& load, const Real& most) {
    const Real size = length(load);
    return size > most ? load * (most / size) : load;
  }

  /// Extrapolates along the search direction by the ratio of the changes in the last two sweeps to those in the two
  /// before. Returns the size of the changes.
  [[nodiscard]] Real go_on(const Real& size_before) {
    Real size(0);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      const Impulse change = row.impulse - before_[r];
      size += change.press * change.press * row.of_normal + squared(change.rub) * row.of_slip;
      if (row.resistance > Real(0)) size += squared(change.roll) * row.of_roll;
    }
    const bool is_new =
        !(size <= size_before && size_before > Real(0) && size_before < std::numeric_limits<Real>::max());
    const Real factor = is_new ? Real(0) : size / size_before;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      Row& row = rows_[r];
      const Impulse change = row.impulse - before_[r];
      if (is_new) {
        way_[r] = size_before > Real(0) ? Impulse{} : change;
        continue;
      }
      const Impulse farther = way_[r] * factor;
      push(row, farther);
      row.impulse = row.impulse + farther;
      way_[r] = farther + change;
    }
    return size;
  }

  std::vector<Moving> movers_{1};  // place 0 belongs to walls, which no impulse moves
  std::vector<Row> rows_;
  std::vector<Impulse> before_, way_;  // of rows: before the last two sweeps; search direction
};

extern template class ProjectedGaussSeidel<float, 2>;
extern template class ProjectedGaussSeidel<float, 3>;
extern template class ProjectedGaussSeidel<double, 2>;
extern template class ProjectedGaussSeidel<double, 3>;

}  // namespace continuo
