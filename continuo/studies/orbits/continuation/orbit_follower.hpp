// Along a branch of closed orbits, from its start to where it ends. Internal to orbit_continuation: the starts are in
// orbit_starts.cpp, what says that a branch ends in orbit_endings.cpp.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <continuo/studies/orbit_continuation.hpp>
#include <continuo/studies/orbits/continuation/orbit_branch.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>

namespace continuo::studies::detail {

class OrbitFollower {
  using Vector = std::vector<double>;
  using Place = OrbitPlace;

 public:
  OrbitFollower(const ParametricSystem& system, const OrbitContinuationOptions& options)
      : system_(system),
        options_(options),
        steps_(system, options),
        range_(options.high - options.low),
        covered_(options.low, options.high, options.progress) {}

  /// `orbit`: its state at a part of the period; `mesh` says where that changes fast.
  [[nodiscard]] OrbitBranch from_orbit(const std::function<Vector(double part)>& orbit, double period,
                                       const Vector& mesh);
  [[nodiscard]] OrbitBranch from_hopf(const HopfPoint& start);
  [[nodiscard]] OrbitBranch from_mark(const OrbitMark& start);

 private:
  static constexpr std::size_t most_refinements = 6;

  /// Until its mesh serves it, as far as that goes.
  void refine(Place& place);
  [[nodiscard]] double amplitude(const Place& place) { return length(steps_.deviations(place)); }
  [[nodiscard]] bool inside(const Place& place) const {
    return place.point.constant >= options_.low && place.point.constant <= options_.high;
  }
  [[nodiscard]] bool is_interrupted() const { return options_.interrupt && options_.interrupt->load(); }
  [[nodiscard]] OrbitBranchEnd ended(OrbitEnding ending, double constant, std::string reason) const {
    return {ending, constant, std::move(reason)};
  }
  [[nodiscard]] std::string name() const { return system_.constant_name(options_.constant); }
  [[nodiscard]] OrbitBranchEnd with_last(OrbitBranchEnd end, const Place& place);
  [[nodiscard]] OrbitBranchEnd followed(OrbitBranch& branch, const Place& from, double direction);
  /// Through the equilibrium, to the same orbits half a turn later.
  [[nodiscard]] bool vanishes(const Place& a, const Place& b);
  /// Where the orbits of a period doubling come back to those of half the period, at another doubling.
  [[nodiscard]] std::optional<OrbitBranchEnd> turns_become_one(OrbitBranch& branch, const Place& here,
                                                               const Place& next, double step);
  [[nodiscard]] OrbitBranchEnd at_bound(OrbitBranch& branch, const Place& a, const Place& b);
  [[nodiscard]] bool comes_back(const Place& here, const Place& origin, double step) const;
  /// What lies between two neighbours, narrowed down to where its test is zero.
  void mark(OrbitBranch& branch, const Place& a, const Place& b, double step);
  /// `before`: a place of the branch from which it was found, on the same mesh.
  void add(OrbitBranch& branch, OrbitBifurcation kind, const Place& before, Place place);
  /// The Hopf point to which so small an orbit belongs: as far away as the orbit is wide, and no more.
  [[nodiscard]] std::optional<HopfPoint> hopf_near(const Place& place);
  [[nodiscard]] OrbitBranchEnd lost(const Place& here);
  /// What the last points say. `here` is the last of them.
  [[nodiscard]] std::optional<OrbitBranchEnd> ending_of(std::span<const OrbitPoint> way, const Place& here);
  /// Whether the orbit is within a hundredth of its size of an equilibrium for a third of its period: near a homoclinic
  /// one all but a fixed time is spent there. Where the constant stands still and the period grows without that, as in
  /// the explosion of a canard, the branch goes on.
  [[nodiscard]] bool waits_at_an_equilibrium(const Place& place);

  const ParametricSystem& system_;
  const OrbitContinuationOptions& options_;
  OrbitBranchSteps steps_;
  bool doubled_ = false;          // from a period doubling: twice round
  double range_, amplitude_ = 0;  // the largest so far
  CoveredRange covered_;
};

}  // namespace continuo::studies::detail
