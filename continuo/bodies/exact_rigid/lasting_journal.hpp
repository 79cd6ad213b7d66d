// The lasting contacts of the exact motion of rigid bodies, with their impulses so far, for the log of contacts.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/exact_rigid/near_parts.hpp>

namespace continuo {

template <class Real, int Dim>
class LastingJournal {
 public:
  struct Lasting {
    NearPair pair{};
    Real impulse{};
    template <class Archive>
    void transfer(Archive& archive) {
      archive(pair), archive(impulse);
    }
  };

  void add_impulse(const NearPair& pair, const Real& impulse) {
    if (Lasting* const one = find(pair)) one->impulse += impulse;
  }
  /// From now on the contacts of the pairs for which `is_concerned` is true are these, sorted. Calls
  /// `changed(pair, change, impulse)` for those that begin and those that end.
  template <class IsConcerned, class Changed>
  void update(std::span<const NearPair> now, IsConcerned&& is_concerned, Changed&& changed) {
    std::erase_if(all_, [&](const Lasting& one) {
      const bool ends = is_concerned(one.pair) && !std::ranges::binary_search(now, one.pair);
      if (ends) changed(one.pair, ContactChange::end, one.impulse);
      return ends;
    });
    for (const NearPair& pair : now) {
      if (find(pair)) continue;
      changed(pair, ContactChange::begin, Real(0));
      all_.insert(std::ranges::upper_bound(all_, pair, {}, &Lasting::pair), {pair, Real(0)});
    }
  }
  /// Whether all pairs can be of a world with so many parts and walls.
  [[nodiscard]] bool fits(std::size_t parts, std::size_t walls) const {
    return std::ranges::is_sorted(all_, {}, &Lasting::pair) && std::ranges::all_of(all_, [&](const Lasting& one) {
             return one.pair.b < parts && one.pair.a < (one.pair.is_wall ? walls : parts);
           });
  }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(all_);
  }

 private:
  [[nodiscard]] Lasting* find(const NearPair& pair) {
    const auto at = std::ranges::lower_bound(all_, pair, {}, &Lasting::pair);
    return at != all_.end() && at->pair == pair ? &*at : nullptr;
  }
  std::vector<Lasting> all_;  // sorted
};

}  // namespace continuo
