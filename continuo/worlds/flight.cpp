// Interpolates the states of bodies between two instants.
#include <algorithm>
#include <cstddef>

#include <continuo/language/world.hpp>
#include <continuo/worlds/flight.hpp>

namespace continuo::worlds {

void Flight::at(const model::Model& model, double t, std::vector<double>& x) const {
  const double length = to - from, part = length > 0 ? std::clamp((t - from) / length, 0.0, 1.0) : 1;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = start[i] + part * (end[i] - start[i]);
  if (is_straight || part == 0 || part == 1) return;
  const model::WorldDescription& world = *model.world;
  for (const model::BodyDescription& body : world.bodies) {
    for (int axis = 0; axis < world.dimension; ++axis) {
      const std::size_t place = body.first_state + 2 * static_cast<std::size_t>(axis), speed = place + 1;
      const double rise = end[place] - start[place];
      // Hermite's cubic in the part of the piece that has passed, and its derivative.
      const double a = length * start[speed] - rise, b = length * end[speed] - rise, rest = 1 - part;
      x[place] = start[place] + part * rise + part * rest * (rest * a - part * b);
      x[speed] = (rise + rest * (1 - 3 * part) * a - part * (2 - 3 * part) * b) / length;
    }
  }
}

std::vector<double> looks_at(double from, double to, const std::vector<double>& contacts) {
  constexpr int even = 1000;
  constexpr double beside = 1e-9;  // of the run: how far a look is from its contact
  const double whole = to - from;
  std::vector<double> times;
  for (int k = 1; k < even; ++k) times.push_back(from + whole * k / even);
  for (const double contact : contacts) times.insert(times.end(), {contact - beside * whole, contact + beside * whole});
  std::erase_if(times, [&](double t) { return !(t > from && t < to); });
  std::ranges::sort(times);
  return times;
}

}  // namespace continuo::worlds
