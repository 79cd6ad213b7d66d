// The outcomes of a sweep on disk, in chunks of consecutive runs: each chunk is a file of its own, which is there as a
// whole or not at all, so that whatever ends a program costs no more than the chunks that it was at. Programs on
// several machines may fill one folder at the same time.
//
//   Result<SweepFolder> folder = SweepFolder::open("k.nc.sweep", identity_of(sweep, version));
//   for (const std::uint64_t chunk : folder->missing())
//     if (const Status status = folder->write(chunk, outcomes); !status) return status;
//
// A chunk says what it is of and has the hash of its content: one that is cut short, damaged, or of another sweep is
// none. Numbers are stored with all their bits, so that what is read is what was written.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <continuo/status/result.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies {

/// What the chunks of one sweep have in common.
struct SweepIdentity {
  std::string hash{};       // 64 hexadecimal digits: equal ones have equal outcomes
  std::uint64_t runs = 0;   //
  std::uint64_t width = 0;  // how many numbers are kept of each run

  /// How many runs make a chunk: about a thousand chunks, none of them large. The first ones have 1, 2, 4, ... runs, so
  /// that the first results come at once, however many there will be.
  [[nodiscard]] std::uint64_t per_chunk() const;
  /// How many chunks there are.
  [[nodiscard]] std::uint64_t chunks() const;
  /// The first run of a chunk.
  [[nodiscard]] std::uint64_t first_run(std::uint64_t chunk) const;
  /// How many runs are in it.
  [[nodiscard]] std::uint64_t size(std::uint64_t chunk) const;
};

/// That of a sweep. `program`: the version of the program, other versions have other bits.
[[nodiscard]] SweepIdentity identity_of(const PreparedSweep& sweep, const std::string& program);

/// What has become of the chunk of this number.
enum class ChunkState { missing, whole, damaged };

/// A folder with chunks.
class SweepFolder {
 public:
  /// The folder of a sweep, made where there is none. The reason where it cannot be made or is of another sweep.
  [[nodiscard]] static Result<SweepFolder> open(const std::string& path, SweepIdentity identity);
  /// Whether the folder is there.
  [[nodiscard]] static bool exists(const std::string& path);

  /// The name of its file.
  [[nodiscard]] std::string file(std::uint64_t chunk) const;

  /// Reads a chunk as far as its hash needs.
  [[nodiscard]] ChunkState state(std::uint64_t chunk) const;
  /// The chunks that are to be done, in rising order. Damaged ones are among them.
  [[nodiscard]] std::vector<std::uint64_t> missing() const;

  /// Stores a chunk: the outcomes of its runs in their order. The file takes its name when all of it is on the disk.
  Status write(std::uint64_t chunk, const std::vector<SweepOutcome>& outcomes) const;
  /// The outcomes of a chunk, bit by bit those that were written; the reason where it is missing or damaged.
  [[nodiscard]] Result<std::vector<SweepOutcome>> read(std::uint64_t chunk) const;
  /// Removes the folder with its chunks: they are elsewhere.
  Status remove() const;

  /// Where it is.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// What it is of.
  [[nodiscard]] const SweepIdentity& identity() const { return identity_; }

 private:
  SweepFolder(std::string path, SweepIdentity identity) : path_(std::move(path)), identity_(std::move(identity)) {}

  std::string path_;
  SweepIdentity identity_;
};

}  // namespace continuo::studies
