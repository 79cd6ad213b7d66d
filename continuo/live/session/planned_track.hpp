// continuo/live/session/planned_track.hpp
// The motion of a model by a method that somebody has chosen, with the parameters and inputs that somebody has moved.
#pragma once
#include <memory>

#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/track.hpp>
#include <continuo/live/session/notices.hpp>
#include <continuo/live/settings.hpp>

namespace continuo::live {

/// Null where the model cannot be run so: `notices` has told why, and keeps it. `interrupt` gives up its steps.
[[nodiscard]] std::unique_ptr<Track> planned_track(const LiveModel& shown, const Settings& settings,
                                                   const MethodChoice& choice, StepInterrupt& interrupt,
                                                   Notices& notices);

}  // namespace continuo::live
