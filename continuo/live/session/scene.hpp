// continuo/live/session/scene.hpp
// The drawing of a moment: the numbers of its things, and where its bodies are.
#pragma once
#include <memory>

#include <continuo/live/audience.hpp>
#include <continuo/live/motion/history.hpp>
#include <continuo/live/session/live_evaluation.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::live {

class Scene {
 public:
  void show(const LiveModel& shown, const Variables& variables) {
    numbers_ = LiveEvaluation(shown, shown.scene, variables);
  }
  /// Into the slice. `world` is that of the bodies, null without any.
  void draw(const Sample& sample, const worlds::WorldRun* world, Slice& slice);

 private:
  LiveEvaluation numbers_;
};

}  // namespace continuo::live
