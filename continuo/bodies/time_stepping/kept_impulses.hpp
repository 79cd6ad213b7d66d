// The impulses of contacts from one step to the next.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <continuo/bodies/support/vector.hpp>
#include <continuo/bodies/time_stepping/contact_rows.hpp>

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

}  // namespace continuo
