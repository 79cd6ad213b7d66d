// continuo/live/loop.cpp
// The thread of a session: commands, turns and the pace of pictures.
#include <chrono>
#include <exception>
#include <utility>

#include <pthread.h>

#include <continuo/live/loop.hpp>

namespace continuo::live {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Loop::Loop(Session& session, Complain complain) : session_(session), complain_(std::move(complain)) {}

Loop::~Loop() {
  stop();
}

void Loop::start() {
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "session");
}

void Loop::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool Loop::post(Command command, std::uint64_t client) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting) return false;
  waiting_.push_back({std::move(command), client});
  return true;
}

void Loop::obey_all() {
  std::vector<Waiting> now;
  {
    const std::lock_guard lock(mutex_);
    now.swap(waiting_);
  }
  for (const Waiting& waiting : now) {
    Status status;
    try {
      status = obey(session_, waiting.command);
    } catch (const std::exception& error) {  // out of memory, most likely: the view lives on
      session_.pause();
      status = {.ending = Ending::cannot_continue, .message = std::string("internal error: ") + error.what()};
    }
    if (!status) complain_(waiting.client, status.message);
  }
}

void Loop::run() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point next = Clock::now();
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    const double rate = rate_.load();
    session_.set_rate(rate);
    obey_all();
    session_.turn();
    next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate));
    if (next < Clock::now()) next = Clock::now();  // what was missed is not made up for
    lock.lock();
    wake_.wait_until(lock, next, [this] { return stopping_; });
  }
}

}  // namespace continuo::live
