// continuo/methods/explicit_rk/dop853.hpp
#pragma once
#include <cmath>
#include <cstddef>
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// The tableau of Dop853; its interpolant in Hairer's form is turned into ours below.
namespace dop853 {

inline constexpr Tableau<12, 3, 7> pair{
    .c = {0, 0.0526001519587677318785587544488_c, 0.0789002279381515978178381316732_c,
          0.11835034190722739672675719751_c, 0.28164965809277260327324280249_c, 1_c / 3, 1_c / 4, 4_c / 13, 127_c / 195,
          3_c / 5, 6_c / 7, 1},
    .a = {{},
          {0.0526001519587677318785587544488_c},
          {0.0197250569845378994544595329183_c, 0.0591751709536136983633785987549_c},
          {0.0295875854768068491816892993775_c, 0, 0.0887627564304205475450678981324_c},
          {0.241365134159266685502369798665_c, 0, -0.884549479328286085344864962717_c,
           0.924834003261792003115737966543_c},
          {1_c / 27, 0, 0, 0.170828608729473871279604482173_c, 0.125467687566822425016691814123_c},
          {19_c / 512, 0, 0, 0.170252211019544039314978060272_c, 0.0602165389804559606850219397283_c, -9_c / 512},
          {0.0370920001185047927108779319836_c, 0, 0, 0.170383925712239993810214054705_c,
           0.107262030446373284651809199168_c, -0.0153194377486244017527936158236_c,
           0.00827378916381402288758473766002_c},
          {0.624110958716075717114429577812_c, 0, 0, -3.36089262944694129406857109825_c,
           -0.868219346841726006818189891453_c, 27.5920996994467083049415600797_c, 20.1540675504778934086186788979_c,
           -43.4898841810699588477366255144_c},
          {0.477662536438264365890433908527_c, 0, 0, -2.48811461997166764192642586468_c,
           -0.590290826836842996371446475743_c, 21.2300514481811942347288949897_c, 15.2792336328824235832596922938_c,
           -33.2882109689848629194453265587_c, -0.0203312017085086261358222928593_c},
          {-0.93714243008598732571704021658_c, 0, 0, 5.18637242884406370830023853209_c,
           1.09143734899672957818500254654_c, -8.14978701074692612513997267357_c, -18.5200656599969598641566180701_c,
           22.7394870993505042818970056734_c, 2.49360555267965238987089396762_c, -3.0467644718982195003823669022_c},
          {2.27331014751653820792359768449_c, 0, 0, -10.5344954667372501984066689879_c,
           -2.00087205822486249909675718444_c, -17.9589318631187989172765950534_c, 27.9488845294199600508499808837_c,
           -2.85899827713502369474065508674_c, -8.87285693353062954433549289258_c, 12.3605671757943030647266201528_c,
           0.643392746015763530355970484046_c}},
    .b = {0.0542937341165687622380535766363_c, 0, 0, 0, 0, 4.45031289275240888144113950566_c,
          1.89151789931450038304281599044_c, -5.8012039600105847814672114227_c, 0.31116436695781989440891606237_c,
          -0.152160949662516078556178806805_c, 0.201365400804030348374776537501_c, 0.0447106157277725905176885569043_c},
    .extra_c = {1_c / 10, 1_c / 5, 7_c / 9},
    .extra_a = {
        {0.0561675022830479523392909219681_c, 0, 0, 0, 0, 0, 0.253500210216624811088794765333_c,
         -0.246239037470802489917441475441_c, -0.124191423263816360469010140626_c, 0.15329179827876569731206322685_c,
         0.00820105229563468988491666602057_c, 0.00756789766054569976138603589584_c, -0.008298_c},
        {0.0318346481635021405060768473261_c, 0, 0, 0, 0, 0.0283009096723667755288322961402_c,
         0.0535419883074385676223797384372_c, -0.0549237485713909884646569340306_c, 0, 0,
         -0.000108347328697249322858509316994_c, 0.000382571090835658412954920192323_c,
         -0.000340465008687404560802977114492_c, 0.141312443674632500278074618366_c},
        {-0.428896301583791923408573538692_c, 0, 0, 0, 0, -4.69762141536116384314449447206_c,
         7.68342119606259904184240953878_c, 4.06898981839711007970213554331_c, 0.356727187455281109270669543021_c, 0, 0,
         0, -0.00139902416515901462129418009734_c, 2.9475147891527723389556272149_c,
         -9.15095847217987001081870187138_c}}};

/// b minus the weights of order 5.
inline constexpr Coefficient error5[12] = {0.01312004499419488073250102996_c,
                                           0,
                                           0,
                                           0,
                                           0,
                                           -1.225156446376204440720569753_c,
                                           -0.4957589496572501915214079952_c,
                                           1.664377182454986536961530415_c,
                                           -0.350328848749973681688648729_c,
                                           0.3341791187130174790297318841_c,
                                           0.08192320648511571246570742613_c,
                                           -0.02235530786388629525884427845_c};

/// Weights of order 3: not zero at the stages 1, 9 and 12.
inline constexpr Coefficient third_order[12] = {
    31_c / 127, 0, 0, 0, 0, 0, 0, 0, 0.733846688281611857341361741547_c, 0, 0, 3_c / 136};

/// The interpolant is cubic Hermite + theta^2 (1 - theta)^2 (D4 + theta (D5 + (1 - theta) (D6 + theta D7))).
inline constexpr Coefficient d[4][16] = {
    {-8.4289382761090128651353491142_c, 0, 0, 0, 0, 0.5667149535193777696253178359_c, -3.0689499459498916912797304727_c,
     2.384667656512069828772814968_c, 2.1170345824450282767155149946_c, -0.8713915837779729920678990749_c,
     2.240437430260788275854177165_c, 0.6315787787694688181557024929_c, -0.0889903364513333108206981174_c,
     18.148505520854727256656404962_c, -9.1946323924783554000451984436_c, -4.4360363875948939664310572_c},
    {10.427508642579134603413151009_c, 0, 0, 0, 0, 242.28349177525818288430175319_c, 165.20045171727028198505394887_c,
     -374.54675472269020279518312152_c, -22.113666853125306036270938578_c, 7.7334326684722638389603898808_c,
     -30.674084731089398182061213626_c, -9.3321305264302278729567221706_c, 15.697238121770843886131091075_c,
     -31.139403219565177677282850411_c, -9.3529243588444783865713862664_c, 35.81684148639408375246589854_c},
    {19.985053242002433820987653617_c, 0, 0, 0, 0, -387.03730874935176555105901742_c, -189.17813819516756882830838328_c,
     527.80815920542364900561016686_c, -11.573902539959630126141871134_c, 6.8812326946963000169666922661_c,
     -1.000605096691083840318386098_c, 0.7777137798053443209286926574_c, -2.7782057523535084065932004339_c,
     -60.196695231264120758267380846_c, 84.320405506677161018159903784_c, 11.99229113618278932803513003_c},
    {-25.693933462703749003312586129_c, 0, 0, 0, 0, -154.18974869023643374053993627_c,
     -231.52937917604549567536039109_c, 357.6391179106141237828534991_c, 93.405324183624310003907691704_c,
     -37.458323136451633156875139351_c, 104.09964950896230045147246184_c, 29.840293426660503123344363579_c,
     -43.533456590011143754432175058_c, 96.3245539591882829483949506_c, -39.177261675615439165231486172_c,
     -149.72683625798562581422125276_c}};

[[nodiscard]] consteval Tableau<12, 3, 7> with_dense() {
  auto result = pair;
  for (std::size_t j = 0; j < 16; ++j) {
    result.dense[j][0] = d[0][j];
    result.dense[j][1] = d[1][j] + d[2][j];
    result.dense[j][2] = d[3][j] - d[2][j];
    result.dense[j][3] = -d[3][j];
  }
  return result;
}

}  // namespace dop853

