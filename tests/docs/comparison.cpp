// The numbers of docs/comparison.md stand in the pages and files from which they are taken.
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tests/docs/blocks.hpp>

namespace continuo::docs {
namespace {

struct Figure {
  std::string number;              // in a row of the comparison
  std::vector<std::string> words;  // of that row
  std::string source;
  std::vector<std::string> words_there;  // of a line of the source that holds the number too
};

const std::vector<Figure>& figures() {
  static const std::string nonstiff = "docs/benchmarks_nonstiff.md", stiff = "docs/benchmarks_stiff.md",
                           results = "bench/RESULTS.md", odeint = "docs/coming_from_odeint.md";
  static const std::vector<Figure> all{
      {"**0.63**", {"Lorenz", "1e-06"}, nonstiff, {"| Lorenz to t = 10 | 1e-06 |", "odeint"}},
      {"**1.1**", {"Arenstorf", "1e-10"}, nonstiff, {"| Arenstorf orbit, one period | 1e-10 |", "odeint"}},
      {"**0.34**", {"Kepler", "1e-10"}, nonstiff, {"| Kepler, e = 0.5, 100 orbits | 1e-10 |", "odeint"}},
      {"**0.34**", {"Pleiades", "1e-12"}, nonstiff, {"| Pleiades to t = 3 | 1e-12 |", "gsl"}},
      {"**0.28**", {"Outer solar", "1e-08"}, nonstiff, {"| Outer solar system, 200,000 days | 1e-08 |", "odeint"}},
      {"**0.31**", {"Robertson", "1e-06"}, stiff, {"| Robertson to t = 1e11 | 1e-06 |"}},
      {"**0.032**", {"HIRES", "1e-10"}, stiff, {"| HIRES to t = 321.8122 | 1e-10 |"}},
      {"**0.015**", {"van der Pol", "1e-10"}, stiff, {"| van der Pol, 1 / epsilon = 1e6, to t = 11 | 1e-10 |"}},
      {"**0.10**", {"Brusselator"}, stiff, {"| Brusselator in one dimension, N = 500, to t = 10 | 1e-06 | rodas4"}},
      {"**0.11**", {"Brusselator"}, stiff, {"| Brusselator in one dimension, N = 500, to t = 10 | 1e-06 | model"}},
      {"**575**", {"right answers"}, results, {"| ours |", "**0**"}},
      {"500", {"right answers"}, results, {"| TWPBVPC |", "40"}},
      {"495", {"right answers"}, results, {"| COLNEW |", "27"}},
      {"1/47", {"gas of 1,000"}, results, {"gas of 1,000", "exact, double"}},
      {"1/12.7", {"heap of 10,000"}, results, {"heap of 10,000", "fast, double"}},
      {"2.06", {"chaotic_system"}, odeint, {"chaotic_system"}},
      {"30", {"lines"}, odeint, {"harmonic_oscillator.cpp", "92"}},
      {"**0.82**", {"machine code"}, "docs/native.md", {"outer_planets"}},
      {"**2.36**", {"bounces"}, results, {"| dop853 | 30 |"}},
      {"1.0", {"default", "Pleiades"}, nonstiff, {"| Pleiades to t = 3 |", "(dprkn8)"}},
  };
  return all;
}

bool has_line(const std::string& file, const std::string& number, const std::vector<std::string>& words) {
  std::ifstream in(std::string(CONTINUO_SOURCE_DIR) + "/" + file);
  for (std::string line; std::getline(in, line);) {
    bool found = line.find(number) != std::string::npos;
    for (const std::string& word : words) found = found && line.find(word) != std::string::npos;
    if (found) return true;
  }
  return false;
}

TEST(Comparison, EachNumberStandsInItsSource) {
  for (const Figure& figure : figures()) {
    EXPECT_TRUE(has_line("docs/comparison.md", figure.number, figure.words)) << figure.number << " " << figure.words[0];
    EXPECT_TRUE(has_line(figure.source, figure.number, figure.words_there)) << figure.source << ": " << figure.number;
  }
}

/// Every row that gives a time as a bold number is among the figures.
TEST(Comparison, EachBoldTimeIsCompared) {
  std::ifstream in(std::string(CONTINUO_SOURCE_DIR) + "/docs/comparison.md");
  std::size_t rows = 0;
  for (std::string line; std::getline(in, line);) {
    const auto start = line.find("| time **");
    if (start == std::string::npos) continue;
    ++rows;
    const std::string number = line.substr(start + 7, line.find("**", start + 9) + 2 - (start + 7));
    bool known = false;
    for (const Figure& figure : figures())
      known = known || (figure.number == number && line.find(figure.words[0]) != std::string::npos);
    EXPECT_TRUE(known) << line;
  }
  EXPECT_GT(rows, 8U);
}

}  // namespace
}  // namespace continuo::docs
