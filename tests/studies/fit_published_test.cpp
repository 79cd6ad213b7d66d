// Fits of differential equations with published solutions.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/fit.hpp>

namespace continuo::studies::fit_published_test {
namespace {

FitData data_of(std::vector<double> t, std::vector<std::string> quantities, std::vector<std::vector<double>> values) {
  FitData data;
  for (std::size_t i = 0; i < t.size(); ++i) data.measurements.lines.push_back(i + 2);
  data.measurements.file = "data.csv";
  data.measurements.times = std::move(t);
  data.measurements.columns = quantities;
  data.measurements.values = std::move(values);
  for (std::size_t c = 0; c < quantities.size(); ++c) data.columns.push_back({.column = c, .quantity = quantities[c]});
  return data;
}

FitRequest request_of(const std::string& text, const std::vector<std::string>& unknowns, FitData data) {
  FitRequest request{.program = program_of(text), .data = {std::move(data)}, .unknowns = {}};
  for (const std::string& name : unknowns)
    request.unknowns.push_back({.influence = {.index = model::find_parameter(request.program->model, name)}});
  return request;
}

// Thermal isomerization of alpha-pinene: R. E. Fuguitt, J. E. Hawkins, J. Am. Chem. Soc. 69 (1947); G. E. P. Box, W. G.
// Hunter, J. F. MacGregor, J. Erjavec, Technometrics 15 (1973). The least sum of squares is 19.872 with p = (5.926e-5,
// 2.963e-5, 2.047e-5, 2.745e-4, 3.998e-5): E. D. Dolan, J. J. More, T. S. Munson, "Benchmarking optimization software
// with COPS 3.0", ANL/MCS-TM-273 (2004), problem 6.
TEST(FitPublished, AlphaPinene) {
  const std::vector<double> t{1230, 3060, 4920, 7800, 10680, 15030, 22620, 36420};
  FitRequest request = request_of(
      "param p1 = 1e-5, p2 = 1e-5, p3 = 1e-5, p4 = 1e-4, p5 = 1e-5\n"
      "a' = -(p1 + p2)*a\nb' = p1*a\nc' = p2*a - (p3 + p4)*c + p5*e\nd' = p3*c\ne' = p4*c - p5*e\n"
      "a(0) = 100; b(0) = 0; c(0) = 0; d(0) = 0; e(0) = 0\nrun 0..36420\n",
      {"p1", "p2", "p3", "p4", "p5"},
      data_of(t, {"a", "b", "c", "d", "e"},
              {{88.35, 76.4, 65.1, 50.4, 37.5, 25.9, 14.0, 4.5},
               {7.3, 15.6, 23.1, 32.9, 42.7, 49.1, 57.4, 63.1},
               {2.3, 4.5, 5.3, 6.0, 6.0, 5.9, 5.1, 3.8},
               {0.4, 0.7, 1.1, 1.5, 1.9, 2.2, 2.6, 2.9},
               {1.75, 2.8, 5.8, 9.3, 12.0, 17.0, 21.0, 25.7}}));
  for (FitColumn& column : request.data[0].columns) column.deviation = 1;
  for (FitUnknown& unknown : request.unknowns) unknown.logarithmic = true;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  EXPECT_NEAR(*found.statistics.chi_squared, 19.872, 5e-4);
  const double published[] = {5.926e-5, 2.963e-5, 2.047e-5, 2.745e-4, 3.998e-5};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(found.estimates[i].value, published[i], 5e-4 * published[i]);
}

// J. van Domselaar, P. W. Hemker, "Nonlinear parameter estimation in initial value problems", Mathematisch Centrum NW
// 18/75 (1975): Barnes's problem, prey and predator. The values are those of SciPy's least_squares over LSODA at 1e-11.
TEST(FitPublished, Barnes) {
  std::vector<double> t;
  for (int i = 0; i <= 10; ++i) t.push_back(0.5 * i);
  FitRequest request = request_of(
      "param k1 = 1, k2 = 1, k3 = 1\nx' = k1*x - k2*x*y\ny' = k2*x*y - k3*y\nx(0) = 1; y(0) = 0.3\nrun 0..5\n",
      {"k1", "k2", "k3"},
      data_of(t, {"x", "y"},
              {{1.0, 1.1, 1.3, 1.1, 0.9, 0.7, 0.5, 0.6, 0.7, 0.8, 1.0},
               {0.3, 0.35, 0.4, 0.5, 0.5, 0.4, 0.3, 0.25, 0.25, 0.3, 0.35}}));
  for (FitColumn& column : request.data[0].columns) column.deviation = 0.1;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  const double values[] = {0.86094089, 2.07902922, 1.81494416};
  const double deviations[] = {0.056513552, 0.09340913, 0.097666419};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.estimates[i].value, values[i], 1e-5);
    EXPECT_NEAR(found.estimates[i].deviation, deviations[i], 1e-5);
  }
  EXPECT_NEAR(*found.statistics.chi_squared, 16.446135, 1e-4);
}

