// What kith bench prints, saves and compares; never how long anything takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Json = nlohmann::json;

const std::vector<std::string> kQuick{"bench", "--quick", "--filter", "minimal|solid"};

std::vector<std::string> quick_with(const std::vector<std::string>& more) {
  auto arguments = kQuick;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

// A baseline in which every case took so many seconds, always.
std::string baseline_of(double seconds) {
  auto document = Json::parse(run_kith(quick_with({"--json"})).out);
  for (auto& one : document.at("cases")) {
    for (const auto* key : {"median", "low", "high"}) one.at(key) = seconds;
  }
  return document.dump(2);
}

TEST(Bench, PrintsOneDocumentOfWhatTheFilterSelects) {
  const auto ran = run_kith(quick_with({"--json"}));
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document.at("schema"), "kith.bench/1");
  for (const auto* key : {"version", "git", "dirty", "compiler", "build_type", "flags", "processor", "cores", "threads",
                          "quick", "waited", "peak_memory_mib", "tolerance"}) {
    EXPECT_TRUE(document.contains(key)) << key;
  }
  EXPECT_TRUE(document.at("load").at("before").is_number());
  EXPECT_TRUE(document.at("load").at("after").is_number());
  EXPECT_TRUE(document.at("slower").empty());
  ASSERT_EQ(document.at("cases").size(), 3u);
  EXPECT_EQ(document["cases"][0].at("name"), "geometry.minimal-5");
  for (const auto& one : document["cases"]) {
    EXPECT_EQ(one.at("unit"), "s");
    EXPECT_EQ(one.at("clock"), "cpu");
    EXPECT_GT(one.at("low"), 0.0);
    EXPECT_LE(one.at("low"), one.at("median"));
    EXPECT_LE(one.at("median"), one.at("high"));
    EXPECT_GE(one.at("samples"), 3);
    EXPECT_GT(one.at("rival").at("ratio"), 0.0);
    EXPECT_EQ(one["rival"].at("agrees"), true);
    EXPECT_TRUE(one.at("baseline").is_null());
  }
}

TEST(Bench, PrintsATableForPeople) {
  const auto ran = run_kith(kQuick);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("cores"), HasSubstr("load"), HasSubstr("\ncase "), HasSubstr("ratio"),
                             HasSubstr("\ngeometry.minimal-20 ")));
}

TEST(Bench, ListsWhatItTimesAndTheRivals) {
  const auto ran = run_kith({"bench", "--list"});
  ASSERT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, AllOf(HasSubstr("value iteration for each person in each MDP"), HasSubstr("belief.step"),
                             HasSubstr("study.all-threads"), HasSubstr("growth.features")));
  const auto document = Json::parse(run_kith({"bench", "--list", "--json"}).out);
  EXPECT_EQ(document.at("schema"), "kith.bench-list/1");
  EXPECT_GE(document.at("cases").size(), 15u);
}

TEST(Bench, ShowsHowCostGrows) {
  const auto arguments = std::vector<std::string>{"bench", "--quick", "--growth", "--filter", "constraints"};
  EXPECT_THAT(run_kith(arguments).out, HasSubstr("grows like constraints^"));
  auto with_json = arguments;
  with_json.emplace_back("--json");
  const auto document = Json::parse(run_kith(with_json).out);
  EXPECT_TRUE(document.at("cases").empty());
  ASSERT_EQ(document.at("growth").size(), 1u);
  EXPECT_TRUE(document["growth"][0].at("exponent").is_number());
  ASSERT_GE(document["growth"][0].at("points").size(), 3u);
  EXPECT_EQ(document["growth"][0]["points"][0].at("size"), 1.0);
  EXPECT_GT(document["growth"][0]["points"][0].at("median"), 0.0);
}

