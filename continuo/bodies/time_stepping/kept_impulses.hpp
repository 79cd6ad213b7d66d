// The impulses of contacts from one step to the next, and of contacts between bodies that sleep until these wake: a
// pile that began without them would sink, and then ring for a second.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/time_stepping/contact_rows.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

inline constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// The impulses of a contact between steps.
template <class Real, int Dim>
struct KeptImpulse {
  std::uint32_t other = 0;
  Real normal{};
  Vector<Real, Dim> friction{};  // on `other`

  template <class Archive>
  void transfer(Archive& archive) {
    archive(other), archive(normal), archive(friction);
  }
};
template <class Real, int Dim>
struct KeptImpulses : Rows<KeptImpulse<Real, Dim>> {
  using Base = Rows<KeptImpulse<Real, Dim>>;
  std::vector<Spin<Real, Dim>> rolling{};  // of the same contacts; empty where nothing resists rolling

  template <class Archive>
  void transfer(Archive& archive) {
    archive(this->first), archive(this->entries), archive(rolling);
  }
  /// Whether these can be rows of so many bodies, with partners below `others`.
  [[nodiscard]] bool fits(std::size_t bodies, std::size_t others) const {
    const auto& starts = this->first;
    bool fits = !starts.empty() && starts.front() == 0 && starts.back() == this->entries.size() &&
                starts.size() <= bodies + 1 && std::ranges::is_sorted(starts) &&
                (rolling.empty() || rolling.size() == this->entries.size());
    for (const auto& entry : this->entries) fits = fits && entry.other < others;
    return fits;
  }
  [[nodiscard]] std::size_t find(std::uint32_t k, std::uint32_t other) const {
    if (k < this->rows())
      for (std::size_t i = this->first[k]; i < this->first[k + 1]; ++i)
        if (this->entries[i].other == other) return i;
    return nowhere;
  }
  void clear() {
    Base::clear();
    rolling.clear();
  }
  void append(const KeptImpulses& more) {
    Base::append(more);
    rolling.insert(rolling.end(), more.rolling.begin(), more.rolling.end());
  }
  [[nodiscard]] std::size_t memory() const { return Base::memory() + rolling.capacity() * sizeof(Spin<Real, Dim>); }
};

/// The impulses of a contact between bodies that do not move, by their numbers in the world; walls have numbers behind
/// those of all bodies.
template <class Real, int Dim>
struct RestingImpulse {
  std::uint32_t a = 0;
  KeptImpulse<Real, Dim> on_b{};
  Spin<Real, Dim> rolling{};
};

/// Moves the impulses of contacts without a moving body from `kept` to `resting`, and those of the others back. `kept`
/// has places instead of numbers: number_at[place] is the body there.
template <class Real, int Dim, class Moves>
void exchange_resting(std::span<const std::uint32_t> number_at, const Moves& moves, KeptImpulses<Real, Dim>& kept,
                      std::vector<RestingImpulse<Real, Dim>>& resting) {
  const auto bodies = static_cast<std::uint32_t>(number_at.size());
  const auto number = [&](std::uint32_t place) { return place < bodies ? number_at[place] : place; };
  bool resist_rolling = !kept.rolling.empty();
  for (const auto& contact : resting) resist_rolling = resist_rolling || contact.rolling != Spin<Real, Dim>{};
  std::vector<RestingImpulse<Real, Dim>> all = std::move(resting);
  resting.clear();
  for (std::uint32_t k = 0; k < kept.rows(); ++k)
    for (std::size_t i = kept.first[k]; i < kept.first[k + 1]; ++i) {
      const auto& of = kept.entries[i];
      all.push_back({number(k),
                     {number(of.other), of.normal, of.friction},
                     kept.rolling.empty() ? Spin<Real, Dim>{} : kept.rolling[i]});
    }
  std::vector<std::vector<RestingImpulse<Real, Dim>>> rows(bodies);
  std::vector<std::uint32_t> place_of(bodies);
  for (std::uint32_t k = 0; k < bodies; ++k) place_of[number_at[k]] = k;
  for (const RestingImpulse<Real, Dim>& contact : all) {
    const std::uint32_t b = contact.on_b.other;
    if (moves(contact.a) || (b < bodies && moves(b))) {
      rows[place_of[contact.a]].push_back(contact);
      if (b < bodies) rows[place_of[contact.a]].back().on_b.other = place_of[b];
    } else {
      resting.push_back(contact);
    }
  }
  kept.clear();
  for (const auto& row : rows) {
    for (const RestingImpulse<Real, Dim>& contact : row) {
      kept.entries.push_back(contact.on_b);
      if (resist_rolling) kept.rolling.push_back(contact.rolling);
    }
    kept.end_row();
  }
}

}  // namespace continuo
