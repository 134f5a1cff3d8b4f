#include <gtest/gtest.h>

#include <cctype>
#include <regex>
#include <tuple>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::vector<std::string> kCommands{"init",  "validate", "inspect", "lesson", "ask",    "find",
                                         "teach", "study",    "serve",   "doctor", "version"};

TEST(CommandLine, HasShortAndFullHelpForEveryCommand) {
  for (const auto& command : kCommands) {
    const auto brief = run_kith({command, "-h"});
    const auto full = run_kith({command, "--help"});
    EXPECT_EQ(brief.code, 0) << command;
    EXPECT_EQ(full.code, 0) << command;
    EXPECT_THAT(brief.out,
                AllOf(StartsWith("usage: kith " + command), HasSubstr("examples:\n"), Not(HasSubstr("KITH_"))))
        << command;
    EXPECT_THAT(full.out, HasSubstr("exit codes:")) << command;
    EXPECT_EQ(run_kith({"help", command}).out, full.out) << command;
  }
  const auto all = run_kith({"--help"});
  for (const auto& command : kCommands) EXPECT_THAT(all.out, HasSubstr("\n  " + command + " "));
}

TEST(CommandLine, SuggestsTheNearestCommandAndOption) {
  const auto command = run_kith({"studdy"});
  EXPECT_EQ(command.code, 2);
  EXPECT_THAT(command.err,
              AllOf(HasSubstr("kith: error: unknown command 'studdy'"), HasSubstr("did you mean 'study'?")));
  const auto option = run_kith({"study", "quick", "--sede", "3"});
  EXPECT_EQ(option.code, 2);
  EXPECT_THAT(option.err, AllOf(HasSubstr("unknown option '--sede'"), HasSubstr("did you mean '--seed'?")));
  const auto with_value = run_kith({"study", "quick", "--thread=3"});
  EXPECT_THAT(with_value.err, AllOf(HasSubstr("unknown option '--thread'"), HasSubstr("'--threads'")));
}

TEST(CommandLine, RefusesWhatItDoesNotUnderstandWithTwo) {
  const std::vector<std::vector<std::string>> wrong{
      {"--nonsense"},
      {"inspect"},
      {"inspect", "item-delivery", "surplus"},
      {"inspect", "item-delivery", "--show", "nothing"},
      {"inspect", "item-delivery", "--mdp", "64"},
      {"teach"},
      {"teach", "item-delivery"},
      {"teach", "item-delivery", "--group", "NX"},
      {"study", "quick"},
      {"completion", "bash"},
      {"explain", "E0207"},
  };
  for (const auto& arguments : wrong) {
    const auto ran = run_kith(arguments);
    EXPECT_EQ(ran.code, 2) << ::testing::PrintToString(arguments) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("error")) << ::testing::PrintToString(arguments);
    EXPECT_THAT(ran.out, IsEmpty()) << ::testing::PrintToString(arguments);
  }
}

TEST(CommandLine, FailsInJsonWithTheSameCode) {
  const Scratch scratch;
  std::ofstream{scratch / "bad.toml"} << "schema = \"kith.study/1\"\n";
  std::ofstream{scratch / "stuck.toml"}
      << "schema = \"kith.domain/1\"\nid = \"stuck\"\n[map]\nrows = [\"S#G\"]\n[map.legend]\n"
         "\"S\" = { start = true }\n\"#\" = \"wall\"\n\"G\" = { goal = true }\n"
         "[[feature]]\nname = \"step\"\nwhen = \"action\"\n[reward]\nweights = { step = -1.0 }\n";
  const std::vector<std::pair<std::vector<std::string>, int>> failures{
      {{"studdy"}, 2},
      {{"study", "quick", "--sede"}, 2},
      {{"validate", scratch / "bad.toml"}, 3},
      {{"study", scratch / "bad.toml", "-o", scratch / "run"}, 3},
      {{"validate", scratch / "stuck.toml"}, 4},
      {{"validate", scratch / "absent.toml"}, 5},
      {{"teach", "--from", scratch / "absent", "--team", "1"}, 5},
  };
  for (const auto& [arguments, code] : failures) {
    auto with_json = arguments;
    with_json.emplace_back("--json");
    EXPECT_EQ(run_kith(arguments).code, code) << ::testing::PrintToString(arguments);
    const auto ran = run_kith(with_json);
    EXPECT_EQ(ran.code, code) << ::testing::PrintToString(arguments);
    const auto document = Json::parse(ran.out);
    EXPECT_EQ(document.at("schema"), "kith.error/1");
    ASSERT_FALSE(document.at("errors").empty());
    for (const auto* key : {"id", "message", "file", "line", "column", "hint"}) {
      EXPECT_TRUE(document["errors"][0].contains(key)) << key;
    }
  }
}

