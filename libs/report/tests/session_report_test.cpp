// The report of live sessions, from tables as `kith session export` writes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/sha256.hpp"
#include "kith/report/report.hpp"
#include "scratch_folder.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

// Two groups of two; in the second one a simulated learner took the second place. A third was never taught.
std::map<std::string, std::string> tables() {
  const Json about{{"schema", "kith.session-tables/1"},
                   {"study", "robots"},
                   {"title", "Learning about robots"},
                   {"domain", "item-delivery"},
                   {"program", "kith test"},
                   {"strategies", {"joint", "common"}},
                   {"compositions", {"NP"}},
                   {"types", {{{"letter", "N"}, {"label", "novice"}}, {{"letter", "P"}, {"label", ""}}}},
                   {"inputs", {{"study.toml", "schema = 1\n"}, {"domain.toml", "map\n"}}}};
  return {{"study.json", about.dump()},
          {"codebook.json", "{}\n"},
          {"sessions.csv",
           "session,strategy,composition,replicate,size,people,started_ms,stage,ended,completed,periods,knowledge\n"
           "r1,common,NP,1,2,2,1000,ended,,true,3,0.8\n"
           "r2,joint,NP,1,2,2,2000,ended,facilitator,false,2,0.4\n"
           "r3,common,NP,2,2,2,,lobby,,false,0,0.1\n"},
          {"participants.csv",
           "session,seat,member,simulated,tests,right\n"
           "r1,1,1,false,3,2\nr1,2,2,false,3,3\nr2,1,1,false,2,0\nr2,2,2,false,1,1\nr2,3,2,true,1,1\n"},
          {"periods.csv", "session,period,component,n_active\nr1,1,1,2\nr1,2,1,2\nr1,3,2,2\nr2,1,1,2\nr2,2,1,\n"},
          {"tests.csv",
           "session,period,seat,member,correct\nr1,1,1,1,false\nr1,1,2,2,true\nr1,2,1,1,true\nr1,2,2,2,true\n"
           "r1,3,1,1,true\nr1,3,2,2,true\nr2,1,1,1,false\nr2,1,2,2,true\nr2,2,1,1,\nr2,2,3,2,true\n"},
          {"beliefs.csv",
           "session,period,belief,member,p_bec\nr1,1,common,,0.2\nr1,1,member 1,1,0.3\nr1,1,member 2,2,0.5\n"
           "r1,2,member 1,1,0.6\nr1,2,member 2,2,0.9\nr2,1,member 1,1,0.1\nr2,1,member 2,2,0.7\n"}};
}

class SessionReport : public ::testing::Test {
 protected:
  void write(const std::map<std::string, std::string>& files) const {
    fs::create_directories(folder_);
    std::string sums;
    for (const auto& [name, text] : files) {
      write_file_atomically(folder_ / name, text);
      sums += sha256(text) + "  " + name + "\n";
    }
    write_file_atomically(folder_ / "SHA256SUMS", sums);
  }
  [[nodiscard]] Json report() const { return Json::parse(build_report(folder_)); }
  [[nodiscard]] std::string complaint() const {
    try {
      static_cast<void>(build_report(folder_));
      return "none";
    } catch (const Error& error) {
      return error.diagnostics().empty() ? error.what()
                                         : error.diagnostics().front().id + " " + error.diagnostics().front().message;
    }
  }

  testing::ScratchFolder scratch_;
  fs::path folder_ = scratch_ / "tables";
};

TEST_F(SessionReport, SaysWhatIsKnownOfPeople) {
  write(tables());
  const auto document = report();
  EXPECT_EQ(document["schema"], "kith.report/1");
  EXPECT_EQ(document["title"], "Learning about robots");
  EXPECT_EQ(document["overview"]["teams"], 2);
  EXPECT_EQ(document["overview"]["people"], 4);
  EXPECT_EQ(document["overview"]["completed"], 1);
  EXPECT_EQ(document["overview"]["strategies"], (Json{"joint", "common"})) << "as in the study";
  EXPECT_THAT(document["overview"]["summary"].get<std::vector<std::string>>(),
              ElementsAre("2 groups with 4 people in all were taught how a robot decides, in live sessions.",
                          "67 % of 9 answers were right."));
  EXPECT_EQ(document["overview"]["simulated"], false);
  EXPECT_THAT(document["overview"]["limits"].dump(), HasSubstr("What people believe is not observed."));
  EXPECT_THAT(document["overview"]["limits"].dump(), HasSubstr("1 of 2 teams passed"));
  EXPECT_EQ(document["labels"]["types"], (Json{{"N", "novice"}, {"P", "P"}}));
  EXPECT_EQ(document["reproduce"]["study_toml"], "schema = 1\n");
  EXPECT_FALSE(document.contains("beliefs")) << "nobody knows what people believed";
}

