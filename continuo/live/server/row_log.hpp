// continuo/live/server/row_log.hpp
// The plotted rows of a run as they came, for clients that read at their own pace: each is given what it has not had,
// thinned where that is much.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <continuo/live/audience.hpp>

namespace continuo::live {

/// How far a client has read.
struct ReadMark {
  std::uint64_t next = 0;
  bool rewound = false;  // it has rows that are void
};

class RowLog {
 public:
  static constexpr std::size_t most_rows_in_a_frame = 256;

  /// Takes what the slice adds; `marks` of clients that had read what is now void are put back.
  void add(std::shared_ptr<const Slice> slice, const std::vector<ReadMark*>& marks);
  bool empty() const { return slice_ == nullptr; }
  /// What there is belongs to another model: nothing is shown of it any more.
  void forget(const std::vector<ReadMark*>& marks);

  /// The newest picture with the rows the client has not had. Clients in step share their bytes.
  std::shared_ptr<const std::string> frame(ReadMark& mark);

 private:
  struct Row {
    double t;
    std::vector<float> values, ghost, path, ghost_path;
    std::size_t bytes() const {
      return sizeof(Row) + (values.size() + ghost.size() + path.size() + ghost_path.size()) * sizeof(float);
    }
  };
  static constexpr std::size_t most_bytes = std::size_t{16} << 20, most_rows = 1 << 15;

  void clear();
  void forget_from(double t, const std::vector<ReadMark*>& marks);
  std::uint64_t end() const { return begin_ + rows_.size(); }

  std::shared_ptr<const Slice> slice_;
  std::deque<Row> rows_;
  std::uint64_t begin_ = 0;  // the number of the first row that is kept
  std::size_t bytes_ = 0;

  struct Made {
    ReadMark mark;
    std::shared_ptr<const std::string> bytes;
  };
  std::vector<Made> made_;  // of the newest slice
};

}  // namespace continuo::live
