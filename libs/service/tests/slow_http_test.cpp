// slowhttptest (https://github.com/shekyan/slowhttptest): slow heads, slow bodies and slow readers, as a tool of others
// makes them, while a client that behaves is served. Skipped where the tool is not installed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include "served.hpp"

extern char** environ;

namespace kith::testing {
namespace {

// The tool against a port for ten seconds.
class SlowTool {
 public:
  SlowTool(std::uint16_t port, const std::string& path, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "slowhttptest");
    for (const char* fixed : {"-c", "200", "-r", "200", "-i", "1", "-p", "3", "-l", "10", "-v", "0", "-u"}) {
      arguments.emplace_back(fixed);
    }
    arguments.push_back("http://127.0.0.1:" + std::to_string(port) + path);
    std::vector<char*> raw;
    for (auto& argument : arguments) raw.push_back(argument.data());
    raw.push_back(nullptr);
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    is_there_ = posix_spawnp(&process_, "slowhttptest", &quiet, nullptr, raw.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&quiet);
  }
  ~SlowTool() {
    if (!is_there_ || is_over_) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  SlowTool(const SlowTool&) = delete;
  SlowTool& operator=(const SlowTool&) = delete;

  [[nodiscard]] bool is_there() const { return is_there_; }
  [[nodiscard]] bool is_over() {
    is_over_ = is_over_ || waitpid(process_, nullptr, WNOHANG) == process_;
    return is_over_;
  }

 private:
  pid_t process_ = 0;
  bool is_there_ = false;
  bool is_over_ = false;
};

struct SlowMode {
  const char* name;
  const char* path;
  std::vector<std::string> arguments;
};

class SlowHttp : public ::testing::TestWithParam<SlowMode> {};

// The tool has all its connections at once, or loses most of them to whoever comes from the same address.
class SlowHttpOfOneAddress : public SlowHttp {};

TEST_P(SlowHttpOfOneAddress, LeavesAGoodClientServed) {
  Served served{{.limits = {.unauthenticated_per_address = 20}}};
  SlowTool tool{served.port(), GetParam().path, GetParam().arguments};
  if (!tool.is_there()) GTEST_SKIP() << "slowhttptest is not installed";
  RawWebSocket seat{served.port()};
  seat.say(kHello);
  ASSERT_EQ(seat.hear(), R"({"t":"welcome"})");
  std::size_t rounds = 0;
  while (!tool.is_over()) {
    ASSERT_TRUE(served.serves_well()) << "round " << rounds;
    ++rounds;
    usleep(20'000);
  }
  EXPECT_GT(rounds, 10U);
  EXPECT_GT(served.server.status().turned_away, 100U) << "the tool had no effect";
  seat.say("still here");
  EXPECT_EQ(seat.hear(), "still here");
}

TEST_P(SlowHttp, LeavesAGoodClientServed) {
  Served served{{.limits = {.unauthenticated_per_address = 1000}}};
  SlowTool tool{served.port(), GetParam().path, GetParam().arguments};
  if (!tool.is_there()) GTEST_SKIP() << "slowhttptest is not installed";
  std::size_t rounds = 0;
  std::size_t most = 0;
  while (!tool.is_over()) {
    ASSERT_TRUE(served.serves_well()) << "round " << rounds;
    most = std::max(most, static_cast<std::size_t>(served.server.status().connections));
    ++rounds;
    usleep(20'000);
  }
  RecordProperty("rounds", static_cast<int>(rounds));
  RecordProperty("most_connections", static_cast<int>(most));
  EXPECT_GT(rounds, 10U);
  EXPECT_GT(most, 100U) << "the tool had no effect";
  EXPECT_TRUE(served.serves_well());
  EXPECT_TRUE(all_gone(served.server));
}

const auto kSlowModes = ::testing::Values(
    SlowMode{"Headers", "/j", {"-H"}}, SlowMode{"Bodies", "/api/a", {"-B", "-f", "application/json", "-s", "8192"}},
    SlowMode{"Readers", "/assets/live/large.js", {"-X", "-w", "512", "-y", "1024", "-z", "64"}});
constexpr auto kNameOfMode = [](const ::testing::TestParamInfo<SlowMode>& mode) {
  return std::string{mode.param.name};
};
INSTANTIATE_TEST_SUITE_P(Modes, SlowHttp, kSlowModes, kNameOfMode);
INSTANTIATE_TEST_SUITE_P(Modes, SlowHttpOfOneAddress, kSlowModes, kNameOfMode);

}  // namespace
}  // namespace kith::testing
