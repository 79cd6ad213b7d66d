// continuo/symbolic/tape/tape_enclosure.hpp
// Tapes evaluated with enclosures: where the values of expressions lie while their variables move through intervals.
//
//   std::vector<EnclosureWithSlope<double>> registers(tape.register_count()), out(tape.output_count());
//   ... registers[0..) = t with slope h, the states, the parameters as constants ...
//   tape.prepare<EnclosureWithSlope<double>>(registers);
//   tape.evaluate<EnclosureWithSlope<double>>(registers, out);
#pragma once
#include <span>

#include <continuo/numerics/enclosure_with_slope.hpp>
#include <continuo/symbolic/graph/table.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

/// The values of a table over an interval, or those of its slope.
[[nodiscard]] Enclosure<double> enclose(const Table& table, const Enclosure<double>& x, bool slope);
[[nodiscard]] EnclosureWithSlope<double> enclose(const Table& table, const EnclosureWithSlope<double>& x, bool slope);

extern template void Tape::prepare(std::span<Enclosure<double>>) const;
extern template void Tape::prepare(std::span<EnclosureWithSlope<double>>) const;
extern template void Tape::evaluate(std::span<Enclosure<double>>, std::span<Enclosure<double>>) const;
extern template void Tape::evaluate(std::span<EnclosureWithSlope<double>>, std::span<EnclosureWithSlope<double>>) const;

}  // namespace continuo::model
