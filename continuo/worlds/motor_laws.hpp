// The motors of a model's world whose speed changes with time, as laws for the exact motion: with the derivative of the
// expression of each.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/exact_options.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::worlds {

/// The laws of the motors of a program; without any where no speed changes.
class MotorLaws {
 public:
  /// Of all motors whose speed depends on time, or on inputs, but on no state. `variables` is a register file as
  /// `start_values` gives it.
  MotorLaws(const model::ModelProgram& program, std::span<const double> variables);

  /// Sets a parameter or an input, by its place in the register file.
  void set(std::uint32_t variable, double value);
  /// The laws, of the joints of the world by their numbers in the model. They read this, which must stay where it is.
  [[nodiscard]] std::vector<MotorLaw<double>> laws(std::span<const JointHandle> joints);

 private:
  struct Motor {
    std::size_t joint = 0;    // by its number in the model
    model::Evaluation speed;  // and its derivative by time
  };
  std::vector<Motor> motors_;
  std::vector<double> state_;  // which no speed reads
};

}  // namespace continuo::worlds
