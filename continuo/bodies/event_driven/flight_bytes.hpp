// continuo/bodies/event_driven/flight_bytes.hpp
// Flights as bytes: their state that is not in the world. Partners are saved by number, since places change.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <continuo/bodies/event_driven/flights.hpp>
#include <continuo/bodies/support/bytes.hpp>

namespace continuo {

template <class Archive, class Real, int Dim>
void transfer_flight(Archive& archive, Flight<Real, Dim>& flight) {
  auto& [path, plan, turning, collisions, act] = flight;
  constexpr std::uint8_t tied = 128;  // beside the number of the axis
  auto axis_byte = static_cast<std::uint8_t>(plan.axis | (plan.is_tied ? tied : 0));
  archive(path.x), archive(path.v), archive(path.t);
  archive(plan.collision_time), archive(plan.crossing_time), archive(plan.last_collision), archive(turning.spun_to);
  archive(turning.rests_since), archive(plan.acceleration), archive(plan.cell), archive(plan.partner);
  archive(plan.collisions_of_partner), archive(plan.supports), archive(plan.support_count), archive(plan.is_large);
  archive(plan.direction), archive(axis_byte), archive(turning.spin_rate), archive(plan.path_end);
  archive(turning.spin), archive(turning.spun_since), archive(plan.strikes_at_once), archive(plan.in_a_row);
  auto act_byte = static_cast<std::uint8_t>(act);
  archive(collisions), archive(act_byte);
  if constexpr (Archive::reads) {
    plan.axis = static_cast<std::uint8_t>(axis_byte & ~tied), plan.is_tied = (axis_byte & tied) != 0;
    archive.expect(act_byte <= static_cast<std::uint8_t>(Act::is_proxy), "a body that moves in no known way");
    act = static_cast<Act>(act_byte & 3u);
  }
}

/// The fault of a flight that was read; nullptr where it has none.
template <class Real, int Dim>
[[nodiscard]] const char* fault_of_flight(const World<Real, Dim>& world, const Flight<Real, Dim>& flight) {
  const auto& [path, plan, turning, collisions, act] = flight;
  constexpr Real never = Plan<Real, Dim>::never;
  const auto is_number = [](const Real& value) { return value - value == Real(0); };
  if (!is_finite(path.x) || !is_finite(path.v) || !is_finite(plan.acceleration) || !is_finite(turning.spin_rate) ||
      !is_number(path.t) || !is_number(turning.spun_to) || !is_number(turning.rests_since) ||
      !is_finite(turning.spin) || !is_number(turning.spun_since))
    return "a flight that is not finite";
  if (!(plan.collision_time > -never) || !(plan.crossing_time > -never) || !(plan.last_collision < never) ||
      !(plan.path_end > -never))
    return "an event at no time";
  if (plan.path_end < never && (act != Act::rests || plan.support_count != 1)) return "a path that ends in the air";
  if ((act == Act::is_fixed) != world.is_fixed(plan.number)) return "a flight of a body that does not move";
  if (act == Act::is_fixed && (plan.collision_time < never || plan.crossing_time < never))
    return "an event of a body that does not move";
  if (act == Act::is_proxy && world.gravity == Vector<Real, Dim>{}) return "a body that nobody moves";
  const bool is_body = plan.partner < first_wall, is_wall = !is_body && plan.partner < look_again;
  if (plan.partner == nobody ? plan.collision_time < never
                             : (is_body && (plan.partner >= world.size() || plan.partner == plan.number)) ||
                                   (is_wall && plan.partner - first_wall >= world.walls().size()))
    return "a collision with nobody";
  if (plan.crossing_time < never &&
      (plan.is_large || plan.axis >= Dim || (plan.direction != 1 && plan.direction != -1)))
    return "a crossing to nowhere";
  for (const std::int64_t cell : plan.cell)
    if (cell > std::int64_t{1} << 60 || cell < -(std::int64_t{1} << 60)) return "a cell too far away";
  if (plan.support_count > Dim) return "more supports than there can be";
  for (std::size_t k = 0; k < plan.support_count; ++k)
    if (plan.supports[k] >= world.walls().size()) return "a support that is no wall";
  return nullptr;
}

template <class Real, int Dim>
void save_flights(ByteWriter& writer, const Flights<Real, Dim>& flights) {
  writer(flights.grid.edge());
  for (const std::uint32_t k : flights.places()) {
    Flight<Real, Dim> flight = flights.flight(k);
    if (flight.plan.partner < first_wall) flight.plan.partner = flights.plans[flight.plan.partner].number;
    transfer_flight(writer, flight);
  }
}
/// Reads into the flights of the same world, which must be sorted afterwards. Returns whether they could be read.
template <class Real, int Dim>
[[nodiscard]] bool load_flights(ByteReader& reader, Flights<Real, Dim>& flights) {
  Real edge{};
  reader(edge);
  reader.expect(edge > Real(0) && edge < std::numeric_limits<Real>::infinity(), "cells of no size");
  const std::vector<std::uint32_t> place = flights.places();
  for (std::uint32_t i = 0; i < place.size() && reader.ok(); ++i) {
    Flight<Real, Dim> flight = flights.flight(place[i]);
    transfer_flight(reader, flight);
    flights.set_flight(place[i], flight);
    if (const char* fault = fault_of_flight(flights.world, flight))
      reader.fail("body " + std::to_string(i) + ": " + fault);
  }
  if (!reader.ok()) return false;
  for (auto& plan : flights.plans)
    if (plan.partner < first_wall) plan.partner = place[plan.partner];
  flights.grid = CellGrid<Real, Dim>(edge, place.size());
  return true;
}

}  // namespace continuo
