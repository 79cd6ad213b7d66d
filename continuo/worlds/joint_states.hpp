// What joints of a model's world measure, and what drives them: the speeds of motors and the targets of pulls, which
// are expressions of the model.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// The motors whose speed changes with time, and the pulls.
class JointDrives {
 public:
  /// `variables` is a register file as `start_values` gives it.
  JointDrives(const model::ModelProgram& program, std::span<const double> variables);

  /// Whether no motor changes its speed but where a parameter does, and nothing pulls.
  [[nodiscard]] bool is_empty() const { return motors_.empty() && pulls_.empty(); }
  /// Sets a parameter or an input, by its place in the register file.
  void set(std::uint32_t variable, double value) { evaluation_.set(variable, value); }
  /// Gives the motors their speeds, and the pulls their targets, in this state of the model. Fails where one of them is
  /// no number.
  template <int Dim>
  [[nodiscard]] Status drive(double t, std::span<const double> state, std::span<const JointHandle> joints,
                             World<double, Dim>& world) {
    evaluation_(t, state, values_);
    if (!std::ranges::all_of(values_, [](double value) { return std::isfinite(value); }))
      return invalid_input("the speed of a motor, or the target of a pull, is no number");
    const double* value = values_.data();
    for (const std::size_t k : motors_) {
      const double speed = *value++;
      if (auto* const joint = world.find(joints[k]); joint && joint->motor) joint->motor->speed = speed;
    }
    for (const std::size_t k : pulls_) {
      Vector<double, Dim> target;
      for (double& component : target.components) component = *value++;
      if (auto* const joint = world.find(joints[k])) joint->target = target;
    }
    return {};
  }

 private:
  std::vector<std::size_t> motors_, pulls_;  // by the numbers of their joints
  model::Evaluation evaluation_;
  std::vector<double> values_;  // the speeds of these motors, then the targets of these pulls
};

extern template double coordinate_of(const World<double, 2>&, const Joint<double, 2>&);
extern template double coordinate_of(const World<double, 3>&, const Joint<double, 3>&);
extern template void write_joints(const World<double, 2>&, std::span<const JointHandle>, const model::WorldDescription&,
                                  std::span<double>);
extern template void write_joints(const World<double, 3>&, std::span<const JointHandle>, const model::WorldDescription&,
                                  std::span<double>);

}  // namespace continuo::worlds
