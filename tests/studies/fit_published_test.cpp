// Fits of differential equations that the literature has solved.
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
  ASSERT_TRUE(found.found()) << found.problem;
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
  ASSERT_TRUE(found.found()) << found.problem;
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
  ASSERT_TRUE(found.found()) << found.problem;
  const double values[] = {-2.9196, 0.5752, -3.9159}, deviations[] = {0.1709, 0.1728, 0.1273};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.estimates[i].value, values[i], 6e-5);
    EXPECT_NEAR(found.estimates[i].deviation, deviations[i], 6e-5);
    EXPECT_NEAR(found.estimates[i].degrees, 8, 1e-6);
  }
  EXPECT_NEAR(found.columns[0].met, 0.732, 6e-4);
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
  ASSERT_TRUE(found.found()) << found.problem;
  // SciPy's least squares of the logarithms with equal weights; the deviations of the two are equal to 1 %.
  const double values[] = {0.54016, 0.0271654, 0.796384, 0.0236946, 34.6024, 5.84451};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(found.estimates[i].value, values[i], 3e-3 * values[i]);
    EXPECT_LT(found.estimates[i].low, values[i]);
  }
  EXPECT_NEAR(found.columns[0].met, 0.25, 0.03);
  EXPECT_NEAR(found.columns[1].met, 0.25, 0.03);
}

}  // namespace
}  // namespace continuo::studies::fit_published_test
