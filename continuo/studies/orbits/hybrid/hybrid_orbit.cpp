// Finds a closed orbit through events from a motion, by Newton's method on the return.
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/orbits/hybrid/hybrid_orbit_start.hpp>
#include <continuo/studies/orbits/hybrid/neighbour_runs.hpp>
#include <continuo/studies/orbits/hybrid/orbit_trace.hpp>
#include <continuo/studies/orbits/hybrid/return_multipliers.hpp>
#include <continuo/studies/orbits/hybrid/shooting.hpp>
#include <continuo/studies/support/hybrid_run.hpp>
#include <continuo/studies/support/state_roles.hpp>

namespace continuo::studies {

namespace {

using detail::Shooting;
using detail::ShootingPoint;
using detail::Shot;

constexpr double rtol_of_flow = 1e-12;
constexpr double conserved_cut = 1e-7, rounding_cut = 1e-13;  // of the largest singular value
constexpr double on_circle = 1e-6;                            // a multiplier so near to it is on either side
constexpr double far_in_family = 1e-3, alike = 1e-6;          // in sizes of the motion
constexpr double at_once = 1e-8;                              // of the period

Eigen::Index at(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

HybridOrbit without_hybrid_orbit(std::string hint, Outcome<double> outcome = {}) {
  HybridOrbit none;
  none.outcome = std::move(outcome);
  if (none.outcome) none.outcome.ending = Ending::nonlinear_solve_failed;
  if (!hint.empty()) none.outcome.hint = std::move(hint);
  return none;
}

/// How large each state is on the way; one that stays where it is counts as it is, or as the others.
std::vector<double> sizes_of(const detail::OrbitStarts& starts) {
  std::vector<double> sizes;
  double largest = 0;
  for (std::size_t i = 0; i < starts.low.size(); ++i) {
    sizes.push_back(starts.high[i] - starts.low[i]);
    largest = std::max(largest, sizes.back());
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double place = std::max(std::abs(starts.low[i]), std::abs(starts.high[i]));
    if (sizes[i] > 1e-9 * place) continue;
    sizes[i] = place > 0 ? place : largest > 0 ? largest : 1;
  }
  return sizes;
}

/// One search from one return of the motion.
class OrbitSearch {
 public:
  OrbitSearch(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
              const HybridOrbitOptions& options, const detail::OrbitStarts& starts)
      : program_(program), options_(options), starts_(starts), sizes_(sizes_of(starts)) {
    exact_ = exactly(*program, experiment, rtol_of_flow);
    exact_.interrupt = options.interrupt;
    exact_.max_steps = model::usual_max_steps;
    exact_.atol.clear();
    for (const double size : sizes_) exact_.atol.push_back(rtol_of_flow * size);
    for (std::size_t i = 0; i < sizes_.size(); ++i)
      if (is_discrete(*program, i) && !is_unread(*program, i)) held_.push_back(i);
    flow_.emplace(program, options.parameters, exact_);
  }

  /// Nothing where there is no orbit near this return; then `status` says why.
  std::optional<HybridOrbit> from(const detail::OrbitStart& begin) {
    forced_ = begin.turns > 0;
    const ShootingPoint first{begin.start, begin.period};
    if (!choose_unknowns(first)) return std::nullopt;
    first_period_ = first.period;
    shooting_.emplace(*flow_, unknowns_, held_, sizes_, forced_, first);
    std::optional<ShootingPoint> found = shooting_->solve(first, conserved_cut, options_.tolerance);
    if (!found && !interrupted()) found = shooting_->solve(first, rounding_cut, options_.tolerance);
    if (!found) {
      status_ = shooting_->status();
      return std::nullopt;
    }
    HybridOrbit orbit;
    orbit.turns = begin.turns;
    shorten(*found, orbit);
    std::optional<Shot> shot = shooting_->shoot(*found);
    if (!shot) {
      status_ = shooting_->status();
      return std::nullopt;
    }
    orbit.family = is_family(*found, *shot);
    describe(*found, *shot, orbit);
    if (!orbit.outcome) {
      status_ = {.ending = Ending::cannot_continue, .message = orbit.outcome.hint};
      refused_ = true;
      return std::nullopt;
    }
    return orbit;
  }

  const Status& status() const { return status_; }
  /// There is an orbit, but no derivative.
  bool refused() const { return refused_; }
  bool interrupted() const { return shooting_ && shooting_->interrupted(); }

 private:
  /// All states in which neighbours may lie, but for sums that do not come back.
  bool choose_unknowns(const ShootingPoint& first) {
    unknowns_.clear();
    aside_.clear();
    const detail::FlowImage image = (*flow_)(first.start, first.period);
    if (!image.status) {
      status_ = image.status;
      return false;
    }
    for (const std::size_t i : directions_of(*program_)) {
      const bool comes_back = std::abs(image.x[i] - first.start.x[i]) <= 0.01 * sizes_[i];
      if (is_unread(*program_, i) && !comes_back) {
        aside_.push_back(i);
      } else {
        unknowns_.push_back(i);
      }
    }
    if (unknowns_.empty())
      status_ = {.ending = Ending::cannot_continue,
                 .message = "no state has neighbours: all of them are flags and counters"};
    return !unknowns_.empty();
  }

  /// What has come back may have done so several times.
  void shorten(ShootingPoint& point, HybridOrbit& orbit) {
    constexpr std::size_t most = 16;
    for (std::size_t parts = most; parts >= 2; --parts) {
      if (forced_ && (options_.turns > 0 || orbit.turns % parts != 0)) continue;
      ShootingPoint part = point;
      part.period /= static_cast<double>(parts);
      const std::optional<Shot> shot = shooting_->shoot(part);
      if (!shot || shot->residual.lpNorm<Eigen::Infinity>() > alike) continue;
      point = part;
      orbit.turns /= parts;
      return;
    }
  }

  /// Whether a step along what the equations leave open leads to another orbit.
  bool is_family(const ShootingPoint& point, const Shot& shot) {
    if (unknowns_.empty()) return false;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(shot.matrix, Eigen::ComputeFullV);
    const Eigen::VectorXd& singular = svd.singularValues();
    if (!(singular[singular.size() - 1] < conserved_cut * std::max(1.0, singular[0]))) return false;
    const ShootingPoint there = shooting_->moved(point, far_in_family * svd.matrixV().col(singular.size() - 1));
    const auto other = shooting_->solve(there, conserved_cut, options_.tolerance);
    return other && shooting_->distance(*other, point) > 0.3 * shooting_->distance(there, point);
  }

  Eigen::MatrixXd derivative(const Shot& shot) const {
    Eigen::MatrixXd m(at(unknowns_.size()), at(unknowns_.size()));
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      for (std::size_t l = 0; l < unknowns_.size(); ++l)
        m(at(k), at(l)) = shot.image.by_start[unknowns_[k] * flow_->size() + unknowns_[l]] * sizes_[unknowns_[l]] /
                          sizes_[unknowns_[k]];
    return m;
  }

  void describe(const ShootingPoint& point, const Shot& shot, HybridOrbit& orbit) {
    orbit.period = point.period;
    orbit.start = point.start;
    orbit.aside = aside_;
    orbit.found_nearby = starts_.nearby;
    orbit.events = shot.image.run.events;
    const Eigen::MatrixXd m = derivative(shot);
    if (!confirms({program_, exact_, unknowns_, held_, sizes_}, point, m)) {
      orbit = without_hybrid_orbit(unsupported_reason_confirmed(shot, point.period));
      return;
    }
    Eigen::VectorXd f(at(unknowns_.size()));
    const std::vector<double> rates = flow_->rates(point.start);
    for (std::size_t k = 0; k < unknowns_.size(); ++k) f[at(k)] = rates[unknowns_[k]] / sizes_[unknowns_[k]];
    if (!forced_ && !(f.norm() > 0)) {
      orbit = without_hybrid_orbit("the motion stands still between events: it has no period of its own");
      return;
    }
    orbit.multipliers =
        forced_ ? detail::multipliers_of_flow(m, orbit.family) : detail::multipliers_of_flow(m, f, orbit.family);
    if (orbit.multipliers.size() != unknowns_.size()) {
      orbit = without_hybrid_orbit("the multipliers were not found");
      return;
    }
    judge(orbit);
    differentiate(shot, orbit);
    auto trace = detail::traced(program_, exact_, point.start, point.period);
    orbit.t = std::move(trace.t);
    orbit.x = std::move(trace.x);
    orbit.low = std::move(trace.low);
    orbit.high = std::move(trace.high);
  }

  void judge(HybridOrbit& orbit) const {
    auto others = orbit.multipliers;
    if (!forced_)
      others.erase(std::ranges::min_element(others, {}, [](const auto& value) { return std::abs(value - 1.0); }));
    double largest = 0;
    for (const auto& value : others) largest = std::max(largest, std::abs(value));
    orbit.neighbours = largest > 1 + on_circle   ? HybridOrbit::Neighbours::go_away
                       : largest < 1 - on_circle ? HybridOrbit::Neighbours::come_nearer
                                                 : HybridOrbit::Neighbours::undecided;
  }

  /// Of flow(x, T, p) = x and the phase: dT/dp.
  void differentiate(const Shot& shot, HybridOrbit& orbit) const {
    if (forced_ || orbit.family) return;
    const std::size_t n = unknowns_.size(), count = options_.parameters.size();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(shot.matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    for (std::size_t p = 0; p < count; ++p) {
      Eigen::VectorXd by = Eigen::VectorXd::Zero(at(n + 1));
      for (std::size_t k = 0; k < n; ++k)
        by[at(k)] = shot.image.by_parameters[unknowns_[k] * count + p] / sizes_[unknowns_[k]];
      orbit.period_by.push_back(-svd.solve(by)[at(n)] * first_period_);
    }
  }

  std::string unsupported_reason_confirmed(const Shot& shot, double period) const;

  std::shared_ptr<const model::ModelProgram> program_;
  const HybridOrbitOptions& options_;
  const detail::OrbitStarts& starts_;
  std::vector<double> sizes_;
  model::Experiment exact_;
  std::vector<std::size_t> unknowns_, held_, aside_;
  std::optional<detail::ReturnFlow> flow_;
  std::optional<Shooting> shooting_;
  double first_period_ = 0;
  bool forced_ = false, refused_ = false;
  Status status_;
};

/// Which event is to blame: two at the same time that neighbours pass one after the other, or one whose time depends on
/// the start too much.
std::string OrbitSearch::unsupported_reason_confirmed(const Shot& shot, double period) const {
  const std::vector<SensitivityEvent>& events = shot.image.run.events;
  const auto part = [&](double moves, std::size_t i) { return moves * sizes_[i] / period; };
  for (std::size_t a = 0; a + 1 < events.size(); ++a) {
    const SensitivityEvent &one = events[a], &other = events[a + 1];
    if (std::abs(one.t - other.t) > at_once * period) continue;
    for (const std::size_t i : unknowns_)
      if (std::abs(part(one.time_moves[i] - other.time_moves[i], i)) > alike)
        return fmt::format(
            "the orbit (of period {:.10g}) has no multipliers: `{}` and `{}` happen at once on it, and neighbours pass "
            "them one after the other, in one order or the other",
            period, one.name, other.name);
  }
  constexpr double hardly_crossed = 1e3;
  for (const SensitivityEvent& event : events)
    for (const std::size_t i : unknowns_)
      if (std::abs(part(event.time_moves[i], i)) > hardly_crossed)
        return fmt::format(
            "the orbit (of period {:.10g}) has no multipliers: it touches the surface of `{}` without passing through "
            "it (grazing)",
            period, event.name);
  return fmt::format(
      "the orbit (of period {:.10g}) has no multipliers: neighbours on its two sides do not go where a derivative "
      "would take them, since an event or a jump of the equations is only touched (grazing), or two come at once",
      period);
}

}  // namespace

HybridOrbit find_hybrid_orbit(const std::shared_ptr<const model::ModelProgram>& program,
                              const model::Experiment& experiment, const HybridOrbitOptions& options) {
  if (program->model.needs_dae_solver())
    return without_hybrid_orbit("the model has algebraic equations, through which an orbit is not solved for yet");
  const detail::OrbitStarts starts = detail::orbit_starts(program, experiment, options);
  if (starts.starts.empty()) {
    const bool ran = starts.outcome.ending == Ending::nonlinear_solve_failed;
    HybridOrbit none = without_hybrid_orbit(ran ? std::string() : describe(starts.outcome), starts.outcome);
    none.wanders = starts.wanders;
    return none;
  }
  OrbitSearch search(program, experiment, options, starts);
  for (const detail::OrbitStart& start : starts.starts) {
    if (auto found = search.from(start)) return std::move(*found);
    if (search.interrupted()) return without_hybrid_orbit({}, {.ending = Ending::interrupted});
    if (search.refused()) return without_hybrid_orbit(search.status().message);
  }
  HybridOrbit none = without_hybrid_orbit(
      starts.nearby
          ? fmt::format("the motion does not return to an earlier state within a time of {}, and no orbit was found "
                        "near its way: it may need longer to settle, or have no period",
                        options.duration)
          : fmt::format("the motion returns, but no closed orbit could be solved for: {}", search.status().message));
  none.wanders = starts.nearby;
  return none;
}

}  // namespace continuo::studies
