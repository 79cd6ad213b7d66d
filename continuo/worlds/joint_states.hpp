// What joints of a model's world measure, and the speeds of their motors, which are expressions of the model.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/language/world.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::worlds {

/// The coordinate of a joint: the angle of a hinge, the length of a slider, distance or wheel; 0 of others.
template <int Dim>
[[nodiscard]] double coordinate_of(const World<double, Dim>& world, const Joint<double, Dim>& joint);

/// Writes the measures of all joints into the states of the model, in the order of `model::joint_measures`.
template <int Dim>
void write_joints(const World<double, Dim>& world, std::span<const JointHandle> joints,
                  const model::WorldDescription& text, std::span<double> state);

/// The motors whose speed changes with time.
class MotorSpeeds {
 public:
  /// `variables` is a register file as `start_values` gives it.
  MotorSpeeds(const model::ModelProgram& program, std::span<const double> variables);

  /// Whether no motor changes its speed but where a parameter does.
  [[nodiscard]] bool is_empty() const { return motors_.empty(); }
  /// Sets a parameter or an input, by its place in the register file.
  void set(std::uint32_t variable, double value) { evaluation_.set(variable, value); }
  /// Gives the motors their speeds in this state of the model.
  template <int Dim>
  void drive(double t, std::span<const double> state, std::span<const JointHandle> joints, World<double, Dim>& world) {
    evaluation_(t, state, speeds_);
    for (std::size_t k = 0; k < motors_.size(); ++k)
      if (auto* const joint = world.find(joints[motors_[k]]); joint && joint->motor) joint->motor->speed = speeds_[k];
  }

 private:
  std::vector<std::size_t> motors_;  // by the numbers of their joints
  model::Evaluation evaluation_;
  std::vector<double> speeds_;
};

extern template double coordinate_of(const World<double, 2>&, const Joint<double, 2>&);
extern template double coordinate_of(const World<double, 3>&, const Joint<double, 3>&);
extern template void write_joints(const World<double, 2>&, std::span<const JointHandle>, const model::WorldDescription&,
                                  std::span<double>);
extern template void write_joints(const World<double, 3>&, std::span<const JointHandle>, const model::WorldDescription&,
                                  std::span<double>);

}  // namespace continuo::worlds
