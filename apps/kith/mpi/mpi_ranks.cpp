// The only file that uses MPI: a module of its own, since linking MPI would make every command wait for its libraries.
#include <mpi.h>

#include <cstdlib>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

#include "kith/runs/ranks.hpp"

namespace {

void check(int code) {
  if (code != MPI_SUCCESS) throw std::runtime_error{"MPI error " + std::to_string(code)};
}

// The shared counter is a number in the memory of rank 0 that others add to without rank 0 taking part.
class MpiRanks final : public kith::Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided));
    if (provided < MPI_THREAD_SERIALIZED) throw std::runtime_error{"this MPI does not allow threads"};
    check(MPI_Comm_rank(MPI_COMM_WORLD, &rank_));
    check(MPI_Comm_size(MPI_COMM_WORLD, &size_));
    const MPI_Aint bytes = rank_ == 0 ? static_cast<MPI_Aint>(sizeof(std::uint64_t)) : 0;
    check(MPI_Win_allocate(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD, &memory_, &window_));
    if (rank_ == 0) *memory_ = 0;
    check(MPI_Barrier(MPI_COMM_WORLD));
    check(MPI_Win_lock_all(0, window_));
  }
  // After an error the others would be waited for in vain: mpirun ends them when this process is gone.
  ~MpiRanks() override {
    if (std::uncaught_exceptions() > 0) return;
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  [[nodiscard]] std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
  [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(size_); }

  std::uint64_t take(std::uint64_t n) override {
    const std::lock_guard lock{mutex_};
    std::uint64_t before = 0;
    check(MPI_Fetch_and_op(&n, &before, MPI_UINT64_T, 0, 0, MPI_SUM, window_));
    check(MPI_Win_flush(0, window_));
    return before;
  }

  [[nodiscard]] std::string broadcast(std::string bytes) override {
    std::uint64_t size = bytes.size();
    check(MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD));
    bytes.resize(size);
    if (size > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) throw std::length_error{"broadcast"};
    check(MPI_Bcast(bytes.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD));
    return bytes;
  }

  [[nodiscard]] bool any(bool mine) override {
    int one = mine ? 1 : 0;
    int all = 0;
    check(MPI_Allreduce(&one, &all, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD));
    return all != 0;
  }

  void wait_for_all() override { check(MPI_Barrier(MPI_COMM_WORLD)); }

  [[nodiscard]] std::size_t num_on_this_machine() override {
    MPI_Comm neighbours = MPI_COMM_NULL;
    check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &neighbours));
    int size = 1;
    check(MPI_Comm_size(neighbours, &size));
    MPI_Comm_free(&neighbours);
    return static_cast<std::size_t>(size);
  }

 private:
  int rank_ = 0;
  int size_ = 1;
  std::uint64_t* memory_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;  // one thread at a time speaks to MPI
};

}  // namespace

/// This process among those that were started together; the caller owns it.
extern "C" kith::Ranks* kith_mpi_ranks() { return new MpiRanks; }
