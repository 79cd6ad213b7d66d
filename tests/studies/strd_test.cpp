// The 27 nonlinear regressions of NIST's Statistical Reference Datasets, from both of their starts, to the certified
// values, deviations and sums of squares: https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml. The files are NIST's
// own, in strd/. Each is a model whose output is a function of time.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/fit.hpp>

namespace continuo::studies::strd_test {
namespace {

struct Regression {
  const char* name;
  const char* formula;  // of t
};
constexpr const char* lanczos = "b1*exp(-b2*t) + b3*exp(-b4*t) + b5*exp(-b6*t)";
constexpr const char* gauss = "b1*exp(-b2*t) + b3*exp(-(t - b4)^2/b5^2) + b6*exp(-(t - b7)^2/b8^2)";
constexpr const char* cubic = "(b1 + b2*t + b3*t^2 + b4*t^3)/(1 + b5*t + b6*t^2 + b7*t^3)";

constexpr Regression regressions[] = {
    {"Misra1a", "b1*(1 - exp(-b2*t))"},
    {"Chwirut2", "exp(-b1*t)/(b2 + b3*t)"},
    {"Chwirut1", "exp(-b1*t)/(b2 + b3*t)"},
    {"Lanczos3", lanczos},
    {"Gauss1", gauss},
    {"Gauss2", gauss},
    {"DanWood", "b1*t^b2"},
    {"Misra1b", "b1*(1 - (1 + b2*t/2)^(-2))"},
    {"Kirby2", "(b1 + b2*t + b3*t^2)/(1 + b4*t + b5*t^2)"},
    {"Hahn1", cubic},
    {"Nelson", "b1 - b2*t*exp(-b3*other)"},
    {"MGH17", "b1 + b2*exp(-t*b4) + b3*exp(-t*b5)"},
    {"Lanczos1", lanczos},
    {"Lanczos2", lanczos},
    {"Gauss3", gauss},
    {"Misra1c", "b1*(1 - (1 + 2*b2*t)^(-0.5))"},
    {"Misra1d", "b1*b2*t/(1 + b2*t)"},
    {"Roszman1", "b1 - b2*t - atan(b3/(t - b4))/pi"},
    {"ENSO",
     "b1 + b2*cos(2*pi*t/12) + b3*sin(2*pi*t/12) + b5*cos(2*pi*t/b4) + b6*sin(2*pi*t/b4) + b8*cos(2*pi*t/b7) + "
     "b9*sin(2*pi*t/b7)"},
    {"MGH09", "b1*(t^2 + t*b2)/(t^2 + t*b3 + b4)"},
    {"Thurber", cubic},
    {"BoxBOD", "b1*(1 - exp(-b2*t))"},
    {"Rat42", "b1/(1 + exp(b2 - b3*t))"},
    {"MGH10", "b1*exp(b2/(t + b3))"},
    {"Eckerle4", "(b1/b2)*exp(-0.5*((t - b3)/b2)^2)"},
    {"Rat43", "b1/(1 + exp(b2 - b3*t))^(1/b4)"},
    {"Bennett5", "b1*(b2 + t)^(-1/b3)"},
};

struct Certified {
  std::vector<double> starts[2], values, deviations;
  double sum_of_squares = 0;
  std::map<double, std::vector<std::pair<double, double>>> rows;  // (x, y), by the other predictor where there is one
};

Certified read(const std::string& name) {
  Certified result;
  std::ifstream file(CONTINUO_SOURCE_DIR "/tests/studies/strd/" + name + ".dat");
  bool in_data = false;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string first, equals;
    words >> first;
    if (in_data) {
      std::istringstream numbers(line);
      double y = 0, x = 0, other = 0;
      if (!(numbers >> y >> x)) continue;
      numbers >> other;
      result.rows[other].emplace_back(x, name == "Nelson" ? std::log(y) : y);
    } else if (first == "Data:" && line.find('x') != std::string::npos && line.find("Response") == std::string::npos) {
      in_data = true;
    } else if (first.size() == 2 && first[0] == 'b' && (words >> equals) && equals == "=") {
      double numbers[4];
      for (double& number : numbers) words >> number;
      result.starts[0].push_back(numbers[0]);
      result.starts[1].push_back(numbers[1]);
      result.values.push_back(numbers[2]);
      result.deviations.push_back(numbers[3]);
    } else if (line.starts_with("Residual Sum of Squares:")) {
      result.sum_of_squares = std::stod(line.substr(line.find(':') + 1));
    }
  }
  return result;
}

FitRequest request_of(const Regression& regression, const Certified& certified, int start) {
  double low = INFINITY, high = -INFINITY;
  FitRequest request{.program = nullptr, .data = {}, .unknowns = {}};
  for (const auto& [other, rows] : certified.rows) {
    FitData data;
    data.measurements = {.file = regression.name, .columns = {"y"}, .times = {}, .lines = {}, .values = {{}}};
    auto sorted = rows;
    std::ranges::sort(sorted);
    for (const auto& [x, y] : sorted) {
      data.measurements.times.push_back(x);
      data.measurements.lines.push_back(data.measurements.lines.size() + 1);
      data.measurements.values[0].push_back(y);
      low = std::min(low, x), high = std::max(high, x);
    }
    data.columns = {{.column = 0, .quantity = "y"}};
    data.parameters = {{"other", other}};
    request.data.push_back(std::move(data));
  }
  request.one_deviation = true;
  std::ostringstream text;
  text.precision(17);
  text << "param other = 0\n";
  for (std::size_t i = 0; i < certified.values.size(); ++i)
    text << "param b" << i + 1 << " = " << certified.starts[start][i] << "\n";
  text << "s' = 0\ns(" << low << ") = 0\noutput y = " << regression.formula << "\nrun " << low << ".." << high << "\n";
  request.program = program_of(text.str());
  for (std::size_t i = 0; i < certified.values.size(); ++i)
    request.unknowns.push_back(
        {.influence = {.index = model::find_parameter(request.program->model, "b" + std::to_string(i + 1))}});
  return request;
}

class Strd : public testing::TestWithParam<Regression> {};

// The certified values have eleven digits. The search ends when the sum of squares is constant to fourteen, which
// determines unknowns and deviations to six; of deviations four are tested. Lanczos1 has residuals of 1e-13, the
// rounding of its data, and so has every close fit: its sum of squares and deviations are below the resolution of
// doubles.
TEST_P(Strd, IsFoundFromBothStarts) {
  const Certified certified = read(GetParam().name);
  ASSERT_FALSE(certified.values.empty());
  const bool exact = certified.sum_of_squares < 1e-20;
  for (const int start : {0, 1}) {
    const Fit found = fit(request_of(GetParam(), certified, start));
    ASSERT_TRUE(found.found()) << found.status.message;
    EXPECT_FALSE(found.doubts_of(FitDoubt::Kind::not_converged)) << start;
    for (std::size_t i = 0; i < certified.values.size(); ++i) {
      EXPECT_NEAR(found.estimates[i].value, certified.values[i],
                  1e-6 * (std::abs(certified.values[i]) + certified.deviations[i]))
          << "start " << start + 1 << ", b" << i + 1;
      if (exact) continue;
      EXPECT_NEAR(found.estimates[i].deviation, certified.deviations[i], 1e-4 * certified.deviations[i])
          << "start " << start + 1 << ", b" << i + 1;
    }
    if (exact) continue;
    EXPECT_NEAR(*found.statistics.sum_of_squares, certified.sum_of_squares, 1e-8 * certified.sum_of_squares);
  }
}

INSTANTIATE_TEST_SUITE_P(Nist, Strd, testing::ValuesIn(regressions),
                         [](const auto& regression) { return std::string(regression.param.name); });

}  // namespace
}  // namespace continuo::studies::strd_test
