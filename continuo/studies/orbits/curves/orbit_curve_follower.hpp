// Along a curve of folds, period doublings or tori of orbits, from its start to where it ends. Internal to orbit_curve.
#pragma once
#include <optional>

#include <continuo/studies/orbits/curves/orbit_curve_course.hpp>
#include <continuo/studies/orbits/curves/orbit_curve_steps.hpp>

namespace continuo::studies::detail {

class OrbitCurveFollower {
  using Vector = std::vector<double>;
  using Place = OrbitCurvePlace;

 public:
  OrbitCurveFollower(const ParametricSystem& system, OrbitBifurcation kind, const OrbitCurveOptions& options)
      : system_(system),
        options_(options),
        steps_(system, kind, options),
        covered_(options.low[1], options.high[1], options.progress) {}

  [[nodiscard]] OrbitCurve from(const OrbitMark& start);

 private:
  /// Appends to `curve`, whose kind is set.
  [[nodiscard]] OrbitCurveEnd followed(OrbitCurve& curve, const Place& from, double direction);
  /// What ends the curve between two neighbours, beside a bound.
  /// The greatest deviation of a component, in parts of the greatest on the curve so far.
  [[nodiscard]] double amplitude(const Place& place);
  [[nodiscard]] std::optional<OrbitCurveEnd> shrinks_between(const Place& a, const Place& b);
  /// Of tori: the 1:1 or 1:2 resonance that comes within the next steps.
  [[nodiscard]] std::optional<DegenerateOrbit> resonance_ahead(const Place& a, const Place& b, double step);
  [[nodiscard]] OrbitCurveEnd at_bound(OrbitCurve& curve, const Place& a, const Place& b);
  /// What lies between two neighbours, narrowed down to where its test is zero.
  void mark(OrbitCurve& curve, const Place& a, const Place& b, double step);
  [[nodiscard]] std::optional<Place> located(OrbitDegeneracy kind, const Place& a, const Place& b, double step);
  /// Whether it is what its name says, beyond the zero of its test.
  [[nodiscard]] static bool is_what(OrbitDegeneracy kind, OrbitBifurcation curve, const Place& place);

  const ParametricSystem& system_;
  const OrbitCurveOptions& options_;
  OrbitCurveSteps steps_;
  double located_at_ = 0;  // how far from the place before
  double first_period_ = 0;
  Vector greatest_{};  // deviation of each component so far
  CoveredRange covered_;
};

}  // namespace continuo::studies::detail
