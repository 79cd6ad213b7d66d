// Along a curve of folds or Hopf points, from its start to where it ends. Internal to bifurcation_curve.
#pragma once
#include <optional>
#include <vector>

#include <continuo/studies/equilibria/curve_steps.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>

namespace continuo::studies::detail {

class CurveFollower {
  using Vector = std::vector<double>;
  using Place = CurvePlace;

 public:
  CurveFollower(const ParametricSystem& system, const CurveStart& start, const CurveOptions& options)
      : system_(system),
        options_(options),
        steps_(system, start, options),
        covered_(options.low[1], options.high[1], options.progress) {}

  [[nodiscard]] BifurcationCurve from(const CurveStart& start);
  /// Another curve, of this kind, through a degenerate point.
  [[nodiscard]] BifurcationCurve from(const DegeneratePoint& start, Bifurcation kind);
  /// Whether a curve passes through this place: where it crosses the plane through the place that is upright on the way
  /// between two of its neighbours.
  [[nodiscard]] bool passes(const BifurcationCurve& curve, const CurvePoint& place, double frequency);

 private:
  [[nodiscard]] std::optional<CriticalSpace> space_at(const Vector& z, Bifurcation kind, double frequency);
  /// `begin`: the degenerate point that the first place is; may be null.
  [[nodiscard]] BifurcationCurve both_ways(BifurcationCurve curve, const Place& first, const DegeneratePoint* begin);
  /// Appends to `curve`, whose kind is set.
  [[nodiscard]] CurveEnd followed(BifurcationCurve& curve, const Place& from, double direction,
                                  const DegeneratePoint* begin);
  [[nodiscard]] CurveEnd at_bound(BifurcationCurve& curve, const Place& a, const Place& b);
  [[nodiscard]] bool inside(const CurvePoint& point) const;
  [[nodiscard]] bool comes_back(const Place& a, const Place& b, const Place& origin) const;

  /// What lies between two neighbours, narrowed down to where its test is zero.
  void mark(BifurcationCurve& curve, const Place& a, const Place& b, double step);
  void add(BifurcationCurve& curve, Degeneracy kind, const Place& a, const Place& b, double step);
  [[nodiscard]] std::optional<Place> located(Degeneracy kind, const Place& a, const Place& b, double step);
  /// Whether it is what its name says, beyond the zero of its test. Sets the other frequency.
  [[nodiscard]] bool is_what(Degeneracy kind, const Place& place, const Place& a, const Place& b,
                             double& other_frequency);
  /// Whether a test changes more than rounding does.
  [[nodiscard]] bool is_seen(Degeneracy kind, const Place& a, const Place& b);
  [[nodiscard]] std::vector<NormalFormNumber> numbers_of(Degeneracy kind, const CurvePoint& point) const;

  const ParametricSystem& system_;
  const CurveOptions& options_;
  CurveSteps steps_;
  double located_at_ = 0;  // how far from the place before
  CoveredRange covered_;
};

}  // namespace continuo::studies::detail
