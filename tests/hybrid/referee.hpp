// tests/hybrid/referee.hpp
// The expected motion of a hybrid model, computed slowly and from the rules of events alone: closed forms between the
// events, roots by dense samples and bisection in long double. It shares no code with the library.
//
// The rules:
// - A guard has a side. At an instant it is the side just after it: of the value, or where that is zero of the first
//   derivative along the motion that is not. A guard that has been at zero since the start has none.
// - It fires when its side changes in the watched direction: by the motion, at the root; by an action, at that instant,
//   in the next round. A condition fires when it becomes true, in the same two ways.
// - What fired in one round acts in the order of the text, each on the state that the one before has left, even if that
//   has undone the reason. Within one event all actions read the state from before it.
// - Times of `at` and `every` are decimals, the end of the run included.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <tests/hybrid/hybrid_model.hpp>
#include <tests/hybrid/jet.hpp>

namespace continuo::hybrid {

struct Occurrence {
  int event = 0;
  Real t = 0;
  bool scheduled = false;  // then t is the double that is nearest to the decimal
};

struct Expected {
  std::string rejected{};  // why the model is ambiguous; empty where it is not
  std::vector<Occurrence> events{};
  std::vector<Real> end{};  // the states at the end of the run
  std::size_t most_rounds = 0, slides = 0, simultaneous = 0;
};

/// `refinement` multiplies the number of samples that the rates of the model require.
Expected referee(const HybridModel& model, int refinement = 1);

/// The same, but rejects models whose events move by more than `factor` times a change of initial values and rates:
/// they cannot be solved in finite precision.
Expected referee_of_well_conditioned(const HybridModel& model, Real factor = 20);

}  // namespace continuo::hybrid