TEST(Bench, RefusesAFilterThatSelectsNothing) {
  const auto nothing = run_kith({"bench", "--quick", "--filter", "nosuch"});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err, AllOf(HasSubstr("selects nothing"), HasSubstr("belief.step")));
  const auto no_pattern = run_kith({"bench", "--quick", "--filter", "(.*)*"});  // nothing but letters and a '*'
  EXPECT_EQ(no_pattern.code, 2);
  EXPECT_THAT(no_pattern.err, HasSubstr("'(.*)*' selects nothing"));
  const auto endless = run_kith({"bench", "--quick", "--filter", std::string(60'000, '(')});
  EXPECT_EQ(endless.code, 2);
  EXPECT_THAT(endless.err, AllOf(HasSubstr("--filter has 60000 characters; at most 1000"), Not(HasSubstr("((("))));
  EXPECT_EQ(run_kith({"bench", "--growth", "--save", "x"}).code, 2);
}

TEST(Bench, FindsNamesByTheirParts) {
  const auto named = [](const std::string& filter) {
    std::vector<std::string> names;
    const auto ran = run_kith({"bench", "--quick", "--json", "--filter", filter});
    if (ran.code != 0) return names;
    const auto document = Json::parse(ran.out);
    for (const auto& one : document.at("cases")) names.push_back(one.at("name"));
    return names;
  };
  const std::vector<std::string> minimal{"geometry.minimal-20"};
  EXPECT_EQ(named("geo*min*20"), minimal);
  EXPECT_EQ(named("nosuch|minimal-20"), minimal);
  EXPECT_TRUE(named("20*geo").empty());
}

TEST(Bench, SavesAndReplacesOnlyOnDemand) {
  const Scratch scratch;
  const auto file = scratch / "baseline.json";
  ASSERT_EQ(run_kith(quick_with({"--save", file})).code, 0);
  EXPECT_EQ(Json::parse(text_of(file)).at("schema"), "kith.bench/1");
  const auto again = run_kith(quick_with({"--save", file}));
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("--yes replaces it"));
  EXPECT_EQ(run_kith(quick_with({"--save", file, "--yes"})).code, 0);
  EXPECT_EQ(run_kith(quick_with({"--save", scratch / "absent/baseline.json"})).code, 5);
}

TEST(Bench, PassesABaselineThatWasSlower) {
  const auto ran = run_kith(quick_with({"--json", "--baseline", "-"}), {{}, baseline_of(1000.0), ""});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto document = Json::parse(ran.out);
  EXPECT_TRUE(document.at("slower").empty());
  EXPECT_LT(document["cases"][0].at("baseline").at("ratio"), 1.0);
  EXPECT_EQ(document["cases"][0]["baseline"].at("slower"), false);
}

TEST(Bench, FailsABaselineThatWasQuickerWithSeven) {
  const auto baseline = baseline_of(1e-12);
  const auto ran = run_kith(quick_with({"--baseline", "-"}), {{}, baseline, ""});
  EXPECT_EQ(ran.code, 7);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("slower than the baseline by more than 10 %"), HasSubstr("minimal-20")));
  EXPECT_THAT(ran.out, HasSubstr("slower"));
  const auto with_json = run_kith(quick_with({"--json", "--baseline", "-"}), {{}, baseline, ""});
  EXPECT_EQ(with_json.code, 7);
  EXPECT_EQ(Json::parse(with_json.out).at("slower").size(), 3u);
}

// Errors of baselines: the id, the place and the mend, and exit 3.
void expect_refused(const std::string& baseline, const std::string& id, const std::string& place) {
  const auto ran = run_kith(quick_with({"--baseline", "-"}), {{}, baseline, ""});
  EXPECT_EQ(ran.code, 3) << id;
  EXPECT_THAT(ran.err, AllOf(HasSubstr("<stdin>" + place + ": error[" + id + "]"), HasSubstr("help: "))) << id;
  EXPECT_THAT(ran.out, IsEmpty()) << id;
}

TEST(Bench, RefusesABaselineThatIsNotJson) {
  expect_refused("{\n  \"schema\": \"kith.bench/1\",\n  \"cases\": [}\n", "E1001", ":3:13");
  expect_refused("", "E1001", ":1:1");
}

TEST(Bench, RefusesABaselineOfAnotherSchema) {
  expect_refused("{\n  \"schema\": \"kith.bench/2\"\n}\n", "E1002", ":2:3");
  expect_refused("[]\n", "E1002", ":1:1");
}

TEST(Bench, RefusesABaselineWithWrongFigures) {
  const std::string head =
      "{\n\"schema\": \"kith.bench/1\", \"processor\": \"p\", \"build_type\": \"Release\", \"compiler\": \"c\", "
      "\"git\": \"g\",\n";
  expect_refused(head + "\"cases\": {}}\n", "E1003", ":3:1");
  expect_refused(head + "\"cases\": [7]}\n", "E1003", ":3:1");
  expect_refused(head + "\"cases\": [{\"name\": \"a\", \"median\": 1, \"low\": 1, \"high\": 1},\n" +
                     "{\"name\": \"b\",\n\"median\": -1, \"low\": 1, \"high\": 1}]}\n",
                 "E1003", ":5:1");
  expect_refused("{\"schema\": \"kith.bench/1\", \"cases\": []}\n", "E1003", ":1:1");
}

TEST(Bench, RefusesABaselineWithoutAnyOfTheCases) {
  auto document = Json::parse(baseline_of(1.0));
  for (auto& one : document.at("cases")) one.at("name") = "another." + one.at("name").get<std::string>();
  expect_refused(document.dump(), "E1004", "");
}

TEST(Bench, SaysWhereTheBaselineDiffers) {
  auto document = Json::parse(baseline_of(1000.0));
  document.at("processor") = "an abacus";
  EXPECT_THAT(run_kith(quick_with({"--baseline", "-"}), {{}, document.dump(), ""}).err,
              HasSubstr("the baseline has a different processor: an abacus"));
}

TEST(Bench, CannotReadABaselineThatIsNotThere) {
  const Scratch scratch;
  EXPECT_EQ(run_kith(quick_with({"--baseline", scratch / "absent.json"})).code, 5);
}

}  // namespace
}  // namespace kith::testing
