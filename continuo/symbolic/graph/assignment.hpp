// Assigns to each equation an unknown of its own among those it contains, as long as there is one (augmenting paths,
// C. Berge 1957):
//
//   Assignment assignment(2, {{0, 1}, {1}});    // the first equation contains both unknowns, the second one of them
//   assignment.first_left_over();               // npos: each has its own
//   assignment.equation_of(1);                  // 1
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

namespace continuo::model {

class Assignment {
 public:
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);

  Assignment(std::size_t unknowns, std::vector<std::vector<std::size_t>> contained)
      : contained_(std::move(contained)), equation_of_(unknowns, npos) {}

  /// The first equation that is left without one; npos where all have theirs. Where these are as many as the unknowns,
  /// every unknown is determined then.
  [[nodiscard]] std::size_t first_left_over() {
    for (std::size_t equation = 0; equation < contained_.size(); ++equation) {
      visited_.assign(equation_of_.size(), false);
      if (!find_for(equation)) return equation;
    }
    return npos;
  }
  /// The equation that the unknown was assigned to; npos: none.
  [[nodiscard]] std::size_t equation_of(std::size_t unknown) const { return equation_of_[unknown]; }
  [[nodiscard]] const std::vector<std::size_t>& contained_in(std::size_t equation) const {
    return contained_[equation];
  }

 private:
  [[nodiscard]] bool find_for(std::size_t equation) {
    for (const std::size_t unknown : contained_[equation]) {
      if (visited_[unknown]) continue;
      visited_[unknown] = true;
      if (equation_of_[unknown] != npos && !find_for(equation_of_[unknown])) continue;
      equation_of_[unknown] = equation;
      return true;
    }
    return false;
  }

  std::vector<std::vector<std::size_t>> contained_;
  std::vector<std::size_t> equation_of_;
  std::vector<bool> visited_;
};

}  // namespace continuo::model
