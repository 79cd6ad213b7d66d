// Families of solutions of a boundary-value problem: how they move with one constant, round folds and into the families
// that cross them. Conditions at several times are solved by collocation (boundary_value.hpp), the family is followed
// by pseudo-arclength. H. B. Keller, "Numerical solution of bifurcation and nonlinear eigenvalue problems" (1977); E.
// J. Doedel, H. B. Keller, J. P. Kernevez, "Numerical analysis and control of bifurcation problems (II)", Int. J.
// Bifurcation Chaos 1 (1991).
//
//   // x'' = -p exp(x), x(0) = x(1) = 0 (Bratu): two solutions for each p below the fold at 3.5138
//   boundary::BoundaryValueProblem bratu{parametric_system(2, f, {1.0}), {0, 1}, ends};
//   const auto families = follow_families(bratu, {}, {.low = 0.1, .high = 4});
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/boundary/boundary_value.hpp>
#include <continuo/status/status.hpp>

namespace continuo::studies {

struct FamilyPoint {
  double constant;
  boundary::BoundaryValueSolution solution;  // its one parameter is the constant
};

/// `fold`: the family turns round in the constant. `branch_point`: another family crosses.
enum class FamilyEvent { fold, branch_point };
[[nodiscard]] std::string_view to_string(FamilyEvent kind);

struct FamilyMark {
  FamilyEvent kind;
  FamilyPoint at;
  std::size_t next;  // of the family's points, the first behind it
};

struct Family {
  std::vector<FamilyPoint> points;
  std::vector<FamilyMark> marks;         // in the order of the family
  std::vector<double> doubtful{};        // of the constant, where something happens of which the place was not found
  Status status{};                       // a failure where it neither left the range of the constant nor closed
  std::optional<std::size_t> crossed{};  // it was found where it crosses this family
  std::size_t crossings_left = 0;        // of its crossings, that were beyond FamilyOptions::most_families
};

struct FamilyOptions {
  double low = 0, high = 1;  // of the constant
  double tolerance = 1e-6;   // as boundary::BoundaryValueOptions::tolerance
  // In parts of high - low, and of the sizes of the components.
  double first_step = 0.01, least_step = 1e-6, largest_step = 0.05;
  std::size_t most_points = 500, most_families = 12;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // of the range that has been covered
};

/// The families through solutions near the guesses, where the constant, the problem's only one, has its present value,
/// and those that cross them, each once. The conditions are as many as components; they may read the constant. A guess
/// that leads to no solution gives a family without points that says so.
[[nodiscard]] std::vector<Family> follow_families(const boundary::BoundaryValueProblem& problem,
                                                  const std::vector<boundary::BoundaryValueGuess>& guesses,
                                                  const FamilyOptions& options);

/// The value of a component that is farthest from zero, the first of those that are alike: with its sign it tells the
/// two halves of a pitchfork apart.
[[nodiscard]] double farthest_from_zero(const boundary::BoundaryValueSolution& solution, std::size_t component);

}  // namespace continuo::studies
