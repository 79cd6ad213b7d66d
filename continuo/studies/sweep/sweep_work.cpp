// Hands chunks to threads, and their outcomes on, in their order where that is wanted.
#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <continuo/studies/sweep/sweep_work.hpp>

namespace continuo::studies {
namespace {

constexpr std::size_t most_waiting = 64;  // times as many chunks as a thread takes at once may be ahead of their turn
constexpr std::uint64_t runs_at_once = 1024, runs_at_once_of_process = 256;  // where runs can go together
constexpr std::size_t turns_left = 4;  // of each thread, so that none is left with much at the end

/// What all threads share: which chunk is next, and whose turn it is.
class Hands {
 public:
  Hands(const PreparedSweep& sweep, const SweepIdentity& identity, const SweepWork& work)
      : sweep_(sweep), identity_(identity), work_(work) {
    if (sweep.goes_together())
      at_once_ = static_cast<std::size_t>(
          std::max<std::uint64_t>(1, (work.take ? runs_at_once_of_process : runs_at_once) / identity.per_chunk()));
  }

  void go() {
    for (auto places = next(); !places.empty(); places = next())
      if (!make(places)) break;
    const std::scoped_lock lock(mutex_);
    turned_.notify_all();
  }

  Status status() {
    if (!status_) return status_;
    if (is_all_taken_ && delivered_ == taken_) return {};
    return {.ending = Ending::interrupted, .message = "the sweep was interrupted", .place = {}};
  }

 private:
  bool is_stopped() const { return !status_ || (work_.interrupt && work_.interrupt->load()); }

  /// The next places in the list of chunks that nobody has taken; none where all are.
  std::vector<std::size_t> next() {
    std::unique_lock lock(mutex_);
    // Whose turn it is has been begun by another thread, which does not wait here.
    turned_.wait(lock, [&] { return is_stopped() || !work_.in_order || next_ < turn_ + most_waiting * at_once_; });
    std::vector<std::size_t> places;
    for (std::size_t wanted = 1; !is_stopped() && places.size() < wanted;) {
      const std::uint64_t place = work_.take ? work_.take() : next_++;
      is_all_taken_ = place >= work_.chunks.size();
      if (is_all_taken_) break;
      places.push_back(static_cast<std::size_t>(place));
      const std::size_t left = work_.chunks.size() - places.front();
      const bool is_alone = work_.threads <= 1 && !work_.take;  // nobody else waits for something to do
      wanted = is_alone ? at_once_
                        : std::clamp<std::size_t>(left / (turns_left * std::max<std::size_t>(work_.threads, 1)), 1,
                                                  at_once_);
    }
    taken_ += places.size();
    return places;
  }

  /// Makes these chunks and hands each on when it is whole. False where they were interrupted.
  bool make(const std::vector<std::size_t>& places) {
    std::vector<std::uint64_t> runs;
    for (const std::size_t place : places) {
      const std::uint64_t first = identity_.first_run(work_.chunks[place]), size = identity_.size(work_.chunks[place]);
      for (std::uint64_t i = 0; i < size; ++i) runs.push_back(first + i);
    }
    std::size_t whole = 0;
    std::vector<SweepOutcome> made;
    std::uint64_t wanted = identity_.size(work_.chunks[places.front()]);
    if (work_.interrupt && work_.interrupt->load()) return false;
    sweep_.run_each(runs, [&](SweepOutcome outcome) {
      if (outcome.ending == Ending::interrupted) return false;
      made.push_back(std::move(outcome));
      count();
      if (made.size() == wanted) {
        hand_on(places[whole++], std::exchange(made, {}));
        if (whole < places.size()) wanted = identity_.size(work_.chunks[places[whole]]);
        made.reserve(static_cast<std::size_t>(wanted));
      }
      return !(work_.interrupt && work_.interrupt->load());
    });
    return whole == places.size();
  }

  void count() {
    if (!work_.progress) return;
    const std::scoped_lock lock(watching_);
    work_.progress(++runs_);
  }

  void hand_on(std::size_t place, std::vector<SweepOutcome> outcomes) {
    if (work_.at_once) return deliver_at_once(place, std::move(outcomes));
    const std::scoped_lock lock(mutex_);
    if (!work_.in_order) {
      deliver(place, std::move(outcomes));
      return;
    }
    waiting_.emplace(place, std::move(outcomes));
    for (auto first = waiting_.begin(); first != waiting_.end() && first->first == turn_; first = waiting_.begin()) {
      deliver(turn_++, std::move(first->second));
      waiting_.erase(first);
    }
    turned_.notify_all();
  }

  void deliver_at_once(std::size_t place, std::vector<SweepOutcome> outcomes) {
    Status status = work_.on_chunk(work_.chunks[place], std::move(outcomes));
    const std::scoped_lock lock(mutex_);
    if (status) {
      ++delivered_;
    } else if (status_) {
      status_ = std::move(status);
    }
  }

  void deliver(std::size_t place, std::vector<SweepOutcome> outcomes) {
    if (!status_) return;
    status_ = work_.on_chunk(work_.chunks[place], std::move(outcomes));
    if (status_) ++delivered_;
  }

  const PreparedSweep& sweep_;
  const SweepIdentity& identity_;
  const SweepWork& work_;
  std::mutex mutex_, watching_;
  std::condition_variable turned_;
  std::size_t at_once_ = 1;  // chunks
  std::size_t next_ = 0, turn_ = 0, taken_ = 0, delivered_ = 0;
  bool is_all_taken_ = false;
  std::uint64_t runs_ = 0;
  std::map<std::size_t, std::vector<SweepOutcome>> waiting_;
  Status status_;
};

}  // namespace

Status run_chunks(const PreparedSweep& sweep, const SweepIdentity& identity, const SweepWork& work) {
  Hands hands(sweep, identity, work);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < std::min(work.threads, work.chunks.size()); ++i)
      threads.emplace_back([&hands] { hands.go(); });
    hands.go();
  }
  return hands.status();
}

std::vector<std::uint64_t> chunks_of_part(const SweepIdentity& identity, std::uint64_t part, std::uint64_t parts) {
  const std::uint64_t all = identity.chunks(), each = all / parts, more = all % parts;
  const std::uint64_t first = (part - 1) * each + std::min(part - 1, more);
  std::vector<std::uint64_t> chunks(static_cast<std::size_t>(each + (part <= more ? 1 : 0)));
  for (std::size_t i = 0; i < chunks.size(); ++i) chunks[i] = first + i;
  return chunks;
}

}  // namespace continuo::studies
