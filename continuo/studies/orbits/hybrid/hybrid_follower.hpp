// Along a branch of closed orbits through events, from its start to where it ends. Internal to hybrid_continuation.
#pragma once
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <continuo/studies/orbits/hybrid/hybrid_branch.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>

namespace continuo::studies::detail {

class HybridFollower {
  using Place = HybridPlace;

 public:
  HybridFollower(const HybridContinuationOptions& options, std::string name, HybridBranchSteps& steps)
      : options_(options),
        name_(std::move(name)),
        steps_(steps),
        range_(options.high - options.low),
        covered_(options.low, options.high, options.progress) {}

  [[nodiscard]] OrbitBranch from_orbit(const model::Instant& start, double period, double constant);
  [[nodiscard]] OrbitBranch from_mark(const OrbitMark& start);

 private:
  [[nodiscard]] OrbitBranch both_ways(Place first);
  [[nodiscard]] OrbitBranchEnd followed(OrbitBranch& branch, const Place& from, double direction);
  [[nodiscard]] std::optional<Place> beside(const model::Instant& start, const Eigen::VectorXd& z,
                                            const Eigen::VectorXd& other, double direction);
  /// Whether the orbits go on as they were, though other events pass: some do nothing.
  [[nodiscard]] static bool goes_on(const Place& a, const Place& b);
  [[nodiscard]] OrbitBranchEnd lost(const Place& here) const;
  [[nodiscard]] OrbitBranchEnd at_bound(OrbitBranch& branch, const Place& a, const Place& b);
  [[nodiscard]] std::optional<OrbitBranchEnd> turns_become_one(OrbitBranch& branch, const Place& here,
                                                               const Place& next, double step);
  /// What the last points say: the period grows without bound, or neighbours part too fast to go on.
  [[nodiscard]] std::optional<OrbitBranchEnd> ending_of(std::span<const OrbitPoint> way, const Place& here);
  [[nodiscard]] bool comes_back(const Place& here, const Place& origin, double step) const;
  /// What lies between two neighbours.
  void mark(OrbitBranch& branch, const Place& a, const Place& b, double step);
  /// `at`: so far from `before` the place was found.
  void add(OrbitBranch& branch, OrbitBifurcation kind, const Place& before, Place place, double at);
  [[nodiscard]] bool is_interrupted() const { return options_.interrupt && options_.interrupt->load(); }
  [[nodiscard]] bool inside(const Place& place) const {
    return place.point.constant >= options_.low && place.point.constant <= options_.high;
  }

  const HybridContinuationOptions& options_;
  std::string name_;
  HybridBranchSteps& steps_;
  double range_;
  bool doubled_ = false;  // from a period doubling: twice round
  CoveredRange covered_;
};

}  // namespace continuo::studies::detail
