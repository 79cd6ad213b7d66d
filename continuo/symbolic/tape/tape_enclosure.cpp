// continuo/symbolic/tape/tape_enclosure.cpp
// Tapes evaluated with enclosures, and tables enclosed over intervals.
#include <algorithm>
#include <limits>
#include <span>

#include <continuo/symbolic/tape/tape_enclosure.hpp>
#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model {

namespace {

using Values = Enclosure<double>;

/// The slope of a straight line between points: a rounding in each of three operations.
Values slope_of(const Table::Piece& piece) {
  return piece.slope == 0 ? Values() : enclosing::widened_by<2>(piece.slope, piece.slope);
}

/// Over the pieces of a table that x reaches, `visit` each with the part of x on it.
template <class Visit>
void for_each_piece(const Table& table, const Values& x, Visit&& visit) {
  const std::span<const Table::Piece> pieces = table.pieces(x.lo, x.hi);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const double from = k == 0 ? x.lo : pieces[k].x, to = k + 1 < pieces.size() ? pieces[k + 1].x : x.hi;
    visit(pieces[k], Values(from, to));
  }
}

/// No points, all points.
constexpr double unlimited = std::numeric_limits<double>::infinity();
Values nothing() {
  return {unlimited, -unlimited};
}

Values slopes(const Table& table, const Values& x) {
  Values range = nothing();
  for_each_piece(table, x, [&](const Table::Piece& piece, const Values&) { range = hull(range, slope_of(piece)); });
  return range;
}

}  // namespace

Values enclose(const Table& table, const Values& x, bool slope) {
  if (x.is_entire()) return x;
  if (slope) return slopes(table, x);
  Values range = nothing();
  for_each_piece(table, x, [&](const Table::Piece& piece, const Values& part) {
    const Values here =
        piece.slope == 0 ? Values(piece.y) : Values(piece.y) + slope_of(piece) * (part - Values(piece.x));
    range = hull(range, here);
  });
  return range;
}

EnclosureWithSlope<double> enclose(const Table& table, const EnclosureWithSlope<double>& x, bool slope) {
  const Values range = enclose(table, x.value, slope);
  if (slope || table.between() == Table::Between::step) return enclosing::with_jumps(range);
  return {range, enclosing::times_slope(slopes(table, x.value), x)};
}

template void Tape::prepare(std::span<Values>) const;
template void Tape::prepare(std::span<EnclosureWithSlope<double>>) const;
template void Tape::evaluate(std::span<Values>, std::span<Values>) const;
template void Tape::evaluate(std::span<EnclosureWithSlope<double>>, std::span<EnclosureWithSlope<double>>) const;

}  // namespace continuo::model
