// continuo/methods/support/refined_quintic.hpp
// A quintic between two ends of a step of q'' = a(t, q) is made better by accelerations in between: a is taken where
// the quintic goes, and since h^2 a enters the position, its error counts two powers of h less. What is added is
//
//   theta^3 (1 - theta)^3 (c_0 + c_1 theta + ...),   which leaves position, velocity and acceleration at the ends,
//
// with as many c_i as there are accelerations. So two of them lead from an error h^6 to h^8, four more, taken on that
// curve, to h^10. W. H. Enright, K. R. Jackson, S. P. Norsett, P. G. Thomsen, "Interpolants for Runge-Kutta formulas",
// ACM TOMS 12 (1986), call it bootstrapping. The nodes are those in 8ths, and in 50ths, for which the error of the
// velocity is least for the first power that is not met.
#pragma once
#include <array>
#include <cstddef>

#include <continuo/methods/method.hpp>
#include <continuo/numerics/coefficient.hpp>
#include <continuo/system/system.hpp>

namespace continuo::detail {

/// node[j], and the power of theta to the i + 3 that the residual h^2 a - q'' at node j adds.
template <std::size_t Nodes>
struct QuinticRefinement {
  static constexpr std::size_t nodes = Nodes, powers = Nodes + 3;
  Coefficient node[Nodes];
  Coefficient weight[powers][Nodes];
};

template <int Round>
struct QuinticRound;
template <>
struct QuinticRound<1> {
  static constexpr QuinticRefinement<2> data{.node = {1_c / 8, 7_c / 8},
                                             .weight = {{23552_c / 3915, -72704_c / 27405},
                                                        {-146432_c / 5481, 91136_c / 5481},
                                                        {134144_c / 3045, -103424_c / 3045},
                                                        {-877568_c / 27405, 785408_c / 27405},
                                                        {8192_c / 945, -8192_c / 945}}};
};
template <>
struct QuinticRound<2> {
  static constexpr QuinticRefinement<4> data{
      .node = {2_c / 25, 2_c / 5, 3_c / 5, 23_c / 25},
      .weight = {
          {1232421875_c / 123959472, 89150875_c / 17708496, -29322125_c / 26562744, -3283203125_c / 1425533928},
          {-366794921875_c / 4887544896, -11091553375_c / 212501952, 21106375_c / 1435824, 31287109375_c / 1221886224},
          {387564453125_c / 1629181632, 13708963625_c / 70833984, -5590917625_c / 70833984,
           -177376953125_c / 1629181632},
          {-982966796875_c / 2443772448, -4179045375_c / 11805664, 5201865875_c / 26562744, 143845703125_c / 610943112},
          {6512451171875_c / 17106407136, 36887740625_c / 106250976, -25963521875_c / 106250976,
           -4697509765625_c / 17106407136},
          {-724853515625_c / 3801423808, -12450390625_c / 70833984, 2657421875_c / 17708496,
           156005859375_c / 950355952},
          {103759765625_c / 2631754944, 197265625_c / 5448768, -197265625_c / 5448768, -103759765625_c / 2631754944}}};
};

/// Corrects position and velocity of `pair` by acceleration(j) at node j of the round.
template <int Round, State X, int Degree, class Acceleration>
void refine_quintic(const Scalar<X>& h, PositionVelocity pair, const Acceleration& acceleration,
                    Interpolant<X, Degree>& interpolant) {
  using Real = Scalar<X>;
  using Number = CoefficientOf<Real>;
  constexpr auto& round = QuinticRound<Round>::data;
  const auto whole = [](std::size_t n) { return Real(static_cast<double>(n)); };
  std::array<Real, round.nodes> residual;
  for (std::size_t j = 0; j < round.nodes; ++j) {
    const Number theta = round.node[j].template as<Number>();
    Real curvature(0);
    for (std::size_t power = Degree; power >= 2; --power)
      curvature = curvature * theta + whole(power * (power - 1)) * interpolant.c[power].data()[pair.position];
    residual[j] = h * h * acceleration(j) - curvature;
  }
  for (std::size_t i = 0; i < round.powers; ++i) {
    Real more(0);
    for (std::size_t j = 0; j < round.nodes; ++j) more += round.weight[i][j].template as<Number>() * residual[j];
    interpolant.c[i + 3].data()[pair.position] += more;
    interpolant.c[i + 2].data()[pair.velocity] += whole(i + 3) * more / h;
  }
}

}  // namespace continuo::detail
