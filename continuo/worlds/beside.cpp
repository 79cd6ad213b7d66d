// continuo/worlds/beside.cpp
#include <algorithm>

#include <continuo/worlds/beside.hpp>

namespace continuo::worlds {

template <int Dim>
void write_body(double* state, const Vector<double, Dim>& x, const Vector<double, Dim>& v,
                const Orientation<double, Dim>& orientation, const Spin<double, Dim>& spin) {
  for (std::size_t axis = 0; axis < x.size(); ++axis) {
    *state++ = x[axis];
    *state++ = v[axis];
  }
  if constexpr (Dim == 2) *state++ = orientation[0];
  for (std::size_t k = 0; k < spin.size(); ++k) *state++ = spin[k];
}

template <int Dim>
Beside<Dim>::Beside(const model::ModelProgram& program, std::span<const double> variables)
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
    if (count_ > 0) rates_.emplace_back(program.tape_of(nodes), variables);
  }
  std::vector<model::NodeId> nodes;
  for (const model::ForceDescription& force : text.forces) {
    forces_of_.push_back(force.body);
    for (std::size_t axis = 0; axis < V::size(); ++axis) nodes.push_back(force.components[axis]);
  }
  if (!nodes.empty()) forces_ = model::Evaluation(program.tape_of(nodes), variables);
  all.insert(all.end(), nodes.begin(), nodes.end());
  const std::size_t per_body = model::WorldDescription::states_of_body(Dim);
  for (const std::uint32_t variable : variables_of(model.graph, all)) {
    const std::size_t state = variable - model.layout.states;
    if (variable < model.layout.states || state >= first_) continue;
    if (bodies_read_.empty() || bodies_read_.back() != state / per_body) bodies_read_.push_back(state / per_body);
  }
  values_.resize(nodes.size());
}

template <int Dim>
void Beside<Dim>::set(std::uint32_t variable, double value) {
  for (model::Evaluation& rates : rates_) rates.set(variable, value);
  forces_.set(variable, value);
}

template <int Dim>
void Beside<Dim>::fill(const World<double, Dim>& world, double t, std::span<const V> x, std::span<const V> v,
                       std::span<const double> z) {
  const std::size_t per_body = model::WorldDescription::states_of_body(Dim);
  for (const std::size_t i : bodies_read_) {
    auto orientation = world.orientation[i];
    if constexpr (Dim == 2) orientation += world.spin[i] * (t - world.time);  // no torque acts between contacts
    write_body<Dim>(state_.data() + i * per_body, x[i], v[i], orientation, world.spin[i]);
  }
  std::ranges::copy(z, state_.begin() + static_cast<std::ptrdiff_t>(first_));
}

template <int Dim>
void Beside<Dim>::operator()(const World<double, Dim>& world, double t, std::span<const V> x, std::span<const V> v,
                             std::span<const double> z, std::span<V> force, std::span<double> rate) {
  fill(world, t, x, v, z);
  if (!rate.empty()) rates_[mode_](t, state_, rate);
  if (force.empty() || forces_of_.empty()) return;
  forces_(t, state_, values_);
  for (std::size_t k = 0; k < forces_of_.size(); ++k)
    for (std::size_t axis = 0; axis < V::size(); ++axis) force[forces_of_[k]][axis] += values_[k * V::size() + axis];
}

template void write_body<2>(double*, const Vector<double, 2>&, const Vector<double, 2>&, const Orientation<double, 2>&,
                            const Spin<double, 2>&);
template void write_body<3>(double*, const Vector<double, 3>&, const Vector<double, 3>&, const Orientation<double, 3>&,
                            const Spin<double, 3>&);
template class Beside<2>;
template class Beside<3>;

}  // namespace continuo::worlds
