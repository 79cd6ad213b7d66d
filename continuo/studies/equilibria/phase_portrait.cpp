// continuo/studies/equilibria/phase_portrait.cpp
// Computes the field, nullclines, separatrices and motions of a phase plane.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/phase_portrait.hpp>
#include <continuo/studies/support/flow.hpp>

namespace continuo::studies {

namespace {

using X = std::vector<double>;

constexpr std::size_t points_per_motion = 800;
constexpr double off_saddle = 1e-4;   // of the plane's size: where a separatrix begins
constexpr double far_outside = 0.02;  // motions end so far outside

class Portrait {
 public:
  Portrait(const ParametricSystem& system, const PhasePlane& plane)
      : system_(system), plane_(plane), size_{plane.high[0] - plane.low[0], plane.high[1] - plane.low[1]} {}

  PhasePortrait operator()() {
    add_field();
    add_nullclines();
    const auto found = find_equilibria(system_, {.low = {plane_.low[0], plane_.low[1]},
                                                 .high = {plane_.high[0], plane_.high[1]},
                                                 .t = plane_.t,
                                                 .interrupt = plane_.interrupt});
    portrait_.equilibria = found.equilibria;
    for (const Equilibrium& e : portrait_.equilibria)
      if (e.stability == Stability::saddle) add_separatrices(e);
    const auto begins = starts();
    for (const PlanePoint& start : begins) {
      if (plane_.progress)
        plane_.progress(static_cast<double>(portrait_.motions.size()) / static_cast<double>(begins.size()));
      if (is_interrupted()) return std::move(portrait_);
      PlaneCurve back = motion(start, -1);
      std::ranges::reverse(back);
      const PlaneCurve ahead = motion(start, 1);
      back.insert(back.end(), ahead.begin(), ahead.end());
      portrait_.motions.push_back(std::move(back));
    }
    portrait_.complete = true;
    return std::move(portrait_);
  }

 private:
  bool is_interrupted() const { return plane_.interrupt && plane_.interrupt->load(); }
  PlanePoint slope(const PlanePoint& at) const {
    PlanePoint f{};
    system_.derivative(plane_.t, at, system_.constants, f);
    return f;
  }
  PlanePoint on_grid(std::size_t i, std::size_t j, std::size_t cells, double shift) const {
    const auto of = static_cast<double>(cells);
    return {plane_.low[0] + size_[0] * (static_cast<double>(i) + shift) / of,
            plane_.low[1] + size_[1] * (static_cast<double>(j) + shift) / of};
  }

  void add_field() {
    for (std::size_t i = 0; i < plane_.arrows; ++i) {
      for (std::size_t j = 0; j < plane_.arrows; ++j) {
        const PlanePoint at = on_grid(i, j, plane_.arrows, 0.5), f = slope(at);
        const PlanePoint measured{f[0] / size_[0], f[1] / size_[1]};
        const double speed = std::hypot(measured[0], measured[1]);
        if (!(speed > 0) || !std::isfinite(speed)) continue;
        portrait_.field.push_back({at, {measured[0] / speed, measured[1] / speed}, speed});
      }
    }
  }