// Theophylline in the first subject of R. A. Upton; as R's nls(conc ~ SSfol(...)) has it in its documentation:
// lKe -2.9196 +- 0.1709, lKa 0.5752 +- 0.1728, lCl -3.9159 +- 0.1273, residual standard error 0.732 on 8 degrees.
TEST(FitPublished, Theophylline) {
  const FitRequest request = request_of(
      "param lke = -2.5, lka = 0.5, lcl = -3, dose = 4.02\n"
      "let ke = exp(lke), ka = exp(lka), cl = exp(lcl)\n"
      "depot' = -ka*depot\nbody' = ka*depot - ke*body\ndepot(0) = dose; body(0) = 0\n"
      "output conc = body*ke/cl\nrun 0..25\n",
      {"lke", "lka", "lcl"},
      data_of({0, 0.25, 0.57, 1.12, 2.02, 3.82, 5.1, 7.03, 9.05, 12.12, 24.37}, {"conc"},
              {{0.74, 2.84, 6.57, 10.5, 9.66, 8.58, 8.36, 7.47, 6.89, 5.94, 3.28}}));
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  const double values[] = {-2.9196, 0.5752, -3.9159}, deviations[] = {0.1709, 0.1728, 0.1273};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.estimates[i].value, values[i], 6e-5);
    EXPECT_NEAR(found.estimates[i].deviation, deviations[i], 6e-5);
    EXPECT_NEAR(found.estimates[i].degrees, 8, 1e-6);
  }
  EXPECT_NEAR(found.columns[0].residual_deviation, 0.732, 6e-4);
}

// Pelts of hares and lynxes of the Hudson Bay Company, 1900 to 1920, with lognormal errors: B. Carpenter,
// "Predator-prey population dynamics: the Lotka-Volterra model in Stan" (2018), whose posterior has the means 0.55,
// 0.028, 0.80, 0.024, 34, 5.9 and deviations of both kinds 0.25, under weak priors; most likely is close by.
TEST(FitPublished, HareAndLynx) {
  std::vector<double> t;
  for (int i = 0; i <= 20; ++i) t.push_back(i);
  FitRequest request = request_of(
      "param a = 1, b = 0.05, c = 1, d = 0.05, h0 = 30, l0 = 4\n"
      "hare' = a*hare - b*hare*lynx\nlynx' = d*hare*lynx - c*lynx\nhare(0) = h0; lynx(0) = l0\nrun 0..20\n",
      {"a", "b", "c", "d", "h0", "l0"},
      data_of(t, {"hare", "lynx"},
              {{30.0, 47.2, 70.2, 77.4, 36.3, 20.6, 18.1, 21.4, 22.0, 25.4, 27.1,
                40.3, 57.0, 76.6, 52.3, 19.5, 11.2, 7.6,  14.6, 16.2, 24.7},
               {4.0, 6.1,  9.8,  35.2, 59.4, 41.7, 19.0, 13.0, 8.3,  9.1, 7.4,
                8.0, 12.3, 19.5, 45.7, 51.1, 29.7, 15.8, 9.7,  10.1, 8.6}}));
  for (FitUnknown& unknown : request.unknowns) unknown.logarithmic = true;
  for (FitColumn& column : request.data[0].columns) column.error = ErrorModel::lognormal;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  // SciPy's least squares of the logarithms with equal weights; the deviations of the two are equal to 1 %.
  const double values[] = {0.54016, 0.0271654, 0.796384, 0.0236946, 34.6024, 5.84451};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(found.estimates[i].value, values[i], 3e-3 * values[i]);
    EXPECT_LT(found.estimates[i].low, values[i]);
  }
  EXPECT_NEAR(found.columns[0].residual_deviation, 0.25, 0.03);
  EXPECT_NEAR(found.columns[1].residual_deviation, 0.25, 0.03);
}

