// continuo/live/server/frames.hpp
// The binary messages of docs/protocol.md: one instant of the scene, and the plotted rows since the last one.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include <continuo/live/audience.hpp>

namespace continuo::live {

/// What `flags` of a frame says.
enum FrameFlag : std::uint32_t {
  frame_rewound = 1,
  frame_has_ghost = 2,
  frame_has_bodies = 4,
  frame_has_orientations = 8,
  frame_looks_back = 16,
  frame_has_ghost_bodies = 32,
  frame_has_paths = 64,
  frame_has_velocities = 128,
};

struct FrameRows {
  std::span<const double> t;
  std::span<const float> rows, ghost_rows{};      // the latter empty without a ghost
  std::span<const float> paths{}, ghost_paths{};  // empty without trails
};

/// The scene, time and speeds are those of the slice.
std::string frame_of(const Slice& slice, const FrameRows& rows, bool rewound);

}  // namespace continuo::live
