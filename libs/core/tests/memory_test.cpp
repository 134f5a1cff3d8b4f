#include "kith/core/memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>

#include "kith/core/error.hpp"
#include "scratch_folder.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMebibyte = 1 << 20;

// A machine with 8 GiB available and no control groups, in a folder of its own.
class MemoryOfAMachine : public ::testing::Test {
 protected:
  MemoryOfAMachine() {
    write("proc/meminfo", "MemTotal:       16777216 kB\nMemFree:         1048576 kB\nMemAvailable:    8388608 kB\n");
    unsetenv("KITH_MEMORY");
  }
  ~MemoryOfAMachine() override { unsetenv("KITH_MEMORY"); }
  void write(const std::string& path, const std::string& text) const { (void)scratch_.write(path, text); }
  [[nodiscard]] std::uint64_t free_mebibytes() const { return free_memory(root_) / kMebibyte; }

  testing::ScratchFolder scratch_;
  fs::path root_ = scratch_.path();
};

TEST_F(MemoryOfAMachine, IsWhatIsAvailable) { EXPECT_EQ(free_mebibytes(), 8192u); }

TEST_F(MemoryOfAMachine, IsWhatTheTightestControlGroupLeaves) {
  write("proc/self/cgroup", "0::/jobs/mine\n");
  write("sys/fs/cgroup/jobs/mine/memory.max", "max\n");
  write("sys/fs/cgroup/jobs/mine/memory.current", "1048576\n");
  EXPECT_EQ(free_mebibytes(), 8192u);
  write("sys/fs/cgroup/jobs/memory.max", "2147483648\n");
  write("sys/fs/cgroup/jobs/memory.current", "1073741824\n");
  EXPECT_EQ(free_mebibytes(), 1024u);
  write("sys/fs/cgroup/jobs/memory.stat", "anon 5\ninactive_file 536870912\n");  // cached files, to be dropped
  EXPECT_EQ(free_mebibytes(), 1536u);
}

TEST_F(MemoryOfAMachine, IsSmallWhereAContainerSeesOnlyItsOwnGroup) {
  write("proc/self/cgroup", "0::/docker/0123456789\n");
  write("sys/fs/cgroup/memory.max", "104857600\n");
  write("sys/fs/cgroup/memory.current", "209715200\n");
  EXPECT_EQ(free_mebibytes(), 0u);
}

TEST_F(MemoryOfAMachine, KnowsControlGroupsOfVersionOne) {
  write("proc/self/cgroup", "12:cpu,cpuacct:/\n9:memory:/slurm/job_7\n");
  write("sys/fs/cgroup/memory/slurm/job_7/memory.limit_in_bytes", "3221225472\n");
  write("sys/fs/cgroup/memory/slurm/job_7/memory.usage_in_bytes", "1073741824\n");
  EXPECT_EQ(free_mebibytes(), 2048u);
}

TEST_F(MemoryOfAMachine, IsUnlimitedWhereNothingIsKnown) {
  fs::remove(root_ / "proc/meminfo");
  EXPECT_GT(free_mebibytes(), std::uint64_t{1} << 40U);
}

TEST_F(MemoryOfAMachine, CanBeSaidInTheEnvironment) {
  setenv("KITH_MEMORY", "500M", 1);
  EXPECT_EQ(free_mebibytes(), 500u);
  write("proc/self/status", "Name:\tkith\nVmRSS:\t  102400 kB\n");
  EXPECT_EQ(free_mebibytes(), 400u);  // the rest is taken
  fs::remove(root_ / "proc/self/status");
  setenv("KITH_MEMORY", "3T", 1);
  EXPECT_EQ(free_mebibytes(), 3u << 20U);
  for (const char* const wrong : {"8", "G", "8 G", "8GB", "-1G", "1e3M", "99999999999999999999M", "9999999T"}) {
    setenv("KITH_MEMORY", wrong, 1);
    EXPECT_THROW(static_cast<void>(free_memory()), Error) << wrong;
  }
}

TEST_F(MemoryOfAMachine, HasALimitOfTheProcess) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need all of the address space";
#endif
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  write("proc/self/status", "Name:\tkith\nVmSize:\t  1048576 kB\nVmData:\t  1024 kB\n");
  rlimit tight = before;
  tight.rlim_cur = std::uint64_t{3} << 30U;
  if (before.rlim_max < tight.rlim_cur || setrlimit(RLIMIT_AS, &tight) != 0) GTEST_SKIP() << "cannot set a limit";
  const auto found = free_mebibytes();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_EQ(found, 2048u);
}

TEST(Memory, IsSaidInFewDigits) {
  EXPECT_EQ(memory_text(6'420'000'000), "6.4 GB");
  EXPECT_EQ(memory_text(31'400'000'000), "31 GB");
  EXPECT_EQ(memory_text(1'234'000'000'000), "1230 GB");
  EXPECT_EQ(memory_text(345'678'901), "350 MB");
  EXPECT_EQ(memory_text(12'345'678), "12 MB");
  EXPECT_EQ(memory_text(0), "0 MB");
}

TEST(Memory, ThatIsNotThereIsSaidBeforeItIsTaken) {
  setenv("KITH_MEMORY", "4000G", 1);  // what the tests themselves take is far below a digit of it
  require_memory(4'000'000'000'000, "planning", "");
  try {
    require_memory(6'000'000'000'000, "planning 90000 states", "use a smaller map");
    ADD_FAILURE() << "6 TB of 4 were found";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    EXPECT_STREQ(error.what(), "planning 90000 states needs about 6000 GB of memory; 4290 GB are free");
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics()[0].id, "E1201");
    EXPECT_EQ(error.diagnostics()[0].hint, "use a smaller map");
  }
  unsetenv("KITH_MEMORY");
}

TEST(Memory, ThatIsTakenInSmallPartsIsGuarded) {
  setenv("KITH_MEMORY", "1G", 1);
  MemoryGuard guard{"counting", ""};
  for (int i = 0; i < 50; ++i) guard.take(kMebibyte);  // too little to look
  EXPECT_NO_THROW(guard.take(30 * kMebibyte));
  EXPECT_THROW(guard.take(2000 * kMebibyte), Error);
  unsetenv("KITH_MEMORY");
}

}  // namespace
}  // namespace kith
