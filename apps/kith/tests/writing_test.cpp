// Commands that write, under all the names that a place can have: nothing that was there is lost when one fails.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>

#include "run_kith.hpp"
#include "small_session.hpp"

namespace kith::testing {
namespace {

namespace fs = std::filesystem;

using Contents = std::map<std::string, std::string>;

// All that is in a folder, files with their bytes, links with where they lead to.
Contents contents_of(const fs::path& folder) {
  Contents contents;
  for (const auto& entry : fs::recursive_directory_iterator{folder}) {
    const auto name = entry.path().lexically_relative(folder).string();
    if (entry.is_symlink()) {
      contents[name] = "-> " + fs::read_symlink(entry.path()).string();
    } else {
      contents[name] = entry.is_directory() ? "folder" : text_of(entry.path());
    }
  }
  return contents;
}

// Whether all that was there is there now, as it was.
void expect_kept(const Contents& before, const Contents& now, const std::string& what) {
  for (const auto& [name, content] : before) {
    const auto found = now.find(name);
    ASSERT_NE(found, now.end()) << what << ": " << name << " is gone";
    EXPECT_TRUE(found->second == content) << what << ": " << name << " is another one";
  }
}

struct Writer {
  std::string name;
  std::vector<std::string> start;  // what stands before the place
  std::vector<std::string> rest;   // and behind it
  bool makes_folder = false;
  std::vector<std::string> replacing{};  // what allows to replace what it wrote before
};

constexpr rlim_t kLittle = 200;  // bytes of a file, after which the disk is full

// A run with one team per cell and a session with one person, made once.
class Writing : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    inputs_ = new Scratch;
    ASSERT_EQ(run_kith({"study", "quick", "-o", run(), "--set", "replicates=1", "-q", "--progress", "none"}).code, 0);
    make_session(session(), 1);
  }
  static void TearDownTestSuite() {
    delete inputs_;
    inputs_ = nullptr;
  }
  static std::string run() { return *inputs_ / "run"; }
  static std::string session() { return *inputs_ / "live"; }

  // Those that take long, because they simulate or wait, are tried in fewer ways by tests of their own.
  static std::vector<Writer> writers() {
    const std::vector<std::string> yes{"--yes"};
    return {
        {"study", {"study", "quick", "-o"}, {"--set", "replicates=1", "-q", "--progress", "none"}, true},
        {"session export", {"session", "export", session(), "-o"}, {}, true, yes},
        {"session salvage", {"session", "salvage", session(), "-o"}, {}, true},
        {"analyze --csv", {"analyze", run(), "--brief", "--csv"}, {}, true},
        {"inspect --svg", {"inspect", "two-goals", "--svg"}, {}, true},
        {"init", {"init"}, {}, true},
        {"analyze --latex", {"analyze", run(), "--brief", "--latex"}, {}},
        {"report", {"report", run(), "-o"}, {}},
        {"lesson", {"lesson", "two-goals", "-o"}, {}},
    };
  }
  static Ran run_with(const Writer& writer, const std::string& place, bool replaces = false, const RunWith& with = {}) {
    auto arguments = writer.start;
    arguments.push_back(place);
    arguments.insert(arguments.end(), writer.rest.begin(), writer.rest.end());
    if (replaces) arguments.insert(arguments.end(), writer.replacing.begin(), writer.replacing.end());
    return run_kith(arguments, with);
  }

 private:
  static inline Scratch* inputs_ = nullptr;
};

// Of a folder: "out", "out/", "out/." and a link to it are one place, for a first and for a second time.
TEST_F(Writing, KnowsAFolderByAllOfItsNames) {
  for (const auto& writer : writers()) {
    if (!writer.makes_folder) continue;
    for (const std::string name : {"out/", "out/.", "link"}) {
      const Scratch scratch;
      if (name == "link") {
        fs::create_directory(scratch / "out");
        fs::create_symlink("out", scratch / "link");
      }
      const auto what = writer.name + " " + name;
      const auto first = run_with(writer, (scratch / "") + name);
      ASSERT_EQ(first.code, 0) << what << first.err;
      const auto made = contents_of(scratch / "out");
      EXPECT_FALSE(made.empty()) << what;
      for (const auto& [file, content] : made) EXPECT_EQ(file.find("partial"), std::string::npos) << what << file;
      const auto again = run_with(writer, (scratch / "") + name, true);
      if (again.code != 0) expect_kept(made, contents_of(scratch / "out"), what);
      EXPECT_EQ(contents_of(scratch / "out").size(), made.size()) << what << again.err;
      EXPECT_EQ(contents_of(scratch / "").count("link"), name == "link" ? 1u : 0u) << what;
      if (!writer.replacing.empty()) {
        EXPECT_EQ(again.code, 0) << what << again.err;
      }
    }
  }
}