TEST_F(SessionReport, HasTheTablesOfTheFigures) {
  write(tables());
  const auto shown = report()["tables"];
  EXPECT_EQ(shown["cells"]["columns"].back(), "knowledge_high");
  ASSERT_EQ(shown["cells"]["rows"].size(), 2u);
  EXPECT_EQ(shown["cells"]["rows"][1][0], "common");
  EXPECT_EQ(shown["cells"]["rows"][1][4], 3.0);
  EXPECT_EQ(shown["teams"]["rows"][0], (Json{"joint", "NP", 1, "r2", 2, 0.4, false}));
  const auto knowledge = shown["knowledge_by_period"]["rows"];
  ASSERT_EQ(knowledge.size(), 5u) << knowledge;
  EXPECT_EQ(knowledge[0][3], 0.1) << "joint, novice; the other place had a simulated learner";
  EXPECT_EQ(knowledge[1][0], "common");
  EXPECT_EQ(knowledge[1][3], 0.3);
  EXPECT_EQ(knowledge[4], (Json{"common", "P", 2, 0.9, nullptr, nullptr, 1}));
  const auto right = shown["correct_by_period"]["rows"];
  EXPECT_EQ(right[0][3], 0.0);
  EXPECT_EQ(right[0][6], 1);
  EXPECT_EQ(right.size(), 7u) << right;
  const auto components = shown["periods_by_component"]["rows"];
  ASSERT_EQ(components.size(), 3u);
  EXPECT_EQ(components[0], (Json{"joint", "NP", 1, 1.0, nullptr, nullptr})) << "the last period was not finished";
  EXPECT_EQ(components[1][3], 2.0);
}

TEST_F(SessionReport, NotesWhatLimitsTheConclusions) {
  write(tables());
  const auto notes = report()["notes"].get<std::vector<std::string>>();
  EXPECT_THAT(notes, Contains(HasSubstr("1 room was never taught and is left out.")));
  EXPECT_THAT(notes, Contains(HasSubstr("1 group stopped before everything was learned (facilitator: 1).")));
  EXPECT_THAT(notes, Contains(HasSubstr("Simulated learners had the places of 1 member.")));
}

TEST_F(SessionReport, ComparesGroups) {
  auto files = tables();
  auto& sessions = files["sessions.csv"];
  for (int i = 4; i < 24; ++i) {
    const bool joint = i % 2 == 0;
    sessions += "r" + std::to_string(i) + (joint ? ",joint" : ",common") + ",NP," + std::to_string(i) +
                ",2,2,1000,ended,,true," + std::to_string(joint ? 4 + i % 3 : 9 + i % 4) + ",0." +
                std::to_string(50 + i) + "\n";
  }
  write(files);
  const auto document = report();  // without R, which tests counts
  ASSERT_EQ(document["findings"].size(), 1u) << document["notes"];
  EXPECT_THAT(document["findings"][0]["sentence"].get<std::string>(), HasSubstr("knowledge"));
  EXPECT_THAT(document["notes"].get<std::vector<std::string>>(),
              Contains(AllOf(HasSubstr("periods ~ "), HasSubstr("which needs R"))));
}

TEST_F(SessionReport, OfNoGroupsSaysSo) {
  auto files = tables();
  for (auto& [name, text] : files) {
    if (name.find(".csv") != std::string::npos) text.erase(text.find('\n') + 1);
  }
  write(files);
  const auto document = report();
  EXPECT_EQ(document["overview"]["teams"], 0);
  EXPECT_EQ(document["tables"]["cells"]["rows"], Json::array());
  EXPECT_THAT(document["notes"].get<std::vector<std::string>>(), Contains(HasSubstr("Nothing was tested")));
  EXPECT_THAT(document["methods"]["paragraph"].get<std::string>(), HasSubstr("with kith test."));
}

TEST_F(SessionReport, RefusesTablesThatWereChangedOrLost) {
  write(tables());
  write_file_atomically(folder_ / "tests.csv", "session\n");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("E0607"), HasSubstr("not the one that was exported")));
  fs::remove(folder_ / "tests.csv");
  EXPECT_THAT(complaint(), HasSubstr("E0604"));
  auto files = tables();
  files.erase("beliefs.csv");
  write(files);
  EXPECT_THAT(complaint(), HasSubstr("E0604"));
  files = tables();
  files["study.json"] = "{}";
  write(files);
  EXPECT_THAT(complaint(), HasSubstr("E0605"));
}

TEST_F(SessionReport, AsksForAnExportOfASession) {
  fs::create_directories(folder_);
  write_file_atomically(folder_ / "session.sqlite", "");
  EXPECT_THAT(complaint(), AllOf(HasSubstr("E0602"), HasSubstr("live sessions")));
}

}  // namespace
}  // namespace kith