// Dimers of STAT5A and STAT5B: M. E. Boehm et al., J. Proteome Res. 13 (2014), with deviations of its three columns
// unknown, as in the collection of L. Schmiester et al., PLoS Comput. Biol. 17 (2021), whose best known -log L is
// 138.222.
TEST(FitPublished, DimersOfStat5) {
  const std::vector<std::string> unknowns{"epo", "exp_hetero", "exp_homo", "imp_hetero", "imp_homo", "phos"};
  FitRequest request = request_of(
      "param epo = 0.02, exp_hetero = 1e-4, exp_homo = 5e-3\n"
      "param imp_hetero = 0.02, imp_homo = 1e4, phos = 1e4\n"
      "param ratio = 0.693, s = 0.107, cyt = 1.4, nuc = 0.45\n"
      "let ba = 1.25e-7*exp(-epo*t)\n"
      "a' = -2*ba*a^2*phos - ba*a*b*phos + 2*(nuc/cyt)*exp_homo*naa + (nuc/cyt)*exp_hetero*nab\n"
      "b' = -2*ba*b^2*phos - ba*a*b*phos + 2*(nuc/cyt)*exp_homo*nbb + (nuc/cyt)*exp_hetero*nab\n"
      "aa' = ba*a^2*phos - imp_homo*aa\n"
      "ab' = ba*a*b*phos - imp_hetero*ab\n"
      "bb' = ba*b^2*phos - imp_homo*bb\n"
      "naa' = (cyt/nuc)*imp_homo*aa - exp_homo*naa\n"
      "nab' = (cyt/nuc)*imp_hetero*ab - exp_hetero*nab\n"
      "nbb' = (cyt/nuc)*imp_homo*bb - exp_homo*nbb\n"
      "a(0) = 207.6*ratio; b(0) = 207.6*(1 - ratio)\n"
      "aa(0) = 0; ab(0) = 0; bb(0) = 0; naa(0) = 0; nab(0) = 0; nbb(0) = 0\n"
      "output pa = (100*ab + 200*aa*s)/(ab + a*s + 2*aa*s)\n"
      "output pb = -(100*ab - 200*bb*(s - 1))/((b*(s - 1) - ab) + 2*bb*(s - 1))\n"
      "output ra = (100*ab + 100*a*s + 200*aa*s)/(2*ab + a*s + 2*aa*s - b*(s - 1) - 2*bb*(s - 1))\n"
      "run 0..240\n",
      unknowns,
      data_of(
          {0, 2.5, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 120, 160, 200, 240}, {"pa", "pb", "ra"},
          {{7.90107299873911, 66.3634939682528, 81.1713239165337, 94.7303080627876, 95.1164830493244, 91.44171655392,
            91.2570992263545, 93.672297840992, 88.754232823019, 85.2697032178279, 81.1323953369608, 76.135928475796,
            65.2480591250229, 42.5996587097166, 25.1577975445976, 15.4301823994994},
           {4.59653334288927, 29.6345459874189, 46.0438064695701, 81.9747336191685, 80.5716092952489, 79.0357196371442,
            75.6723803658298, 71.6247198618303, 69.0628632755742, 67.1473843168934, 60.8994762938824, 54.8092577721492,
            43.9812899778025, 29.7714581636675, 20.089016562771, 10.961845166698},
           {14.7231682180584, 33.762342293107, 36.7998512942493, 49.7176022859654, 46.9281200952955, 47.8365745550135,
            46.9287272497385, 40.5977529351181, 43.783663885071, 44.4573876523855, 41.3271592618297, 41.0627332148332,
            39.2358300289377, 36.6194605442418, 34.8937144010561, 32.2110771608676}}));
  for (FitUnknown& unknown : request.unknowns) unknown.low = 1e-5, unknown.high = 1e5, unknown.logarithmic = true;
  request.likelihood = Likelihood::plain;
  request.starts_in_doubt = 0;
  const Fit found = fit(request);
  ASSERT_TRUE(found.found()) << found.status.message;
  EXPECT_NEAR(*found.statistics.log_likelihood, -138.222, 2e-3);
  EXPECT_TRUE(found.estimates[1].at_bound);  // as the best known has it
}

}  // namespace
}  // namespace continuo::studies::fit_published_test