// All of them, as the help lists them.
std::vector<std::string> commands() {
  const auto help = run_kith({"--help"}).out;
  std::vector<std::string> names;
  std::istringstream lines{help.substr(help.find("commands:\n") + 10)};
  for (std::string line; std::getline(lines, line) && line.rfind("  ", 0) == 0;) {
    names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

// A variable in somebody's shell must not answer a question, name a place or change a result.
TEST(CommandLine, TakesNothingButThreadsFromTheEnvironment) {
  RunWith everything;
  for (const auto& command : commands()) {
    auto help = run_kith({command, "--help"}).out;
    for (auto at = help.find("KITH_"); at != std::string::npos; at = help.find("KITH_", at + 1)) {
      EXPECT_EQ(help.substr(at, 12), "KITH_THREADS") << command;
    }
    std::smatch option;
    for (; std::regex_search(help, option, std::regex{"--([a-z-]+)"}); help = option.suffix()) {
      std::string name = "KITH_" + option[1].str();
      for (char& c : name) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      if (name != "KITH_THREADS") everything.environment.emplace_back(name, "true");
    }
  }
  EXPECT_GT(everything.environment.size(), 60u);
  // What they print depends on nothing but their options.
  const std::vector<std::vector<std::string>> fixed{{"inspect", "item-delivery"},
                                                    {"teach", "item-delivery", "--group", "N"},
                                                    {"validate", "no-such-file"},
                                                    {"version"},
                                                    {"session", "redact", "no-such-folder"}};
  for (const auto& arguments : fixed) {
    const auto with = run_kith(arguments, everything);
    const auto without = run_kith(arguments);
    EXPECT_EQ(with.code, without.code) << ::testing::PrintToString(arguments) << with.err;
    EXPECT_EQ(with.out, without.out) << ::testing::PrintToString(arguments);
    EXPECT_EQ(with.err, without.err) << ::testing::PrintToString(arguments);
  }
  const RunWith two{{{"KITH_THREADS", "2"}}, "", ""};
  EXPECT_EQ(run_kith({"study", "quick", "--dry-run"}, two).code, 0);
}

// What counts is the value, however it is written.
TEST(CommandLine, TakesNumbersByTheirValue) {
  const std::vector<std::tuple<std::vector<std::string>, std::vector<std::string>, std::vector<std::string>>> options{
      {{"verify", "no-such-folder", "--sample"}, {"1", "1.0", "1e0", "0.5", "1e-3"}, {"0", "0.0", "1.5", "-1", "x"}},
      {{"audit", "no-such-folder", "--forgetting"}, {"0", "0.0", "0e0", "0.02", "3"}, {"-0.1", "1e9", "x", "nan"}},
      {{"serve", "quick", "--rehearse", "1", "-o", "/dev/null", "--reconnects"}, {"0", "0.0", "1", "1.0"}, {"2", "-1"}},
      {{"serve", "quick", "--rehearse", "1", "-o", "/dev/null", "--for"}, {"0", "0.0", "1.5"}, {"-1", "inf"}},
      {{"serve", "quick", "--rehearse", "1", "-o", "/dev/null", "--restart-after"}, {"0", "0.0"}, {"-1"}},
      {{"serve", "quick", "--rehearse", "1", "-o", "/dev/null", "--answer-every"}, {"0.1", "1e1"}, {"0", "0.0"}},
      {{"analyze", "no-such-folder", "--alpha"}, {"0.05", "5e-2"}, {"0", "0.0", "1", "1.0"}},
  };
  for (const auto& [start, good, bad] : options) {
    for (const bool is_good : {true, false}) {
      for (const auto& value : is_good ? good : bad) {
        auto arguments = start;
        arguments.push_back(value);
        const auto ran = run_kith(arguments);
        EXPECT_EQ(ran.code == 2, !is_good) << ::testing::PrintToString(arguments) << ran.err;
      }
    }
  }
}

TEST(CommandLine, ColoursOnlyWhenAsked) {
  EXPECT_THAT(run_kith({"inspect", "item-delivery"}).out, Not(HasSubstr("\033[")));
  EXPECT_THAT(run_kith({"inspect", "item-delivery", "--color", "always"}).out, HasSubstr("\033[1m"));
}

TEST(CommandLine, SaysWhenStandardOutputIsFull) {
  const auto ran = err_of(5, {"inspect", "item-delivery"}, {{}, "", "/dev/full"});
  EXPECT_THAT(ran, HasSubstr("cannot write to standard output"));
}

TEST(CommandLine, EndsQuietlyWhenItsReaderGoesAway) {
  const Scratch scratch;
  std::ofstream{scratch / "script"} << "{ '" << KITH_PROGRAM << "' inspect item-delivery --json --show demos 2>'"
                                    << scratch / "err"
                                    << "'; echo $? >'" << scratch / "code"
                                    << "'; } | head -c 10 >/dev/null\n";
  ASSERT_EQ(std::system(("bash '" + scratch / "script" + "'").c_str()), 0);
  EXPECT_EQ(text_of(scratch / "code"), "141\n");
  EXPECT_EQ(text_of(scratch / "err"), "");
}

TEST(CommandLine, SaysWhereThereIsNoJson) {
  const std::vector<std::vector<std::string>> commands{
      {"session", "list", "x"}, {"study", "quick", "--dry-run"}, {"init"}, {"version"}};
  for (const auto& arguments : commands) {
    auto with_json = arguments;
    with_json.emplace_back("--json");
    const auto ran = run_kith(with_json);
    EXPECT_EQ(ran.code, 2) << ran.out;
    EXPECT_THAT(ran.out, HasSubstr("prints no JSON"));
  }
}

TEST(Version, NamesTheBuild) {
  EXPECT_THAT(out_of({"--version"}), ::testing::MatchesRegex("kith [0-9.]+ \\(.+, GNU .+, .+\\)\n"));
}

TEST(Doctor, FindsThisMachineHealthy) {
  const auto ran = out_of({"doctor"});
  EXPECT_THAT(ran, HasSubstr("self-test"));
  EXPECT_THAT(ran, HasSubstr("CLI11 "));
}

TEST(Validate, AcceptsStudiesAndDomains) {
  const std::string root = KITH_SOURCE_DIR;
  EXPECT_THAT(out_of({"validate", root + "/studies/paper.toml", root + "/domains/item_delivery.toml"}),
              AllOf(HasSubstr("study 'paper' is valid (300 teams"), HasSubstr("64 worlds, 9312 start states")));
}

TEST(Validate, KnowsWhatComesWithKith) {
  const auto ran = out_of({"validate", "rescue-floor", "paper"});
  EXPECT_THAT(ran, AllOf(HasSubstr("rescue-floor: domain 'rescue-floor' is valid (16 worlds"),
                         HasSubstr("paper: study 'paper' is valid (300 teams")));
  EXPECT_EQ(run_kith({"validate", "rescue-flor"}).code, 5);
}

TEST(Validate, ReadsStandardInput) {
  const auto ran = err_of(3, {"validate", "-"}, {{}, "schema = \"kith.unknown/1\"\n", ""});
  EXPECT_THAT(ran, HasSubstr("<stdin>:1:10: error[E0106]"));
}

TEST(Validate, LetsWarningsCountOnDemand) {
  const auto study = text_of(std::string{KITH_SOURCE_DIR} + "/studies/quick.toml");
  const auto lonely = study +
                      "[learner.Z]\nability = { mean = 0.8, sd = 0.02 }\nconfirm_gain = { value = 0.01 }\ncorrect_gain "
                      "= { value = 0.02 }\n";
  const auto lenient = run_kith({"validate", "-"}, {{}, lonely, ""});
  EXPECT_EQ(lenient.code, 0);
  EXPECT_THAT(lenient.err, HasSubstr("warning[W0401]"));
  EXPECT_THAT(err_of(3, {"validate", "--strict", "-"}, {{}, lonely, ""}), HasSubstr("error[W0401]"));
}

// The published facts of item delivery [jayaraman2024], as others will read them.
TEST(Inspect, PrintsTheKnownFactsOfItemDelivery) {
  const auto document = json_of({"inspect", "item-delivery"});
  EXPECT_EQ(document.at("mdps"), 64);
  EXPECT_EQ(document.at("demonstrations"), 9312);
  EXPECT_EQ(document.at("weights").at("raw"), Json({-3.0, 3.5, -1.0}));
  EXPECT_EQ(document.at("bec").at("constraints"), Json({{-1, 0, 2}, {0, -1, -4}, {1, 1, 0}}));
  EXPECT_NEAR(document.at("bec").at("area_sr"), 0.0261, 0.0001);
  ASSERT_EQ(document.at("knowledge_components").size(), 3u);
  EXPECT_EQ(document["knowledge_components"][0].at("masked"), Json({"recharge"}));
  EXPECT_EQ(document["knowledge_components"][2].at("masked"), Json::array());
  EXPECT_NEAR(document["knowledge_components"][0].at("area_sr"), 0.4373, 0.0001);
  EXPECT_EQ(document.at("coverage").at("vertices"), 19324);
  EXPECT_EQ(document.at("coverage").at("max"), 7);
  EXPECT_EQ(document.at("mask_counters").size(), 3u);
  EXPECT_FALSE(document.contains("demos"));
}

TEST(Inspect, ListsDemonstrationsOnDemand) {
  const auto document = Json::parse(run_kith({"inspect", "item-delivery", "--json", "--show", "demos"}).out);
  ASSERT_EQ(document.at("demos").size(), 9312u);
  const auto& start = document["demos"][0];
  for (const auto* key : {"robot", "items", "stations", "mdp"}) EXPECT_TRUE(start.at("start").contains(key)) << key;
  EXPECT_EQ(start.at("features").size(), 3u);
  EXPECT_TRUE(start.at("unique").is_boolean());
  EXPECT_TRUE(start.at("one_step").is_array());
}

TEST(Inspect, ShowsEveryPart) {
  for (const std::string part : {"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals"}) {
    const auto ran = run_kith({"inspect", "item-delivery", "--show", part});
    EXPECT_EQ(ran.code, 0) << part << ran.err;
    EXPECT_GT(ran.out.size(), 150u) << part;
  }
  const auto some = run_kith({"inspect", "item-delivery", "--show", "map,demos"}).out;
  EXPECT_THAT(some, HasSubstr("--all shows them"));
  EXPECT_GT(run_kith({"inspect", "item-delivery", "--show", "map,demos", "--all"}).out.size(), 3 * some.size());
}

}  // namespace
}  // namespace kith::testing
