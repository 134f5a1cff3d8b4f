#include "kith/runs/ranks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <thread>
#include <vector>

#include "kith/runs/journal.hpp"
#include "study_runs.hpp"

namespace kith {
namespace {

using testing::expected;
using testing::how;
using ::testing::IsEmpty;
using testing::item_delivery;
using testing::quick_study;
using testing::run;
using testing::StudyRunTest;
using testing::tables_in;

namespace fs = std::filesystem;

// Threads of one process that behave like ranks.
class ThreadRanks {
 public:
  explicit ThreadRanks(std::size_t size) : size_{size}, barrier_{static_cast<std::ptrdiff_t>(size)} {}

  class One final : public Ranks {
   public:
    One(ThreadRanks& all, std::size_t rank) : all_{all}, rank_{rank} {}
    std::uint64_t take(std::uint64_t n) override { return all_.counter_.fetch_add(n); }
    [[nodiscard]] std::size_t rank() const override { return rank_; }
    [[nodiscard]] std::size_t size() const override { return all_.size_; }
    [[nodiscard]] std::string broadcast(std::string bytes) override {
      if (rank_ == 0) all_.message_ = std::move(bytes);
      wait_for_all();
      auto result = all_.message_;
      wait_for_all();
      return result;
    }
    [[nodiscard]] bool any(bool mine) override {
      if (mine) all_.any_ = true;
      wait_for_all();
      const bool result = all_.any_;
      wait_for_all();
      all_.any_ = false;
      wait_for_all();
      return result;
    }
    void wait_for_all() override { all_.barrier_.arrive_and_wait(); }
    [[nodiscard]] std::size_t num_on_this_machine() override { return all_.size_; }

   private:
    ThreadRanks& all_;
    std::size_t rank_;
  };

 private:
  std::size_t size_;
  std::barrier<> barrier_;
  std::atomic<std::uint64_t> counter_{0};
  std::string message_;
  std::atomic<bool> any_{false};
};

// Runs it on ranks; `stop_after` teams of a rank stop all of them.
bool run_on_ranks(const fs::path& folder, std::size_t size, std::size_t stop_after = 1000) {
  ThreadRanks ranks{size};
  std::atomic<bool> finished{true};
  std::vector<std::thread> threads;
  for (std::size_t rank = 0; rank < size; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadRanks::One one{ranks, rank};
      auto options = how();
      options.threads = 1;
      options.ranks = &one;
      std::size_t taught = 0;
      options.on_progress = [&](std::size_t, std::size_t, std::size_t) { ++taught; };
      options.stopped = [&] { return taught >= stop_after; };
      StudyRun run{folder, quick_study(), options};
      if (!run.teach(item_delivery())) finished = false;
      if (finished) (void)run.publish({});
    });
  }
  for (auto& thread : threads) thread.join();
  return finished;
}

TEST_F(StudyRunTest, GivesTheSameTablesOnAnyNumberOfRanks) {
  for (const std::size_t size : {1u, 2u, 4u}) {
    const auto folder = scratch_.path() / std::to_string(size);
    EXPECT_TRUE(run_on_ranks(folder, size));
    EXPECT_EQ(tables_in(folder), expected());
    EXPECT_THAT(rank_journals(folder), IsEmpty());
  }
}

TEST_F(StudyRunTest, TakesUpWhatRanksLeftWhenTheyWereStopped) {
  EXPECT_FALSE(run_on_ranks(folder_, 2, 1));
  {
    StudyRun run{folder_, quick_study(), how()};
    EXPECT_GE(run.num_resumed(), 1u);
    EXPECT_THAT(rank_journals(folder_), IsEmpty());
  }
  EXPECT_EQ(run(folder_), expected());
}

}  // namespace
}  // namespace kith
