// continuo/worlds/coupled_equations.hpp
// The equations that a model couples to its bodies: forces given by expressions, and differential equations with states
// of their own.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/language/world.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::worlds {

/// Writes the states of one body in the order of the model: x, x', y, y', ..., and those of its rotation.
template <int Dim>
void write_body(double* state, const Vector<double, Dim>& x, const Vector<double, Dim>& v,
                const Orientation<double, Dim>& orientation, const Spin<double, Dim>& spin);

/// The forces, torques and equations of a model beside its bodies, to be evaluated at any state.
template <int Dim>
class CoupledEquations {
 public:
  using V = Vector<double, Dim>;

  /// For a program with a world of Dim dimensions; `variables` is a register file as `start_values` gives it.
  CoupledEquations(const model::ModelProgram& program, std::span<const double> variables);

  /// The number of states of the equations.
  [[nodiscard]] std::size_t states() const { return count_; }
  /// Whether any expression is a force on a body.
  [[nodiscard]] bool has_forces() const { return !forces_of_.empty(); }
  /// Whether any expression is a torque on a body.
  [[nodiscard]] bool has_torques() const { return !torques_of_.empty(); }
  /// Whether the model has only bodies.
  [[nodiscard]] bool is_empty() const { return count_ == 0 && !has_forces() && !has_torques(); }
  /// The index of the first state of the equations among the states of the model.
  [[nodiscard]] std::size_t first() const { return first_; }
  /// Sets a parameter or an input, by its place in the register file.
  void set(std::uint32_t variable, double value);
  /// The mode of the equations.
  [[nodiscard]] std::size_t mode() const { return mode_; }
  /// Changes the mode of the equations.
  void go(std::size_t mode) { mode_ = mode; }

  /// Adds to forces and torques and sets the rates of the equations' states z; an empty span leaves one of these out.
  /// Without orientations and spins those of the world are used, continued from its time.
  void operator()(const World<double, Dim>& world, double t, const BodyStates<double, Dim>& at,
                  std::span<const double> z, std::span<V> force, std::span<Spin<double, Dim>> torque,
                  std::span<double> rate);

 private:
  void fill(const World<double, Dim>& world, double t, const BodyStates<double, Dim>& at, std::span<const double> z);

  std::size_t first_ = 0, count_ = 0, mode_ = 0;
  std::vector<std::size_t> forces_of_, torques_of_;  // the body of each
  std::vector<std::size_t> bodies_read_;             // whose states are read
  std::vector<model::Evaluation> rates_;             // by mode
  model::Evaluation forces_, torques_;
  std::vector<double> state_, values_;
};

extern template class CoupledEquations<2>;
extern template class CoupledEquations<3>;

}  // namespace continuo::worlds
