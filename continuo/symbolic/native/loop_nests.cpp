// Merges members into loops, loops into loops around them, as long as any are found.
#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include <continuo/symbolic/native/loop_nests.hpp>

namespace continuo::model {

namespace {

constexpr std::size_t smallest_loop = 4;    // of members; fewer are as many lines as their loop
constexpr std::size_t smallest_around = 3;  // of loops
constexpr std::size_t most_mixed = 8;       // so many loops may take turns in the list
constexpr std::size_t most_nested = 4;
constexpr std::size_t most_short_loops = 16;  // of less than `short_loop` members
constexpr std::size_t short_loop = 12;

class LoopFinder {
 public:
  LoopFinder(std::span<const std::int32_t> addresses, std::size_t width) : addresses_(addresses), width_(width) {}

  std::vector<LoopNest> find() {
    std::vector<LoopNest> nests(addresses_.size() / width_);
    for (std::size_t m = 0; m < nests.size(); ++m) nests[m].member = m;
    for (std::size_t level = 0; level < most_nested; ++level) {
      const std::size_t before = nests.size();
      nests = merged(nests, level == 0 ? smallest_loop : smallest_around);
      if (nests.size() == before) break;
    }
    return nests;
  }

 private:
  [[nodiscard]] std::int32_t address(const LoopNest& nest, std::size_t k) const {
    return addresses_[nest.member * width_ + k];
  }

  [[nodiscard]] static bool are_alike(const LoopNest& a, const LoopNest& b) {
    return std::ranges::equal(a.dimensions, b.dimensions, [](const auto& p, const auto& q) {
      return p.count == q.count && p.member_step == q.member_step && p.steps == q.steps;
    });
  }

  [[nodiscard]] bool follows(const LoopNest& nest, const LoopNest& before, const LoopNest::Dimension& step) const {
    if (nest.member - before.member != step.member_step || !are_alike(nest, before)) return false;
    for (std::size_t k = 0; k < width_; ++k)
      if (address(nest, k) - address(before, k) != step.steps[k]) return false;
    return true;
  }

  /// What a loop would be that begins with these two.
  [[nodiscard]] LoopNest::Dimension between(const LoopNest& first, const LoopNest& second) const {
    LoopNest::Dimension step{.count = 2, .member_step = second.member - first.member, .steps = {}};
    for (std::size_t k = 0; k < width_; ++k) step.steps.push_back(address(second, k) - address(first, k));
    return step;
  }

  /// How many from `begin` on are `mixed` loops that take turns.
  std::size_t reach(std::span<const LoopNest> nests, std::size_t mixed, std::size_t least) const {
    if (nests.size() < mixed * least) return 0;
    std::vector<LoopNest::Dimension> steps;
    std::size_t end = mixed;
    for (; end < nests.size(); ++end) {
      const std::size_t turn = end % mixed;
      const LoopNest &nest = nests[end], &before = nests[end - mixed];
      if (end < 2 * mixed) {
        if (!are_alike(nest, before)) break;
        steps.push_back(between(before, nest));
      } else if (!follows(nest, before, steps[turn])) {
        break;
      }
    }
    end -= end % mixed;  // all loops of one length
    return end >= mixed * least ? end : 0;
  }

  std::vector<LoopNest> merged(const std::vector<LoopNest>& nests, std::size_t least) const {
    std::vector<LoopNest> found;
    for (std::size_t begin = 0; begin < nests.size();) {
      const std::span rest = std::span(nests).subspan(begin);
      std::size_t mixed = 1, end = 0;
      while (mixed <= most_mixed && (end = reach(rest, mixed, least)) == 0) ++mixed;
      if (end == 0) {
        found.push_back(rest.front());
        ++begin;
        continue;
      }
      for (std::size_t turn = 0; turn < mixed; ++turn) {
        LoopNest around = rest[turn];
        around.dimensions.push_back(between(rest[turn], rest[turn + mixed]));
        around.dimensions.back().count = end / mixed;
        found.push_back(std::move(around));
      }
      begin += end;
    }
    return found;
  }

  std::span<const std::int32_t> addresses_;
  std::size_t width_;
};

}  // namespace

std::size_t LoopNest::size() const {
  std::size_t all = 1;
  for (const Dimension& dimension : dimensions) all *= dimension.count;
  return all;
}

Loops loops_of(std::span<const std::int32_t> addresses, std::size_t width) {
  std::vector<LoopNest> found = LoopFinder(addresses, width).find();
  const auto is_short = [](const LoopNest& nest) {
    return nest.dimensions.size() == 1 && nest.dimensions[0].count < short_loop;
  };
  const bool dissolve = static_cast<std::size_t>(std::ranges::count_if(found, is_short)) > most_short_loops;
  Loops loops;
  for (LoopNest& nest : found) {
    if (nest.dimensions.empty()) {
      loops.alone.push_back(nest.member);
    } else if (dissolve && is_short(nest)) {
      for (std::size_t k = 0; k < nest.dimensions[0].count; ++k)
        loops.alone.push_back(nest.member + k * nest.dimensions[0].member_step);
    } else {
      loops.nests.push_back(std::move(nest));
    }
  }
  std::ranges::sort(loops.alone);
  return loops;
}

std::string sum_text(std::int64_t begin, std::span<const std::int64_t> steps) {
  const bool all_zero = std::ranges::all_of(steps, [](std::int64_t step) { return step == 0; });
  std::string text = begin != 0 || all_zero ? fmt::format("{}", begin) : "";
  for (std::size_t d = steps.size(); d-- > 0;) {
    if (steps[d] == 0) continue;
    text += text.empty() ? (steps[d] < 0 ? "-" : "") : steps[d] < 0 ? " - " : " + ";
    if (std::abs(steps[d]) != 1) text += fmt::format("{}*", std::abs(steps[d]));
    text += loop_variables[d];
  }
  return text;
}

}  // namespace continuo::model
