// Adds the options for the length of steps along a branch, and tests their order.
#include <algorithm>

#include <apps/continuo/studies/branch_steps.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

namespace continuo::app {

void add_branch_steps(CLI::App& verb, BranchSteps& steps, CLI::Option* along) {
  verb.add_option("--ds", steps.first, "First step along a branch, as a fraction of the range (0.01)")
      ->type_name("STEP")
      ->needs(along);
  verb.add_option("--ds-min", steps.least, "Smallest step, below which a branch ends (1e-7)")
      ->type_name("STEP")
      ->needs(along);
  verb.add_option("--ds-max", steps.largest, "Largest step (0.05)")->type_name("STEP")->needs(along);
}

bool are_in_order(const BranchSteps& steps) {
  const auto is_wrong = [](const char* name, const std::optional<double>& step) {
    if (!step || (*step > 0 && *step <= 1)) return false;
    if (*step > 1) {
      say(fmt::format("{} is {}: a step is a fraction of the range, at most 1", name, *step));
      return true;
    }
    say(fmt::format("{} must be greater than zero, and is {}", name, *step));
    return true;
  };
  if (is_wrong("--ds", steps.first) || is_wrong("--ds-min", steps.least) || is_wrong("--ds-max", steps.largest))
    return false;
  // What is not given is what the options' help says, or gives way to what is.
  constexpr double usual_least = 1e-7, usual_largest = 0.05;
  const double least = steps.least.value_or(usual_least);
  const double largest = steps.largest.value_or(std::max(usual_largest, steps.first.value_or(0)));
  const auto out_of_order = [](const char* small, double a, const char* large, double b) {
    if (a <= b) return false;
    say(fmt::format("{} is {}, and {} is less, {}", small, a, large, b));
    return true;
  };
  return !(steps.first && out_of_order("--ds-min", least, "--ds", *steps.first)) &&
         !(steps.first && steps.largest && out_of_order("--ds", *steps.first, "--ds-max", largest)) &&
         !out_of_order("--ds-min", least, "--ds-max", largest);
}

}  // namespace continuo::app
