// Adds to a slice that has not been published, and takes back from it.
#include <algorithm>
#include <utility>
#include <vector>

#include <continuo/live/session/pending_slice.hpp>

namespace continuo::live {

void PendingSlice::add(const Row& row) {
  const auto append = [](std::vector<float>& all, const std::vector<float>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  slice_->row_t.push_back(row.t);
  append(slice_->rows, row.values);
  append(slice_->ghost_rows, row.ghost);
  append(slice_->paths, row.path);
  append(slice_->ghost_paths, row.ghost_path);
  changed_ = true;
}

void PendingSlice::add(LiveEvent event) {
  constexpr std::size_t most_at_once = 200;
  if (slice_->events.size() < most_at_once) slice_->events.push_back(std::move(event));
  changed_ = true;
}

void PendingSlice::rewind_to(double t, std::size_t columns, std::size_t paths) {
  slice_->rewound_to = std::min(t, slice_->rewound_to.value_or(t));
  while (!slice_->row_t.empty() && slice_->row_t.back() >= t) {
    slice_->row_t.pop_back();
    slice_->rows.resize(slice_->rows.size() - columns);
    slice_->ghost_rows.resize(slice_->ghost_rows.size() - columns);
    slice_->paths.resize(slice_->paths.size() - paths);
    slice_->ghost_paths.resize(slice_->ghost_paths.size() - paths);
  }
  std::erase_if(slice_->events, [t](const LiveEvent& event) { return event.t > t; });
  changed_ = true;
}

std::shared_ptr<const Slice> PendingSlice::take() {
  changed_ = false;
  return std::exchange(slice_, std::make_shared<Slice>());
}

}  // namespace continuo::live
