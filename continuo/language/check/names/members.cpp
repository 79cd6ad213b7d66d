// continuo/language/check/names/members.cpp
// The box of a family grows with its members; what lies far off is kept apart.
#include <algorithm>

#include <continuo/language/check/names/members.hpp>

namespace continuo::model::detail {

namespace {

constexpr std::size_t outside = static_cast<std::size_t>(-1);

/// The place of a cell in a box.
std::size_t place_in(const std::vector<long>& low, const std::vector<long>& size, std::span<const long> indices) {
  if (indices.size() != low.size()) return outside;
  std::size_t place = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto at = static_cast<std::size_t>(indices[i] - low[i]), end = static_cast<std::size_t>(size[i]);
    if (at >= end) return outside;  // also what lies below, which is a huge number here
    place = place * end + at;
  }
  return place;
}

/// The indices that follow in a box, the last one first.
void next_cell(const std::vector<long>& low, const std::vector<long>& size, std::vector<long>& indices) {
  for (std::size_t i = indices.size(); i-- > 0;) {
    if (++indices[i] < low[i] + size[i]) return;
    indices[i] = low[i];
  }
}

}  // namespace

/// `outside` where the box does not reach.
std::size_t Members::place_of(std::span<const long> indices) const {
  return box_.cells.empty() ? outside : place_in(box_.low, box_.size, indices);
}

std::uint32_t Members::number_at(std::size_t place, std::span<const long> indices) const {
  if (place != outside && box_.cells[place] != none) return box_.cells[place];
  if (scattered_.empty()) return none;
  const auto found = scattered_.find({indices.begin(), indices.end()});
  return found == scattered_.end() ? none : found->second;
}

std::uint32_t Members::number_of(std::span<const long> indices) const {
  return number_at(place_of(indices), indices);
}

const Symbol* Members::find(std::span<const long> indices) const {
  const std::uint32_t number = number_of(indices);
  return number == none ? nullptr : &symbols_[number];
}

std::pair<const Symbol*, bool> Members::add(std::span<const long> indices, const Symbol& symbol) {
  const std::size_t place = place_of(indices);
  const std::uint32_t known = number_at(place, indices);
  if (known != none) return {&symbols_[known], false};
  (place == outside ? new_cell(indices) : box_.cells[place]) = static_cast<std::uint32_t>(symbols_.size());
  symbols_.push_back(symbol);
  return {&symbols_.back(), true};
}

/// Of a member outside the box.
std::uint32_t& Members::new_cell(std::span<const long> indices) {
  if (box_.cells.empty()) {
    box_.low.assign(indices.begin(), indices.end());
    box_.size.assign(indices.size(), 1);
    box_.cells.assign(1, none);
    return box_.cells.front();
  }
  return widen(indices) ? box_.cells[place_of(indices)] : scattered_[{indices.begin(), indices.end()}];
}

/// By half its size at least, so that the cells are moved a few times only; false where most would be empty.
bool Members::widen(std::span<const long> indices) {
  if (indices.size() != box_.low.size()) return false;
  Box wider;
  double volume = 1;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const long first = box_.low[i], end = first + box_.size[i], spare = box_.size[i] / 2;
    const long low = indices[i] < first ? std::min(indices[i], first - spare) : first;
    const long high = indices[i] >= end ? std::max(indices[i] + 1, end + spare) : end;
    wider.low.push_back(low);
    wider.size.push_back(high - low);
    volume *= static_cast<double>(high - low);
  }
  if (volume > 64 + 8 * static_cast<double>(symbols_.size())) return false;
  if (wider.low == box_.low && std::equal(box_.size.begin() + 1, box_.size.end(), wider.size.begin() + 1)) {
    box_.size = std::move(wider.size);  // longer by whole rows: no cell is moved
    box_.cells.resize(static_cast<std::size_t>(volume), none);
    return true;
  }
  wider.cells.assign(static_cast<std::size_t>(volume), none);
  std::vector<long> at = box_.low;
  for (const std::uint32_t cell : box_.cells) {
    if (cell != none) wider.cells[place_in(wider.low, wider.size, at)] = cell;
    next_cell(box_.low, box_.size, at);
  }
  box_ = std::move(wider);
  return true;
}

std::vector<std::vector<long>> Members::all() const {
  std::vector<std::vector<long>> found;
  std::vector<long> at = box_.low;
  for (const std::uint32_t cell : box_.cells) {
    if (cell != none) found.push_back(at);
    next_cell(box_.low, box_.size, at);
  }
  for (const auto& [indices, cell] : scattered_) found.push_back(indices);
  return found;
}

}  // namespace continuo::model::detail
