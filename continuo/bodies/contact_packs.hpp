// Contacts in packs of as many as there are lanes, by colour.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/lane_bodies.hpp>

namespace continuo {

/// As many contacts as there are lanes. Of one of a body and a wall, b is the wall's stand-in.
template <class Real, int Dim>
struct ContactPack {
  using L = StoredLanes<Real>;
  LaneIndices<Real> a{}, b{};
  Vector<L, Dim> normal{};  // from a to b
  L separation{}, normal_impulse{};
  Vector<L, Dim> friction_impulse{};
};
/// What few worlds have: several materials, bounces, rolling resistance.
template <class Real, int Dim>
struct RarePack {
  using L = StoredLanes<Real>;
  L friction{}, restitution{}, rolling_resistance{};
  Spin<L, Dim> rolling_impulse{};
};

/// The contacts of one kind, colour by colour: packs first[c] ... first[c + 1] - 1.
template <class Real, int Dim>
struct ColouredPacks {
  static constexpr std::size_t width = lanes_at_once<Real>;
  static constexpr std::size_t most_colours = 64;

  std::vector<ContactPack<Real, Dim>> packs{};
  std::vector<RarePack<Real, Dim>> rare{};  // empty where all are alike, and neither bounce nor resist
  std::array<std::uint32_t, most_colours + 1> first{};
  std::array<std::uint32_t, most_colours> count{};  // of contacts
  std::size_t colours = 0;

  /// What more than 63 neighbours leave over goes to the last colour, one contact a pack: these do share bodies, and
  /// are for one after the other.
  static bool is_shared(std::size_t colour) { return colour == most_colours - 1; }

  RarePack<Real, Dim>* rare_of(std::size_t pack) { return rare.empty() ? nullptr : &rare[pack]; }

  /// Room for `count`; lanes that no contact will fill have stand-ins.
  void make_room(const SolverBodies<Real, Dim>& bodies, bool has_rare) {
    colours = 0;
    for (std::size_t c = 0; c < most_colours; ++c) {
      const std::uint32_t lanes = static_cast<std::uint32_t>(width);
      first[c + 1] = first[c] + (is_shared(c) ? count[c] : (count[c] + lanes - 1) / lanes);
      if (count[c] > 0) colours = c + 1;
    }
    const std::size_t total = first[most_colours];
    if (packs.capacity() < total) {
      packs = {};  // nothing in them is needed, and half as much again would be a good part of all memory
      packs.reserve(total + total / 64);
    }
    packs.resize(total);
    rare.resize(has_rare ? total : 0);
    for (std::size_t c = 0; c < colours; ++c) {
      if (is_shared(c))
        for (std::size_t p = first[c]; p < first[c + 1]; ++p) clear(p, bodies);
      else if (count[c] % width != 0)
        clear(first[c + 1] - 1, bodies);
    }
  }

 private:
  void clear(std::size_t pack, const SolverBodies<Real, Dim>& bodies) {
    packs[pack] = {};
    for (std::size_t lane = 0; lane < width; ++lane) {
      packs[pack].a[lane] = bodies.stand_in(2 * lane);
      packs[pack].b[lane] = bodies.stand_in(2 * lane + 1);
    }
    if (!rare.empty()) rare[pack] = {};
  }
};

}  // namespace continuo
