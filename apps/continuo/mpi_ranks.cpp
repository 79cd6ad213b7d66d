// Speaks to the other processes by MPI.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>

#include <apps/continuo/mpi_ranks.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fcntl.h>
#include <unistd.h>

#include <continuo/results/sha256.hpp>

namespace continuo::app {
namespace {

/// What a rank says at the end; the largest is that of all.
enum class Said : int { done, interrupted, failed };

}  // namespace

MpiRanks::MpiRanks(int& argc, char**& argv) {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (provided < MPI_THREAD_SERIALIZED) {
    if (is_first()) say("this MPI lets no more than one thread call it, and a sweep needs several");
    MPI_Finalize();
    std::exit(EXIT_FAILURE);
  }
  if (!is_first()) be_silent();
  std::uint64_t* counter = nullptr;
  MPI_Win_allocate(is_first() ? sizeof(std::uint64_t) : 0, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                   &counter, &window_);
  MPI_Win_lock_all(0, window_);
  if (is_first()) {
    const std::uint64_t zero = 0;
    MPI_Put(&zero, 1, MPI_UINT64_T, 0, 0, 1, MPI_UINT64_T, window_);
    MPI_Win_flush(0, window_);
  }
}

/// Until it is at work, a rank would say once more what the first one says.
void MpiRanks::be_silent() {
  error_output_ = dup(STDERR_FILENO);
  const int nothing = open("/dev/null", O_WRONLY);
  if (nothing < 0) return;
  dup2(nothing, STDOUT_FILENO);
  dup2(nothing, STDERR_FILENO);
  close(nothing);
}

void MpiRanks::speak() {
  if (error_output_ >= 0) dup2(error_output_, STDERR_FILENO);
}

/// A rank that ends before the others expect it answers what they still ask.
MpiRanks::~MpiRanks() {
  if (stage_ == Stage::at_work) MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);  // an error in the program
  if (stage_ == Stage::begun) (void)agree({});
  if (stage_ == Stage::agreed) (void)share(std::nullopt);
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
  MPI_Finalize();
}

bool MpiRanks::agree(const std::string& text) {
  std::array<char, 64> own{}, first{};  // digits of a hash; of no text, zeros
  if (!text.empty()) {
    const std::string hash = results::sha256(text);
    std::copy_n(hash.begin(), own.size(), own.begin());
  }
  first = own;
  MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
  const int is_same = !text.empty() && own == first ? 1 : 0;
  int all_same = 0;
  MPI_Allreduce(&is_same, &all_same, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  stage_ = all_same == 1 ? Stage::agreed : Stage::ended;
  return all_same == 1;
}

std::optional<SweepRanks::Chunks> MpiRanks::share(const std::optional<Chunks>& list) {
  constexpr std::uint64_t no_list = ~std::uint64_t{0};
  std::uint64_t size = list ? list->size() : no_list;
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  stage_ = size == no_list ? Stage::ended : Stage::at_work;
  if (size == no_list) return std::nullopt;
  Chunks shared = is_first() ? *list : Chunks(static_cast<std::size_t>(size));
  MPI_Bcast(shared.data(), static_cast<int>(size), MPI_UINT64_T, 0, MPI_COMM_WORLD);
  speak();
  if (is_first()) answering_ = std::jthread([this](const std::stop_token& stop) { answer_others(stop); });
  return shared;
}

/// Where the network cannot add to the memory of another machine by itself, MPI does so within any call of rank 0.
void MpiRanks::answer_others(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      const std::scoped_lock lock(calls_);
      int found = 0;
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &found, MPI_STATUS_IGNORE);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::uint64_t MpiRanks::take() {
  const std::scoped_lock lock(calls_);
  const std::uint64_t one = 1;
  std::uint64_t place = 0;
  MPI_Fetch_and_op(&one, &place, MPI_UINT64_T, 0, 0, MPI_SUM, window_);
  MPI_Win_flush(0, window_);
  return place;
}

Status MpiRanks::join(const Status& status) {
  if (answering_.joinable()) {
    answering_.request_stop();
    answering_.join();
  }
  const Said own = status ? Said::done : status.ending == Ending::interrupted ? Said::interrupted : Said::failed;
  const int said = static_cast<int>(own);
  int worst = 0;
  MPI_Allreduce(&said, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  stage_ = Stage::ended;
  if (worst == static_cast<int>(own)) return status;
  if (worst == static_cast<int>(Said::interrupted))
    return {.ending = Ending::interrupted, .message = "the sweep was interrupted", .place = {}};
  return {.ending = Ending::cannot_continue, .message = "another process failed, and says above why", .place = {}};
}

}  // namespace continuo::app
