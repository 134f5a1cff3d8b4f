// Models without a map on the command line: validated, shown, exported, taught, studied.
#include <gtest/gtest.h>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

const std::string kIce = std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing";

// A copy of the example in a folder of its own, with an edit in one of its files.
class Model : public ::testing::Test {
 protected:
  Model() {
    for (const auto* file : {".toml", "_states.csv", "_transitions.csv"}) {
      std::ofstream{scratch_ / (std::string{"icy_crossing"} + file)} << text_of(kIce + file);
    }
  }

  void edit(const std::string& file, const std::string& from, const std::string& to) {
    auto text = text_of(scratch_ / file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream{scratch_ / file} << text.replace(at, from.size(), to);
  }

  Scratch scratch_;
};

TEST_F(Model, IsValidAndShown) {
  const auto checked = out_of({"validate", scratch_ / "icy_crossing.toml"});
  EXPECT_THAT(checked, HasSubstr("domain 'icy-crossing' is valid (3 worlds, 45 start states)"));
  const auto shown = run_kith({"inspect", scratch_ / "icy_crossing.toml", "--show", "map,policy"});
  if (shown.code == 0) {
    EXPECT_THAT(shown.out,
                AllOf(HasSubstr("glaze"), HasSubstr("an end: in the hut at f1"), HasSubstr("on the bank at a1")));
  }
}

TEST_F(Model, IsAskedAboutWithItsChances) {
  const std::vector<std::string> question{"ask", scratch_ / "icy_crossing.toml", "why right at 'a1' in world 0?"};
  EXPECT_THAT(out_of(question), AllOf(HasSubstr("the robot: right x5 (most likely path, 66 % chance)"),
                                      HasSubstr("falling into the water in "), HasSubstr(" of 10 runs"),
                                      HasSubstr("otherwise: down x2, right x5, up x2\n")));
  auto as_json = question;
  as_json.emplace_back("--json");
  const auto document = Json::parse(run_kith(as_json).out);
  const auto& example = document.at("examples").at(0);
  EXPECT_NEAR(example.at("chance").get<double>(), 0.66, 0.005);
  EXPECT_TRUE(example.at("alternative").at("chance").is_null()) << "nobody slips on the bank";
  ASSERT_EQ(example.at("runs").at("runs").size(), 5u);
  for (const auto& run : example.at("runs").at("runs")) {
    EXPECT_EQ(run.at("frames").at(0).at("robot"), example.at("start").at("robot"));
    EXPECT_TRUE(run.at("ended").is_boolean());
  }
  const auto certain = json_of({"ask", "item-delivery", "when does it recharge?"});
  EXPECT_TRUE(certain.at("examples").at(0).at("chance").is_null());
  EXPECT_TRUE(certain.at("examples").at(0).at("runs").is_null());
}

struct Malformed {
  std::string file, from, to;
  std::string place;  // "_states.csv:3:1: error[E0241]"
  std::string message, hint;
  int code = 3;
};

TEST_F(Model, IsRefusedWithMessagePlaceHintAndCode) {
  const std::string toml = "icy_crossing.toml";
  const std::string states = "icy_crossing_states.csv";
  const std::string rows = "icy_crossing_transitions.csv";
  const std::vector<Malformed> cases{
      {toml, "icy_crossing_states.csv", "states.csv", "icy_crossing.toml:15:15: error[E0233]",
       "'states.csv' cannot be read", "it is expected at"},
      {toml, "\"icy_crossing_states", "\"../icy_crossing_states", "icy_crossing.toml:15:15: error[E0232]",
       "cannot be a file of a model", "in its folder or below"},
      {states, "b1,on the ice", "a1,on the ice", "icy_crossing_states.csv:3:1: error[E0241]", "'a1' is given twice",
       "one row"},
      {states, "e2,in the water at e2,true", "e2,in the water at e2,false",
       "icy_crossing_states.csv:12:1: error[E0255]", "'e2' of MDP 'firm ice' is not terminal, but has no transition",
       "mark it as terminal"},
      {states, "false,true,1,1", "false,true,one,1", "icy_crossing_states.csv:2:33: error[E0506]",
       "\"one\" in column \"x\" is not of type integer", "42"},
      {rows, "a1,right,b1,1", "a1,right,b9,1", "icy_crossing_transitions.csv:3:19: error[E0240]",
       "there is no state 'b9'", ""},
      {rows, "a1,right,b1,1", "a1,rihgt,b1,1", "icy_crossing_transitions.csv:3:13: error[E0243]", "action 'rihgt'",
       "did you mean 'right'?"},
      {rows, "a1,right,b1,1,0,0,1", "a1,right,b1,0.9,0,0,1", "icy_crossing_transitions.csv:3:22: error[E0248]",
       "sum to 0.900000, not 1", "outcomes missing"},
      {rows, "a1,right,b1,1,0,0,1", "a1,right,b1,1,0,nan,1", "icy_crossing_transitions.csv:3:26: error[E0506]",
       "\"nan\" in column \"home\"", ""},
      {rows, "a1,right,b1,1,0,0,1", "a1,right,b1,1,0,0", "icy_crossing_transitions.csv:3:26: error[E0505]",
       "7 cells, the header 8", "commas"},
      {rows, "a1,right,b1,1,0,0,1", "a1,right,b1,1,0,0,1\nfirm ice,a1,right,b1,1,0,0,1",
       "icy_crossing_transitions.csv:4:10: error[E0246]", "are given twice", "sum of the probabilities"},
      {rows, "water,home", "wtaer,home", "icy_crossing_transitions.csv:1:35: error[E0503]", "unknown column \"wtaer\"",
       "did you mean water?"},
      {rows, "firm ice,a1,down,a2", "firm ice,f1,down,a2", "icy_crossing_transitions.csv:2:10: error[E0254]",
       "'f1' is terminal", "remove its transitions"},
  };
  for (const auto& c : cases) {
    const auto before = text_of(scratch_ / c.file);
    edit(c.file, c.from, c.to);
    const auto ran = run_kith({"validate", scratch_ / "icy_crossing.toml"});
    EXPECT_EQ(ran.code, c.code) << ran.err;
    EXPECT_THAT(ran.err, AllOf(HasSubstr(scratch_ / c.place), HasSubstr(c.message), HasSubstr(c.hint)));
    std::ofstream{scratch_ / c.file} << before;
  }
}

TEST_F(Model, IsInfeasibleWhereAStartCannotEnd) {
  edit("icy_crossing_transitions.csv", "firm ice,a1,down,a2,1,0,0,1\nfirm ice,a1,right,b1,1,0,0,1\n",
       "firm ice,a1,down,a1,1,0,0,1\n");
  const auto ran = err_of(4, {"validate", scratch_ / "icy_crossing.toml"});
  EXPECT_THAT(ran, AllOf(HasSubstr("icy_crossing_states.csv:2:1: error[E0260]"),
                         HasSubstr("an end cannot be reached with certainty"), HasSubstr("terminal")));
}

TEST_F(Model, IsInfeasibleWhereRewardGrowsForEver) {
  edit("icy_crossing.toml", "discount  = 0.95", "discount  = 1.0");
  edit("icy_crossing.toml", "step = -1 }\n\n[prior]", "step = 1 }\n\n[prior]");
  edit("icy_crossing.toml", "{ step = -1 } ]", "{ step = 1 } ]");
  const auto ran = err_of(4, {"validate", scratch_ / "icy_crossing.toml"});
  EXPECT_THAT(ran, AllOf(HasSubstr("icy_crossing.toml:40:11: error[E0323]"),
                         HasSubstr("in 3 of 3 MDPs, first in 'firm ice'"), HasSubstr("cost")));
}

// Of PRISM and Gymnasium, as a file of theirs and as a domain file that names one.
TEST_F(Model, OfAnotherProgramIsConvertedFirst) {
  for (const std::string name : {"m.tra", "lake.json"}) {
    std::ofstream{scratch_ / name} << "[]";
    for (const std::string command : {"validate", "inspect", "teach", "ask", "infer"}) {
      std::vector<std::string> call{command, scratch_ / name};
      if (command == "ask") call.emplace_back("why?");
      if (command == "teach") call.insert(call.end(), {"--group", "N"});
      if (command == "infer") call.insert(call.end(), {"--policy", "policy.csv"});
      const auto ran = run_kith(call);
      EXPECT_EQ(ran.code, 3) << command << ran.err;
      EXPECT_THAT(ran.err, AllOf(HasSubstr("E0236"), HasSubstr("python -m kith.convert " + (scratch_ / name))));
    }
  }
  edit("icy_crossing.toml", "\"csv\"", "\"gym-json\"");
  const auto ran = err_of(3, {"inspect", scratch_ / "icy_crossing.toml"});
  EXPECT_THAT(ran, HasSubstr("python -m kith.convert " + (scratch_ / "icy_crossing.toml") + " -o NEW.toml"));
}

// The same without its picture.
class Unpictured : public Model {
 protected:
  Unpictured() {
    const auto text = text_of(scratch_ / "icy_crossing.toml");
    const auto begin = text.find("[model.drawing]"), end = text.find("[[feature]]");
    std::ofstream{scratch_ / "icy_crossing.toml"} << text.substr(0, begin) + text.substr(end);
    auto study = text_of(std::string{KITH_SOURCE_DIR} + "/studies/quick.toml");
    const auto at = study.find("\"item-delivery\"");
    EXPECT_NE(at, std::string::npos);
    std::ofstream{scratch_ / "study.toml"} << study.replace(at, 15, "\"icy_crossing.toml\"");
  }
};

TEST_F(Unpictured, IsTaughtInWords) {
  const auto ran = out_of({"teach", scratch_ / "icy_crossing.toml", "--group", "N", "--seed", "1"});
  EXPECT_THAT(ran, AllOf(HasSubstr("lists of actions and states"), HasSubstr("-> ")));
  EXPECT_THAT(ran, Not(HasSubstr("bare map")));
  const auto json = json_of({"inspect", scratch_ / "icy_crossing.toml", "--show", "demos"});
  EXPECT_THAT(json.at("demos").at(0).at("start").at("name").get<std::string>(), HasSubstr("at a"));
}

TEST_F(Unpictured, IsStudiedResumedAndVerifiedFromItsFolder) {
  const std::vector<std::string> study{"study", scratch_ / "study.toml", "-o", scratch_ / "run",
                                       "--set", "replicates=2"};
  expect_code(0, study);
  const std::string states = "icy_crossing_states.csv";
  EXPECT_EQ(text_of(scratch_ / ("run/inputs/" + states)), text_of(scratch_ / states));
  EXPECT_THAT(text_of(scratch_ / "run/manifest.json"), HasSubstr("\"" + states + "\": \""));
  EXPECT_EQ(run_kith(study).code, 0);  // all teams are there
  std::filesystem::remove(scratch_ / states);
  expect_code(0, {"verify", scratch_ / "run"});
  EXPECT_EQ(run_kith({"teach", "--from", scratch_ / "run", "--team", "1"}).code, 0);
}

TEST_F(Unpictured, IsAnotherStudyWithAnotherModel) {
  const std::vector<std::string> study{"study", scratch_ / "study.toml", "-o", scratch_ / "run",
                                       "--set", "replicates=2"};
  ASSERT_EQ(run_kith(study).code, 0);
  edit("icy_crossing_states.csv", "on the bank", "at the bank");
  EXPECT_THAT(err_of(2, study), HasSubstr("different study"));
}

}  // namespace
}  // namespace kith::testing
