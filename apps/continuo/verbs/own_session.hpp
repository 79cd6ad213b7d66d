// apps/continuo/verbs/own_session.hpp
// Sessions of viewers: each in a process of its own, so that no text of theirs, whatever it computes, fills or breaks,
// can harm the presenter's.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/terminal/exit_codes.hpp>
#include <sys/types.h>

#include <continuo/live/server.hpp>
#include <continuo/live/server/places.hpp>

namespace continuo::app {

/// The processes that serve viewers who have sessions of their own. One thread at a time.
class OwnSessions {
 public:
  /// How many there may be: one who does nothing, or whose computer has most of them, makes room for another.
  static constexpr std::size_t most = 40;

  /// The paths of the models that can be shown: of the one that was named, and of the gallery.
  explicit OwnSessions(std::vector<std::string> models);
  ~OwnSessions();

  /// False where there are too many, or no process can be started.
  bool start(const live::OwnSession& session);

 private:
  struct Process;

  void forget_ended();

  std::vector<std::string> models_;
  live::Places places_{{.owners = most}};
  std::vector<std::unique_ptr<Process>> processes_;
};

/// In such a process: serves its viewer until they leave. `memory`, in bytes, is all that it may use, at the lowest
/// priority.
ExitCode serve_own_session(const std::string& file, std::vector<live::GalleryModel> gallery, std::size_t memory);

}  // namespace continuo::app
