// Contacts in batches of as many as there are lanes, by group and colour.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_solver/contact_blocks.hpp>
#include <continuo/bodies/contact_solver/lane_bodies.hpp>

namespace continuo {

/// As many contacts as there are lanes. In a contact with a wall, b is the immovable body that represents the wall.
template <class Real, int Dim>
struct ContactBatch {
  using L = StoredLanes<Real>;
  LaneIndices<Real> a{}, b{};
  Vector<L, Dim> normal{};  // from a to b
  L separation{};
};
/// The values that every pass over contacts changes, separate from those that it only reads, and aligned to a cache
/// line.
template <class Real, int Dim>
struct alignas(64) BatchImpulses {
  using L = StoredLanes<Real>;
  L normal{};
  Vector<L, Dim> friction{};  // on b; in space its part along the normal resists spinning
};
/// Values that few worlds need: those of several materials, of restitution and of rolling resistance.
template <class Real, int Dim>
struct SpecialMaterialBatch {
  using L = StoredLanes<Real>;
  L friction{}, restitution{}, rolling_resistance{};
  Spin<L, Dim> rolling_impulse{};
};

/// The values that the batches of a step pass on to those of the next step.
template <class Real, int Dim>
struct StoredImpulses {
  LargeArray<BatchImpulses<Real, Dim>> impulses{};
  LargeArray<SpecialMaterialBatch<Real, Dim>> special{};  // empty where all are alike, and neither bounce nor resist

  [[nodiscard]] std::size_t memory() const {
    return impulses.capacity() * sizeof(impulses[0]) + special.capacity() * sizeof(special[0]);
  }
};

/// The contacts of one kind, group by group and colour by colour.
template <class Real, int Dim>
struct ColouredBatches : StoredImpulses<Real, Dim> {
  using StoredImpulses<Real, Dim>::impulses;
  using StoredImpulses<Real, Dim>::special;
  static constexpr std::size_t width = lanes_at_once<Real>;
  static constexpr std::size_t most_colours = 64;

  /// Batches first[c] ... first[c + 1] - 1 are those of a colour.
  struct Group {
    std::array<std::uint32_t, most_colours + 1> first{};
  };
  LargeArray<ContactBatch<Real, Dim>> batches{};
  StoredImpulses<Real, Dim> before{};  // those of the step before
  std::vector<std::uint64_t> bins{};   // of a batch's bodies, see contact_blocks.hpp
  std::vector<Group> groups{};
  std::vector<std::array<std::uint32_t, most_colours>> count{};  // contacts of each group and colour, before allocation
  std::size_t contacts = 0;
  std::size_t colours = 0;  // in the group with the most

  /// Contacts for which 63 colours are not enough get the last colour, with one contact per batch: such batches may
  /// share bodies, and are solved one after the other.
  [[nodiscard]] static bool is_shared(std::size_t colour) { return colour == most_colours - 1; }

  [[nodiscard]] SpecialMaterialBatch<Real, Dim>* special_material_of(std::size_t batch) {
    return special.empty() ? nullptr : &special[batch];
  }

  void clear(std::size_t number_of_groups) {
    groups.assign(number_of_groups, {});
    count.assign(number_of_groups, {});
  }
  /// Allocates batches for the contacts that were counted. Lanes without a contact get stand-ins.
  void make_room(const ContactBlocks& blocks, const SolverBodies<Real, Dim>& bodies, bool has_special_material) {
    std::uint32_t total = 0;
    colours = contacts = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (std::size_t c = 0; c < most_colours; ++c) {
        const std::uint32_t lanes = static_cast<std::uint32_t>(width), of_colour = count[g][c];
        groups[g].first[c] = total;
        total += is_shared(c) ? of_colour : (of_colour + lanes - 1) / lanes;
        contacts += of_colour;
        if (of_colour > 0) colours = std::max(colours, c + 1);
      }
      groups[g].first[most_colours] = total;
    }
    std::swap<StoredImpulses<Real, Dim>>(*this, before);
    // The old contents are not needed, and growth by half would be a good part of all memory.
    if (batches.capacity() < total) {
      batches = {}, bins = {};
      batches.reserve(total + total / 64), bins.reserve(batches.capacity());
    }
    if (impulses.capacity() < total) {
      impulses = {};
      impulses.reserve(total + total / 64);
    }
    batches.resize(total), impulses.resize(total);
    bins.assign(total, 0);
    special.resize(has_special_material ? total : 0);
    for (std::size_t g = 0; g < groups.size(); ++g) clear_spare(g, blocks.stand_ins_of(g), bodies);
    count = {};
  }
  [[nodiscard]] std::size_t memory() const {
    return StoredImpulses<Real, Dim>::memory() + before.memory() + batches.capacity() * sizeof(batches[0]) +
           bins.capacity() * sizeof(bins[0]) + groups.capacity() * sizeof(groups[0]);
  }

 private:
  void clear_spare(std::size_t g, std::size_t stand_ins, const SolverBodies<Real, Dim>& bodies) {
    const Group& group = groups[g];
    for (std::size_t c = 0; c < most_colours; ++c) {
      if (is_shared(c))
        for (std::size_t p = group.first[c]; p < group.first[c + 1]; ++p) clear(p, stand_ins, bodies);
      else if (count[g][c] % width != 0)
        clear(group.first[c + 1] - 1, stand_ins, bodies);
    }
  }
  void clear(std::size_t batch, std::size_t stand_ins, const SolverBodies<Real, Dim>& bodies) {
    batches[batch] = {}, impulses[batch] = {};
    for (std::size_t lane = 0; lane < width; ++lane) {
      batches[batch].a[lane] = bodies.stand_in(stand_ins, 2 * lane);
      batches[batch].b[lane] = bodies.stand_in(stand_ins, 2 * lane + 1);
    }
    if (!special.empty()) special[batch] = {};
  }
};

}  // namespace continuo
