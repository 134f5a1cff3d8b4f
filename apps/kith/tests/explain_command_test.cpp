#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

// Whether a cell is on the map of a document.
void expect_on_map(const Json& document, const Json& cell) {
  EXPECT_GE(cell.at(0), 1);
  EXPECT_LE(cell.at(0), document["domain"]["width"]);
  EXPECT_GE(cell.at(1), 1);
  EXPECT_LE(cell.at(1), document["domain"]["height"]);
}

void expect_board(const Json& document, const Json& board, const Json& frames) {
  ASSERT_EQ(board.at("map").size(), document["domain"]["height"]);
  for (const auto& row : board["map"]) EXPECT_EQ(row.get<std::string>().size(), document["domain"]["width"]);
  ASSERT_GE(frames.size(), 2u);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    expect_on_map(document, frames[i].at("robot"));
    EXPECT_EQ(frames[i].at("action").is_null(), i + 1 == frames.size());
    for (const auto& item : frames[i].at("items")) {
      expect_on_map(document, item.at("cell"));
      if (item.at("carried")) {
        EXPECT_EQ(item["cell"], frames[i]["robot"]);
      }
    }
    for (const auto& station : frames[i].at("stations")) expect_on_map(document, station);
  }
}

TEST(CurriculumCommand, PrintsBoardsReasonsAndTestsAsJson) {
  const auto ran = run_kith({"curriculum", "item-delivery", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document.at("schema"), "kith.curriculum/1");
  EXPECT_EQ(document["domain"]["features"][0],
            (Json{{"name", "rubble"}, {"words", "crossing rubble"}, {"weight", -3.0}}));
  ASSERT_FALSE(document.at("components").empty());
  for (const auto& component : document["components"]) {
    for (const auto& shown : component.at("demonstrations")) {
      expect_board(document, shown, shown.at("frames"));
      const auto& decisive = shown.at("decisive");
      const std::size_t frame = decisive.at("frame");
      EXPECT_EQ(decisive.at("cell"), shown["frames"][frame]["robot"]);
      const auto& other = shown.at("alternative").at("frames");
      EXPECT_NE(other[frame]["action"], shown["frames"][frame]["action"]);
      EXPECT_EQ(other[frame]["robot"], shown["frames"][frame]["robot"]);
      EXPECT_FALSE(shown.at("conveys").empty());
      if (shown.at("flip").is_null()) continue;
      expect_board(document, shown["flip"], shown["flip"].at("frames"));
      EXPECT_EQ(shown["flip"]["frames"][frame]["action"], other[frame]["action"]);
    }
    for (const auto& test : component.at("tests")) {
      expect_board(document, test, test.at("frames"));
      EXPECT_THAT(test.at("difficulty").get<std::string>(), ::testing::AnyOf("easy", "medium", "hard"));
    }
  }
}

TEST(CurriculumCommand, PrintsTheSameWithTheSameSeed) {
  const auto first = run_kith({"curriculum", "item-delivery", "--seed", "5"});
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr("1. "), HasSubstr("Demonstration 1: world "), HasSubstr("they part at ("),
                               HasSubstr("Test 1: world ")));
  EXPECT_EQ(run_kith({"curriculum", "item-delivery", "--seed", "5"}).out, first.out);
}

TEST(CurriculumCommand, FailsWithFourWhereNothingCanBeTaught) {
  const Scratch scratch;
  std::ofstream{scratch / "road.toml"}
      << "schema = \"kith.domain/1\"\nid = \"road\"\n[map]\nrows = [\"S..G\"]\n[map.legend]\n\".\" = \"floor\"\n"
         "\"S\" = { start = true }\n\"G\" = { goal = true }\n[[feature]]\nname = \"arrival\"\nwhen = \"goal\"\n"
         "[[feature]]\nname = \"move\"\nwhen = \"action:up\"\n[[feature]]\nname = \"step\"\nwhen = \"action\"\n"
         "[reward]\nweights = { arrival = 1, move = -1, step = -1 }\n[prior]\nhalfspaces = [ { step = -1 } ]\n";
  const auto ran = run_kith({"curriculum", scratch / "road.toml"});
  EXPECT_EQ(ran.code, 4);
  EXPECT_THAT(ran.err, HasSubstr("nothing about 'road' can be taught: "));
  const auto json = run_kith({"curriculum", scratch / "road.toml", "--json"});
  EXPECT_EQ(json.code, 4);
  EXPECT_EQ(Json::parse(json.out)["errors"][0]["id"], "E1001");
}

