// bench/reference/extrapolation.hpp
// Reference values from a code that shares nothing with the library: the modified midpoint rule, extrapolated in h^2.
// W. B. Gragg, SIAM J. Numer. Anal. 2 (1965); E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential
// Equations I", II.9. Meant for binary128: order 2 * Columns, far beyond what double precision can use.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

#include <boost/multiprecision/float128.hpp>

namespace continuo::bench {

using Quad = boost::multiprecision::float128;

/// One extrapolated step of x by h. Returns the largest difference of the last two columns.
template <std::size_t Columns, class System, std::size_t Size>
Quad extrapolate(const System& f, Quad t, Quad h, std::array<Quad, Size>& x) {
  using State = std::array<Quad, Size>;
  std::array<State, Columns> row;  // row[k]: column k of the latest row of the Neville scheme
  State slope, before, here, next;
  Quad difference = 0;
  for (std::size_t j = 0; j < Columns; ++j) {
    const std::size_t parts = 2 * (j + 1);
    const Quad part = h / static_cast<Quad>(parts);
    before = x;
    f(t, x, slope);
    for (std::size_t i = 0; i < Size; ++i) here[i] = x[i] + part * slope[i];
    for (std::size_t m = 1; m < parts; ++m) {
      f(t + static_cast<Quad>(m) * part, here, slope);
      for (std::size_t i = 0; i < Size; ++i) next[i] = before[i] + 2 * part * slope[i];
      before = here;
      here = next;
    }
    State entry = here;
    for (std::size_t k = 0; k < j; ++k) {
      const Quad ratio = static_cast<Quad>(j + 1) / static_cast<Quad>(j - k);
      State better;
      difference = 0;
      for (std::size_t i = 0; i < Size; ++i) {
        const Quad correction = (entry[i] - row[k][i]) / (ratio * ratio - 1);
        better[i] = entry[i] + correction;
        difference = std::max<Quad>(difference, (abs(correction)));
      }
      row[k] = entry;
      entry = better;
    }
    row[j] = entry;
  }
  x = row[Columns - 1];
  return difference;
}

/// x(duration) with the error of each step below `tolerance`, by order 2 * Columns.
template <std::size_t Columns, class Problem>
std::array<Quad, Problem::size> reference_end(double tolerance) {
  std::array<Quad, Problem::size> x;
  std::copy_n(Problem::start().begin(), Problem::size, x.begin());
  const Quad end = Problem::duration;
  Quad t = 0, h = end / 1000;
  while (t < end) {
    h = std::min(h, end - t);
    auto tried = x;
    const Quad error = extrapolate<Columns>(Problem{}, t, h, tried);
    const bool good = error < Quad(tolerance);
    if (good) {
      x = tried;
      t += h;
    }
    // The error shrinks with h^(2 Columns - 1): half a step less makes it some millions smaller.
    if (!good) h /= 2;
    if (good && error < Quad(tolerance) * Quad(1e-6)) h *= Quad(1.5);
  }
  return x;
}

}  // namespace continuo::bench
