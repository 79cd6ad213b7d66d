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

/// Batches of contacts of one colour.
struct BatchRun {
  std::size_t first = 0, last = 0;  // up to the one before the last
  bool is_shared = false;           // whether contacts of different batches may share bodies
};

/// The lanes of registers that coloured contacts are solved in: batches of one colour each, one after the other. Those
/// of the shared colour have a batch each. Contacts may be of several groups, whose batches follow each other.
class LanesOfColours {
 public:
  static constexpr std::uint32_t none = 0xffffffff;

  /// Takes the colours of contacts for registers of so many lanes, and the group of each contact, which is below
  /// `groups`, unless all are of one.
  void find(const ContactColours& colours, std::size_t lanes, std::span<const std::uint32_t> group_of = {},
            std::size_t groups = 1) {
    next_.assign(groups * most, 0);
    const auto next = [&](std::size_t contact, std::size_t colour) -> std::size_t& {
      return next_[(groups > 1 ? group_of[contact] : 0) * most + colour];
    };
    for (std::size_t c = 0; c < most; ++c)
      for (const std::uint32_t k : colours.of(c)) ++next(k, c);
    runs_.clear(), first_run_.clear();
    std::size_t batches = 0;
    for (std::size_t group = 0; group < groups; ++group) {
      first_run_.push_back(runs_.size());
      for (std::size_t c = 0; c < most; ++c) {
        const bool is_shared = ContactColours::is_shared(c);
        std::size_t& of_colour = next_[group * most + c];
        if (of_colour == 0) continue;
        const std::size_t first = batches;
        batches += is_shared ? of_colour : (of_colour + lanes - 1) / lanes;
        of_colour = first * lanes;
        runs_.push_back({first, batches, is_shared});
      }
    }
    first_run_.push_back(runs_.size());
    in_lane_.assign(batches * lanes, none);
    for (std::size_t c = 0; c < most; ++c)
      for (const std::uint32_t k : colours.of(c)) {
        in_lane_[next(k, c)] = k;
        next(k, c) += ContactColours::is_shared(c) ? lanes : 1;
      }
  }
  /// The batches of a group, colour by colour.
  [[nodiscard]] std::span<const BatchRun> runs(std::size_t group) const {
    return std::span(runs_).subspan(first_run_[group], first_run_[group + 1] - first_run_[group]);
  }
  /// All batches of a group, or none.
  [[nodiscard]] BatchRun batches(std::size_t group) const {
    const auto all = runs(group);
    return all.empty() ? BatchRun{} : BatchRun{all.front().first, all.back().last};
  }
  [[nodiscard]] std::size_t batches() const { return runs_.empty() ? 0 : runs_.back().last; }
  /// Which contact is in each lane, or none; batch after batch.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return in_lane_; }

 private:
  static constexpr std::size_t most = ContactColours::most;

  std::vector<BatchRun> runs_;
  std::vector<std::size_t> first_run_{0, 0};  // of each group
  std::vector<std::size_t> next_;             // lane of each colour of each group, while contacts are put there
  std::vector<std::uint32_t> in_lane_;
};

}  // namespace continuo
