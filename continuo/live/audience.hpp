// continuo/live/audience.hpp
// The observers of a session: the data that a session shows them, with the names of docs/protocol.md.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace continuo::live {

/// Bodies of a world at one instant, `dimension` numbers each; angles in the plane, quaternions (x, y, z, w) in space.
struct Bodies {
  std::size_t dimension = 3;
  std::vector<float> position, orientation;
  std::vector<float> velocity{};  // of worlds with few bodies
  /// The number of bodies.
  [[nodiscard]] std::size_t count() const { return position.size() / dimension; }
};

/// An event that is shown in the list.
struct LiveEvent {
  double t;
  std::string name, mark;
};

/// What one turn of a session adds to the picture.
struct Slice {
  std::uint32_t run = 0;
  bool looking_back = false;
  std::optional<double> rewound_to;  // rows at this time and later are void, those of this slice come after that
  double t = 0, reached = 0, target = 0;
  bool ghost = false;
  std::vector<double> row_t;
  std::vector<float> rows, ghost_rows;    // row after row
  std::vector<float> paths, ghost_paths;  // of each row, where the trails are
  std::vector<float> scene, ghost_scene;
  std::vector<LiveEvent> events;
  std::shared_ptr<const Bodies> bodies, ghost_bodies;  // null where the model has none
};

/// What a text says; who comes later needs the newest `model` and `state`.
enum class Topic { model, state, message };

/// An observer of a session. It is called on the thread of the session.
class Audience {
 public:
  virtual ~Audience() = default;
  /// Gets the newest part of the picture.
  virtual void see(std::shared_ptr<const Slice> slice) = 0;
  /// Gets a message, as JSON (docs/protocol.md).
  virtual void hear(Topic topic, std::string json) = 0;
};

}  // namespace continuo::live
