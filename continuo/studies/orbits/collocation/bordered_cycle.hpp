// Linear equations of a closed chain with a border, as collocation has them for a closed orbit. Internal to
// orbit_continuation.
//
// Unknowns: for each link of the chain n numbers at its beginning, then `interior` numbers of its own; behind all of
// them two more. Equations: `interior` + n for each link, of its own unknowns, the beginning of the next one (the first
// after the last) and the two; then two, the border, of everything. All is eliminated by reflections, which let no
// entry grow, however the solutions of the chain do: S. J. Wright, "Stable parallel algorithms for two-point boundary
// value problems", SIAM J. Sci. Stat. Comput. 13 (1992) 742-764.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace continuo::studies::detail {

class BorderedCycle {
 public:
  BorderedCycle(std::size_t n, std::size_t interior, std::size_t links);

  [[nodiscard]] std::size_t unknowns() const { return links_ * (interior_ + n_) + 2; }
  /// Rows of `width()`: the link's own unknowns, its beginning, that of the next one, the two, the right-hand side. To
  /// be filled anew before each `solve`.
  [[nodiscard]] std::span<double> link(std::size_t k) {
    return std::span(rows_).subspan(k * height() * width(), height() * width());
  }
  [[nodiscard]] std::size_t width() const { return interior_ + 2 * n_ + 3; }
  [[nodiscard]] std::size_t height() const { return interior_ + n_; }
  /// The border's equation `row`, 0 or 1, of all unknowns.
  [[nodiscard]] std::span<double> border(std::size_t row) {
    return std::span(border_).subspan(row * unknowns(), unknowns());
  }

  /// False where they have no one solution. `border_values`: the right-hand side of the border.
  [[nodiscard]] bool solve(double first_border_value, double second_border_value, std::span<double> solution);

 private:
  [[nodiscard]] bool eliminate_interiors();
  [[nodiscard]] bool eliminate_beginnings();
  [[nodiscard]] bool solve_last(std::span<double> solution);
  void substitute(std::span<double> solution) const;

  std::size_t n_, interior_, links_;
  std::vector<double> rows_, border_;
  /// Of each link but the first: n rows that give its beginning by those of the first and the next one, 3 n + 3 wide,
  /// then n rows of what is left.
  std::vector<double> joints_;
  std::vector<double> closed_;  // what is left: of the first beginning twice, the two, the right-hand side
  std::vector<double> corner_;  // of the border: the two, the right-hand side
};

}  // namespace continuo::studies::detail
