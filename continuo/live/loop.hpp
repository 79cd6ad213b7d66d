// continuo/live/loop.hpp
// Gives a session its thread: obeys what came in, then a turn, as often as there are pictures to be shown.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <continuo/live/session.hpp>
#include <continuo/live/session/commands.hpp>

namespace continuo::live {

/// Seconds of a clock that never goes backwards.
[[nodiscard]] double steady_seconds();

/// What a session is at, and for how long: to be told to who waits for it.
struct Work {
  /// Commands, such as one that reads another model; or the motion.
  enum class Kind { commands, motion };
  Kind kind;
  double seconds;
};

/// The thread of a session.
class Loop {
 public:
  /// `complain` is told what was wrong with a command, and of which client.
  using Complain = std::function<void(std::uint64_t client, const std::string& problem)>;

  /// The session must outlive the loop, and only the loop may use it while it runs.
  Loop(Session& session, Complain complain);
  /// Stops the thread.
  ~Loop();

  /// Starts the thread.
  void start();
  /// Returns when the turn that is being made has ended.
  void stop();

  /// From any thread. False: there is too much to do already, ask again in a moment. A step that takes long is given up
  /// for the command, unless that is a step too, and begun again after it: who drags a slider is answered at once.
  bool post(Command command, std::uint64_t client);
  /// From any thread, some twenty times a second: gives up the step that has become too long for commands that wait.
  /// Returns what the session is at, if anything.
  std::optional<Work> watch();
  /// Sets the number of pictures a second, from any thread.
  void set_rate(double pictures) { rate_.store(pictures); }

 private:
  struct Waiting {
    Command command;
    std::uint64_t client;
  };
  static constexpr std::size_t most_waiting = 1000;
  static constexpr double longest_wait = 0.05;  // seconds that commands wait for a step

  void run();
  void obey(const std::vector<Waiting>& waiting);
  void begin(Work::Kind kind);
  void make_way();

  Session& session_;
  Complain complain_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Waiting> waiting_;
  std::optional<Work> work_;  // its `seconds` are those of the clock when it began
  bool stopping_ = false;
  std::atomic<double> rate_{60};
  std::thread thread_;
};

}  // namespace continuo::live