TEST(AskCommand, AnswersInTextAndJson) {
  const auto ran = run_kith({"ask", "item-delivery", "when", "does", "it", "recharge?"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("Stopping at the charger happens in "), HasSubstr("it does not: ")));
  const auto json = run_kith({"ask", "item-delivery", "when does it recharge?", "--json"});
  ASSERT_EQ(json.code, 0) << json.err;
  const auto document = Json::parse(json.out);
  EXPECT_EQ(document.at("schema"), "kith.ask/1");
  EXPECT_EQ(document.at("question"), "when: stopping at the charger");
  for (const auto& example : document.at("examples")) expect_board(document, example, example.at("frames"));
}

TEST(AskCommand, PointsAtWhatItDoesNotUnderstand) {
  const auto ran = run_kith({"ask", "item-delivery", "when does it rechrge?"});
  EXPECT_EQ(ran.code, 3);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("question:1:14: error[E1003]: nobody knows 'rechrge' here"),
                             HasSubstr("did you mean 'recharge'?")));
}

TEST(Inspect, DrawsEveryCellByItsOwnSymbol) {
  EXPECT_THAT(run_kith({"inspect", "two-goals", "--mdp", "0", "--show", "map"}).out, HasSubstr("\n  A....    A....\n"));
  EXPECT_THAT(run_kith({"inspect", "skateboard", "--show", "map"}).out, HasSubstr("\n  ppppqq    ppppqq\n"));
}

TEST(Init, WritesWhatRunsAsItIs) {
  for (const std::string name : {"item-delivery", "blank", "human-study"}) {
    SCOPED_TRACE(name);
    const Scratch scratch;
    const auto folder = scratch / "new";
    const auto ran = run_kith({"init", folder, "--template", name});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("wrote domain.toml, study.toml, README.md"));
    EXPECT_EQ(std::filesystem::exists(folder + "/consent.md"), name == "human-study");
    const auto domain = folder + "/domain.toml";
    const auto study = folder + "/study.toml";
    const auto valid = run_kith({"validate", "--strict", domain, study});
    EXPECT_EQ(valid.code, 0) << valid.err;
    EXPECT_EQ(run_kith({"curriculum", domain}).code, 0);
    const auto taught = run_kith({"study", study, "-o", scratch / "results", "--set", "replicates=1", "--quiet"});
    EXPECT_EQ(taught.code, 0) << taught.err;
    EXPECT_TRUE(std::filesystem::exists(scratch / "results/tables/teams.csv"));
  }
}

TEST(Init, NeverReplacesAFile) {
  const Scratch scratch;
  std::ofstream{scratch / "README.md"} << "mine";
  const auto ran = run_kith({"init", scratch / ""});
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("README.md exists already"));
  EXPECT_EQ(text_of(scratch / "README.md"), "mine");
  EXPECT_FALSE(std::filesystem::exists(scratch / "domain.toml"));
  EXPECT_EQ(run_kith({"init", scratch / "README.md/below"}).code, 5);
  EXPECT_EQ(run_kith({"init", scratch / "x", "--template", "blnk"}).code, 2);
  const auto json = run_kith({"init", scratch / "y", "--json"});
  EXPECT_EQ(Json::parse(json.out).at("files"), (Json{"domain.toml", "study.toml", "README.md"}));
}

}  // namespace
}  // namespace kith::testing
