// bench/nonstiff/page.hpp
// The results as a page in Markdown.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <bench/nonstiff/drift.hpp>
#include <bench/report.hpp>

namespace continuo::bench {

inline constexpr std::array<double, 4> nonstiff_errors{1e-6, 1e-8, 1e-10, 1e-12};

void write_nonstiff_page(const std::string& file, const std::vector<Measured>& all, const std::vector<Drift>& drifts);

}  // namespace continuo::bench
