// How often intervals of 95 % hold the truth: by loss, error model and length of the columns, in repeated fits of
// x = a e^(-k t) with known a and k. Of 1,000 repeats a share of 95 % has a deviation of 0.7 %.
//
//   fit_coverage [REPEATS] [models|losses|columns|ratios|several]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <continuo/language/check/check.hpp>
#include <continuo/language/syntax/parser.hpp>
#include <continuo/studies/fit.hpp>

namespace {

using namespace continuo;
using namespace continuo::studies;

constexpr double true_a = 8, true_k = 0.6;
using Noise = std::function<double(double value, std::mt19937_64& random)>;

double normal(std::mt19937_64& random) {
  return std::normal_distribution<double>(0, 1)(random);
}

struct Case {
  std::string name;
  ErrorModel error;
  Noise noise;
};

std::shared_ptr<const model::ModelProgram> decay() {
  const model::Source source("decay.sim", "param a = 6, k = 0.8\nx' = -k*x\nx(0) = a\noutput y = 100*x\nrun 0..4\n");
  return model::compile(std::move(*check(model::parse(source).model, source).model));
}

// Where large values are many and late, not few and early.
std::shared_ptr<const model::ModelProgram> growth() {
  const model::Source source("growth.sim",
                             "param a = 6, k = 0.8\nx' = a - k*x\nx(0) = 0\noutput y = 100*x\nrun 0..4\n");
  return model::compile(std::move(*check(model::parse(source).model, source).model));
}
double grown(double t) {
  return true_a / true_k * (1 - std::exp(-true_k * t));
}
double decayed(double t) {
  return true_a * std::exp(-true_k * t);
}

FitData column(std::size_t rows, const std::string& quantity, double factor, const Case& which, std::mt19937_64& random,
               double (*truth)(double) = decayed) {
  FitData data;
  data.measurements = {.file = quantity, .columns = {quantity}, .times = {}, .lines = {}, .values = {{}}};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 4 * (static_cast<double>(i) + 0.5) / static_cast<double>(rows);
    data.measurements.times.push_back(t);
    data.measurements.lines.push_back(i + 2);
    data.measurements.values[0].push_back(which.noise(factor * truth(t), random));
  }
  data.columns = {{.column = 0, .quantity = quantity, .error = which.error}};
  return data;
}

struct Coverage {
  int a = 0, k = 0, none = 0;
  double widths = 0;
};

template <class Make>
Coverage covered(int repeats, const Make& make) {
  Coverage result;
  for (int i = 0; i < repeats; ++i) {
    const Fit found = fit(make());
    if (!found.found()) {
      ++result.none;
      continue;
    }
    result.a += found.estimates[0].low <= true_a && true_a <= found.estimates[0].high;
    result.k += found.estimates[1].low <= true_k && true_k <= found.estimates[1].high;
    result.widths += found.half_width(1) / repeats;
  }
  return result;
}

