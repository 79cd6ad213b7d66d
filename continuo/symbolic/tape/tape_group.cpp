// Groups equal operations into batches by colours, and orders their members for contiguous operands.
#include <algorithm>
#include <array>
#include <compare>

#include <continuo/symbolic/tape/tape_group.hpp>

namespace continuo::model::tape {

namespace {

/// Within a group, a loop over operands that lie side by side saves the gathering of them; it must save the beginning
/// of two more loops.
constexpr std::size_t smallest_cut = 32;

/// Where the stretch ends that begins here and needs no gathering.
std::size_t end_of_run(std::span<const Places> sequence, std::size_t begin) {
  std::size_t end = begin + 1;
  if (end == sequence.size()) return end;
  const auto steps = [&](std::size_t i) {
    Places step{};
    for (std::size_t k = 0; k < step.size(); ++k) step[k] = sequence[i][k] - sequence[i - 1][k];
    return step;
  };
  const Places first = steps(end);
  if (std::ranges::any_of(first, [](std::uint32_t step) { return step > 1; })) return end;
  while (end < sequence.size() && steps(end) == first) ++end;
  return end;
}

/// Operations come about in the same way if their codes do the same to operands that do. Two colours that are equal by
/// accident would stand in one group, which computes the same.
Colour colour_of(const Selected& s, std::span<const Colour> colour) {
  constexpr Colour odd = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio: spreads the bits (Knuth, TAOCP 3, 6.4)
  Colour mixed = static_cast<Colour>(s.code) + 1;
  for (std::size_t k = 0; k < operands(s.code); ++k) {
    mixed = (mixed ^ colour[s.operand[k].index]) * odd;
    mixed ^= mixed >> 32;
  }
  return mixed;
}

struct Kind {
  std::uint32_t level;
  Code code;
  friend auto operator<=>(const Kind&, const Kind&) = default;
};

struct Coloured {
  Kind kind;
  Colour colour;
  std::size_t operation;
  friend auto operator<=>(const Coloured&, const Coloured&) = default;
};

std::vector<Coloured> coloured(std::span<const Selected> selected, std::vector<Colour>& colour) {
  std::vector<std::uint32_t> level(colour.size(), 0);
  std::vector<Coloured> all;
  all.reserve(selected.size());
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const Selected& s = selected[i];
    std::uint32_t mine = 1;
    for (std::size_t k = 0; k < operands(s.code); ++k) mine = std::max(mine, level[s.operand[k].index] + 1);
    level[s.result.index] = mine;
    colour[s.result.index] = colour_of(s, colour);
    all.push_back({{mine, s.code}, colour[s.result.index], i});
  }
  std::ranges::sort(all);
  return all;
}

bool is_batch(const Kind& kind, std::size_t size) {
  return size >= smallest_batch && kind.code < Code::interpolate;
}

/// Of equal kind: one group for each colour of many, one for the others together if they are many, else each its own.
void split(std::span<const Coloured> equal, std::vector<Group>& groups) {
  const Kind kind = equal.front().kind;
  Group rest;
  while (!equal.empty()) {
    const auto end = std::ranges::find_if(equal, [&](const Coloured& c) { return c.colour != equal.front().colour; });
    Group alike;
    for (auto it = equal.begin(); it != end; ++it) alike.push_back(it->operation);
    equal = equal.subspan(alike.size());
    if (is_batch(kind, alike.size())) {
      groups.push_back(std::move(alike));
    } else {
      rest.insert(rest.end(), alike.begin(), alike.end());
    }
  }
  std::ranges::sort(rest);
  if (is_batch(kind, rest.size())) {
    groups.push_back(std::move(rest));
  } else {
    for (const std::size_t i : rest) groups.push_back({i});
  }
}

}  // namespace

std::vector<Group> groups_of(std::span<const Selected> selected, std::vector<Colour>& colour) {
  const std::vector<Coloured> sorted = coloured(selected, colour);
  std::vector<Group> groups;
  for (std::span<const Coloured> left = sorted; !left.empty();) {
    const auto end = std::ranges::find_if(left, [&](const Coloured& c) { return c.kind != left.front().kind; });
    const auto count = static_cast<std::size_t>(end - left.begin());
    if (is_batch(left.front().kind, count)) {
      split(left.first(count), groups);
    } else {
      Group single;
      for (const Coloured& c : left.first(count)) single.push_back(c.operation);
      std::ranges::sort(single);
      for (const std::size_t i : single) groups.push_back({i});
    }
    left = left.subspan(count);
  }
  return groups;
}

std::size_t breaks(std::span<const Places> sequence) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < sequence.size(); i = end_of_run(sequence, i)) ++count;
  return count;
}

std::vector<Stretch> stretches(std::span<const Places> sequence) {
  std::vector<Stretch> cut;
  std::size_t open = 0;  // before it everything is cut
  for (std::size_t i = 0; i < sequence.size();) {
    const std::size_t end = end_of_run(sequence, i);
    if (end - i >= smallest_cut) {
      if (i > open) cut.push_back({open, i});
      cut.push_back({i, end});
      open = end;
    }
    i = end;
  }
  if (open < sequence.size()) cut.push_back({open, sequence.size()});
  return cut;
}

}  // namespace continuo::model::tape
