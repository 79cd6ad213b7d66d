// Sorts columns by the name and indices of their family, and finds the axes of each.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>

#include <continuo/results/families.hpp>

namespace continuo::results {

namespace {

struct Member {
  std::string name;
  std::vector<long> indices;
  std::size_t place;
};

/// `u[1,2]'` is 1, 2 of `u'`.
std::optional<Member> member_of(std::string_view name, std::size_t place) {
  const std::size_t open = name.find('['), close = name.find(']');
  if (open == name.npos || close == name.npos || close < open) return std::nullopt;
  Member member{std::string(name.substr(0, open)).append(name.substr(close + 1)), {}, place};
  const char *at = name.data() + open + 1, *const end = name.data() + close;
  while (at < end) {
    long index = 0;
    const auto read = std::from_chars(at, end, index);
    if (read.ec != std::errc()) return std::nullopt;
    member.indices.push_back(index);
    at = read.ptr;
    while (at < end && (*at == ',' || *at == ' ')) ++at;
  }
  if (member.indices.empty()) return std::nullopt;
  return member;
}

/// Its axes, once the members are sorted; empty where some are missing.
std::vector<ColumnFamily::Axis> axes_of(const std::vector<Member>& members) {
  std::vector<ColumnFamily::Axis> axes;
  std::size_t count = 1;
  for (std::size_t k = 0; k < members.front().indices.size(); ++k) {
    const long first = members.front().indices[k], last = members.back().indices[k];
    if (last < first) return {};
    axes.push_back({first, static_cast<std::size_t>(last - first) + 1});
    count *= axes.back().count;
  }
  if (count != members.size()) return {};
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::size_t rest = i;
    for (std::size_t k = axes.size(); k-- > 0; rest /= axes[k].count)
      if (members[i].indices[k] != axes[k].first + static_cast<long>(rest % axes[k].count)) return {};
  }
  return axes;
}

}  // namespace

std::vector<ColumnFamily> families_of(std::span<const model::Column> columns) {
  std::map<std::string, std::vector<Member>> by_name;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (auto member = member_of(columns[i].name, i)) by_name[member->name].push_back(std::move(*member));
  std::vector<ColumnFamily> families;
  std::vector<bool> is_taken(columns.size());
  for (auto& [name, members] : by_name) {
    const std::size_t rank = members.front().indices.size();
    const std::string& unit = columns[members.front().place].unit;
    const bool is_alike = std::ranges::all_of(members, [&](const Member& member) {
      return member.indices.size() == rank && columns[member.place].unit == unit;
    });
    if (members.size() < 2 || !is_alike) continue;
    std::ranges::sort(members, {}, &Member::indices);
    ColumnFamily family{name, unit, axes_of(members), {}};
    if (family.axes.empty()) continue;
    for (const Member& member : members) {
      family.places.push_back(member.place);
      is_taken[member.place] = true;
    }
    families.push_back(std::move(family));
  }
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (!is_taken[i]) families.push_back({columns[i].name, columns[i].unit, {}, {i}});
  std::ranges::sort(families, {}, [](const ColumnFamily& family) { return std::ranges::min(family.places); });
  return families;
}

}  // namespace continuo::results
