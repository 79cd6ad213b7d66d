// Characters see the world as it is after a step; they are the last of it to move.
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include <continuo/worlds/characters.hpp>

namespace continuo::worlds {

namespace {

constexpr double skin = 1.0 / 60;  // in radii

/// The centre of a capsule above its lowest point.
template <int Dim>
Vector<double, Dim> centre_above_foot(double height) {
  Vector<double, Dim> up;
  up[Dim - 1] = height / 2;
  return up;
}

/// What is solid to a body: groups that do not ignore its own.
template <int Dim>
QueryFilter filter_of(const World<double, Dim>& world, std::size_t body) {
  return {.groups = ~world.ignored_groups()[world.group(body)], .without = world.handle(body)};
}

}  // namespace

template <int Dim>
Characters<Dim>::Characters(const model::ModelProgram& program, std::span<const double> variables) {
  const model::WorldDescription& text = *program.model.world;
  std::vector<model::NodeId> nodes;
  for (const model::CharacterDescription& character : text.characters) {
    all_.push_back(
        {.body = character.body, .measure = character.first_measure, .name = text.bodies[character.body].name});
    for (std::size_t axis = 0; axis + 1 < Dim; ++axis) nodes.push_back(character.walk[axis]);
    nodes.push_back(character.jump);
  }
  if (!nodes.empty()) wishes_ = model::Evaluation(program.tape_of(nodes), variables);
  values_.resize(nodes.size());
}

template <int Dim>
void Characters<Dim>::set(std::uint32_t variable, double value) {
  if (!is_empty()) wishes_.set(variable, value);
}

template <int Dim>
Status Characters<Dim>::measure(const model::Model& model, std::span<const double> variables,
                                const World<double, Dim>& world) {
  std::vector<model::NodeId> nodes;
  for (const model::CharacterDescription& of : model.world->characters)
    nodes.insert(nodes.end(), {of.radius, of.height, of.steepest, of.highest_step});
  if (nodes.empty()) return {};
  const std::vector<double> values = evaluate(model, nodes, variables);
  std::vector<CharacterOptions<double>> options;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const double* const of = values.data() + 4 * k;
    options.push_back({.radius = of[0],
                       .height = of[1],
                       .steepest = of[2],
                       .highest_step = of[3],
                       .skin = skin * of[0],
                       .fall_acceleration = -world.gravity[Dim - 1],
                       .filter = filter_of(world, all_[k].body)});
    if (Status fault = check(options.back()); !fault) return invalid_input("`" + all_[k].name + "`: " + fault.message);
  }
  for (std::size_t k = 0; k < all_.size(); ++k) all_[k].options = options[k];
  return {};
}

template <int Dim>
void Characters<Dim>::prepare(double t, std::span<const double> state, const World<double, Dim>& world) {
  wishes_(t, state, values_);
  for (One& one : all_) {
    Character<double, Dim>& character = one.character;
    const V &x = world.position[one.body], &v = world.velocity[one.body];
    if (x != one.placed) {
      character.position = x - centre_above_foot<Dim>(one.options.height);
      character.is_on_ground = false, character.ground = {};
    }
    if (v != one.velocity) character.rise = v[Dim - 1];
    one.placed = x, one.velocity = v;
  }
}

template <int Dim>
Status Characters<Dim>::walk(World<double, Dim>& world, double duration) {
  const Queries<double, Dim> queries(world);
  const double* wish = values_.data();
  for (One& one : all_) {
    V velocity;
    for (std::size_t axis = 0; axis + 1 < Dim; ++axis) velocity[axis] = *wish++;
    const double jump = *wish++;
    if (!std::isfinite(jump)) return invalid_input("`" + one.name + "`: the speed at which it jumps is no number");
    if (one.character.is_on_ground && jump > 0) one.character.rise = jump;
    auto walked = continuo::walk(world, queries, one.character, velocity, duration, one.options);
    if (!walked) return invalid_input("`" + one.name + "`: " + walked.status().message);
    one.character = *std::move(walked);
    const V centre = one.character.position + centre_above_foot<Dim>(one.options.height);
    one.velocity = (centre - one.placed) * (1 / duration);
    if (!one.character.is_on_ground) one.velocity[Dim - 1] = one.character.rise;
    one.placed = centre;
    world.position[one.body] = centre, world.velocity[one.body] = one.velocity;
  }
  return {};
}

template <int Dim>
void Characters<Dim>::write(std::span<double> state) const {
  for (const One& one : all_) state[one.measure] = one.character.is_on_ground ? 1 : 0;
}

/// All numbers but its sizes, which follow from parameters.
template <int Dim>
template <class Self, class Act>
void Characters<Dim>::for_each_number(Self& one, Act&& act) {
  auto& of = one.character;
  for (auto* const v : {&of.position, &of.normal, &of.local_foot, &of.foot, &one.placed, &one.velocity})
    for (auto& component : v->components) act(component);
  act(of.rise), act(of.is_on_ground), act(of.ground.slot), act(of.ground.generation);
}

template <int Dim>
std::vector<double> Characters<Dim>::saved() const {
  std::vector<double> numbers;
  for (const One& one : all_)
    for_each_number(one, [&](const auto& number) { numbers.push_back(static_cast<double>(number)); });
  return numbers;
}

template <int Dim>
bool Characters<Dim>::fits(std::span<const double> saved) const {
  if (saved.size() != all_.size() * numbers_of_one) return false;
  for (std::size_t i = 0; i < saved.size(); ++i) {
    const std::size_t place = i % numbers_of_one;  // `placed` and `velocity` are no numbers before the first step
    const bool may_be_nothing = place >= 4 * std::size_t{Dim} && place < 6 * std::size_t{Dim};
    if (!std::isfinite(saved[i]) && !may_be_nothing) return false;
    if (place > 6 * std::size_t{Dim} && !(saved[i] >= 0 && saved[i] <= std::numeric_limits<std::uint32_t>::max()))
      return false;
  }
  return true;
}

template <int Dim>
void Characters<Dim>::restore(std::span<const double> saved) {
  for (One& one : all_)
    for_each_number(one, [&](auto& number) {
      using Number = std::remove_reference_t<decltype(number)>;
      if constexpr (std::is_same_v<Number, bool>) {
        number = saved.front() != 0;
      } else {
        number = static_cast<Number>(saved.front());
      }
      saved = saved.subspan(1);
    });
}

template class Characters<2>;
template class Characters<3>;

}  // namespace continuo::worlds
