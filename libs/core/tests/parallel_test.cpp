#include "kith/core/parallel.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

namespace kith {
namespace {

TEST(ForEachIndex, CallsEveryIndexOnceOnAnyNumberOfThreads) {
  for (const std::size_t threads : {0u, 1u, 2u, 3u, 16u}) {
    for (const std::size_t n : {0u, 1u, 2u, 1000u}) {
      std::vector<std::atomic<int>> calls(n);
      EXPECT_TRUE(for_each_index(n, {.threads = threads, .on_progress = {}}, [&](std::size_t i) { ++calls[i]; }));
      for (const auto& count : calls) EXPECT_EQ(count, 1);
    }
  }
}

TEST(ForEachIndex, StartsNoMoreThreadsThanAskedFor) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  for_each_index(100, {.threads = 3, .on_progress = {}}, [&](std::size_t) {
    const std::lock_guard lock{mutex};
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_GE(threads.size(), 1u);
  EXPECT_LE(threads.size(), 3u);
}

TEST(ForEachIndex, EndsAtTheFirstExceptionAndThrowsIt) {
  for (const std::size_t threads : {1u, 4u}) {
    std::atomic<std::size_t> calls{0};
    const auto body = [&](std::size_t i) {
      ++calls;
      if (i == 10) throw std::runtime_error{"ten"};
    };
    EXPECT_THROW(for_each_index(1'000'000, {.threads = threads, .on_progress = {}}, body), std::runtime_error);
    EXPECT_LT(calls, 1'000'000u);
  }
}

TEST(ForEachIndex, StopsWhenProgressSaysSo) {
  const auto stop_at_five = [](std::size_t done, std::size_t) { return done < 5; };
  std::atomic<std::size_t> calls{0};
  EXPECT_FALSE(for_each_index(1000, {.threads = 2, .on_progress = stop_at_five}, [&](std::size_t) { ++calls; }));
  EXPECT_LE(calls, 6u);  // one more may have been under way
}

bool can_start_a_thread() {
  try {
    std::jthread{[] {}};
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

// In a process of its own, whose user may have no more processes.
TEST(ForEachIndex, GoesOnAloneWhereTheSystemGivesNoThread) {
  constexpr int kNotLimited = 77;
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    const rlimit none = {0, 0};
    if (geteuid() == 0 && setuid(kNobody) != 0) _exit(kNotLimited);
    if (setrlimit(RLIMIT_NPROC, &none) != 0 || can_start_a_thread()) _exit(kNotLimited);
    std::vector<int> calls(100, 0);
    for_each_index(calls.size(), {.threads = 8, .on_progress = {}}, [&](std::size_t i) { ++calls[i]; });
    _exit(calls == std::vector<int>(100, 1) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotLimited) {
    GTEST_SKIP() << "the number of threads cannot be limited here";
  }
  EXPECT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace kith
