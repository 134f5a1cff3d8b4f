#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "domain_texts.hpp"
#include "run_kith.hpp"

namespace kith::testing {
namespace {

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
  const auto document = json_of({"lesson", "item-delivery"});
  EXPECT_EQ(document.at("schema"), "kith.curriculum/1");
  EXPECT_EQ(document["domain"]["features"][0], (Json{{"name", "rubble"},
                                                     {"words", "crossing rubble"},
                                                     {"many", "crossing rubble {n} times"},
                                                     {"do", "cross rubble"},
                                                     {"do_many", "cross rubble {n} times"},
                                                     {"weight", -3.0}}));
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
    }
    for (const auto& test : component.at("tests")) {
      expect_board(document, test, test.at("frames"));
      EXPECT_THAT(test.at("difficulty").get<std::string>(), ::testing::AnyOf("easy", "medium", "hard"));
    }
  }
}

TEST(CurriculumCommand, PrintsTheSameWithTheSameSeed) {
  const auto first = run_kith({"lesson", "item-delivery", "--seed", "5"});
  const auto before = run_kith({"curriculum", "item-delivery", "--seed", "5"});  // its name in earlier versions
  EXPECT_EQ(before.out, first.out);
  EXPECT_THAT(before.err, HasSubstr("is called 'kith lesson' now"));
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr("1. "), HasSubstr("Demonstration 1: world "),
                               HasSubstr("they differ from step "), HasSubstr("Test 1: world ")));
  EXPECT_EQ(run_kith({"lesson", "item-delivery", "--seed", "5"}).out, first.out);
}

// A robot that has one way to go.
std::string write_road(const Scratch& scratch) {
  const std::string file = scratch / "road.toml";
  std::ofstream{file}
      << "schema = \"kith.domain/1\"\nid = \"road\"\n[map]\nrows = [\"S..G\"]\n[map.legend]\n\".\" = \"floor\"\n"
         "\"S\" = { start = true }\n\"G\" = { goal = true }\n[[feature]]\nname = \"arrival\"\nwhen = \"goal\"\n"
         "[[feature]]\nname = \"move\"\nwhen = \"action:up\"\n[[feature]]\nname = \"step\"\nwhen = \"action\"\n"
         "[reward]\nweights = { arrival = 1, move = -1, step = -1 }\n[prior]\nhalfspaces = [ { step = -1 } ]\n";
  return file;
}

TEST(CurriculumCommand, FailsWithFourWhereNothingCanBeTaught) {
  const Scratch scratch;
  write_road(scratch);
  EXPECT_THAT(err_of(4, {"lesson", scratch / "road.toml"}), HasSubstr("nothing about 'road' can be taught: "));
  const auto json = run_kith({"lesson", scratch / "road.toml", "--json"});
  EXPECT_EQ(json.code, 4);
  EXPECT_EQ(Json::parse(json.out)["errors"][0]["id"], "E1101");
}

TEST(TeachCommand, FailsWithFourWhereNothingCanBeTaught) {
  const Scratch scratch;
  const auto ran = err_of(4, {"teach", write_road(scratch), "--group", "NP"});
  EXPECT_THAT(ran, HasSubstr("nothing about 'road' can be taught: "));
}

TEST(StudyCommand, FailsWithFourAndLeavesNothingWhereNothingCanBeTaught) {
  const Scratch scratch;
  const auto ran =
      err_of(4, {"study", "paper", "--set", "domain=\"" + write_road(scratch) + "\"", "-o", scratch / "run"});
  EXPECT_THAT(ran, HasSubstr("nothing about 'road' can be taught: "));
  EXPECT_FALSE(std::filesystem::exists(scratch / "run"));
}

// Whoever misses its only facet expects the robot to go to and fro for ever.
TEST(WhatCanBeShown, IsTheSameForCurriculumTeachAndStudy) {
  const Scratch scratch;
  std::ofstream{scratch / "open.toml"} << kToAndFro;
  EXPECT_THAT(out_of({"lesson", scratch / "open.toml"}), HasSubstr("right and step twice together cost something"));
  const auto taught = out_of({"teach", scratch / "open.toml", "--group", "NP", "--strategy", "common"});
  EXPECT_THAT(taught, HasSubstr("1 of 1 knowledge components learned"));
  expect_code(0, {"study", "quick", "--set", "domain=\"" + scratch / "open.toml" + "\"", "-o", scratch / "run"});
  EXPECT_EQ(tables_in(scratch / "run").at("teams.csv").find(",skipped,"), std::string::npos);
}

