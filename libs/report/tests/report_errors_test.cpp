// Every way in which a folder can fail to be a finished run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "kith/core/error.hpp"
#include "kith/report/report.hpp"
#include "resealed.hpp"
#include "runs.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace kith::testing;

// The first complaint: "ID FILE:LINE MESSAGE", and the kind.
struct Complaint {
  std::string text;
  std::optional<ErrorKind> kind;
};
Complaint complaint_about(const fs::path& folder) {
  try {
    static_cast<void>(build_report(folder));
  } catch (const Error& error) {
    if (error.diagnostics().empty()) return {error.what(), error.kind()};
    const auto& first = error.diagnostics().front();
    return {first.id + " " + fs::path{first.file}.filename().string() + ":" + std::to_string(first.line) + " " +
                first.message,
            error.kind()};
  }
  return {"no complaint", std::nullopt};
}

class ReportErrors : public ::testing::Test {
 protected:
  ReportErrors() { publish(run_, tiny_study(), invented_teams()); }
  void expect(const std::string& start, const std::string& part, ErrorKind kind = ErrorKind::kInvalidInput) const {
    const auto complaint = complaint_about(run_);
    EXPECT_THAT(complaint.text, AllOf(::testing::StartsWith(start), HasSubstr(part)));
    EXPECT_EQ(complaint.kind, kind);
  }
  [[nodiscard]] fs::path table(const std::string& name) const { return run_ / "tables" / name; }

  ScratchFolder scratch_;
  fs::path run_ = scratch_ / "run";
};

TEST_F(ReportErrors, NameAFolderThatIsNotThere) {
  fs::remove_all(run_);
  expect("E0601 run:0", "there is no such folder", ErrorKind::kIo);
  std::ofstream{run_} << "a file";
  expect("E0601 run:0", "this is a file", ErrorKind::kIo);
}

TEST_F(ReportErrors, NameAFolderThatIsNoRun) {
  fs::remove_all(run_);
  fs::create_directories(run_);
  expect("E0602 run:0", "the folder is empty");
  std::ofstream{run_ / "notes.txt"} << "text";
  expect("E0602 run:0", "not a run folder");
}

TEST_F(ReportErrors, NameARunThatHasNotFinished) {
  fs::remove(run_ / "manifest.json");
  expect("E0603 run:0", "it has no manifest.json");
  fs::remove_all(run_);
  fs::create_directories(run_ / ".kith-staging-17");
  expect("E0603 run:0", "the study has not finished");
}

TEST_F(ReportErrors, NameARunThatStoppedEarly) {
  edit(run_ / "manifest.json", "\"finished\"", "\"interrupted\"");
  testing::reseal(run_);
  expect("E0603 manifest.json:0", "did not finish");
}

TEST_F(ReportErrors, NameAMissingTable) {
  fs::remove(table("progress.csv"));
  expect("E0604 progress.csv:0", "the table is missing");
  fs::remove(table("teams.csv"));
  expect("E0604 teams.csv:0", "the table is missing");
}

TEST_F(ReportErrors, NameADamagedManifest) {
  std::ofstream{run_ / "manifest.json"} << "{";
  expect("E0605 manifest.json:0", "the manifest is damaged", ErrorKind::kMismatch);
  fs::remove(run_ / "manifest.json");
  testing::reseal(run_);
  edit(run_ / "manifest.json", "\"finished\"", "\"fini5hed\"");
  expect("E0605 manifest.json:0", "the manifest is damaged", ErrorKind::kMismatch);
}

TEST_F(ReportErrors, NameAFileThatIsNotTheOneThatTheRunWrote) {
  const auto sound = read_file(table("teams.csv"));
  edit(table("teams.csv"), ",true,4,", ",true,5,");
  expect("E0607 teams.csv:0", "its hash is not that in manifest.json", ErrorKind::kMismatch);
  std::ofstream{table("teams.csv")} << sound;
  edit(run_ / "inputs/study.toml", "replicates = 2", "replicates = 3");
  expect("E0607 study.toml:0", "its hash is not that in manifest.json", ErrorKind::kMismatch);
}

TEST_F(ReportErrors, NameTeamsThatAreMissingOrTwice) {
  const auto text = read_file(table("teams.csv"));
  const auto last = text.rfind('\n', text.size() - 2) + 1;
  std::ofstream{table("teams.csv")} << text.substr(0, last);
  testing::reseal(run_);
  expect("E0606 teams.csv:0", "the table has 3 teams, the study 4");
  std::ofstream{table("teams.csv")} << text + text.substr(last);
  testing::reseal(run_);
  expect("E0606 teams.csv:6", "team 4 occurs twice");
}

TEST_F(ReportErrors, NameRowsOfATeamThatAreNotTogether) {
  const auto text = read_file(table("responses.csv"));
  const auto begin = text.find('\n') + 1;
  const auto row = text.substr(begin, text.find('\n', begin) + 1 - begin);
  std::ofstream{table("responses.csv")} << text + row;
  testing::reseal(run_);
  expect("E0622 responses.csv:7", "rows of team 3 are not adjacent");
}

// With a manifest that agrees with the file again.
TEST_F(ReportErrors, NameTheRowOfWhatCannotBe) {
  const std::vector<std::array<std::string, 5>> cases{
      {"tables/periods.csv", "\ncommon,NP,1,3,", "\ncommon,NP,1,33,", "E0620 periods.csv:5", "there is no team 33"},
      {"tables/periods.csv", "\ncommon,NP,1,3,", "\ncommon,NN,1,3,", "E0620 periods.csv:5",
       "contradicts what inputs/study.toml says of team 3"},
      {"tables/periods.csv", "common,NP,1,3,1,1,", "common,NP,1,3,1,9,", "E0621 periods.csv:5", "9 is not from 1 to 3"},
      {"tables/periods.csv", "area_sr", "area", "E0502 periods.csv:1", "column \"area_sr\" is missing"},
      {"tables/progress.csv", ",0.2,", ",1.2,", "E0621 progress.csv:3", "from 0 to 1"},
      {"tables/teams.csv", ",true,4,", ",true,four,", "E0506 teams.csv:4", "\"four\" in column \"periods\""},
      {"inputs/study.toml", "replicates = 2", "replicates = 0", "E0110 study.toml:", "replicates"}};
  for (const auto& [file, from, to, start, part] : cases) {
    SCOPED_TRACE(file + ": " + to);
    const auto sound = read_file(run_ / file);
    edit(run_ / file, from, to);
    testing::reseal(run_);
    expect(start, part);
    std::ofstream{run_ / file} << sound;
  }
}

}  // namespace
}  // namespace kith
