// What becomes of a command when the system denies it something: output, memory, files of the usual kind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::IsEmpty;

namespace fs = std::filesystem;

std::vector<std::string> tiny_study(const std::string& folder) {
  return {"study", "quick", "-o", folder, "--set", "replicates=2", "-j", "1"};
}

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const Tables& tiny_tables() {
  static const Tables kTables = [] {
    const Scratch scratch;
    EXPECT_EQ(run_kith(tiny_study(scratch / "run")).code, 0);
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
    const auto ran = out_of(with(tiny_study(scratch / "run"), {"--progress", "json"}), {.prepare = deny});
    EXPECT_EQ(tables_in(scratch / "run"), tiny_tables());
    EXPECT_THAT(ran, Not(IsEmpty()));
    EXPECT_EQ(run_kith({"verify", scratch / "run", "--progress", "json"}, {.prepare = deny}).code, 0);
  }
}

TEST(Progress, ThatCannotBeWrittenEndsNoOtherCommand) {
  const RunWith full{.prepare = fill_standard_error};
  EXPECT_EQ(
      run_kith({"power", "quick", "--pool", "20", "--teams", "5", "--draws", "10", "--progress", "json"}, full).code,
      0);
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
  const auto done = [&] { return json_of({"status", scratch / "run"}).at("done").get<int>(); };
  const int before = done();
  usleep(500'000);  // several updates of the bar
  EXPECT_EQ(kill(child, SIGTERM), 0);
  EXPECT_EQ(exit_code_of(child), 128 + SIGTERM);
  EXPECT_GE(done(), before);
}

// --- standard streams -------------------------------------------------------------

TEST(StandardStreams, ThatAreClosedAreNotMixedUpWithFiles) {
  for (const int closed : {STDOUT_FILENO, STDERR_FILENO}) {
    const Scratch scratch;
    const auto ran = run_kith(with(tiny_study(scratch / "run"), {"-v", "--progress", "json"}), {.prepare = [closed] {
                                close(STDIN_FILENO);
                                close(closed);
                              }});
    EXPECT_EQ(ran.code, closed == STDOUT_FILENO ? 5 : 0) << ran.err;
    EXPECT_EQ(tables_in(scratch / "run"), tiny_tables());
    for (const auto& entry : fs::recursive_directory_iterator{scratch / "run"}) {
      if (!entry.is_regular_file()) continue;
      EXPECT_THAT(text_of(entry.path()), AllOf(Not(HasSubstr("kith: ")), Not(HasSubstr("\"eta_s\"")))) << entry.path();
    }
    EXPECT_EQ(run_kith({"verify", scratch / "run"}).code, 0);
  }
}

TEST(StandardStreams, ThatAreClosedAreErrorsWhereTheyAreNeeded) {
  const auto no_input = err_of(5, {"validate", "-"}, {.prepare = [] { close(STDIN_FILENO); }});
  EXPECT_THAT(no_input, HasSubstr("cannot read standard input"));
  const auto no_output = err_of(5, {"version"}, {.prepare = [] { close(STDOUT_FILENO); }});
  EXPECT_THAT(no_output, HasSubstr("cannot write to standard output"));
}

TEST(Json, ThatCannotBeWrittenIsAnErrorInWords) {
  const auto ran = err_of(5, {"lesson", "item-delivery", "--json"}, {.out_to = "/dev/full"});
  EXPECT_THAT(ran, HasSubstr("kith: error: cannot write to standard output: No space left on device"));
  EXPECT_THAT(err_of(5, {"inspect", "item-delivry", "--json"}, {.out_to = "/dev/full"}),
              AllOf(HasSubstr("did you mean 'item-delivery'?"), HasSubstr("cannot write to standard output")));
}

TEST(Messages, DoNotCommandTheTerminal) {
  const auto ran = err_of(3, {"inspect", "no\033[2Jsuch\rdomain"});
  EXPECT_THAT(ran, AllOf(HasSubstr("no\\x1b[2Jsuch\\x0ddomain"), Not(HasSubstr("\033")), Not(HasSubstr("\r"))));
  const Scratch scratch;
  write_text(scratch / "d.toml", "schema = \"\\u001b[2J\"\n");
  EXPECT_THAT(run_kith({"inspect", scratch / "d.toml"}).err, AllOf(HasSubstr("\\x1b[2J"), Not(HasSubstr("\033"))));
}

TEST(Results, DoNotCommandTheTerminalEither) {
  const Scratch scratch;
  const auto name = scratch / "a\033[2Jb.toml";
  fs::copy_file(fs::path{KITH_SOURCE_DIR} / "domains" / "item_delivery.toml", name);
  const Terminal terminal;
  EXPECT_EQ(run_kith({"validate", name}, {.out_to = terminal.name()}).code, 0);
  EXPECT_THAT(terminal.read_some(), AllOf(HasSubstr("a\\x1b[2Jb.toml"), HasSubstr("is valid"), Not(HasSubstr("\033"))));
  EXPECT_THAT(run_kith({"validate", name}).out, HasSubstr(name));  // what a program reads stays as it is
}

// --- memory -----------------------------------------------------------------------

Ran run_in_memory(const std::vector<std::string>& arguments, std::size_t megabytes) {
  return run_kith(arguments, {.prepare = [megabytes] {
                    const rlimit limit = {megabytes << 20U, megabytes << 20U};
                    setrlimit(RLIMIT_AS, &limit);
                  }});
}

TEST(Memory, ThatIsNotThereIsAnErrorOfItsOwn) {
  std::size_t enough = 8;  // to start
  while (run_in_memory({"version"}, enough).code != 0 && enough < 4096) enough += 2;
  for (const auto& command :
       std::vector<std::vector<std::string>>{{"inspect", "item-delivery"}, {"inspect", "item-delivery", "--json"}}) {
    std::size_t refused = 0;
    for (auto megabytes = enough; megabytes < enough + 400; megabytes += 6) {
      const auto ran = run_in_memory(command, megabytes);
      if (ran.code == 0) break;
      ++refused;
      // Either it is known before the work begins, or memory runs out in the middle of it.
      const bool known_before = ran.code == 4;
      EXPECT_TRUE(known_before || ran.code == 5) << megabytes << ran.err;
      EXPECT_THAT(ran.err, Not(HasSubstr("bug")));
      if (command.back() == "--json") {
        EXPECT_EQ(Json::parse(ran.out).at("errors").at(0).at("id"), known_before ? "E1201" : "memory");
      } else if (known_before) {
        EXPECT_THAT(ran.err, HasSubstr("E1201"));
      } else {
        EXPECT_THAT(ran.err, AllOf(HasSubstr("out of memory"), HasSubstr("-j")));
      }
    }
    EXPECT_GT(refused, 0u);
  }
}

// --- files ------------------------------------------------------------------------

TEST(Files, WithNamesThatTheSystemRefusesAreNoInternalError) {
  const std::string long_name(5000, 'a');
  for (const auto& command : std::vector<std::vector<std::string>>{{"inspect", long_name},
                                                                   {"study", long_name, "-o", "/tmp/x"},
                                                                   {"power", long_name},
                                                                   {"validate", long_name}}) {
    const auto ran = run_kith(command);
    EXPECT_THAT(ran.code, ::testing::AnyOf(3, 5)) << command.front();
    EXPECT_THAT(ran.err, Not(HasSubstr("internal error"))) << command.front();
  }
}

TEST(Files, ThatAStudyNamesAsItsDomainAreNotShown) {
  const Scratch scratch;
  write_text(scratch / "secret", "password of the king: swordfish\n");
  const auto ran = err_of(3, {"study", "quick", "--dry-run", "--set", "domain=\"" + (scratch / "secret") + "\""});
  EXPECT_THAT(ran, AllOf(HasSubstr("E0116"), HasSubstr("ends in .toml"), Not(HasSubstr("swordfish"))));
}

class RunFolder : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run_kith(tiny_study(run_)).code, 0); }

  [[nodiscard]] std::string teams_file() const { return run_ + "/tables/teams.csv"; }

  Scratch scratch_;
  std::string run_ = scratch_ / "run";
};

