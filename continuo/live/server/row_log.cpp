// continuo/live/server/row_log.cpp
// Keeps rows for clients, each with a mark of what it has read.
#include <algorithm>
#include <utility>

#include <continuo/live/server/frames.hpp>
#include <continuo/live/server/row_log.hpp>

namespace continuo::live {

void RowLog::clear() {
  rows_.clear();
  bytes_ = 0;
  begin_ = 0;
}

void RowLog::forget(const std::vector<ReadMark*>& marks) {
  clear();
  slice_.reset();
  made_.clear();
  for (ReadMark* mark : marks) *mark = {};
}

void RowLog::forget_from(double t, const std::vector<ReadMark*>& marks) {
  while (!rows_.empty() && rows_.back().t >= t) {
    bytes_ -= rows_.back().bytes();
    rows_.pop_back();
  }
  for (ReadMark* mark : marks) {
    if (mark->next > end()) *mark = {end(), true};
  }
}

void RowLog::add(std::shared_ptr<const Slice> slice, const std::vector<ReadMark*>& marks) {
  if (!slice_ || slice->run != slice_->run) {
    clear();
    for (ReadMark* mark : marks) *mark = {};
  }
  if (slice->rewound_to) forget_from(*slice->rewound_to, marks);
  const std::size_t count = slice->row_t.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto part = [&](const std::vector<float>& all) {
      const std::size_t columns = all.size() / count;
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * columns);
      return std::vector<float>(first, first + static_cast<std::ptrdiff_t>(columns));
    };
    rows_.push_back(
        {slice->row_t[i], part(slice->rows), part(slice->ghost_rows), part(slice->paths), part(slice->ghost_paths)});
    bytes_ += rows_.back().bytes();
  }
  while (rows_.size() > 1 && (bytes_ > most_bytes || rows_.size() > most_rows)) {
    bytes_ -= rows_.front().bytes();
    rows_.pop_front();
    ++begin_;
  }
  slice_ = std::move(slice);
  made_.clear();
}

std::shared_ptr<const std::string> RowLog::frame(ReadMark& mark) {
  const ReadMark from{std::max(mark.next, begin_), mark.rewound};
  mark = {end(), false};
  for (const Made& made : made_) {
    if (made.mark.next == from.next && made.mark.rewound == from.rewound) return made.bytes;
  }
  const std::size_t first = from.next - begin_, count = rows_.size() - first;
  const std::size_t kept = std::min(count, most_rows_in_a_frame);
  std::vector<double> t;
  std::vector<float> values, ghost, paths, ghost_paths;
  for (std::size_t k = 0; k < kept; ++k) {
    // The first and the last always, the others evenly between.
    const Row& row = rows_[first + (kept > 1 ? k * (count - 1) / (kept - 1) : 0)];
    t.push_back(row.t);
    values.insert(values.end(), row.values.begin(), row.values.end());
    paths.insert(paths.end(), row.path.begin(), row.path.end());
    if (!slice_->ghost) continue;
    ghost.insert(ghost.end(), row.ghost.begin(), row.ghost.end());
    ghost_paths.insert(ghost_paths.end(), row.ghost_path.begin(), row.ghost_path.end());
  }
  auto bytes =
      std::make_shared<const std::string>(frame_of(*slice_, {t, values, ghost, paths, ghost_paths}, from.rewound));
  made_.push_back({from, bytes});
  return bytes;
}

}  // namespace continuo::live
