// Differentiates the speeds of motors.
#include <array>
#include <memory>

#include <continuo/language/world_methods.hpp>
#include <continuo/symbolic/graph/derivative.hpp>
#include <continuo/worlds/motor_laws.hpp>

namespace continuo::worlds {

MotorLaws::MotorLaws(const model::ModelProgram& program, std::span<const double> variables)
    : state_(program.model.states.size()) {
  const model::Model& model = program.model;
  for (std::size_t k = 0; k < model.world->joints.size(); ++k) {
    const model::NodeId speed = model.world->joints[k].motor_speed;
    if (!speed.valid() || !changes(model, speed) || reads_states(model, speed)) continue;
    model::Graph graph = model.graph;
    const model::NodeId of_time = program.with_inputs(graph, speed);
    const std::array nodes{of_time, differentiate(graph, of_time, model::Layout::time)};
    const auto tape = std::make_shared<const model::Tape>(graph, nodes, program.tape_variables(), program.tables);
    motors_.push_back({k, model::Evaluation(tape, variables)});
  }
}

void MotorLaws::set(std::uint32_t variable, double value) {
  for (Motor& motor : motors_) motor.speed.set(variable, value);
}

std::vector<MotorLaw<double>> MotorLaws::laws(std::span<const JointHandle> joints) {
  std::vector<MotorLaw<double>> made;
  for (Motor& motor : motors_)
    made.push_back({joints[motor.joint], [this, &motor](double t) {
                      std::array<double, 2> now{};
                      motor.speed(t, state_, now);
                      return MotorSpeed<double>{now[0], now[1]};
                    }});
  return made;
}

}  // namespace continuo::worlds