TEST_F(RunFolder, WithoutAColumnIsNoInternalError) {
  auto text = text_of(teams_file());
  const auto at = text.find("replicate");
  ASSERT_NE(at, std::string::npos);
  write_text(teams_file(), text.replace(at, 9, "repeat"));
  EXPECT_THAT(err_of(7, {"analyze", run_}), AllOf(HasSubstr("E0607"), HasSubstr("teams.csv")));
}

TEST_F(RunFolder, WithANamedPipeInItKeepsNobodyWaiting) {
  fs::remove(teams_file());
  ASSERT_EQ(mkfifo(teams_file().c_str(), 0600), 0);
  for (const auto& command :
       std::vector<std::vector<std::string>>{{"analyze", run_}, {"analyze", run_, "--model", "knowledge ~ strategy"}}) {
    EXPECT_THAT(err_of(3, command, {.prepare = guard}), AllOf(HasSubstr("teams.csv"), HasSubstr("not a regular file")));
  }
}

TEST_F(RunFolder, GetsItsReportWhereALinkLeadsElsewhere) {
  write_text(scratch_ / "precious", "mine");
  fs::create_symlink(scratch_ / "precious", run_ + "/report.html");
  ASSERT_EQ(run_kith({"report", run_}).code, 0);
  EXPECT_EQ(text_of(scratch_ / "precious"), "mine");
  EXPECT_FALSE(fs::is_symlink(run_ + "/report.html"));
  EXPECT_THAT(text_of(run_ + "/report.html"), HasSubstr("<html"));
  fs::create_symlink("named.html", scratch_ / "link");
  ASSERT_EQ(run_kith({"report", run_, "-o", scratch_ / "link"}).code, 0);
  EXPECT_TRUE(fs::is_symlink(scratch_ / "link"));
  EXPECT_THAT(text_of(scratch_ / "named.html"), HasSubstr("<html"));
}

