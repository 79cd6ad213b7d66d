// The events that end a flight under general forces: two bodies begin to touch, a contact opens or begins to slip, or a
// body leaves the range for which the candidates were listed.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <continuo/bodies/constrained/constrained_system.hpp>
#include <continuo/solve/event.hpp>

namespace continuo {

/// A pair that can begin to touch before the candidates are listed again.
template <class Real>
struct Candidate {
  enum class Watched { gap, approach, nothing };  // approach: the two overlap and separate; nothing: in contact
  Touching pair{};
  Watched watched = Watched::gap;
  Real lowest{};  // the event is where the gap falls to this
};

/// The guards of a flight: one for every candidate, three for every persistent contact, and last one for the range of
/// the list of candidates. The flight stops where a guard falls through 0.
template <class Real, int Dim>
class ConstrainedEvents {
 public:
  using V = Vector<Real, Dim>;
  using X = std::vector<Real>;

  ConstrainedEvents(const World<Real, Dim>& world, const std::vector<Candidate<Real>>& candidates, const Real& reach,
                    std::size_t held)
      : world_(&world),
        candidates_(&candidates),
        reach_(reach),
        held_(held),
        begin_(world.position),
        x_(begin_),
        v_(begin_) {}

  [[nodiscard]] std::size_t size() const {
    return candidates_->size() + PersistentContacts<Real, Dim>::guards * held_ + 1;
  }
  [[nodiscard]] std::string_view name(std::size_t i) const { return i + 1 < size() ? "contact" : "list"; }
  [[nodiscard]] Direction direction(std::size_t) const { return Direction::falls; }
  [[nodiscard]] bool is_guard(std::size_t) const { return true; }
  [[nodiscard]] bool can_restart(std::size_t) const { return true; }  // each stops the flight
  [[nodiscard]] bool can_assign(std::size_t) const { return false; }
  template <class System>
  [[nodiscard]] bool active(const System&, std::size_t) const {
    return true;
  }
  [[nodiscard]] Real next_time(std::size_t, Real, bool) const { return std::numeric_limits<Real>::infinity(); }

  /// The values are cached by instant: the search for the root of each guard evaluates all guards.
  void guards(ConstrainedSystem<Real, Dim>& flow, Real t, const X& state, std::span<Real> values) {
    const auto same = [&](const Known& one) { return one.t == t && one.state == state; };
    if (const auto known = std::ranges::find_if(known_, same); known != known_.end()) {
      std::ranges::copy(known->values, values.begin());
      return;
    }
    find_guards(flow, t, state, values);
    if (held_ == 0) return;  // the guards of candidates are cheap
    if (known_.size() == most_known) known_.clear();
    known_.push_back({t, state, {values.begin(), values.end()}});
  }
  template <class System>
  [[nodiscard]] EventResponse fire(System&, std::size_t, Real, const X&, X&) {
    return {.stop = true};
  }

 private:
  static constexpr std::size_t most_known = 256;
  struct Known {
    Real t;
    X state;
    std::vector<Real> values;
  };

  void find_guards(ConstrainedSystem<Real, Dim>& flow, Real t, const X& state, std::span<Real> values) {
    ConstrainedSystem<Real, Dim>::unpack(state, x_, v_);
    std::size_t next = 0;
    for (const Candidate<Real>& candidate : *candidates_) values[next++] = guard(candidate);
    if (held_ > 0) {
      rate_.resize(state.size());
      flow(t, state, rate_);
    }
    for (std::size_t k = 0; k < held_; ++k)
      for (std::size_t which = 0; which < PersistentContacts<Real, Dim>::guards; ++which)
        values[next++] = flow.held().guard(k, which);
    Real farthest(0);
    for (std::size_t i = 0; i < x_.size(); ++i) farthest = std::max(farthest, squared(V(x_[i] - begin_[i])));
    values[next] = reach_ * reach_ - farthest;
  }
  [[nodiscard]] Real guard(const Candidate<Real>& at) const {
    if (at.watched == Candidate<Real>::Watched::nothing) return Real(1);
    const auto [a, b, w] = at.pair;
    Real gap, parting;
    if (at.pair.with_wall()) {
      const Wall<Real, Dim> wall = facing(world_->walls()[w], begin_[a]);
      gap = dot(wall.normal, x_[a]) - wall.offset - world_->radius[a];
      parting = dot(wall.normal, v_[a]);
    } else {
      const V apart = x_[b] - x_[a];
      const Real distance = length(apart);
      gap = distance - world_->radius[a] - world_->radius[b];
      parting = distance > Real(0) ? dot(apart, V(v_[b] - v_[a])) / distance : Real(0);
    }
    return at.watched == Candidate<Real>::Watched::approach ? parting : gap - at.lowest;
  }

  const World<Real, Dim>* world_;
  const std::vector<Candidate<Real>>* candidates_;
  Real reach_;
  std::size_t held_;
  std::vector<V> begin_, x_, v_;
  X rate_;
  std::vector<Known> known_;
};

}  // namespace continuo
