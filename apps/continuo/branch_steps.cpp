#include <cmath>

#include <apps/continuo/branch_steps.hpp>
#include <apps/continuo/terminal.hpp>
#include <fmt/format.h>

namespace continuo::app {

void add_branch_steps(CLI::App& verb, BranchSteps& steps, CLI::Option* along) {
  verb.add_option("--ds", steps.first, "First step along a branch, as a part of the range; else 0.01")
      ->type_name("STEP")
      ->needs(along);
  verb.add_option("--ds-min", steps.least, "The least step, below which a branch is given up; else 1e-7")
      ->type_name("STEP")
      ->needs(along);
  verb.add_option("--ds-max", steps.largest, "The greatest step; else 0.05")->type_name("STEP")->needs(along);
}

bool are_in_order(const BranchSteps& steps) {
  const auto is_wrong = [](const char* name, const std::optional<double>& step) {
    if (!step || (std::isfinite(*step) && *step > 0)) return false;
    say(fmt::format("{} must be greater than zero, and is {}", name, *step));
    return true;
  };
  if (is_wrong("--ds", steps.first) || is_wrong("--ds-min", steps.least) || is_wrong("--ds-max", steps.largest))
    return false;
  const auto out_of_order = [](const char* small, const std::optional<double>& a, const char* large,
                               const std::optional<double>& b) {
    if (!a || !b || *a <= *b) return false;
    say(fmt::format("{} is {}, and {} is less, {}", small, *a, large, *b));
    return true;
  };
  return !out_of_order("--ds-min", steps.least, "--ds", steps.first) &&
         !out_of_order("--ds", steps.first, "--ds-max", steps.largest) &&
         !out_of_order("--ds-min", steps.least, "--ds-max", steps.largest);
}

}  // namespace continuo::app