void print(const std::string& what, const char* loss, std::size_t rows, const Coverage& c, int repeats) {
  std::printf("%-34s %-8s %4zu   a %5.1f %%   k %5.1f %%   +- %-9.3g %s\n", what.c_str(), loss, rows,
              100.0 * c.a / repeats, 100.0 * c.k / repeats, c.widths, c.none > 0 ? "some not found" : "");
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const int repeats = count > 1 ? std::atoi(words[1]) : 1000;
  const std::string only = count > 2 ? words[2] : "";
  const auto program = decay(), growing = growth();
  std::mt19937_64 random(1);
  const std::vector<Case> cases{
      {"constant", ErrorModel::constant, [](double y, auto& r) { return y + 0.3 * normal(r); }},
      {"proportional", ErrorModel::proportional, [](double y, auto& r) { return y * (1 + 0.08 * normal(r)); }},
      {"both", ErrorModel::both, [](double y, auto& r) { return y + 0.1 * normal(r) + 0.06 * y * normal(r); }},
      {"lognormal", ErrorModel::lognormal, [](double y, auto& r) { return y * std::exp(0.1 * normal(r)); }},
  };
  const Case poisson{"poisson", ErrorModel::poisson,
                     [](double y, auto& r) { return static_cast<double>(std::poisson_distribution<int>(y)(r)); }};
  const Case contaminated{"a tenth ten times as far off", ErrorModel::constant, [](double y, auto& r) {
                            const bool far = std::uniform_real_distribution<double>(0, 1)(r) < 0.1;
                            return y + (far ? 3 : 0.3) * normal(r);
                          }};
  const auto request = [&] {
    FitRequest made{.program = program, .data = {}, .unknowns = {}};
    made.unknowns = {{.influence = {.index = 0}}, {.influence = {.index = 1}}};
    made.starts_in_doubt = 0;
    return made;
  };
  const auto run = [&](const Case& which, std::size_t rows, Loss loss, const char* quantity, double factor) {
    const auto c = covered(repeats, [&] {
      FitRequest made = request();
      made.data = {column(rows, quantity, factor, which, random)};
      made.options.loss = loss;
      return made;
    });
    print(which.name, loss_names[static_cast<std::size_t>(loss)].data(), rows, c, repeats);
  };
  const std::vector<std::size_t> lengths{5, 7, 10, 20, 50, 100};
  const std::vector<Loss> losses{Loss::squares, Loss::huber, Loss::soft_l1, Loss::cauchy, Loss::tukey};
  if (only.empty() || only == "models") {
    for (const Case& which : cases)
      for (const std::size_t rows : lengths) run(which, rows, Loss::squares, "x", 1);
    for (const std::size_t rows : lengths) run(poisson, rows, Loss::squares, "y", 100);
  }
  if (only.empty() || only == "losses") {
    for (const Loss loss : losses)
      for (const std::size_t rows : lengths) run(cases[0], rows, loss, "x", 1);
    for (const Loss loss : losses)
      for (const std::size_t rows : {20U, 50U, 100U}) run(contaminated, rows, loss, "x", 1);
  }
  // The ratio of the two deviations is that at the value 3, in the midst of either model's.
  if (only.empty() || only == "ratios")
    for (const bool grows : {false, true})
      for (const double ratio : {0.1, 1.0, 10.0})
        for (const std::size_t rows : {5U, 7U, 10U, 20U}) {
          const Case both{"", ErrorModel::both, [&](double y, auto& r) {
                            return y + 0.2 / std::hypot(1, ratio) * (normal(r) + ratio * y / 3 * normal(r));
                          }};
          const auto c = covered(repeats, [&] {
            FitRequest asked = request();
            asked.program = grows ? growing : program;
            asked.data = {column(rows, "x", 1, both, random, grows ? grown : decayed)};
            return asked;
          });
          char what[64];
          std::snprintf(what, sizeof what, "%s, relative %g times constant", grows ? "growth" : "decay", ratio);
          print(what, "squares", rows, c, repeats);
        }
  // Columns of two deviations each, as large as each other at the value 3; all columns are as exact as each other.
  if (only.empty() || only == "several")
    for (const std::vector<std::size_t>& rows : {std::vector<std::size_t>{5, 5}, {8, 8}, {12, 12}, {5, 100}, {6, 6, 6}})
      for (const bool grows : {false, true}) {
        const auto c = covered(repeats, [&] {
          FitRequest made = request();
          made.program = grows ? growing : program;
          for (std::size_t i = 0; i < rows.size(); ++i) {
            const double size = i == 0 ? 1 : 100;
            const Case both{"", ErrorModel::both,
                            [size](double y, auto& r) { return y + 0.15 * size * normal(r) + 0.05 * y * normal(r); }};
            made.data.push_back(column(rows[i], i == 0 ? "x" : "y", size, both, random, grows ? grown : decayed));
          }
          return made;
        });
        std::size_t all = 0;
        for (const std::size_t n : rows) all += n;
        print(std::string(grows ? "growth" : "decay") + ", " + std::to_string(rows.size()) +
                  " of two deviations each, " + std::to_string(rows[0]) + " to " + std::to_string(rows.back()) +
                  " rows",
              "squares", all, c, repeats);
      }
  if (only.empty() || only == "columns")
    for (const auto& [first, second, times] :
         {std::tuple{5, 5, 6}, {5, 100, 6}, {100, 5, 6}, {10, 20, 6}, {8, 8, 6}, {5, 5, 1}, {8, 8, 1}, {12, 12, 1}}) {
      const auto c = covered(repeats, [&] {
        FitRequest made = request();
        const Case exact{"", ErrorModel::constant, [](double y, auto& r) { return y + 0.1 * normal(r); }};
        const Case rough{"", ErrorModel::constant, [&](double y, auto& r) { return y + 10 * times * normal(r); }};
        made.data = {column(static_cast<std::size_t>(first), "x", 1, exact, random),
                     column(static_cast<std::size_t>(second), "y", 100, rough, random)};
        return made;
      });
      print("x of " + std::to_string(first) + " rows, y of " + std::to_string(second) + ", " + std::to_string(times) +
                " times as far off",
            "squares", static_cast<std::size_t>(first + second), c, repeats);
    }
}
