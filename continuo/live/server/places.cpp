// continuo/live/server/places.cpp
// Counts connections by kind and address, and chooses who has to leave.
#include <algorithm>
#include <utility>

#include <continuo/live/server/places.hpp>

namespace continuo::live {

Places::Places(Limits limits) : limits_(limits) {}

Places::Place::~Place() {
  if (const auto all = all_.lock()) all->entries.erase(number_);
}

std::unique_ptr<Places::Place> Places::enter(Guest guest, const std::string& address, Leave leave, Idle idle) {
  if (count(guest) >= limit(guest) && !make_room(guest, address)) return nullptr;
  const std::uint64_t number = ++all_->last;
  all_->entries.emplace(number, Entry{guest, address, std::move(leave), std::move(idle)});
  return std::make_unique<Place>(all_, number);
}

std::size_t Places::limit(Guest guest) const {
  switch (guest) {
    case Guest::viewer:
      return limits_.viewers;
    case Guest::presenter:
      return limits_.presenters;
    case Guest::owner:
      return limits_.owners;
    case Guest::stranger:
      break;
  }
  return limits_.strangers;
}

std::size_t Places::count(Guest guest) const {
  const auto is_one = [&](const auto& entry) { return entry.second.guest == guest; };
  return static_cast<std::size_t>(std::ranges::count_if(all_->entries, is_one));
}

std::size_t Places::count_of(Guest guest, const std::string& address) const {
  const auto is_one = [&](const auto& entry) { return entry.second.guest == guest && entry.second.address == address; };
  return static_cast<std::size_t>(std::ranges::count_if(all_->entries, is_one));
}

std::string Places::fullest_address(Guest guest) const {
  std::map<std::string, std::size_t> counts;
  for (const auto& [number, entry] : all_->entries)
    if (entry.guest == guest) ++counts[entry.address];
  return std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; })->first;
}

bool Places::make_room(Guest guest, const std::string& address) {
  if (limit(guest) == 0) return false;
  if (guest == Guest::presenter) {
    turn_out(guest, nullptr, true);
    return true;
  }
  const std::string fullest = fullest_address(guest);
  const bool is_fair = count_of(guest, fullest) < count_of(guest, address) + 2;
  if (guest == Guest::owner) return make_room_for_owner(is_fair ? nullptr : &fullest);
  if (guest == Guest::viewer && is_fair) return false;
  turn_out(guest, &fullest, guest == Guest::stranger);
  return true;
}

bool Places::make_room_for_owner(const std::string* fullest) {
  auto idlest = all_->entries.end();
  double longest = -1;
  for (auto each = all_->entries.begin(); each != all_->entries.end(); ++each) {
    const Entry& entry = each->second;
    if (entry.guest != Guest::owner || (fullest && entry.address != *fullest)) continue;
    const double idle = entry.idle ? entry.idle() : 0;
    if (idle <= longest) continue;
    longest = idle;
    idlest = each;
  }
  if (!fullest && longest < limits_.idle) return false;
  turn_out(idlest);
  return true;
}

void Places::turn_out(Guest guest, const std::string* address, bool oldest) {
  const auto is_one = [&](const auto& entry) {
    return entry.second.guest == guest && (!address || entry.second.address == *address);
  };
  auto chosen = std::ranges::find_if(all_->entries, is_one);
  if (!oldest) {
    for (auto other = chosen; other != all_->entries.end(); ++other)
      if (is_one(*other)) chosen = other;
  }
  turn_out(chosen);
}

void Places::turn_out(std::map<std::uint64_t, Entry>::iterator chosen) {
  const Leave leave = std::move(chosen->second.leave);
  all_->entries.erase(chosen);  // before it leaves: its place is free already
  leave();
}

}  // namespace continuo::live
