// continuo/bodies/contact_list.hpp
// Pairs that may touch before the list is made again: those nearer than `skin`. The list holds until a body has moved
// half of that (L. Verlet, Phys. Rev. 159 (1967) 98-103). Bodies are sorted by cells first, so that neighbours in space
// are neighbours in memory, and pairs are coloured: no two of a colour share a body, so that a colour can be solved in
// any order, by lanes or threads, to the same bits.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/solver_body.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// A pair or, with b = wall, a body and a wall. Impulses are those of the last substep, for the next to start from.
template <class Real, int Dim>
struct Contact {
  std::uint32_t a = 0, b = 0;
  Real normal_impulse{}, restitution{}, friction{}, rolling_resistance{};
  Real normal_mass{}, tangent_mass{};  // effective: what resists along the normal, across it
  Vector<Real, Dim> friction_impulse{};
  Spin<Real, Dim> rolling_impulse{};
};

/// Bodies sorted by cell, and the cells of a dense grid over all of them.
template <class Real, int Dim>
class SortedCells {
 public:
  using V = Vector<Real, Dim>;

  /// order[k] is the body at place k, cell by cell; `edge` is enlarged where the grid would need too many cells.
  void sort(std::span<const V> x, Real edge, std::vector<std::uint32_t>& order) {
    lower_ = upper_ = x.empty() ? V{} : x[0];
    for (const V& at : x)
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        lower_[axis] = std::min(lower_[axis], at[axis]);
        upper_[axis] = std::max(upper_[axis], at[axis]);
      }
    choose_counts(edge, x.size());
    std::vector<std::uint32_t> cell(x.size());
    first_.assign(total_ + 1, 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      cell[i] = static_cast<std::uint32_t>(number(coordinates(x[i])));
      ++first_[cell[i] + 1];
    }
    for (std::size_t c = 0; c < total_; ++c) first_[c + 1] += first_[c];
    order.resize(x.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < x.size(); ++i) order[next[cell[i]]++] = static_cast<std::uint32_t>(i);
  }

  /// visit(first, last) for the places of bodies whose cells meet the box from `lower` to `upper`, row by row.
  template <class Visit>
  void for_each_row(const V& lower, const V& upper, Visit&& visit) const {
    const auto from = coordinates(lower), to = coordinates(upper);
    auto at = from;
    for (;;) {
      auto end = at;
      end[0] = to[0];
      visit(first_[number(at)], first_[number(end) + 1]);
      std::size_t axis = 1;
      while (axis < at.size() && at[axis] == to[axis]) {
        at[axis] = from[axis];
        ++axis;
      }
      if (axis == at.size()) return;
      ++at[axis];
    }
  }

 private:
  using Coordinates = std::array<std::size_t, static_cast<std::size_t>(Dim)>;

  void choose_counts(Real edge, std::size_t bodies) {
    const double most = 8.0 * static_cast<double>(bodies) + 64;
    for (edge_ = edge;; edge_ *= 2) {
      double cells = 1;
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        const double along = std::floor(static_cast<double>((upper_[axis] - lower_[axis]) / edge_)) + 1;
        cells *= along;
        if (cells <= most) count_[axis] = static_cast<std::size_t>(along);
      }
      if (cells <= most) {
        total_ = static_cast<std::size_t>(cells);
        return;
      }
    }
  }
  Coordinates coordinates(const V& x) const {
    Coordinates at{};
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real cells = (x[axis] - lower_[axis]) / edge_;
      at[axis] = cells > Real(0) ? static_cast<std::size_t>(std::min(cells, static_cast<Real>(count_[axis] - 1))) : 0;
    }
    return at;
  }
  std::size_t number(const Coordinates& at) const {
    std::size_t n = 0;
    for (std::size_t axis = at.size(); axis-- > 0;) n = n * count_[axis] + at[axis];
    return n;
  }

  V lower_{}, upper_{};
  Real edge_ = Real(1);
  Coordinates count_{};
  std::size_t total_ = 0;
  std::vector<std::uint32_t> first_;
};

/// Contacts colour by colour: those of colour c are first[c] ... first[c + 1] - 1.
template <class Real, int Dim>
struct ColouredContacts {
  std::vector<Contact<Real, Dim>> contacts;
  std::vector<std::size_t> first{0};

  std::size_t colours() const { return first.size() - 1; }
};

/// Orders contacts by colour, greedily: the lowest colour that neither body has. Bodies that never move are shared
/// freely. What more than 63 neighbours leave over goes to a 64th colour, whose contacts do share bodies: that one is
/// for one after the other.
template <class Real, int Dim>
ColouredContacts<Real, Dim> coloured(std::vector<Contact<Real, Dim>> contacts, std::size_t bodies,
                                     std::span<const SolverBody<Real, Dim>> body) {
  constexpr std::size_t most = 64;
  std::vector<std::uint64_t> taken(bodies, 0);
  std::vector<std::uint8_t> colour(contacts.size());
  std::array<std::size_t, most + 1> count{};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto [a, b] = std::pair(contacts[i].a, contacts[i].b);
    std::uint64_t used = 0;
    if (body[a].inverse_mass > 0) used |= taken[a];
    if (body[b].inverse_mass > 0) used |= taken[b];
    const auto c = std::min<std::size_t>(static_cast<std::size_t>(std::countr_one(used)), most - 1);
    colour[i] = static_cast<std::uint8_t>(c);
    taken[a] |= std::uint64_t{1} << c;
    taken[b] |= std::uint64_t{1} << c;
    ++count[c + 1];
  }
  ColouredContacts<Real, Dim> result;
  std::size_t used_colours = most;
  while (used_colours > 0 && count[used_colours] == 0) --used_colours;
  for (std::size_t c = 0; c < most; ++c) count[c + 1] += count[c];
  result.first.assign(count.begin(), count.begin() + static_cast<std::ptrdiff_t>(used_colours) + 1);
  result.contacts.resize(contacts.size());
  auto next = count;
  for (std::size_t i = 0; i < contacts.size(); ++i) result.contacts[next[colour[i]]++] = contacts[i];
  return result;
}

}  // namespace continuo
