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

constexpr std::size_t most_waiting = 64;  // chunks that are ahead of their turn

/// What all threads share: which chunk is next, and whose turn it is.
class Hands {
 public:
  Hands(const PreparedSweep& sweep, const SweepIdentity& identity, const SweepWork& work)
      : sweep_(sweep), identity_(identity), work_(work) {}

  void go() {
    while (const auto place = next()) {
      auto made = run_chunk(sweep_, identity_, work_.chunks[*place], work_.interrupt, [this] { count(); });
      if (!made) break;
      hand_on(*place, *std::move(made));
    }
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

  std::optional<std::size_t> next() {
    std::unique_lock lock(mutex_);
    // Whose turn it is has been begun by another thread, which does not wait here.
    turned_.wait(lock, [&] { return is_stopped() || !work_.in_order || next_ < turn_ + most_waiting; });
    if (is_stopped()) return std::nullopt;
    const std::uint64_t place = work_.take ? work_.take() : next_;
    is_all_taken_ = place >= work_.chunks.size();
    if (is_all_taken_) return std::nullopt;
    ++taken_;
    if (!work_.take) ++next_;
    return static_cast<std::size_t>(place);
  }

  void count() {
    if (!work_.progress) return;
    const std::scoped_lock lock(watching_);
    work_.progress(++runs_);
  }

  void hand_on(std::size_t place, std::vector<SweepOutcome> outcomes) {
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
  std::size_t next_ = 0, turn_ = 0, taken_ = 0, delivered_ = 0;
  bool is_all_taken_ = false;
  std::uint64_t runs_ = 0;
  std::map<std::size_t, std::vector<SweepOutcome>> waiting_;
  Status status_;
};

}  // namespace

std::optional<std::vector<SweepOutcome>> run_chunk(const PreparedSweep& sweep, const SweepIdentity& identity,
                                                   std::uint64_t chunk, const std::atomic<bool>* interrupt,
                                                   const std::function<void()>& on_run) {
  std::vector<SweepOutcome> made;
  const std::uint64_t first = identity.first_run(chunk), size = identity.size(chunk);
  made.reserve(static_cast<std::size_t>(size));
  for (std::uint64_t i = 0; i < size; ++i) {
    if (interrupt && interrupt->load()) return std::nullopt;
    made.push_back(sweep.run(first + i));
    if (made.back().ending == Ending::interrupted) return std::nullopt;
    if (on_run) on_run();
  }
  return made;
}

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
