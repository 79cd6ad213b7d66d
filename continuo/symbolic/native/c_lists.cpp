// Finds loops over the places of lists, at which their numbers advance evenly.
#include <vector>

#include <fmt/format.h>

#include <continuo/symbolic/native/c_lists.hpp>
#include <continuo/symbolic/native/loop_nests.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t most_statements = 1000;

std::string statement(const CList& list, const std::string& place, const std::string& number) {
  return fmt::format("{}[{}] = {};", list.name, place, number);
}

}  // namespace

std::optional<std::string> c_loops(std::span<const CList> lists) {
  const std::size_t count = lists.front().numbers.size(), width = 1 + lists.size();
  std::vector<std::int32_t> addresses;
  addresses.reserve(count * width);
  for (std::size_t k = 0; k < count; ++k) {
    addresses.push_back(static_cast<std::int32_t>(k));
    for (const CList& list : lists) addresses.push_back(static_cast<std::int32_t>(list.numbers[k]));
  }
  const Loops loops = loops_of(addresses, width);
  if (loops.alone.size() + loops.nests.size() > most_statements) return std::nullopt;
  std::string text;
  for (const std::size_t k : loops.alone) {
    for (const CList& list : lists)
      text += fmt::format("  {}\n", statement(list, fmt::format("{}", k), fmt::format("{}", list.numbers[k])));
  }
  for (const LoopNest& nest : loops.nests) {
    const auto index = [&](std::size_t column) {
      std::vector<std::int64_t> steps;
      for (const LoopNest::Dimension& dimension : nest.dimensions) steps.push_back(dimension.steps[column]);
      return sum_text(addresses[nest.member * width + column], steps);
    };
    for (std::size_t d = nest.dimensions.size(); d-- > 0;)
      text += fmt::format("  for (int {0} = 0; {0} < {1}; ++{0}){2}\n", loop_variables[d], nest.dimensions[d].count,
                          d == 0 ? " {" : "");
    for (std::size_t l = 0; l < lists.size(); ++l)
      text += fmt::format("    {}\n", statement(lists[l], index(0), index(l + 1)));
    text += "  }\n";
  }
  return text;
}

}  // namespace continuo::model
