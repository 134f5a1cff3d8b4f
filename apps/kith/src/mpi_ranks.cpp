// The only file that knows MPI, if kith is built with it.
#include "mpi_ranks.hpp"

#ifdef KITH_MPI
#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#endif

namespace kith::cli {

#ifdef KITH_MPI
namespace {

void check(int code) {
  if (code != MPI_SUCCESS) throw std::runtime_error{"MPI error " + std::to_string(code)};
}

bool is_initialized() {
  int flag = 0;
  MPI_Initialized(&flag);
  return flag != 0;
}

// The shared counter is a number in the memory of rank 0 that others add to without rank 0 taking part.
class MpiRanks final : public Ranks {
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

 private:
  int rank_ = 0;
  int size_ = 1;
  std::uint64_t* memory_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;  // one thread at a time speaks to MPI
};

// mpirun and srun say so in the environment; without them MPI is not even started.
bool several_were_started() {
  for (const auto* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && std::strtol(value, nullptr, 10) > 1) return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<Ranks> mpi_ranks() {
  if (!several_were_started()) return nullptr;
  return std::make_unique<MpiRanks>();
}

std::size_t threads_per_rank() {
  if (!is_initialized()) return 0;
  MPI_Comm neighbours = MPI_COMM_NULL;
  check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &neighbours));
  int size = 1;
  check(MPI_Comm_size(neighbours, &size));
  MPI_Comm_free(&neighbours);
  return std::max<std::size_t>(1, std::thread::hardware_concurrency() / static_cast<std::size_t>(size));
}

bool is_first_rank() {
  if (!is_initialized()) return true;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

const char* mpi_version() {
#ifdef OMPI_MAJOR_VERSION
#define KITH_TEXT_OF(x) #x
#define KITH_TEXT(x) KITH_TEXT_OF(x)
  return "Open MPI " KITH_TEXT(OMPI_MAJOR_VERSION) "." KITH_TEXT(OMPI_MINOR_VERSION) "." KITH_TEXT(
      OMPI_RELEASE_VERSION);
#undef KITH_TEXT
#undef KITH_TEXT_OF
#else
  return "some MPI";
#endif
}

#else

std::unique_ptr<Ranks> mpi_ranks() { return nullptr; }
std::size_t threads_per_rank() { return 0; }
bool is_first_rank() { return true; }
const char* mpi_version() { return "none"; }

#endif

}  // namespace kith::cli
