// Expressions of a model enclosed over parts of a step, by its dense output:
//
//   StepEnclosure guards(program, nodes, start_values(model));
//   const Step step{t, h, driver.dense_output()};
//   guards.over(step, 0, 1)[i].value.lo > 0            // nodes[i] is positive from t to t + h, proved
//   guards.values_over(step, 0.25, 0.25)[i]            // a single instant, with its rounding
//
// Only what the expressions read is enclosed: states by the polynomials that the coefficients are; unknowns that are
// solved for between steps, where blocks are given for them, by their equations with these states in them. Where no
// solution is proved, an unknown may be anything.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/simulation/program/dense_step.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/program/unknown_enclosure.hpp>
#include <continuo/symbolic/tape/tape_enclosure.hpp>
#include <continuo/symbolic/tape/tape_registers.hpp>

namespace continuo::model {

class StepEnclosure {
 public:
  /// `variables` is a whole register file as `start_values` gives it. An unknown that stands in several blocks is
  /// enclosed by the last of them.
  StepEnclosure(const ModelProgram& program, std::span<const NodeId> nodes, std::span<const double> variables,
                std::span<const UnknownBlock> blocks = {});

  /// Each expression for theta in from..to, a part of 0..1, with its slope by theta.
  [[nodiscard]] std::span<const EnclosureWithSlope<double>> over(const Step& step, double from, double to);
  /// The values alone, in a third of the time.
  [[nodiscard]] std::span<const Enclosure<double>> values_over(const Step& step, double from, double to);

  /// The components of the state that the expressions read as the dense output has them, ascending.
  [[nodiscard]] std::span<const std::uint32_t> components() const { return components_; }
  /// A parameter or an input.
  void set(std::uint32_t variable, double value);

 private:
  template <class EnclosePolynomial>
  [[nodiscard]] std::span<const EnclosureWithSlope<double>> over(const Step& step, double from, double to,
                                                                 const EnclosePolynomial& enclose);
  [[nodiscard]] Enclosure<double> component_over(const Step& step, std::size_t i, double from, double to);
  [[nodiscard]] bool is_solved_for(std::uint32_t component) const;

  std::shared_ptr<const Tape> tape_;
  std::uint32_t states_begin_;
  bool reads_time_;
  std::vector<UnknownEnclosure> unknowns_;
  std::vector<std::uint32_t> components_;
  std::vector<double> variables_;
  StepComponent component_;
  TapeRegisters<EnclosureWithSlope<double>> with_slopes_;
  TapeRegisters<Enclosure<double>> values_;
};

}  // namespace continuo::model
