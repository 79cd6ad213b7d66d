// continuo/simulation/program/model_derivatives.hpp
// df/dx and df/dt of a model, exact, in every mode, with the places where df/dx may differ from zero.
//
//   ModelDerivatives derivatives(*program, start_values(model));
//   derivatives.jacobian(mode, t, x, rows);
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::model {

class ModelDerivatives {
 public:
  /// `held`: of the equations with their switches held (SwitchedEquations), whose pattern is full where the motion may
  /// slide and the matrix is small.
  ModelDerivatives(const ModelProgram& program, std::span<const double> variables, bool held = false);

  /// Of all modes together.
  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }
  /// The entries in the order of the pattern.
  void jacobian_values(std::size_t mode, double t, std::span<const double> x, std::span<double> values);
  /// The entries in the layout of the pattern's band; only where the pattern is banded.
  void jacobian_band(std::size_t mode, double t, std::span<const double> x, std::span<double> band);
  /// All n * n, row by row.
  void jacobian(std::size_t mode, double t, std::span<const double> x, std::span<double> rows);
  void time_derivative(std::size_t mode, double t, std::span<const double> x, std::span<double> dfdt);

  /// A parameter, an input or a switch.
  void set(std::uint32_t variable, double value);

 private:
  struct OfMode {
    Evaluation entries;                 // of the pattern, zero where this mode has none
    std::vector<std::uint32_t> moving;  // the components whose derivative by time is not zero
    Evaluation by_time;                 // of those
    tape::Copies in_band;               // the entries
  };

  SparsePattern pattern_;
  std::vector<std::uint32_t> places_in_band_;  // of the entries; empty where the pattern is not banded
  std::vector<OfMode> modes_;
  std::vector<double> values_;
};

}  // namespace continuo::model
