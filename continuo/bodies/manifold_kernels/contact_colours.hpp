// Colours of contacts: two contacts of a colour share no body that moves, so that they can be solved at once.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace continuo {

/// A contact as a colouring sees it; a body that never moves is `none`.
struct ColouredContact {
  static constexpr std::uint32_t none = 0xffffffff;
  std::uint32_t a = none, b = none;
  std::uint8_t points = 0;  // contacts with more of them come first within their colour
  friend bool operator==(const ColouredContact&, const ColouredContact&) = default;
};

/// Contacts in the order of their colours. Those that have one body that never moves come last, so that what holds a
/// heap is solved after it. The colours depend on the order of the contacts alone.
class ContactColours {
 public:
  static constexpr std::size_t most = 64;
  /// Contacts of the last colour may share bodies: those for which the others were not enough.
  [[nodiscard]] static bool is_shared(std::size_t colour) { return colour == most - 1; }

  /// Returns false where they are the contacts of the last call, as in a heap at rest: then the colours are the same.
  bool find(std::span<const ColouredContact> contacts, std::size_t bodies) {
    if (std::ranges::equal(contacts, contacts_)) return false;
    contacts_.assign(contacts.begin(), contacts.end());
    used_.assign(bodies, 0);
    colour_.resize(contacts.size());
    first_ = {};
    for (const bool is_last : {false, true})
      for (std::size_t k = 0; k < contacts.size(); ++k)
        if (has_fixed(contacts[k]) == is_last) colour_[k] = choose(contacts[k]);
    sort(contacts);
    return true;
  }
  /// The contacts of a colour, with those of most points first.
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t colour) const {
    return std::span(order_).subspan(first_[colour], first_[colour + 1] - first_[colour]);
  }
  /// How many colours have contacts.
  [[nodiscard]] std::size_t size() const {
    std::size_t count = 0;
    for (std::size_t c = 0; c < most; ++c) count += first_[c + 1] > first_[c] ? 1 : 0;
    return count;
  }

 private:
  static constexpr std::size_t most_points = 4;

  [[nodiscard]] static bool has_fixed(const ColouredContact& contact) {
    return contact.a == ColouredContact::none || contact.b == ColouredContact::none;
  }
  [[nodiscard]] std::uint8_t choose(const ColouredContact& contact) {
    std::uint64_t used = 0;
    if (contact.a != ColouredContact::none) used |= used_[contact.a];
    if (contact.b != ColouredContact::none) used |= used_[contact.b];
    const auto colour = static_cast<std::uint8_t>(std::min<int>(std::countr_one(used), most - 1));
    const std::uint64_t bit = std::uint64_t{1} << colour;
    if (contact.a != ColouredContact::none) used_[contact.a] |= bit;
    if (contact.b != ColouredContact::none) used_[contact.b] |= bit;
    return colour;
  }
  void sort(std::span<const ColouredContact> contacts) {
    std::array<std::uint32_t, most * most_points + 1> next{};
    const auto place = [&](std::size_t k) {
      return colour_[k] * most_points + (most_points - std::min<std::size_t>(contacts[k].points, most_points));
    };
    for (std::size_t k = 0; k < contacts.size(); ++k) ++next[std::min(place(k), next.size() - 2) + 1];
    for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
    for (std::size_t c = 0; c <= most; ++c) first_[c] = next[c * most_points];
    order_.resize(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k)
      order_[next[std::min(place(k), next.size() - 2)]++] = static_cast<std::uint32_t>(k);
  }

  std::vector<ColouredContact> contacts_;
  std::vector<std::uint64_t> used_;   // colours of each body
  std::vector<std::uint8_t> colour_;  // of each contact
  std::vector<std::uint32_t> order_;
  std::array<std::uint32_t, most + 1> first_{};
};

/// The lanes of registers that coloured contacts are solved in: batches of one colour each, one after the other. Those
/// of the shared colour have a batch each.
class LanesOfColours {
 public:
  static constexpr std::uint32_t none = 0xffffffff;

  void find(const ContactColours& colours, std::size_t lanes) {
    std::size_t batches = 0;
    for (std::size_t c = 0; c < ContactColours::most; ++c) {
      first_[c] = batches;
      const std::size_t count = colours.of(c).size();
      batches += ContactColours::is_shared(c) ? count : (count + lanes - 1) / lanes;
    }
    first_[ContactColours::most] = batches;
    in_lane_.assign(batches * lanes, none);
    for (std::size_t c = 0; c < ContactColours::most; ++c) {
      const auto members = colours.of(c);
      for (std::size_t i = 0; i < members.size(); ++i)
        in_lane_[first_[c] * lanes + (ContactColours::is_shared(c) ? i * lanes : i)] = members[i];
    }
  }
  /// The first batch of a colour; of the number of colours, that of batches.
  [[nodiscard]] std::size_t first(std::size_t colour) const { return first_[colour]; }
  [[nodiscard]] std::size_t batches() const { return first_[ContactColours::most]; }
  /// Which contact is in each lane, or none; batch after batch.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return in_lane_; }

 private:
  std::array<std::size_t, ContactColours::most + 1> first_{};
  std::vector<std::uint32_t> in_lane_;
};

}  // namespace continuo