TEST_F(RunFolder, DoesNotWaitForAReaderOfItsReport) {
  const auto pipe = scratch_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto ran = err_of(5, {"report", run_, "-o", pipe}, {.prepare = guard});
  EXPECT_THAT(ran, HasSubstr("no program reads from this pipe"));
}

TEST(Validate, ReadsAPipe) {
  const Scratch scratch;
  const auto pipe = scratch / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const pid_t writer = fork();
  if (writer == 0) {
    guard();
    std::ofstream{pipe} << text_of(fs::path{KITH_SOURCE_DIR} / "domains" / "item_delivery.toml");
    _exit(0);
  }
  EXPECT_EQ(run_kith({"validate", pipe}, {.prepare = guard}).code, 0);
  EXPECT_EQ(exit_code_of(writer), 0);
}

// --- domains ----------------------------------------------------------------------

TEST(Discount, NextToOneIsRefusedBeforeAStudyBegins) {
  auto text = text_of(fs::path{KITH_SOURCE_DIR} / "domains" / "navigation.toml");
  const auto line = text.find("discount");
  ASSERT_NE(line, std::string::npos);
  const auto end = text.find('\n', line);
  const Scratch scratch;
  const auto study = [&](const std::string& discount) {
    auto changed = text;
    write_text(scratch / "d.toml", changed.replace(line, end - line, "discount = " + discount));
    return run_kith({"study", "quick", "-o", scratch / ("run-" + discount), "--set", "replicates=1", "--set",
                     "domain=\"" + (scratch / "d.toml") + "\""});
  };
  EXPECT_EQ(study("0.999999").code, 0);
  const auto refused = study("0.9999999");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("d.toml:"), HasSubstr("E0110"), HasSubstr("at most 0.999999")));
}

}  // namespace
}  // namespace kith::testing
