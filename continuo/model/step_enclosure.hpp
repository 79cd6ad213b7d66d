// continuo/model/step_enclosure.hpp
// Expressions of a model enclosed over parts of a step, by its dense output:
//
//   StepEnclosure guards(program, nodes, start_values(model));
//   const Step step{t, h, driver.dense_output()};
//   guards.over(step, 0, 1)[i].value.lo > 0            // nodes[i] is positive from t to t + h, proved
//   guards.values_over(step, 0.25, 0.25)[i]            // a single instant, with its rounding
//
// Only the states that the expressions read are enclosed. What is enclosed is the expression of the polynomials that
// the coefficients are: an unknown that is solved for between steps is not among them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/model/model_program.hpp>
#include <continuo/model/tape_enclosure.hpp>

namespace continuo::model {

/// x(begin + theta*size) = sum_j coefficients[j] theta^j for theta in 0..1.
struct Step {
  double begin, size;
  std::span<const std::vector<double>> coefficients;
};

class StepEnclosure {
 public:
  /// `variables` is a whole register file as `start_values` gives it.
  StepEnclosure(const ModelProgram& program, std::span<const NodeId> nodes, std::span<const double> variables);

  /// Each expression for theta in from..to, a part of 0..1, with its slope by theta.
  std::span<const EnclosureWithSlope<double>> over(const Step& step, double from, double to);
  /// The values alone, in a third of the time.
  std::span<const Enclosure<double>> values_over(const Step& step, double from, double to);

  /// The components of the state that the expressions read, ascending.
  std::span<const std::uint32_t> components() const { return components_; }
  /// A parameter or an input.
  void set(std::uint32_t variable, double value);

 private:
  template <class Number>
  struct Registers {
    std::vector<Number> numbers, outputs;
    bool is_prepared = false;
  };
  template <class Number>
  void prepare(Registers<Number>& registers);
  std::span<const double> component(const Step& step, std::size_t i);
  Enclosure<double> component_over(const Step& step, std::size_t i, double from, double to);

  std::shared_ptr<const Tape> tape_;
  std::uint32_t states_begin_;
  bool reads_time_;
  std::vector<std::uint32_t> components_;
  std::vector<double> variables_, coefficients_;
  Registers<EnclosureWithSlope<double>> with_slopes_;
  Registers<Enclosure<double>> values_;
};

}  // namespace continuo::model
