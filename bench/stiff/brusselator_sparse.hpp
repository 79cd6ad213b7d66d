// bench/stiff/brusselator_sparse.hpp
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <bench/problems/brusselator_line.hpp>

#include <continuo/numerics/sparse_pattern.hpp>

namespace continuo::bench {

/// BrusselatorLine that gives its Jacobian as a sparse matrix, column by column. Ours and the peer's solver are both
/// given the entries by this code.
struct SparseBrusselator : BrusselatorLine<> {
  SparsePattern pattern;
  std::vector<std::size_t> place;  // of each entry of jacobian_entries in the pattern

  explicit SparseBrusselator(std::size_t count = 500) {
    points = count;
    diffusion = static_cast<double>((points + 1) * (points + 1)) / 50;
    const State x = start();
    std::vector<MatrixPlace> places;
    jacobian_entries(x, [&](std::size_t row, std::size_t column, double) {
      places.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)});
    });
    pattern = SparsePattern(x.size(), places);
    for (const MatrixPlace& at : places) place.push_back(pattern.find(at.row, at.column));
  }

  const SparsePattern& jacobian_pattern() const { return pattern; }
  template <class X>
  void jacobian_values(double, const X& x, std::span<double> values) const {
    const std::size_t* next = place.data();
    jacobian_entries(x, [&](std::size_t, std::size_t, double value) { values[*next++] = value; });
  }
};

}  // namespace continuo::bench
