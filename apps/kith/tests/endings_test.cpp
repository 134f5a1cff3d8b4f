// What becomes of a command when the system denies it something: output, memory, files of the usual kind.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Json = nlohmann::json;

namespace fs = std::filesystem;

std::vector<std::string> small_study(const std::string& folder) {
  return {"study", "quick", "-o", folder, "--set", "replicates=2", "-j", "1"};
}

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const Tables& expected() {
  static const Tables kTables = [] {
    const Scratch scratch;
    EXPECT_EQ(run_kith(small_study(scratch / "run")).code, 0);
    return tables_in(scratch / "run");
  }();
  return kTables;
}

void write_text(const std::string& file, const std::string& text) { std::ofstream{file} << text; }

// Nothing that hangs may hang the tests: the program is ended by SIGALRM.
void guard() { alarm(120); }

// --- progress ---------------------------------------------------------------------

void close_standard_error() { close(STDERR_FILENO); }

void fill_standard_error() { dup2(open("/dev/full", O_WRONLY), STDERR_FILENO); }

void break_standard_error() {
  int ends[2] = {-1, -1};
  if (pipe(ends) != 0) _exit(126);
  close(ends[0]);
  dup2(ends[1], STDERR_FILENO);
}

TEST(Progress, ThatCannotBeWrittenDoesNotEndAStudy) {
  for (const auto& deny : {close_standard_error, fill_standard_error, break_standard_error}) {
    const Scratch scratch;
    const auto ran = run_kith(with(small_study(scratch / "run"), {"--progress", "json"}), {.prepare = deny});
    EXPECT_EQ(ran.code, 0);
    EXPECT_EQ(tables_in(scratch / "run"), expected());
    EXPECT_THAT(ran.out, Not(IsEmpty()));
    EXPECT_EQ(run_kith({"verify", scratch / "run", "--progress", "json"}, {.prepare = deny}).code, 0);
  }
}

TEST(Progress, ThatCannotBeWrittenEndsNoOtherCommand) {
  const RunWith full{.prepare = fill_standard_error};
  EXPECT_EQ(
      run_kith({"power", "quick", "--pool", "20", "--teams", "5", "--draws", "10", "--progress", "json"}, full).code,
      0);
  EXPECT_EQ(run_kith({"bench", "--quick", "--filter", "geometry", "--progress", "json"}, full).code, 0);
}

// A terminal of which the test is the other end.
class Terminal {
 public:
  Terminal() : descriptor_{posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)} {
    EXPECT_EQ(grantpt(descriptor_), 0);
    EXPECT_EQ(unlockpt(descriptor_), 0);
    name_ = ptsname(descriptor_);
  }
  ~Terminal() { close_it(); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string read_some() const {
    std::string text(4096, '\0');
    const auto count = read(descriptor_, text.data(), text.size());
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return text;
  }
  void close_it() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
  }

 private:
  int descriptor_ = -1;
  std::string name_;
};

TEST(Progress, OfAClosedTerminalDoesNotEndAStudy) {
  const Scratch scratch;
  write_text(scratch / "in", "");
  Terminal terminal;
  const auto show_on_terminal = [&terminal] {
    guard();
    dup2(open(terminal.name().c_str(), O_WRONLY | O_NOCTTY), STDERR_FILENO);
  };
  const auto child = start_kith(
      {"study", "quick", "-o", scratch / "run", "--set", "replicates=100000", "-j", "1", "--progress", "bar"},
      {.prepare = show_on_terminal}, scratch / "in", scratch / "out", scratch / "err");
  std::string shown;
  while (shown.find("teams") == std::string::npos) {
    const auto more = terminal.read_some();
    if (more.empty() && kill(child, 0) != 0) break;
    shown += more;
  }
  EXPECT_THAT(shown, HasSubstr("/200000 teams"));
  terminal.close_it();
  const auto done = [&] {
    return Json::parse(run_kith({"status", scratch / "run", "--json"}).out).at("done").get<int>();
  };
  const int before = done();
  usleep(500'000);  // several updates of the bar
  EXPECT_EQ(kill(child, SIGTERM), 0);
  EXPECT_EQ(exit_code_of(child), 128 + SIGTERM);
  EXPECT_GE(done(), before);
}

}  // namespace
}  // namespace kith::testing