TEST(CurriculumCommand, WritesAPageThatHoldsTheDocument) {
  const Scratch scratch;
  const auto ran = run_kith({"lesson", "item-delivery", "-o", scratch / "lesson.html"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("lesson.html"));
  const auto page = text_of(scratch / "lesson.html");
  EXPECT_THAT(page, AllOf(HasSubstr("<title>What will the robot do?</title>"),
                          HasSubstr("\"schema\":\"kith.curriculum/1\""), HasSubstr("default-src 'none'")));
  EXPECT_EQ(page.find("/*KITH_"), std::string::npos);
  EXPECT_EQ(run_kith({"lesson", "item-delivery", "-o", "-"}).out, page);
  EXPECT_EQ(run_kith({"lesson", "item-delivery", "-o", "-", "--json"}).code, 2);
}

TEST(FindCommand, ListsWhatCanBeIsolated) {
  EXPECT_THAT(out_of({"find", "item-delivery"}), HasSubstr("(-1,0,2): crossing rubble costs more than 2 steps"));
  const auto document = json_of({"find", "item-delivery"});
  EXPECT_EQ(document.at("schema"), "kith.find/1");
  EXPECT_FALSE(document.at("constraints").empty());
}

TEST(FindCommand, FindsAStartByNormalOrSentence) {
  const auto by_normal = out_of({"find", "item-delivery", "(-1,0,2)"});
  EXPECT_THAT(by_normal, HasSubstr("teaches exactly this: (-1,0,2)"));
  EXPECT_EQ(run_kith({"find", "item-delivery", "crossing rubble costs more than 2 steps"}).out, by_normal);
  const auto document = json_of({"find", "item-delivery", "(-1,0,2)", "--test"});
  EXPECT_EQ(document.at("purpose"), "test");
  expect_board(document, document.at("found"), document["found"].at("frames"));
}

TEST(FindCommand, SaysThatNoWorldDoesItAndWritesOneThatDoes) {
  const Scratch scratch;
  const auto none = err_of(4, {"find", "item-delivery", "(1,1,0)"});
  EXPECT_THAT(none, HasSubstr("no start state of 'item-delivery' teaches exactly (1,1,0)"));
  EXPECT_EQ(json_of({"find", "item-delivery", "(1,1,0)"}, 4)["errors"][0]["id"], "E1111");
  ASSERT_EQ(run_kith({"find", "item-delivery", "(-1,0,2)", "-o", scratch / "world.toml"}).code, 0);
  EXPECT_THAT(out_of({"find", scratch / "world.toml", "(-1,0,2)"}), HasSubstr("World 0, start "));
  EXPECT_EQ(run_kith({"validate", scratch / "world.toml"}).code, 0);
}

TEST(FindCommand, WorksWhereNobodyKnowsWhatPeopleExpect) {
  EXPECT_THAT(out_of({"find", "rescue-floor", "(0,0,-1,0,-1)"}),
              AllOf(HasSubstr("teaches exactly this: (0,0,-1,0,-1): a stair and a step together cost something\n"),
                    HasSubstr(": a stair and a step\ntogether cost something\n  #")));
  const auto document = json_of({"find", "navigation", "(0,-1,0,0,0,0,-2)", "--test"});
  EXPECT_THAT(document.at("found").at("reason").get<std::string>(),
              HasSubstr(": crossing grass and 2 steps together cost "));
  expect_board(document, document["found"], document["found"].at("frames"));
}

TEST(FindCommand, GivesExpectationsWhereThereAreAny) {
  const auto cliff = std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml";
  EXPECT_THAT(out_of({"find", cliff, "(0,-1)"}), HasSubstr("teaches exactly this: (0,-1): a step costs something\n"));
  const auto found = json_of({"find", cliff, "(0,-1)"}).at("found");
  EXPECT_THAT(found.at("reason").get<std::string>(), ::testing::EndsWith(": a step costs something"));
  EXPECT_TRUE(found.at("frames").at(0).contains("robot")) << "its table is drawn";
}

TEST(FindCommand, SaysWhatCannotBeDoneWithoutAMap) {
  const auto icy = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml";
  const auto constraints = json_of({"find", icy}).at("constraints");
  ASSERT_FALSE(constraints.empty());
  std::string normal;
  for (const auto& entry : constraints[0].at("normal")) normal += entry.dump() + " ";
  const auto none = err_of(4, {"find", icy, normal});
  EXPECT_THAT(none, AllOf(HasSubstr("error[E1111]: no start state of 'icy-crossing' teaches exactly "),
                          HasSubstr("`kith find DOMAIN` lists what can be isolated")));
  const Scratch scratch;
  const auto cliff = std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml";
  const auto written = run_kith({"find", cliff, "(0,-1)", "-o", scratch / "one.toml"});
  EXPECT_EQ(written.code, 4);
  EXPECT_THAT(written.err, AllOf(HasSubstr("world 0 of 'cliff' cannot be written"),
                                 HasSubstr("help: it has no map: copy its tables")));
  const auto json = run_kith({"find", cliff, "(0,-1)", "-o", scratch / "one.toml", "--json"});
  EXPECT_EQ(Json::parse(json.out)["errors"][0]["id"], "E1112");
  EXPECT_FALSE(std::filesystem::exists(scratch / "one.toml"));
}

TEST(Inspect, WritesPictures) {
  const Scratch scratch;
  const auto folder = scratch / "pictures";
  expect_code(0, {"inspect", "item-delivery", "--show", "map", "--svg", folder});
  for (const std::string name : {"map", "policy", "bec", "coverage", "counterfactuals"}) {
    const auto text = text_of(folder + "/" + name + ".svg");
    EXPECT_THAT(text, AllOf(HasSubstr("<svg xmlns=\"http://www.w3.org/2000/svg\""), HasSubstr("<title>"),
                            ::testing::EndsWith("</svg>\n")))
        << name;
    EXPECT_EQ(text.find("nan"), std::string::npos) << name;
  }
  EXPECT_THAT(text_of(folder + "/bec.svg"), HasSubstr("crossing rubble costs more than 2 steps"));
  EXPECT_EQ(run_kith({"inspect", "item-delivery", "--svg", folder + "/map.svg/below"}).code, 5);
}

TEST(AskCommand, AnswersInTextAndJson) {
  const auto ran = out_of({"ask", "item-delivery", "when", "does", "it", "recharge?"});
  EXPECT_THAT(ran, AllOf(HasSubstr("Stopping at the charger happens in "), HasSubstr("it does not: ")));
  const auto document = json_of({"ask", "item-delivery", "when does it recharge?"});
  EXPECT_EQ(document.at("schema"), "kith.ask/1");
  EXPECT_EQ(document.at("question"), "When does it stop at the charger?");
  for (const auto& example : document.at("examples")) expect_board(document, example, example.at("frames"));
}

TEST(AskCommand, PointsAtWhatItDoesNotUnderstand) {
  const auto ran = err_of(3, {"ask", "item-delivery", "when does it rechrge?"});
  EXPECT_THAT(ran, AllOf(HasSubstr("question:1:14: error[E1103]: kith does not know the word 'rechrge'"),
                         HasSubstr("did you mean 'recharge'?")));
}

TEST(Init, WritesWhatRunsAsItIs) {
  for (const std::string name : {"item-delivery", "blank", "human-study"}) {
    SCOPED_TRACE(name);
    const Scratch scratch;
    const auto folder = scratch / "new";
    EXPECT_THAT(out_of({"init", folder, "--template", name}), HasSubstr("wrote domain.toml, study.toml, README.md"));
    EXPECT_EQ(std::filesystem::exists(folder + "/consent.md"), name == "human-study");
    const auto domain = folder + "/domain.toml";
    const auto study = folder + "/study.toml";
    // What is left to the author of a consent text is said; nothing else is wrong.
    const auto valid = run_kith({"validate", domain, study});
    EXPECT_EQ(valid.code, 0) << valid.err;
    EXPECT_EQ(valid.err.find("W1602") != std::string::npos, name == "human-study") << valid.err;
    EXPECT_EQ(run_kith({"validate", "--strict", domain, study}).code, name == "human-study" ? 3 : 0);
    EXPECT_EQ(run_kith({"lesson", domain}).code, 0);
    expect_code(0, {"study", study, "-o", scratch / "results", "--set", "replicates=1", "--quiet"});
    EXPECT_TRUE(std::filesystem::exists(scratch / "results/tables/teams.csv"));
  }
}

TEST(Init, SaysWhatWorks) {
  const Scratch scratch;
  ASSERT_EQ(run_kith({"init", scratch / "blank", "--template", "blank"}).code, 0);
  EXPECT_THAT(text_of(scratch / "blank/domain.toml"), HasSubstr("2 to 8 of them can be taught"));
  EXPECT_THAT(text_of(scratch / "blank/README.md"), HasSubstr("2 to 8 features can be taught"));
  ASSERT_EQ(run_kith({"init", scratch / "people", "--template", "human-study"}).code, 0);
  EXPECT_THAT(text_of(scratch / "people/study.toml"), HasSubstr("simulated results do not depend on it"));
  EXPECT_THAT(text_of(scratch / "people/README.md"), HasSubstr("says how groups of people are taught"));
}

// Every row of a registry is listed with its parameters, and in the help of commands that take keys.
TEST(ExplainCommand, ListsKindsWithTheirParameters) {
  const auto learners = run_kith({"explain", "learners"});
  EXPECT_EQ(learners.code, 0) << learners.err;
  EXPECT_THAT(learners.out, HasSubstr("    ability_scale\n      a number in (0, 5]; default: 1\n"));
  EXPECT_THAT(learners.out, HasSubstr("    ability.mean\n      a number in [0, 1]; required\n"));
  EXPECT_THAT(learners.out, HasSubstr("[jayaraman2024]"));
  const auto help = run_kith({"help", "study"}).out;
  for (const std::string topic : {"learners", "strategies", "beliefs", "stop-rules", "discussions"}) {
    const auto text = run_kith({"explain", topic}).out;
    const std::regex kind{"\n([a-z-]+)\n    [a-z]"}, parameter{"\n    ([a-z_.]+)\n      [a-z]"};
    EXPECT_TRUE(std::regex_search(text, kind)) << topic;
    for (std::sregex_iterator it{text.begin(), text.end(), kind}, end; it != end; ++it)
      EXPECT_THAT(help, HasSubstr("\n    " + (*it)[1].str()));
    for (std::sregex_iterator it{text.begin(), text.end(), parameter}, end; it != end; ++it)
      EXPECT_THAT(help, HasSubstr((*it)[1].str()));
  }
  EXPECT_THAT(run_kith({"explain", "strategy"}).err, HasSubstr("one of: learners, strategies"));
}

// Texts fit a terminal of 80 columns.
TEST(Texts, FitEightyColumns) {
  std::vector<std::vector<std::string>> commands{{"--help"},
                                                 {"explain", "learners"},
                                                 {"explain", "strategies"},
                                                 {"explain", "beliefs"},
                                                 {"teach", "item-delivery", "--group", "NNP", "--strategy", "joint"},
                                                 {"teach", "skateboard", "--group", "NP"},
                                                 {"lesson", "item-delivery"},
                                                 {"ask", "item-delivery", "when does it recharge?"}};
  for (const std::string name :
       {"init",  "validate", "inspect", "lesson", "ask", "find",   "teach", "study",   "status", "verify",
        "merge", "explain",  "analyze", "report", "fit", "doctor", "power", "session", "serve",  "audit"}) {
    commands.push_back({"help", name});
  }
  for (const auto& command : commands) {
    std::istringstream lines{out_of(command)};
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << command.front() << ": " << line;
  }
}

// Every candidate start is another one, and where everything is can be told.
TEST(InspectJson, TellsStartsApartAndGivesEveryMap) {
  const auto document = json_of({"inspect", "item-delivery", "--show", "demos"});
  std::set<std::string> pictures;
  for (const auto& one : document.at("demos")) {
    auto start = one.at("start");
    EXPECT_TRUE(start.at("start").is_number());
    for (const auto& item : start.at("items")) EXPECT_TRUE(item.at("carried").is_boolean());
    start.erase("start");
    pictures.insert(start.dump());
  }
  EXPECT_EQ(pictures.size(), document.at("demos").size());
  ASSERT_EQ(document.at("maps").size(), document.at("mdps"));
  // Row 1 is on top: the last world's start and the robot's cell in the curriculum agree.
  const auto& map = document.at("maps").at(63);
  const auto& first = document.at("demos").at(0).at("start").at("robot");
  EXPECT_LE(first.at(1), map.size());
  const auto lesson = json_of({"lesson", "item-delivery"});
  const auto& shown = lesson.at("components").at(0).at("demonstrations").at(0);
  const auto& frame = shown.at("frames").at(0);
  bool found = false;
  for (const auto& one : document.at("demos")) {
    const auto& start = one.at("start");
    found = found || (start.at("mdp") == shown.at("world") && start.at("robot") == frame.at("robot") &&
                      start.at("items") == frame.at("items"));
  }
  EXPECT_TRUE(found);
}

TEST(Init, NeverReplacesAFile) {
  const Scratch scratch;
  std::ofstream{scratch / "README.md"} << "mine";
  EXPECT_THAT(err_of(2, {"init", scratch / ""}), HasSubstr("README.md exists already"));
  EXPECT_EQ(text_of(scratch / "README.md"), "mine");
  EXPECT_FALSE(std::filesystem::exists(scratch / "domain.toml"));
  EXPECT_EQ(run_kith({"init", scratch / "README.md/below"}).code, 5);
  EXPECT_EQ(run_kith({"init", scratch / "x", "--template", "blnk"}).code, 2);
}

}  // namespace
}  // namespace kith::testing
