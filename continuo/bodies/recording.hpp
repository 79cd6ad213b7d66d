// continuo/bodies/recording.hpp
// A recording of a run, for playback from a file: frames of positions and orientations at instants of the caller's
// choice. Before the first frame, and wherever bodies have been added or removed since, the file has a snapshot of the
// whole world.
//
//   std::ofstream file("run.continuo", std::ios::binary);
//   Recorder<double, 3> recorder(file);
//   for (...) { motion.advance(); recorder.add(world); }
//   recorder.finish();                                     // writes the index
//
//   const auto recording = Recording<double, 3>::read(bytes_of_the_file);
//   if (!recording) std::cerr << describe(recording.status());
//   const auto frame = recording->frame(17);               // frame.time, frame.position[i]
//
// The last block is the index. A file without it, left by a run that was cut off, is read up to its last complete
// block.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/snapshot.hpp>
#include <continuo/bodies/support/blocks.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// The positions and orientations of all bodies at an instant.
template <class Real, int Dim>
struct Frame {
  Real time{};              // of the world
  std::uint64_t scene = 0;  // Recording::scenes[scene] is the world of these bodies, in the same order
  std::vector<Vector<Real, Dim>> position{};          // of centres
  std::vector<Orientation<Real, Dim>> orientation{};  // angles or quaternions

  /// Reads or writes the frame.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(time), archive(scene), archive(position), archive(orientation);
  }
};

namespace detail {

enum class RecordingBlock : std::uint8_t { scene, frame, index };

inline constexpr FileFormat recording_format{
    {'c', 'o', 'n', 't', 'i', 'r', 'e', 'c'}, 1, "this is no recording", "a recording of another version"};

struct RecordingIndex {
  std::vector<std::uint64_t> scenes{}, frames{};  // where their blocks begin

  template <class Archive>
  void transfer(Archive& archive) {
    archive(scenes), archive(frames);
  }
};

}  // namespace detail

/// Writes a recording to a stream, frame by frame.
template <class Real, int Dim>
class Recorder {
 public:
  /// The stream must be binary and outlive this object. The caller checks the stream for failed writes.
  explicit Recorder(std::ostream& out) : out_(out) {
    ByteWriter head;
    detail::recording_format.write(head);
    head(static_cast<std::uint8_t>(sizeof(Real))), head(static_cast<std::uint8_t>(Dim));
    out_.write(head.bytes());
  }

  /// Writes the present state as a frame, after a snapshot of the whole world where bodies have been added or removed.
  /// Costs about 56 bytes a body in space and double precision.
  void add(const World<Real, Dim>& world) {
    std::vector<BodyHandle> bodies(world.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i] = world.handle(i);
    if (index_.scenes.empty() || bodies != bodies_) {
      bodies_ = std::move(bodies);
      index_.scenes.push_back(out_.position());
      out_.write(detail::RecordingBlock::scene, snapshot(world));
    }
    ByteWriter writer;
    writer(Frame<Real, Dim>{world.time, index_.scenes.size() - 1, world.position, world.orientation});
    index_.frames.push_back(out_.position());
    out_.write(detail::RecordingBlock::frame, writer.bytes());
  }
  /// Writes the index, with which a recording is whole.
  void finish() {
    ByteWriter writer;
    writer(index_);
    out_.write(detail::RecordingBlock::index, writer.bytes());
    out_.flush();
  }

 private:
  BlockWriter out_;
  std::vector<BodyHandle> bodies_;
  detail::RecordingIndex index_;
};

/// A recording that was read from a file.
template <class Real, int Dim>
struct Recording {
  bool is_whole = false;                   // false where the index is missing: the run was cut off
  std::vector<World<Real, Dim>> scenes{};  // the worlds, a new one where bodies were added or removed
  std::vector<Frame<Real, Dim>> frames{};  // in the order of time

  /// Frame i, counted from 0.
  [[nodiscard]] const Frame<Real, Dim>& frame(std::size_t i) const { return frames[i]; }
  /// The last frame not after t; the first frame where all are after t.
  [[nodiscard]] const Frame<Real, Dim>& at(const Real& t) const {
    const auto after = std::ranges::upper_bound(frames, t, {}, &Frame<Real, Dim>::time);
    return after == frames.begin() ? frames.front() : *(after - 1);
  }

  /// Fails as unreadable where there is not one frame to play.
  [[nodiscard]] static Result<Recording> read(std::span<const std::byte> bytes) {
    Recording recording;
    ByteReader file(bytes);
    detail::recording_format.expect(file);
    std::uint8_t real = 0, dim = 0;
    file(real), file(dim);
    file.expect(real == sizeof(Real) && dim == Dim, "numbers or dimensions of another kind");
    detail::RecordingIndex found;
    while (!recording.is_whole) {
      const std::uint64_t begin = file.position();
      const auto block = next_block(file, detail::RecordingBlock::index);
      if (block) recording.take(file, block->kind, block->bytes, begin, found);
      if (!file.ok()) return file.status();
      if (!block) break;
    }
    if (recording.frames.empty())
      return Status{.ending = Ending::unreadable,
                    .message = "byte " + std::to_string(bytes.size()) + ": not one frame"};
    return recording;
  }

 private:
  void take(ByteReader& file, detail::RecordingBlock kind, std::span<const std::byte> block, std::uint64_t begin,
            detail::RecordingIndex& found) {
    if (kind == detail::RecordingBlock::scene) {
      found.scenes.push_back(begin);
      if (const Status read = restore(block, scenes.emplace_back()); !read) fail_in_block(file, read.message);
    } else if (kind == detail::RecordingBlock::frame) {
      found.frames.push_back(begin);
      read_block(file, block, [&](ByteReader& reader) { take_frame(reader); });
    } else {
      read_block(file, block, [&](ByteReader& reader) {
        detail::RecordingIndex index;
        reader(index);
        reader.expect(index.scenes == found.scenes && index.frames == found.frames, "an index of other blocks");
      });
      is_whole = true;
    }
  }
  void take_frame(ByteReader& reader) {
    Frame<Real, Dim>& frame = frames.emplace_back();
    reader(frame);
    reader.expect(!scenes.empty() && frame.scene == scenes.size() - 1, "a frame of no scene before it");
    reader.expect(scenes.empty() || (frame.position.size() == scenes.back().size() &&
                                     frame.orientation.size() == frame.position.size()),
                  "a frame of other bodies");
    reader.expect(frames.size() == 1 || frame.time >= frames[frames.size() - 2].time, "a frame before the last");
  }
};

}  // namespace continuo
