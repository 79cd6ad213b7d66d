// Names events, and finds the marks that they have reached.
#include <algorithm>

#include <continuo/simulation/program/event_names.hpp>

namespace continuo::model {

const std::vector<EventName>& EventNames::of(const ModelEvents& events, std::span<const std::size_t> fired,
                                             bool with_slides) {
  names_.clear();
  const auto marks = events.marks().subspan(marks_seen_);
  for (const std::size_t i : fired) {
    const auto mark = std::ranges::find(marks, i, &Marked::event);
    const bool is_marked = mark != marks.end();
    if (events.is_declared(i)) {
      names_.push_back({std::string(events.name(i)), is_marked ? mark->text : std::string()});
    } else if (with_slides && events.is_jump(i) && is_marked) {
      names_.push_back({mark->text + " " + std::string(events.name(i)), {}});
    }
  }
  marks_seen_ = events.marks().size();
  return names_;
}

}  // namespace continuo::model
