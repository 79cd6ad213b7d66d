// continuo/worlds/coupled_equations.cpp
// Evaluates the forces and the states that a model couples to its bodies.
#include <algorithm>

#include <continuo/worlds/coupled_equations.hpp>

namespace continuo::worlds {

template <int Dim>
void write_body(double* state, const Vector<double, Dim>& x, const Vector<double, Dim>& v,
                const Orientation<double, Dim>& orientation, const Spin<double, Dim>& spin) {
  for (std::size_t axis = 0; axis < x.size(); ++axis) {
    *state++ = x[axis];
    *state++ = v[axis];
  }
  for (std::size_t k = 0; k < orientation.size(); ++k) *state++ = orientation[k];
  for (std::size_t k = 0; k < spin.size(); ++k) *state++ = spin[k];
}

template <int Dim>
CoupledEquations<Dim>::CoupledEquations(const model::ModelProgram& program, std::span<const double> variables)
    : mode_(program.model.start_mode), state_(program.model.states.size()) {
  const model::Model& model = program.model;
  const model::WorldDescription& text = *model.world;
  first_ = text.body_states();
  count_ = text.first_measure - first_;
  std::vector<model::NodeId> all;
  for (const model::Mode& mode : model.modes) {
    const auto begin = mode.derivatives.begin() + static_cast<std::ptrdiff_t>(first_);
    const std::vector<model::NodeId> nodes(begin, begin + static_cast<std::ptrdiff_t>(count_));
    all.insert(all.end(), nodes.begin(), nodes.end());
    if (count_ > 0) rates_.emplace_back(program.busy_tape_of(nodes), variables);
  }
  const auto take = [&](const std::vector<model::ForceDescription>& loads, std::size_t components,
                        std::vector<std::size_t>& bodies, model::Evaluation& evaluation) {
    std::vector<model::NodeId> nodes;
    for (const model::ForceDescription& load : loads) {
      bodies.push_back(load.body);
      for (std::size_t k = 0; k < components; ++k) nodes.push_back(load.components[k]);
    }
    if (!nodes.empty()) evaluation = model::Evaluation(program.tape_of(nodes), variables);
    all.insert(all.end(), nodes.begin(), nodes.end());
  };
  take(text.forces, V::size(), forces_of_, forces_);
  take(text.torques, Spin<double, Dim>::size(), torques_of_, torques_);
  const std::size_t per_body = model::WorldDescription::states_of_body(Dim);
  for (const std::uint32_t variable : variables_of(model.graph, all)) {
    const std::size_t state = variable - model.layout.states;
    if (variable < model.layout.states || state >= first_) continue;
    if (bodies_read_.empty() || bodies_read_.back() != state / per_body) bodies_read_.push_back(state / per_body);
  }
  values_.resize(std::max(forces_of_.size() * V::size(), torques_of_.size() * Spin<double, Dim>::size()));
}

template <int Dim>
void CoupledEquations<Dim>::set(std::uint32_t variable, double value) {
  for (model::Evaluation& rates : rates_) rates.set(variable, value);
  forces_.set(variable, value);
  torques_.set(variable, value);
}

template <int Dim>
void CoupledEquations<Dim>::fill(const World<double, Dim>& world, double t, const BodyStates<double, Dim>& at,
                                 std::span<const double> z) {
  const std::size_t per_body = model::WorldDescription::states_of_body(Dim);
  const bool is_told = !at.spin.empty();
  for (const std::size_t i : bodies_read_) {
    const Spin<double, Dim> spin = is_told ? at.spin[i] : world.spin[i];
    const Orientation<double, Dim> orientation =
        is_told ? at.orientation[i] : turned(world.orientation[i], spin, t - world.time);
    write_body<Dim>(state_.data() + i * per_body, at.x[i], at.v[i], orientation, spin);
  }
  std::ranges::copy(z, state_.begin() + static_cast<std::ptrdiff_t>(first_));
}

template <int Dim>
void CoupledEquations<Dim>::operator()(const World<double, Dim>& world, double t, const BodyStates<double, Dim>& at,
                                       std::span<const double> z, std::span<V> force,
                                       std::span<Spin<double, Dim>> torque, std::span<double> rate) {
  fill(world, t, at, z);
  if (!rate.empty()) rates_[mode_](t, state_, rate);
  const auto add = [&](const std::vector<std::size_t>& bodies, model::Evaluation& evaluation, auto loads) {
    if (loads.empty() || bodies.empty()) return;
    const std::size_t components = loads[0].size();
    evaluation(t, state_, std::span(values_).first(bodies.size() * components));
    for (std::size_t k = 0; k < bodies.size(); ++k)
      for (std::size_t axis = 0; axis < components; ++axis) loads[bodies[k]][axis] += values_[k * components + axis];
  };
  add(forces_of_, forces_, force);
  add(torques_of_, torques_, torque);
}

template void write_body<2>(double*, const Vector<double, 2>&, const Vector<double, 2>&, const Orientation<double, 2>&,
                            const Spin<double, 2>&);
template void write_body<3>(double*, const Vector<double, 3>&, const Vector<double, 3>&, const Orientation<double, 3>&,
                            const Spin<double, 3>&);
template class CoupledEquations<2>;
template class CoupledEquations<3>;

}  // namespace continuo::worlds