/// Dormand and Prince's method of order 8 in twelve stages with Hairer's error estimate (orders 5 and 3 together) and
/// interpolant of order 7 (three more stages). The one for tolerances of some 1e-7 to 1e-13.
/// E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed. (1993), II.5 and II.6,
/// and the code DOP853 (version of 1996-2009), whose digits these are.
struct Dop853 : ExplicitRungeKutta<Dop853> {
  static constexpr std::string_view name = "dop853";
  static constexpr int order = 8, error_order = 7, dense_order = 7, dense_degree = 7;
  static constexpr Tableau<12, 3, 7> tableau = dop853::with_dense();

 private:
  struct FifthOrderError {
    constexpr const Coefficient& operator()(std::size_t j) const { return dop853::error5[j]; }
  };
  struct ThirdOrderError {
    constexpr Coefficient operator()(std::size_t j) const { return tableau.b[j] - dop853::third_order[j]; }
  };
  using Fifth = detail::Row<FifthOrderError, 12>;
  using Third = detail::Row<ThirdOrderError, 12>;

 public:
  /// The square of Hairer's combination h |err5|^2 / sqrt(n (|err5|^2 + 0.01 |err3|^2)) of the two estimates (II.10,
  /// eq. 10.17): of the size of h^8, and safe where one of the two vanishes by chance.
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    if (work.own.is_measured_by(tolerance)) return work.own.square;
    using Unit = detail::Unit<X>;
    const auto fifth = detail::stages_of<Fifth, X>(work.k);
    const auto third = detail::stages_of<Third, X>(work.k);
    Unit sum5{}, sum3{};
    detail::for_each_unit(x, [&](std::size_t i) __attribute__((always_inline)) {
      const Unit end = detail::load<X>(x_new.data(), i), scale = detail::error_scale<X>(tolerance, i, x, x_new);
      const Unit ratio5 = detail::row_sum<Fifth, X>(fifth, i) / scale;
      const Unit ratio3 = detail::row_sum<Third, X>(third, i) / scale;
      sum5 += ratio5 * ratio5 + detail::zero_if_finite(end);
      sum3 += ratio3 * ratio3;
    });
    // Both sums are zero at rest: the 1e-37 keeps 0 / 0 out, and is too small to be seen beside an error that matters.
    const Scalar<X> square5 = detail::total<X>(sum5), square3 = detail::total<X>(sum3);
    const Scalar<X> both = square5 + Scalar<X>(0.01) * square3 + Scalar<X>(1e-37);
    return (h * square5) * (h * square5) / both * detail::one_over_dimension(x);
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>& h, std::size_t i) {
    return detail::size_of_sum<Fifth, X>(work.k, h, i);
  }
};

}  // namespace continuo
