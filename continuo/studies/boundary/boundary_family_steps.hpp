// One place after the other on a family of solutions: predicted along the tangent, solved for by collocation. Internal
// to boundary_family.
//
// The constant p is one more unknown of the boundary-value problem, and the step gives one more condition: (z - z0) .
// d = step, where z is x at some times spread over the interval and p, d a direction. Lengths are measured in sizes: of
// each component what it has reached, of the constant its range. A motion that the differential equations allow and
// that is zero at one time is zero throughout, so that no direction hides from these times.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <continuo/boundary/collocation_system.hpp>
#include <continuo/studies/boundary/boundary_family.hpp>

namespace continuo::studies::detail {

/// How x and the constant move, x at the collocation points of a mesh.
struct FamilyDirection {
  std::vector<double> mesh, points;
  double constant = 0;

  void at(double t, std::span<double> x) const;
};

struct FamilyPlace {
  boundary::BoundaryValueSolution solution;
  FamilyDirection tangent;  // of the family, of length 1 in sizes
  double slope = 0;         // the constant's part of it, in sizes: zero in a fold
  /// Zero where the equations hold in more than one direction, which is `other` then, across the tangent and of length
  /// 1: some measures of it, each of which may leap through infinity where the others do not.
  static constexpr std::size_t tests = 9;
  std::array<double, tests> crossing{};
  FamilyDirection other;

  [[nodiscard]] double constant() const { return solution.parameters[0]; }
};

class FamilySteps {
 public:
  FamilySteps(const boundary::BoundaryValueProblem& problem, const FamilyOptions& options);
  FamilySteps(const FamilySteps&) = delete;  // its problem's conditions read it
  FamilySteps& operator=(const FamilySteps&) = delete;

  /// The solution near the guess with this value of the constant, its tangent towards greater ones.
  [[nodiscard]] std::optional<FamilyPlace> at_constant(const boundary::BoundaryValueGuess& guess,
                                                       const std::vector<double>& mesh, double value);
  /// A step in this direction from a place. Nothing where none is found, or one that is farther off than `farthest`
  /// steps. The tangent is the one nearest to the direction.
  [[nodiscard]] std::optional<FamilyPlace> stepped(const boundary::BoundaryValueSolution& from,
                                                   const FamilyDirection& direction, double step,
                                                   double farthest = 0.5);
  /// The same place, solved for with twice as many intervals.
  [[nodiscard]] std::optional<FamilyPlace> on_halved_mesh(const FamilyPlace& place);
  /// The solution near `guess` whose difference from `through` has no part along the way from `guess` to `towards`.
  [[nodiscard]] std::optional<FamilyPlace> across(const boundary::BoundaryValueSolution& guess,
                                                  const boundary::BoundaryValueSolution& towards,
                                                  const boundary::BoundaryValueSolution& through);

  /// Takes the sizes of the components from here where they have grown.
  void measure(const boundary::BoundaryValueSolution& solution);
  [[nodiscard]] double distance(const boundary::BoundaryValueSolution& a,
                                const boundary::BoundaryValueSolution& b) const;
  /// To length 1.
  void scale(FamilyDirection& direction) const;
  [[nodiscard]] static double cosine(const FamilySteps& steps, const FamilyDirection& a, const FamilyDirection& b);
  /// A closer look, at places that are marked.
  void set_tolerance(double tolerance) { tolerance_ = tolerance; }
  [[nodiscard]] double range() const { return range_; }

 private:
  /// x at the sample times, then the constant, each in its size and so that the sum of squares is a mean over time.
  [[nodiscard]] std::vector<double> sampled(const boundary::BoundaryValueSolution& solution) const;
  [[nodiscard]] std::vector<double> sampled(const FamilyDirection& direction) const;
  template <class At>
  [[nodiscard]] std::vector<double> samples_of(const At& at, double constant) const;
  [[nodiscard]] std::optional<FamilyPlace> solved(const boundary::BoundaryValueGuess& guess,
                                                  const std::vector<double>& mesh, double constant);
  [[nodiscard]] bool describe(FamilyPlace& place);
  [[nodiscard]] std::vector<double> disturbance(const boundary::CollocationSystem& system, std::size_t test) const;
  [[nodiscard]] double seen(const FamilyDirection& direction, std::size_t test) const;
  [[nodiscard]] FamilyDirection direction_of(const boundary::CollocationSystem& system,
                                             const boundary::BoundaryValueSolution& solution,
                                             std::span<const double> z) const;

  boundary::BoundaryValueProblem problem_;  // with the condition of the step
  std::size_t n_;
  const FamilyOptions& options_;
  double tolerance_, range_;
  std::vector<double> sizes_, first_sizes_;
  std::vector<std::size_t> sample_places_;  // which of the problem's times
  /// The condition of a step: row . sampled(z) = target.
  struct Step {
    std::vector<double> row;
    double target = 0;
  };
  std::shared_ptr<Step> step_;
};

}  // namespace continuo::studies::detail
