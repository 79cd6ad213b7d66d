// Unknowns of algebraic equations enclosed over parts of a step, as the guards see them: not by the polynomials of the
// dense output, but solved for from the states that it gives (numerics/implicit_enclosure.hpp).
//
//   UnknownEnclosure unknowns(program, coupling.block(guard).value(), start_values(model));
//   unknowns.over({t, h, driver.dense_output()}, 0, 0.5);
//   unknowns.values()[k], unknowns.slopes()[k]          // of block.components[k], for theta in 0..0.5
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/numerics/implicit_enclosure.hpp>
#include <continuo/simulation/program/dense_step.hpp>
#include <continuo/simulation/program/unknown_coupling.hpp>
#include <continuo/symbolic/tape/tape_enclosure.hpp>
#include <continuo/symbolic/tape/tape_registers.hpp>

namespace continuo::model {

class UnknownEnclosure {
 public:
  /// `variables` is a whole register file as `start_values` gives it.
  UnknownEnclosure(const ModelProgram& program, UnknownBlock block, std::span<const double> variables);

  /// True where it is proved that the equations have one solution near the dense output for each theta in from..to.
  bool over(const Step& step, double from, double to);
  /// Of that solution; entire where nothing is proved.
  [[nodiscard]] std::span<const Enclosure<double>> values() const { return solution_.values(); }
  [[nodiscard]] std::span<const Enclosure<double>> slopes() { return solution_.slopes(); }

  [[nodiscard]] std::span<const std::uint32_t> components() const { return block_.components; }
  /// A parameter or an input.
  void set(std::uint32_t variable, double value);

 private:
  /// An entry of the matrix.
  struct Place {
    std::size_t row, column;
  };
  void find_columns(const Graph& graph);
  void place_middle(const Step& step, double middle);
  void compute_residuals(std::span<const double> unknowns, std::span<double> residuals);
  void enclose_residuals(std::span<const double> unknowns, std::span<Enclosure<double>> residuals);
  void enclose_slopes(std::span<const Enclosure<double>> box, std::span<Enclosure<double>> by_unknowns,
                      std::span<Enclosure<double>> by_theta);

  UnknownBlock block_;
  std::shared_ptr<const Tape> tape_;
  std::uint32_t states_begin_;
  std::vector<std::uint32_t> states_;         // that the equations read, beside the unknowns
  std::vector<std::vector<Place>> together_;  // columns that share no row, by their entries
  std::vector<double> variables_, middle_;
  StepComponent component_;
  ImplicitEnclosure<double> solution_;
  std::vector<Enclosure<double>> guess_;
  std::vector<EnclosureWithSlope<double>> moving_;  // time and those states over the part
  TapeRegisters<double> numbers_at_middle_;
  TapeRegisters<Enclosure<double>> at_middle_;
  TapeRegisters<EnclosureWithSlope<double>> over_part_;
  bool is_instant_ = false;
};

}  // namespace continuo::model
