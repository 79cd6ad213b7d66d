// continuo/live/server/frames.cpp
// Writes slices as binary frames.
#include <bit>
#include <cstring>
#include <type_traits>

#include <continuo/live/server/frames.hpp>

namespace continuo::live {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers go over the wire as they lie in memory");

class Bytes {
 public:
  template <class Number>
  void add(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Number>
  void add(std::span<const Number> values) {
    text_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::uint32_t flags_of(const Slice& slice, const FrameRows& rows, bool rewound) {
  std::uint32_t flags = 0;
  if (rewound) flags |= frame_rewound;
  if (slice.ghost) flags |= frame_has_ghost;
  if (slice.bodies) flags |= frame_has_bodies;
  if (slice.bodies && !slice.bodies->orientation.empty()) flags |= frame_has_orientations;
  if (slice.looking_back) flags |= frame_looks_back;
  if (slice.bodies && slice.ghost_bodies) flags |= frame_has_ghost_bodies;
  if (!rows.paths.empty()) flags |= frame_has_paths;
  if (slice.bodies && !slice.bodies->velocity.empty()) flags |= frame_has_velocities;
  return flags;
}

}  // namespace

std::string frame_of(const Slice& slice, const FrameRows& rows, bool rewound) {
  constexpr std::uint32_t kind = 1;
  Bytes bytes;
  bytes.add(kind);
  bytes.add(slice.run);
  bytes.add(flags_of(slice, rows, rewound));
  bytes.add(static_cast<std::uint32_t>(rows.t.size()));
  bytes.add(slice.t);
  bytes.add(slice.reached);
  bytes.add(slice.target);
  bytes.add(rows.t);
  bytes.add(rows.rows);
  bytes.add(std::span<const float>(slice.scene));
  if (slice.ghost) {
    bytes.add(rows.ghost_rows);
    bytes.add(std::span<const float>(slice.ghost_scene));
  }
  if (slice.bodies) {
    bytes.add(static_cast<std::uint32_t>(slice.bodies->count()));
    bytes.add(std::span<const float>(slice.bodies->position));
    bytes.add(std::span<const float>(slice.bodies->orientation));
    if (slice.ghost_bodies) {
      bytes.add(std::span<const float>(slice.ghost_bodies->position));
      bytes.add(std::span<const float>(slice.ghost_bodies->orientation));
    }
  }
  bytes.add(rows.paths);
  if (slice.ghost) bytes.add(rows.ghost_paths);
  if (slice.bodies) bytes.add(std::span<const float>(slice.bodies->velocity));
  return bytes.take();
}

}  // namespace continuo::live
