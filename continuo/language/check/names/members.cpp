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
  for (std::size_t i = 0; i < low.size(); ++i) {
    const long at = indices[i] - low[i];
    if (at < 0 || at >= size[i]) return outside;
    place = place * static_cast<std::size_t>(size[i]) + static_cast<std::size_t>(at);
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

std::uint32_t Members::number_of(std::span<const long> indices) const {
  const std::size_t place = box_.cells.empty() ? outside : place_in(box_.low, box_.size, indices);
  if (place != outside && box_.cells[place] != none) return box_.cells[place];
  if (scattered_.empty()) return none;
  const auto found = scattered_.find({indices.begin(), indices.end()});
  return found == scattered_.end() ? none : found->second;
}

const Symbol* Members::find(std::span<const long> indices) const {
  const std::uint32_t number = number_of(indices);
  return number == none ? nullptr : &symbols_[number];
}

std::pair<const Symbol*, bool> Members::add(std::span<const long> indices, const Symbol& symbol) {
  if (const Symbol* known = find(indices)) return {known, false};
  cell_for(indices) = static_cast<std::uint32_t>(symbols_.size());
  symbols_.push_back(symbol);
  return {&symbols_.back(), true};
}

std::uint32_t& Members::cell_for(std::span<const long> indices) {
  if (box_.cells.empty()) {
    box_.low.assign(indices.begin(), indices.end());
    box_.size.assign(indices.size(), 1);
    box_.cells.assign(1, none);
  }
  std::size_t place = place_in(box_.low, box_.size, indices);
  if (place == outside && widen(indices)) place = place_in(box_.low, box_.size, indices);
  return place == outside ? scattered_[{indices.begin(), indices.end()}] : box_.cells[place];
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
