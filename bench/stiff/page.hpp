// bench/stiff/page.hpp
// The results as people read them: on the terminal, and as a page in Markdown.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <bench/report.hpp>

namespace continuo::bench {

inline bool of_odeint(const Curve& curve) {
  return std::string_view(curve.solver).starts_with("odeint");
}
inline bool of_cvode(const Curve& curve) {
  return std::string_view(curve.solver).starts_with("cvode");
}

/// rtol = 1e-3 ... 1e-11, and what the error at the end may be at most, in units of what was asked.
inline constexpr std::array<int, 9> tolerances_asked{3, 4, 5, 6, 7, 8, 9, 10, 11};
inline constexpr double most_tolerances = 30;

struct Kept {
  std::string method;
  std::array<double, tolerances_asked.size()> error;
};

struct StiffResult {
  Measured measured;
  std::vector<Kept> kept;
  std::vector<Wanted> wanted;
};

void print_costs(const StiffResult& result);
void print_kept(const StiffResult& result);
void write_page(const std::string& file, const std::vector<StiffResult>& all);

}  // namespace continuo::bench
