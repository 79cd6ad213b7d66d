// continuo/live/session/messages.hpp
// What the server says in JSON: docs/protocol.md, one function each.
#pragma once
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/live/audience.hpp>
#include <continuo/live/live_model.hpp>
#include <continuo/live/settings.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::live {

struct ModelWords {
  std::uint32_t run;
  const LiveModel& shown;
  std::span<const double> variables;
  std::string path;
  const std::string& text;
  bool saveable;
  bool welcome;                                 // no model was named: the page begins with the gallery
  std::span<const model::Diagnostic> mistakes;  // of the text, which therefore is not what runs
  std::span<const GalleryModel> gallery;
  const model::Plan& plan;
  const worlds::WorldRun* world;  // null without bodies
  std::size_t undo;
};
std::string model_json(const ModelWords& words);

struct StateWords {
  const LiveModel& shown;
  std::span<const double> variables;
  const model::Plan& plan;
  const model::Plan* ghost = nullptr;  // null without one
  bool playing = false, slow = false;
  double t = 0, target = 1, reached = 0, first = 0, last = 0;
  std::size_t undo = 0;
  std::string mode{}, ended{};
  Statistics statistics{};
};
std::string state_json(const StateWords& words);

/// A body, looked at closely.
std::string picked_json(const worlds::WorldRun& world, std::size_t body);
std::string event_json(const LiveEvent& event);
std::string message_json(const model::Diagnostic& problem, const model::Source& source);
/// Without a place in the text.
std::string note_json(std::string_view severity, std::string_view text, std::string_view hint = {});
std::string checked_json(double id, std::span<const model::Diagnostic> problems, const model::Source& source);
std::string saved_json(std::string_view path);
std::string pong_json(double id);

/// To a new client: who it is, and what it may do.
struct RoleWords {
  std::string_view role;
  std::vector<std::string_view> may;
  bool own_sessions;            // whether viewers may have sessions of their own
  std::string viewers_address;  // for the presenter; else empty
};
std::string role_json(const RoleWords& words);
/// To the presenter: how many viewers there are.
std::string room_json(std::size_t viewers);
/// What the session is at that takes long; empty: it does so no longer.
std::string busy_json(std::string_view with, double seconds);

}  // namespace continuo::live
