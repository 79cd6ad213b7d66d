// The processes that mpirun has started. Chunks are taken by one-sided communication: a counter lies in the memory of
// rank 0, and each rank adds to it without the help of another.
#pragma once
#include <mutex>
#include <thread>

#include <apps/continuo/studies/sweep_ranks.hpp>
#include <mpi.h>

namespace continuo::app {

class MpiRanks final : public SweepRanks {
 public:
  /// Begins MPI; it ends with this object.
  MpiRanks(int& argc, char**& argv);
  ~MpiRanks() override;

  bool is_first() const override { return rank_ == 0; }
  std::size_t count() const override { return static_cast<std::size_t>(size_); }
  bool agree(const std::string& text) override;
  std::optional<Chunks> share(const std::optional<Chunks>& list) override;
  std::uint64_t take() override;
  Status join(const Status& status) override;

 private:
  enum class Stage { begun, agreed, at_work, ended };
  void answer_others(const std::stop_token& stop);
  void be_silent();
  void speak();

  Stage stage_ = Stage::begun;
  int rank_ = 0, size_ = 1;
  int error_output_ = -1;  // the standard error of a rank that is silent
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex calls_;        // MPI is called by one thread at a time
  std::jthread answering_;  // of rank 0, while it makes runs
};

}  // namespace continuo::app
