// continuo/live/loop.hpp
// Gives a session its thread: obeys what came in, then a turn, as often as there are pictures to be shown.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <continuo/live/session.hpp>
#include <continuo/live/session/commands.hpp>

namespace continuo::live {

/// Seconds of a clock that never goes backwards.
[[nodiscard]] double steady_seconds();

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

  /// From any thread. False: there is too much to do already, ask again in a moment.
  bool post(Command command, std::uint64_t client);
  /// Sets the number of pictures a second, from any thread.
  void set_rate(double pictures) { rate_.store(pictures); }

 private:
  struct Waiting {
    Command command;
    std::uint64_t client;
  };
  static constexpr std::size_t most_waiting = 1000;

  void run();
  void obey_all();

  Session& session_;
  Complain complain_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Waiting> waiting_;
  bool stopping_ = false;
  std::atomic<double> rate_{60};
  std::thread thread_;
};

}  // namespace continuo::live
