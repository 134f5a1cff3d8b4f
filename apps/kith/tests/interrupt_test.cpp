// Signals, whatever the program is doing.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <sstream>

#include "large_map.hpp"
#include "run_kith.hpp"
#include "slow_study.hpp"

namespace kith::testing {
namespace {

using ::testing::AnyOf;
using ::testing::IsEmpty;
using Clock = std::chrono::steady_clock;

namespace fs = std::filesystem;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// A process that must not outlive its test.
class Child {
 public:
  explicit Child(pid_t process) : process_{process} {}
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    static_cast<void>(exit_code_of(process_));
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void send(int signal) const { kill(process_, signal); }
  // Processor time that it has used, all threads together, in seconds.
  [[nodiscard]] double processor_time() const {
    auto stat = text_of("/proc/" + std::to_string(process_) + "/stat");
    std::istringstream fields{stat.erase(0, stat.rfind(')') + 1)};
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    double user = 0.0, system = 0.0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  // The exit code if it ends within so many seconds, else -1.
  [[nodiscard]] int code_within(double seconds) {
    const auto start = Clock::now();
    int status = 0;
    while (waitpid(process_, &status, WNOHANG) == 0) {
      if (seconds_since(start) > seconds) return -1;
      usleep(5'000);
    }
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t process_;
};

// Nothing is asked about signals while the first lesson is chosen.
std::vector<std::string> long_lesson(const Scratch& scratch) {
  return {"study", slow_study(scratch, "NN"), "-o", scratch / "run", "-j", "2"};
}

constexpr double kHang = 30.0;  // seconds; what answers does so within one, on a machine that is not too busy

TEST(Interrupt, EndsAStudyInTheMiddleOfALongStep) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Scratch scratch;
    std::ofstream{scratch / "in"} << "";
    Child child{start_kith(long_lesson(scratch), {}, scratch / "in", scratch / "out", scratch / "err")};
    for (int i = 0; i < 3000 && !fs::exists(scratch / "run/study.sqlite"); ++i) usleep(10'000);
    // Well into the lesson, however busy the machine is: what comes before it takes a tenth of this.
    const double made = child.processor_time();
    for (int i = 0; i < 3000 && child.processor_time() < made + 0.3; ++i) usleep(10'000);
    child.send(signal);
    EXPECT_EQ(child.code_within(kHang), 128 + signal);
    EXPECT_THAT(text_of(scratch / "err"), HasSubstr("interrupted in the middle of a long step"));
    EXPECT_THAT(text_of(scratch / "out"), IsEmpty());
    EXPECT_FALSE(fs::exists(scratch / "run/tables"));
  }
}

TEST(Interrupt, EndsAtOnceWhenAskedTwice) {
  const Scratch scratch;
  std::ofstream{scratch / "in"} << "";
  Child child{start_kith(long_lesson(scratch), {}, scratch / "in", scratch / "out", scratch / "err")};
  for (int i = 0; i < 3000 && !fs::exists(scratch / "run/study.sqlite"); ++i) usleep(10'000);
  child.send(SIGINT);
  usleep(20'000);
  child.send(SIGINT);
  EXPECT_EQ(child.code_within(kHang), 128 + SIGINT);
}

// As nohup does.
TEST(Interrupt, IsNotAHangUpThatTheCallerIgnores) {
  const Scratch scratch;
  std::ofstream{scratch / "in"} << "";
  struct sigaction ignore = {};
  struct sigaction before = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGHUP, &ignore, &before);
  Child child{start_kith({"study", "quick", "-o", scratch / "run", "--set", "replicates=50", "-q"}, {}, scratch / "in",
                         scratch / "out", scratch / "err")};
  sigaction(SIGHUP, &before, nullptr);
  for (int i = 0; i < 3000 && !fs::exists(scratch / "run/study.sqlite"); ++i) usleep(10'000);
  child.send(SIGHUP);
  EXPECT_EQ(child.code_within(kHang), 0);
  EXPECT_TRUE(fs::exists(scratch / "run/tables"));
}

// Wherever the signal meets them: reading, planning, choosing, or at the end already.
TEST(InterruptSlow, EndsEveryCommandOnALargeMap) {
  const Scratch scratch;
  std::ofstream{scratch / "in"} << "";
  const auto study = long_lesson(scratch)[1];
  const auto map = scratch / "map.toml";
  std::ofstream{map} << large_map(300);
  const std::vector<std::vector<std::string>> commands{{"validate", map},
                                                       {"validate", study},
                                                       {"inspect", map, "--show", "bec,kc,demos,tests,counterfactuals"},
                                                       {"lesson", map},
                                                       {"ask", map, "what do you care about?"},
                                                       {"find", map},
                                                       {"teach", map, "--group", "NN"},
                                                       {"study", study, "-o", scratch / "run"},
                                                       {"power", study}};
  for (const auto& command : commands) {
    for (const int milliseconds : {300, 3000}) {
      Child child{start_kith(command, {}, scratch / "in", scratch / "out", scratch / "err")};
      usleep(static_cast<unsigned>(milliseconds) * 1000);
      child.send(SIGINT);
      EXPECT_THAT(child.code_within(kHang), AnyOf(128 + SIGINT, 0, 2, 3, 4))
          << command.front() << text_of(scratch / "err");
      fs::remove_all(scratch / "run");
    }
  }
}

}  // namespace
}  // namespace kith::testing
