// What ends a flight under general forces: two that come to touch, a contact that lets go or begins to slip, or a list
// of candidates that is good no more.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <continuo/bodies/forced_flow.hpp>
#include <continuo/solve/event.hpp>

namespace continuo {

/// Two that can meet before the candidates are listed anew.
struct Candidate {
  enum class Watched { gap, approach, nothing };  // approach: where they overlapped at the start; nothing: held
  Touching pair{};
  Watched watched = Watched::gap;
};

/// Guards that fall through 0, each of which stops the flight: of every candidate; of every contact that is held three;
/// and last, how far bodies are from where the list ends.
template <class Real, int Dim>
class ForcedWatch {
 public:
  using V = Vector<Real, Dim>;
  using X = std::vector<Real>;

  /// A gap is watched for falling below -`allowance`.
  ForcedWatch(const World<Real, Dim>& world, const std::vector<Candidate>& candidates, const Real& allowance,
              const Real& reach, std::size_t held)
      : world_(&world),
        candidates_(&candidates),
        allowance_(allowance),
        reach_(reach),
        held_(held),
        begin_(world.position),
        x_(begin_),
        v_(begin_) {}

  std::size_t size() const { return candidates_->size() + HeldContacts<Real, Dim>::guards * held_ + 1; }
  std::string_view name(std::size_t i) const { return i + 1 < size() ? "contact" : "list"; }
  Direction direction(std::size_t) const { return Direction::falls; }
  bool is_guard(std::size_t) const { return true; }
  template <class System>
  bool active(const System&, std::size_t) const {
    return true;
  }
  Real next_time(std::size_t, Real, bool) const { return std::numeric_limits<Real>::infinity(); }

  void guards(ForcedFlow<Real, Dim>& flow, Real t, const X& state, std::span<Real> values) {
    ForcedFlow<Real, Dim>::unpack(state, x_, v_);
    std::size_t next = 0;
    for (const Candidate& candidate : *candidates_) values[next++] = guard(candidate);
    if (held_ > 0) {
      rate_.resize(state.size());
      flow(t, state, rate_);
    }
    for (std::size_t k = 0; k < held_; ++k)
      for (std::size_t which = 0; which < HeldContacts<Real, Dim>::guards; ++which)
        values[next++] = flow.held().guard(k, which);
    Real farthest(0);
    for (std::size_t i = 0; i < x_.size(); ++i) farthest = std::max(farthest, squared(V(x_[i] - begin_[i])));
    values[next] = reach_ * reach_ - farthest;
  }
  template <class System>
  EventResponse fire(System&, std::span<const std::size_t>, Real, const X&, X&) {
    return {.stop = true};
  }

 private:
  Real guard(const Candidate& at) const {
    if (at.watched == Candidate::Watched::nothing) return Real(1);
    const bool by_speed = at.watched == Candidate::Watched::approach;
    const auto [a, b, w] = at.pair;
    if (at.pair.with_wall()) {
      const Wall<Real, Dim> wall = facing(world_->walls()[w], begin_[a]);
      if (by_speed) return dot(wall.normal, v_[a]);
      return dot(wall.normal, x_[a]) - wall.offset - world_->radius[a] + allowance_;
    }
    const V apart = x_[b] - x_[a];
    if (by_speed) return dot(apart, V(v_[b] - v_[a]));
    return length(apart) - world_->radius[a] - world_->radius[b] + allowance_;
  }

  const World<Real, Dim>* world_;
  const std::vector<Candidate>* candidates_;
  Real allowance_, reach_;
  std::size_t held_;
  std::vector<V> begin_, x_, v_;
  X rate_;
};

}  // namespace continuo
