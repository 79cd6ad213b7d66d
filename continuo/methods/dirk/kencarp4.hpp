// continuo/methods/dirk/kencarp4.hpp
#pragma once
#include <string_view>

#include <continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp>

namespace continuo {

/// ARK4(3)6L[2]SA of Kennedy and Carpenter, orders 4 and 3, six stages: an L-stable method with explicit first stage
/// for the stiff part of f and an explicit one for the rest, where the system is split (system.hpp, IsSplit); otherwise
/// the implicit one for all. Interpolant of order 3. C. A. Kennedy, M. H. Carpenter, "Additive Runge-Kutta schemes for
/// convection-diffusion-reaction equations", Appl. Numer. Math. 44 (2003) 139-181.
struct KenCarp4 : DiagonallyImplicitRungeKutta<KenCarp4> {
  static constexpr std::string_view name = "kencarp4";
  static constexpr int order = 4, error_order = 3, dense_degree = 3, dense_order = 3;
  static constexpr DiagonalTableau<6, 3> tableau{
      .gamma = 1_c / 4,
      .c = {0, 1_c / 2, 83_c / 250, 31_c / 50, 17_c / 20, 1},
      .a = {{},
            {1_c / 4, 1_c / 4},
            {8611_c / 62500, -1743_c / 31250, 1_c / 4},
            {5012029_c / 34652500, -654441_c / 2922500, 174375_c / 388108, 1_c / 4},
            {15267082809_c / 155376265600, -71443401_c / 120774400, 730878875_c / 902184768, 2285395_c / 8070912,
             1_c / 4},
            {82889_c / 524892, 0, 15625_c / 83664, 69875_c / 102672, -2260_c / 8211, 1_c / 4}},
      .b = {82889_c / 524892, 0, 15625_c / 83664, 69875_c / 102672, -2260_c / 8211, 1_c / 4},
      .embedded = {4586570599_c / 29645900160, 0, 178811875_c / 945068544, 814220225_c / 1159782912,
                   -3700637_c / 11593932, 61727_c / 225920},
      .explicit_a = {{},
                     {1_c / 2},
                     {13861_c / 62500, 6889_c / 62500},
                     {-116923316275_c / 2393684061468, -2731218467317_c / 15368042101831,
                      9408046702089_c / 11113171139209},
                     {-451086348788_c / 2902428689909, -2682348792572_c / 7519795681897,
                      12662868775082_c / 11960479115383, 3355817975965_c / 11060851509271},
                     {647845179188_c / 3216320057751, 73281519250_c / 8382639484533, 552539513391_c / 3454668386233,
                      3354512671639_c / 8306763924573, 4040_c / 17871}},
      .dense = {
          {6943876665148_c / 7220017795957, 0, 7640104374378_c / 9702883013639, -20649996744609_c / 7521556579894,
           8854892464581_c / 2390941311638, -11397109935349_c / 6675773540249},
          {-54480133_c / 30881146, 0, -11436875_c / 14766696, 174696575_c / 18121608, -12120380_c / 966161,
           3843_c / 706},
          {6818779379841_c / 7100303317025, 0, 2173542590792_c / 12501825683035, -31592104683404_c / 5083833661969,
           61146701046299_c / 7138195549469, -17219254887155_c / 4939391667607}}};
};

}  // namespace continuo