// The disk is full, at the first attempt and when something is to be replaced.
TEST_F(Writing, LosesNothingWhereTheDiskIsFull) {
  RunWith full;
  full.prepare = [] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{kLittle, kLittle};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
  for (const auto& writer : writers()) {
    const Scratch scratch;
    const auto fresh = run_with(writer, scratch / "out", false, full);
    EXPECT_NE(fresh.code, 0) << writer.name;
    if (!writer.makes_folder) {
      EXPECT_TRUE(contents_of(scratch / "").empty()) << writer.name;
    }
    fs::remove_all(scratch / "out");
    ASSERT_EQ(run_with(writer, scratch / "out").code, 0) << writer.name;
    if (writer.makes_folder) std::ofstream{scratch / "out/notes.txt"} << "mine";
    const auto before = contents_of(scratch / "");
    const auto again = run_with(writer, scratch / "out", true, full);
    expect_kept(before, contents_of(scratch / ""), writer.name + again.err);
  }
}

// Something else is there: files of somebody, a folder where a file is to be and a file where a folder is to be, a link
// that leads nowhere. And a place where nobody can write.
TEST_F(Writing, LosesNothingThatIsSomebodyElses) {
  for (const auto& writer : writers()) {
    const Scratch scratch;
    fs::create_directories(scratch / "folder");
    for (const auto* file : {"folder/thesis.tex", "folder/study.toml", "folder/teams.csv", "file"}) {
      std::ofstream{scratch / file} << "years of work";
    }
    fs::create_symlink("nowhere/at/all", scratch / "dangling");
    const auto before = contents_of(scratch / "");
    const std::string wrong = writer.makes_folder ? "file" : "folder";
    const std::vector<std::string> places{wrong,       wrong + "/", wrong + "/.", "dangling",      "dangling/",
                                          "no/such/x", "file/x",    "file/x/",    "/proc/no-such", "/proc/no-such/x"};
    for (const auto& place : places) {
      const bool is_far = place.front() == '/';
      const auto ran = run_with(writer, is_far ? place : (scratch / "") + place, true);
      const auto what = writer.name + " " + place + " " + std::to_string(ran.code) + " " + ran.err;
      if (place == "no/such/x" && writer.makes_folder) {
        fs::remove_all(scratch / "no");
      } else {
        EXPECT_NE(ran.code, 0) << what;
        EXPECT_NE(ran.code, 1) << what;
      }
      EXPECT_EQ(contents_of(scratch / ""), before) << what;
    }
    if (!writer.makes_folder) continue;
    // A folder of somebody: their files stay, whether the command takes the folder or not.
    const auto ran = run_with(writer, scratch / "folder", true);
    expect_kept(before, contents_of(scratch / ""), writer.name + " folder " + ran.err);
  }
}

TEST_F(Writing, ReplacesNothingButAnExport) {
  const Scratch scratch;
  const std::vector<std::string> again{"session", "export", session(), "-o", scratch / "out/", "--yes"};
  ASSERT_EQ(run_kith({"session", "export", session(), "-o", scratch / "out"}).code, 0);
  const auto made = contents_of(scratch / "out");
  std::ofstream{scratch / "out/report.html"} << "a report";
  fs::remove(scratch / "out/events.csv");
  std::ofstream{scratch / "out/tests.csv"} << "damaged";
  EXPECT_EQ(run_kith(again).code, 0);
  auto now = contents_of(scratch / "out");
  EXPECT_EQ(now["report.html"], "a report");
  now.erase("report.html");
  EXPECT_EQ(now, made);
  fs::remove(scratch / "out/SHA256SUMS");
  EXPECT_THAT(err_of(2, again), ::testing::HasSubstr("no export of a session"));
}

}  // namespace
}  // namespace kith::testing
