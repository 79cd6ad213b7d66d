// Gives every method of the catalogue a number: the first colours, without dashes, to those that are compared most.
#include <algorithm>
#include <array>
#include <string_view>

#include <continuo/results/method_colors.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t colors_of_palette = 6;  // then the dashes change

/// Each of the first six has a colour of its own, and so have the next six.
constexpr std::array<std::string_view, 12> familiar = {
    "explicit_euler",     "semi_implicit_euler", "heun",         "implicit_euler", "rk4",    "velocity_verlet",
    "central_difference", "tsitouras5",          "rosenbrock23", "bdf2",           "dop853", "trapezoidal"};

std::size_t number_of_method(std::string_view name) {
  const std::string_view method = canonical_name(name);
  const auto known = std::ranges::find(familiar, method);
  if (known != familiar.end()) return static_cast<std::size_t>(known - familiar.begin());
  const auto& all = method_catalogue();
  const auto place = std::ranges::find(all, method, &MethodInfo::name);
  return place == all.end() ? 0 : familiar.size() + static_cast<std::size_t>(place - all.begin());
}

}  // namespace

std::vector<std::size_t> colors_of_methods(std::span<const std::string> names) {
  std::vector<std::size_t> numbers;
  for (const std::string& name : names) {
    std::size_t number = number_of_method(name);
    const bool is_known = find_method(name) != nullptr;
    while (std::ranges::find(numbers, number) != numbers.end()) number += is_known ? colors_of_palette : 1;
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace continuo::results