  /// Marching squares: where a component of f changes its sign along the edges of a cell, the crossings are joined.
  void add_nullclines() {
    const std::size_t cells = plane_.cells, side = cells + 1;
    std::vector<PlanePoint> values(side * side);
    for (std::size_t i = 0; i < side; ++i)
      for (std::size_t j = 0; j < side; ++j) values[i * side + j] = slope(on_grid(i, j, cells, 0));
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < cells; ++i)
        for (std::size_t j = 0; j < cells; ++j) add_cell(values, c, i, j);
  }
  void add_cell(const std::vector<PlanePoint>& values, std::size_t c, std::size_t i, std::size_t j) {
    const std::size_t side = plane_.cells + 1;
    constexpr std::array<std::array<std::size_t, 2>, 5> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
    PlaneCurve crossings;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t ai = i + corners[k][0], aj = j + corners[k][1], bi = i + corners[k + 1][0],
                        bj = j + corners[k + 1][1];
      const double a = values[ai * side + aj][c], b = values[bi * side + bj][c];
      if (!((a > 0) != (b > 0)) || !std::isfinite(a) || !std::isfinite(b)) continue;
      const double share = a / (a - b);
      const PlanePoint from = on_grid(ai, aj, plane_.cells, 0), to = on_grid(bi, bj, plane_.cells, 0);
      crossings.push_back({from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])});
    }
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
      portrait_.nullclines[c].push_back({crossings[k], crossings[k + 1]});
  }

  /// From just beside a saddle: along the eigenvector that grows forwards in time, along the other backwards.
  void add_separatrices(const Equilibrium& saddle) {
    const auto found = eigenvalues(jacobian_of(system_, plane_.t, saddle.x, system_.constants), 2);
    for (std::size_t k = 0; k < found.values.size(); ++k) {
      const double direction = found.values[k].real() > 0 ? 1 : -1;
      for (const double sign : {1.0, -1.0}) {
        const PlanePoint along{found.vectors[k][0].real(), found.vectors[k][1].real()};
        const double length = std::hypot(along[0] / size_[0], along[1] / size_[1]) / off_saddle;
        const PlaneCurve rest =
            motion({saddle.x[0] + sign * along[0] / length, saddle.x[1] + sign * along[1] / length}, direction);
        PlaneCurve curve{{saddle.x[0], saddle.x[1]}};
        curve.insert(curve.end(), rest.begin(), rest.end());
        portrait_.separatrices.push_back(std::move(curve));
      }
    }
  }

  std::vector<PlanePoint> starts() const {
    if (!plane_.starts.empty()) return plane_.starts;
    std::vector<PlanePoint> starts;
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(plane_.spread))));
    for (std::size_t i = 0; i < side; ++i)
      for (std::size_t j = 0; j < side; ++j) starts.push_back(on_grid(i, j, side, 0.5));
    return starts;
  }

  /// Until it leaves the part of the plane, or its time is over.
  PlaneCurve motion(const PlanePoint& start, double direction) const {
    Options<X> options{.rtol = plane_.rtol, .atol = 1e-3 * plane_.rtol};
    options.interrupt = plane_.interrupt;
    options.save = Save<X>::dense();
    options.max_steps = 200'000;
    auto outside = rises<X>("outside", [this](double, const X& x) {
      double most = -1;
      for (std::size_t i = 0; i < 2; ++i)
        most = std::max(most, std::abs(2 * (x[i] - plane_.low[i]) / size_[i] - 1) - 1 - far_outside);
      return most;
    });
    outside.stop_after = 1;
    options.events = {std::move(outside)};
    const auto run = run_flow(system_, system_.constants, {start[0], start[1]},
                              {plane_.t, plane_.t + direction * plane_.duration}, options);
    if (run.t.empty()) return {};
    const double from = run.t.front(), spacing = direction * plane_.duration / double(points_per_motion);
    const auto count = static_cast<std::size_t>(std::ceil((run.t.back() - from) / spacing));
    const auto point = [&](double t) {
      const X x = run(t);
      return PlanePoint{x[0], x[1]};
    };
    PlaneCurve curve{point(from)};
    for (std::size_t k = 1; k <= count; ++k) {
      const double t = k == count ? run.t.back() : from + static_cast<double>(k) * spacing;
      const double before = k == 1 ? from : from + static_cast<double>(k - 1) * spacing;
      add_between(curve, point, before, t, point(t), 0);
    }
    std::erase_if(curve, [](const PlanePoint& at) { return !std::isfinite(at[0]) || !std::isfinite(at[1]); });
    return curve;
  }

  /// From the last point of the curve to the one at t, with as many between as its bends take: times that are even
  /// leave corners where the motion is fast.
  template <class Point>
  void add_between(PlaneCurve& curve, const Point& point, double before, double t, const PlanePoint& there,
                   int depth) const {
    constexpr double flat = 5e-4;  // of the plane: the curve beside its chord
    constexpr int deepest = 12;
    const double middle = (before + t) / 2;
    const PlanePoint here = curve.back(), between = point(middle);
    double off = 0, length = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      off = std::max(off, std::abs(between[i] - (here[i] + there[i]) / 2) / size_[i]);
      length = std::max(length, std::abs(there[i] - here[i]) / size_[i]);
    }
    constexpr double longest = 0.05;  // a chord may pass by chance through the middle of a bend
    if (depth < deepest && (off > flat || length > longest)) {
      add_between(curve, point, before, middle, between, depth + 1);
      add_between(curve, point, middle, t, there, depth + 1);
      return;
    }
    curve.push_back(there);
  }

  const ParametricSystem& system_;
  const PhasePlane& plane_;
  PlanePoint size_;
  PhasePortrait portrait_;
};

}  // namespace

PhasePortrait phase_portrait(const ParametricSystem& system, const PhasePlane& plane) {
  return Portrait(system, plane)();
}

}  // namespace continuo::studies
