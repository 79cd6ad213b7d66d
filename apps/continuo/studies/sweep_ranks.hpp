// Processes on one machine or many that make a sweep together, each with a rank, as MPI starts them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <continuo/status/status.hpp>

namespace continuo::app {

/// What the ranks of a sweep say to each other. Each calls agree, then share, then, where share gave a list, take
/// and join. Nothing of this waits for a rank that is at work, but join.
class SweepRanks {
 public:
  using Chunks = std::vector<std::uint64_t>;

  SweepRanks() = default;
  SweepRanks(const SweepRanks&) = delete;
  SweepRanks& operator=(const SweepRanks&) = delete;
  virtual ~SweepRanks() = default;

  /// Whether this is rank 0, which speaks for all, and makes the table.
  virtual bool is_first() const = 0;
  /// How many there are.
  virtual std::size_t count() const = 0;
  /// Whether all have the same text.
  virtual bool agree(const std::string& text) = 0;
  /// The list of rank 0, for all. Nothing where it has none: then there is nothing to do.
  virtual std::optional<Chunks> share(const std::optional<Chunks>& list) = 0;
  /// The next place in the list that no rank has taken, or one behind the list. For any thread.
  virtual std::uint64_t take() = 0;
  /// Waits until all ranks have made what they took. How all of it ended: as this rank ended where that is a failure,
  /// else as another did.
  virtual Status join(const Status& status) = 0;
};

}  // namespace continuo::app
