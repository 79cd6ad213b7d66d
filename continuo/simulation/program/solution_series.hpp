// The Taylor series of a model's solution in one mode, for the method `taylor`: the expressions of the derivatives as
// operations on series. Equal operations on the same level, such as those of a grid's points, are one.
//
//   SolutionSeries series(program, program.model.modes[0].derivatives, start_values(program.model));
//   std::vector<double> c(9 * n);   // begins with x
//   series.expand(t, 0.1, c);       // x_i(t + 0.1 s) = c[i] + c[n + i] s + ... + c[8 n + i] s^8
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/methods/taylor_series/series_steps.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::model {

/// A copy is a checkpoint.
class SolutionSeries {
 public:
  /// `variables` is a whole register file as `start_values` gives it; `guards` are those that many steps watch.
  SolutionSeries(const ModelProgram& program, std::span<const NodeId> derivatives, std::span<const double> variables,
                 std::span<const NodeId> guards = {});
  SolutionSeries(const SolutionSeries& other);
  SolutionSeries(SolutionSeries&&) noexcept;
  SolutionSeries& operator=(const SolutionSeries& other);
  SolutionSeries& operator=(SolutionSeries&&) noexcept;
  ~SolutionSeries();

  /// The coefficients after those of order 0, which are there, order by order; those of `held` states are 0.
  void expand(double t, double scale, std::span<double> c, std::span<const std::size_t> held = {});
  /// Many steps of the solution by machine code, see SeriesSteps; 0 where there is none (yet).
  [[nodiscard]] std::size_t take_steps(SeriesSteps<double>& steps);
  /// Whether these steps watch all guards.
  [[nodiscard]] bool watches_guards() const;
  /// Whether anything in the expressions jumps or bends.
  [[nodiscard]] bool has_corners() const;

  /// A parameter, an input, or the variable of a switch.
  void set(std::uint32_t variable, double value);

 private:
  friend class SeriesCompiler;
  struct Program;
  std::unique_ptr<Program> program_;
};

}  // namespace continuo::model
