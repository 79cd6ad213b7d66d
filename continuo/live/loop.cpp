// continuo/live/loop.cpp
// The thread of a session: commands, turns and the pace of pictures.
#include <algorithm>
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
    session_.interrupt();
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool Loop::post(Command command, std::uint64_t client) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting) return false;
  waiting_.push_back({std::move(command), client});
  make_way();
  return true;
}

std::optional<Work> Loop::watch() {
  const std::lock_guard lock(mutex_);
  make_way();
  if (!work_) return std::nullopt;
  return Work{work_->kind, steady_seconds() - work_->seconds};
}

void Loop::make_way() {
  const bool waits = std::ranges::any_of(waiting_, [](const Waiting& next) { return next.command.what != "step"; });
  if (waits && work_ && steady_seconds() - work_->seconds > longest_wait) session_.interrupt();
}

void Loop::begin(Work::Kind kind) {
  work_ = Work{kind, steady_seconds()};
}

void Loop::obey(const std::vector<Waiting>& waiting) {
  for (const Waiting& next : waiting) {
    Status status;
    try {
      status = live::obey(session_, next.command);
    } catch (const std::exception& error) {  // out of memory, most likely: the view lives on
      session_.pause();
      status = {.ending = Ending::cannot_continue, .message = std::string("internal error: ") + error.what()};
    }
    if (!status) complain_(next.client, status.message);
  }
}

void Loop::run() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point next = Clock::now();
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const std::vector<Waiting> now = std::exchange(waiting_, {});
    session_.forget_interrupt();  // what it made way for is obeyed now
    begin(Work::Kind::commands);
    lock.unlock();
    const double rate = rate_.load();
    session_.set_rate(rate);
    obey(now);
    lock.lock();
    begin(Work::Kind::motion);
    lock.unlock();
    session_.turn();
    next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate));
    if (next < Clock::now()) next = Clock::now();  // what was missed is not made up for
    lock.lock();
    work_.reset();
    wake_.wait_until(lock, next, [this] { return stopping_; });
  }
}

}  // namespace continuo::live
