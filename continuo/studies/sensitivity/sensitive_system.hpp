// A model and its sensitivities as a System: what `solve` integrates. The state is x, then the columns of S. Internal
// to sensitivity.
//
// Where the motion slides along surfaces, f = f0 + sum of w_i (f_i - f0) with the weights for which no surface is left
// (simulation/program/switched_motion.hpp): with a_ji how fast f_i goes towards the upper side of surface j,
//   sum over i of w_i (a_ji - a_j0) = -a_j0,
// which differentiated gives the weights' derivatives by the same matrix, and with them
//   S' = df0 + sum of w_i (df_i - df0) + dw_i (f_i - f0), where d is d/dx S + d/dp.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/simulation/program/model_system.hpp>
#include <continuo/studies/sensitivity/sensitive_program.hpp>

namespace continuo::studies::detail {

/// A tape of a SensitiveProgram with registers of its own.
class WideEvaluation {
 public:
  WideEvaluation(std::shared_ptr<const model::Tape> tape, const SensitiveProgram& program,
                 std::span<const double> variables);

  void operator()(double t, std::span<const double> wide, std::span<double> outputs);
  std::vector<double> operator()(double t, std::span<const double> wide);
  /// Sets a parameter or an input.
  void set(std::uint32_t variable, double value);
  /// Sets the variable of a switch.
  void place(std::uint32_t variable, double value) { registers_[variable] = value; }

 private:
  std::shared_ptr<const model::Tape> tape_;
  std::uint32_t states_, further_;
  std::size_t n_;
  std::vector<double> registers_;
};

class SensitiveSystem {
 public:
  using X = std::vector<double>;

  SensitiveSystem(std::shared_ptr<const SensitiveProgram> program, std::span<const double> variables);

  void operator()(double t, const X& x, X& dxdt) { rates(t, x, dxdt); }
  [[nodiscard]] std::size_t mode() const { return plain_.mode(); }
  [[nodiscard]] const SensitiveProgram& program() const { return *program_; }
  [[nodiscard]] model::ModelSystem& plain() { return plain_; }
  [[nodiscard]] const model::ModelSystem& plain() const { return plain_; }
  /// The jumps of the equations are located from now on, as those of the model's own run.
  void hold_switches(double t, const X& x);
  /// After an event: the switches as the model has them now.
  void place_switches();
  /// The rates in the present mode.
  void rates(double t, const X& x, X& dxdt);
  /// What is compiled of the surfaces of the present mode.
  [[nodiscard]] std::vector<double> surfaces(double t, const X& x) { return surfaces_[mode()](t, x); }
  /// What is compiled of event i of the model, in the order of the text.
  [[nodiscard]] std::vector<double> event(std::size_t i, double t, const X& x) { return events_[i](t, x); }
  /// An input that has stepped.
  void set(std::uint32_t variable, double value);
  [[nodiscard]] std::span<const double> variables() const { return variables_; }

  [[nodiscard]] std::string_view component_name(std::size_t i) const { return program_->name(i); }
  [[nodiscard]] const SparsePattern& jacobian_pattern() { return program_->jacobians().pattern; }
  void jacobian_values(double t, const X& x, std::span<double> values);
  void jacobian(double t, const X& x, std::span<double> rows);
  void time_derivative(double t, const X& x, X& dfdt);
  [[nodiscard]] bool has_mass() const { return plain_.has_mass(); }
  [[nodiscard]] double mass(std::size_t i) const { return plain_.mass(i % program_->size()); }

 private:
  struct Jacobian {
    std::vector<WideEvaluation> by_state, by_time;
    std::vector<std::vector<std::size_t>> entry;  // by mode: where in the pattern each place is
  };
  [[nodiscard]] Jacobian& derivatives();
  void add_mode(std::size_t mode);
  void place(std::size_t k, double value);
  void slide(double t, const X& x, X& dxdt);
  [[nodiscard]] bool slides_in_full() const;
  void difference_rows(double t, const X& x, std::span<double> rows);

  std::shared_ptr<const SensitiveProgram> program_;
  model::ModelSystem plain_;
  std::vector<double> variables_;
  std::vector<WideEvaluation> rates_, surfaces_, approach_;  // by mode
  std::vector<WideEvaluation> events_;
  std::optional<Jacobian> jacobian_;
};

}  // namespace continuo::studies::detail
