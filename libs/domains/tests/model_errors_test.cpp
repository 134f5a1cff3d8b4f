// What is wrong with an explicit model is said with its file, line, column and mend.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/core/error.hpp"
#include "kith/domains/other_models.hpp"
#include "kith/mdp/behaviour.hpp"
#include "models_under_test.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;

struct ModelCase {
  std::string name;
  const ModelTexts* base;
  std::string file;
  std::string from;
  std::string to;
  std::string expected;  // "E0240 transitions.csv 3:8": the first complaint
  std::string message = "";
  std::string hint = "";
  bool infeasible = false;
};

// A walk over ice that holds, which may be slippery.
std::string sure_rows(const std::string& slip) {
  return "bank,go,ice,1,0,1\nice,go,shore,1," + slip + ",1\nice,creep,bank,1,0,1\n";
}
const std::string kRows =
    "bank,go,ice,1,0,1\nice,go,shore,0.75,0,1\nice,go,bank,0.25,1,1\nice,creep,shore,0.5,0,1\n"
    "ice,creep,ice,0.5,0,1\nbank,creep,bank,1,0,1\n";

const std::string kNine =
    "[[feature]]\nname = \"a\"\n[[feature]]\nname = \"b\"\n[[feature]]\nname = \"c\"\n[[feature]]\nname = \"d\"\n"
    "[[feature]]\nname = \"e\"\n[[feature]]\nname = \"f\"\n[[feature]]\nname = \"g\"\n[reward]";

std::vector<ModelCase> model_cases() {
  const auto* csv = &kIceCsv;
  const auto* drawn = &kIceDrawn;
  const std::string toml = "domain.toml";
  const std::string states = "states.csv";
  const std::string rows = "transitions.csv";
  return {
      // the domain file
      {"map_and_model", csv, toml, "[model]", "[map]\nrows = [\"SG\"]\n[model]", "E0230 domain.toml 7:2", "not both"},
      {"feature_like_a_column", csv, toml, "\"slip\"", "\"next\"", "E0231 domain.toml 10:8", "cannot be called"},
      {"prism", csv, toml, "\"csv\"", "\"prism\"", "E0235 domain.toml 6:10", "converted to tables",
       "python -m kith.convert domain.toml"},
      {"file_above", csv, toml, "\"states.csv\"", "\"../states.csv\"", "E0232 domain.toml 7:10",
       "cannot be a file of a model", "relative to the domain file"},
      {"file_elsewhere", csv, toml, "\"states.csv\"", "\"/etc/states.csv\"", "E0232 domain.toml 7:10"},
      {"file_hidden", csv, toml, "\"states.csv\"", "\".ssh/states.csv\"", "E0232 domain.toml 7:10", "", "hidden"},
      {"file_of_another_kind", csv, toml, "\"states.csv\"", "\"passwords\"", "E0232 domain.toml 7:10",
       "cannot be a file of a model", "ends in .csv"},
      {"file_beside", csv, toml, "\"states.csv\"", "\"./none.csv\"", "E0233 domain.toml 7:10"},
      {"feature_of_blanks", csv, toml, "\"slip\"", "\" \"", "E0225 domain.toml 10:8", "cannot be the name"},
      {"discount_near_one", csv, toml, "discount = 1.0", "discount = 0.999999999", "E0110 domain.toml 4:12",
       "at most 0.999999", "discount = 1"},
      {"file_missing", csv, toml, "\"states.csv\"", "\"state.csv\"", "E0233 domain.toml 7:10", "cannot be read",
       "state.csv"},
      {"unknown_format", csv, toml, "\"csv\"", "\"cvs\"", "E0112 domain.toml 6:10", "", "csv"},
      {"unknown_key", csv, toml, "format", "colour = 1\nformat", "E0107 domain.toml 6:1"},
      {"no_feature", csv, toml, "[[feature]]\nname = \"slip\"\n[[feature]]\nname = \"step\"\n", "",
       "E0301 domain.toml 1:1"},
      {"nine_features", csv, toml, "[reward]", kNine, "E0301 domain.toml 25:1", "not 9"},
      {"weight_missing", csv, toml, "slip = -2, ", "", "E0311 domain.toml 14:11"},
      {"action_twice", csv, toml, "discount = 1.0", "actions = [\"go\", \"creep\", \"go\"]", "E0222 domain.toml 4:27"},
      // tables
      {"state_column_missing", csv, states, "state,name", "stat,name", "E0502 states.csv 1:1", "\"state\" is missing"},
      {"variable_no_integer", csv, states, "true,0", "true,left", "E0506 states.csv 2:29", "integer"},
      {"state_twice", csv, states, "ice,on the ice", "bank,on the ice", "E0241 states.csv 3:1",
       "'bank' is given twice"},
      {"feature_column_missing", csv, rows, "slip,step", "slap,step", "E0503 transitions.csv 1:31", "", "slip"},
      {"unknown_state", csv, rows, "bank,go", "bnak,go", "E0240 transitions.csv 2:1", "no state 'bnak' in states.csv",
       "did you mean 'bank'?"},
      {"unknown_next", csv, rows, "go,shore", "go,shor", "E0240 transitions.csv 3:8", "'shor'",
       "did you mean 'shore'?"},
      {"unknown_mdp", csv, states, "state,name", "mdp,state,name", "E0505 states.csv 2:29"},
      {"row_twice", csv, rows, "ice,creep,ice,0.5,0,1\n", "ice,creep,shore,0.5,0,1\n", "E0246 transitions.csv 6:1",
       "twice", "sum of the probabilities"},
      {"probability_zero", csv, rows, "0.25", "0", "E0247 transitions.csv 4:13", "above 0"},
      {"probability_negative", csv, rows, "0.75", "-0.75", "E0247 transitions.csv 3:14"},
      {"probability_above_one", csv, rows, "0.75", "1.75", "E0247 transitions.csv 3:14", "at most 1"},
      {"sum_not_one", csv, rows, "0.75", "0.7", "E0248 transitions.csv 4:13", "sum to 0.950000, not 1", "2 outcomes"},
      {"feature_not_finite", csv, rows, "0.25,1,1", "0.25,inf,1", "E0249 transitions.csv 4:18",
       "feature 'slip' is not a finite number"},
      {"feature_nan", csv, rows, "0.25,1,1", "0.25,nan,1", "E0506 transitions.csv 4:18"},
      {"rows_of_a_terminal_state", csv, rows, "bank,creep,bank", "shore,creep,bank", "E0254 transitions.csv 7:1",
       "'shore' is terminal"},
      {"state_without_action", csv, states, "shore,ashore,true,false,2\n",
       "shore,ashore,true,false,2\npier,on a pier,false,false,3\n", "E0255 states.csv 5:1", "'pier'", "terminal"},
      {"no_end", csv, states, "ashore,true", "ashore,false", "E0256 states.csv 1:1", "no terminal state"},
      {"terminal_start", csv, states, "true,false,2", "true,true,2", "E0258 states.csv 4:1", "cannot be a start"},
      {"undeclared_action", csv, toml, "discount = 1.0", "actions = [\"go\", \"crawl\"]", "E0243 transitions.csv 5:5",
       "'creep'", "known: go, crawl"},
      {"unreachable_end", csv, rows, "bank,go,ice,1,0,1\n", "bank,go,bank,1,0,1\n", "W0205 states.csv 2:1", "left out"},
      {"variable_too_large", csv, states, "true,1", "true,3000000000", "E0249 states.csv 3:27", "too large"},
      {"mdp_without_states", csv, states,
       "state,name,terminal,start,x\nbank,on the bank,false,true,0\nice,on the "
       "ice,false,true,1\nshore,ashore,true,false,2\n",
       "mdp,state,terminal\na,bank,false\na,ice,false\na,shore,true\n", "E0502 transitions.csv 1:1",
       "\"mdp\" is missing"},
      // drawings
      {"drawing_without_map", csv, toml, "[[feature]]", "[model.drawing]\nx = \"x\"\ny = \"x\"\n[[feature]]",
       "E0275 domain.toml 9:1", "there is no [map]", "rows and [map.legend]"},
      {"drawing_of_states_without_numbers", csv, toml, "[[feature]]", "[model.drawing]\ncolumns = 2\n[[feature]]",
       "E0276 domain.toml 10:11", "needs states that are numbers, not 'bank'", "x = "},
      {"drawing_of_unknown_variable", drawn, toml, "x = \"x\"", "x = \"column\"", "E0276 domain.toml 16:5",
       "no variable 'column'", "known: x, y, dog, held"},
      {"drawing_with_one_origin", drawn, toml, "[0, 0]", "[0]", "E0276 domain.toml 18:10", "x and the y", "[0, 0]"},
      {"drawing_in_no_mdp", drawn, toml, "{ terrain = \"ice\" }", "{ terrain = \"ice\", optional = \"wet ice\" }",
       "E0277 domain.toml 25:1", "no MDP 'wet ice'", "remove 'optional'"},
      {"drawing_optional", drawn, toml, "{ terrain = \"ice\" }", "{ terrain = \"ice\", optional = true }",
       "E0277 domain.toml 25:1", "must name the MDP"},
      {"drawing_of_unknown_symbol", drawn, toml, "D = {", "E = {", "E0278 domain.toml 20:1", "'E' is not a symbol",
       "item = \"NAME\""},
      {"drawing_moves_terrain", drawn, toml, "D = {", "\"~\" = {", "E0278 domain.toml 20:1",
       "neither an item nor a destination", "rows"},
      {"drawing_item_nowhere", drawn, toml, "D = { x = \"dog\", y = \"y\", carried = \"held\" }", "",
       "E0278 domain.toml 28:1", "nothing says where symbol 'D' is", "D = { x = \"VARIABLE\""},
      {"drawing_item_in_rows", drawn, toml, ".~G#", "D~G#", "E0278 domain.toml 28:1", "states place it", "below it"},
      {"drawing_off_the_map", drawn, states, "false,true,0,0", "false,true,-1,0", "E0279 states.csv 2:1",
       "in state 'bank' the robot is off the map of 4 x 1 cells: x = -1, y = 0", "the top left cell is 0, 0"},
      {"drawing_counted_from_0", drawn, toml, "origin = [0, 0]\n", "", "E0279 states.csv 2:1", "x = 0, y = 0",
       "origin = [0, 0] counts from 0"},
      {"drawing_thing_off_the_map", drawn, states, "0,0,2,0", "0,0,4,0", "E0279 states.csv 2:1", "dog is off the map"},
      {"drawing_in_a_wall", drawn, states, "true,1,0", "true,3,0", "E0279 states.csv 3:1", "the robot is inside a wall",
       "another symbol at (4,1)"},
      {"drawing_hides_a_difference", drawn, states, "false,true,1,0,9,1", "false,true,0,0,2,0",
       "W0207 domain.toml 15:1", "no difference between the states 'on the bank' and 'on the ice'",
       "[model.drawing.things]"},
      // optimum
      {"for_ever", csv, rows, "bank,creep,bank,1,0,1\n", "ice,pace,bank,0.5,-9,1\nice,pace,ice,0.5,-9,1\n",
       "E0323 domain.toml 14:11", "collect reward for ever", "discount", true},
  };
}

std::string place_of(const Diagnostic& d) {
  return d.id + " " + d.file + " " + std::to_string(d.line) + ":" + std::to_string(d.column);
}

class ModelError : public ::testing::TestWithParam<ModelCase> {};

TEST_P(ModelError, IsReportedAtItsPlaceWithAHint) {
  const ModelCase& c = GetParam();
  const DomainReading reading = read_model_texts(edited(*c.base, c.file, c.from, c.to));
  std::string all;
  for (const Diagnostic& d : reading.diagnostics) all += to_text(d);
  ASSERT_FALSE(reading.diagnostics.empty());
  const Diagnostic& first = reading.diagnostics.front();
  EXPECT_EQ(place_of(first), c.expected) << all;
  EXPECT_THAT(first.message, HasSubstr(c.message));
  EXPECT_THAT(first.hint, HasSubstr(c.hint));
  EXPECT_EQ(first.infeasible, c.infeasible);
  EXPECT_EQ(reading.domain.has_value(), !has_errors(reading.diagnostics));
  EXPECT_TRUE(first.id < "E0232" || first.id[0] != 'E' || first.id >= "E0300" || !first.hint.empty()) << all;
}

INSTANTIATE_TEST_SUITE_P(All, ModelError, ::testing::ValuesIn(model_cases()),
                         [](const auto& c) { return c.param.name; });

TEST(ModelErrors, AreNoneInSoundModels) {
  const auto diagnostics = read_model_texts(kIceCsv).diagnostics;
  EXPECT_FALSE(has_errors(diagnostics)) << to_text(diagnostics.front());
}

TEST(ModelErrors, SayThatCountsAreTooLargeForTheWeights) {
  auto texts = edited(kIceCsv, "transitions.csv", kRows, sure_rows("2000000000"));
  EXPECT_TRUE(read_model_texts(texts).domain.has_value());
  texts = edited(texts, "domain.toml", "slip = -2,", "slip = -0.333333333,");
  const auto diagnostics = read_model_texts(texts).diagnostics;
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(place_of(diagnostics[0]), "E0324 domain.toml 14:11");
  EXPECT_THAT(diagnostics[0].hint, HasSubstr("larger units"));
}

TEST(ModelErrors, WarnOfASingleFeature) {
  auto texts = edited(kIceCsv, "domain.toml", "[[feature]]\nname = \"slip\"\n", "");
  texts = edited(texts, "domain.toml", "slip = -2, ", "");
  texts["transitions.csv"] = "state,action,next,step\nbank,go,ice,1\nice,go,shore,1\n";
  const auto reading = read_model_texts(texts);
  ASSERT_TRUE(reading.domain.has_value());
  EXPECT_EQ(place_of(reading.diagnostics.at(0)), "W0304 domain.toml 10:8");
}

TEST(ModelErrors, AreNoneWhereExpectedCountsAreLarge) {
  const auto texts = edited(kIceCsv, "transitions.csv", "ice,go,bank,0.25,1,1", "ice,go,bank,0.25,2000000000,1");
  const auto reading = read_model_texts(texts);
  ASSERT_TRUE(reading.domain.has_value());
  EXPECT_EQ(reading.domain->count_scale(), 2);
  EXPECT_TRUE(behave(reading.domain->mdp(MdpIndex{0}), reading.domain->weights().raw, {.scale = 2}).has_value());
}

TEST(ModelErrors, SayThatAStartCannotEnd) {
  auto texts = edited(kIceCsv, "transitions.csv", "bank,go,ice,1,0,1\n", "bank,go,bank,1,0,1\n");
  const auto reading = read_model_texts(texts);
  ASSERT_EQ(reading.diagnostics.size(), 2u);
  EXPECT_EQ(place_of(reading.diagnostics[1]), "E0260 states.csv 2:1");
  EXPECT_TRUE(reading.diagnostics[1].infeasible);
}

TEST(ModelErrors, AreNoneWhereARobotMayEnterInSeveralStates) {
  auto texts = kIceCsv;
  texts["states.csv"] = "state,terminal,initial\nbank,false,true\nice,false,true\nshore,true,false\n";
  EXPECT_EQ(sound_model(texts).initial_state(kFirst), StateIndex{0});
  EXPECT_EQ(sound_model(texts).starts(kFirst).size(), 2u);
}

TEST(ModelErrors, AreNoneForAByteOrderMark) {
  EXPECT_TRUE(read_model_texts(edited(kIceCsv, "states.csv", "state,", "\xEF\xBB\xBFstate,")).domain.has_value());
}

// The files themselves, whatever is in them.
TEST(ModelErrors, SayWhatToDoWithFilesOfOtherPrograms) {
  for (const auto* name : {"lake.json", "m.tra", "m.trew"}) {
    try {
      refuse_models_of_others(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.diagnostics().front().id, "E0236");
      EXPECT_THAT(error.diagnostics().front().hint, HasSubstr(std::string{"python -m kith.convert "} + name));
    }
  }
  EXPECT_NO_THROW(refuse_models_of_others("lake.toml"));
}

// A table may have rows for states in which the robot never is, such as the cliff of Gymnasium's CliffWalking.
TEST(ModelErrors, NameStatesThatNoOtherStateLeadsTo) {
  auto texts = kIceCsv;
  texts["states.csv"] = "state,terminal\nbank,false\nice,false\nreef,false\nshore,true\n";
  texts["transitions.csv"] += "reef,go,ice,1,0,1\nreef,creep,reef,1,0,1\n";
  const auto reading = read_model_texts(texts);
  ASSERT_TRUE(reading.domain.has_value());
  EXPECT_EQ(place_of(reading.diagnostics.at(0)), "W0211 states.csv 4:1");
  EXPECT_THAT(reading.diagnostics.at(0).message, HasSubstr("'reef'"));
  EXPECT_EQ(reading.domain->starts(kFirst).size(), 2u);

  texts["states.csv"] = "state,terminal,start\nbank,false,true\nice,false,true\nreef,false,true\nshore,true,false\n";
  EXPECT_EQ(sound_model(texts).starts(kFirst).size(), 3u);

  // Nobody would come to the ice if it did not begin at the bank; the reef only leads where others lead, too.
  texts["states.csv"] = "state,terminal\nbank,false\nice,false\nreef,false\nshore,true\n";
  texts["transitions.csv"] =
      "state,action,next,slip,step\nbank,go,ice,0,1\nbank,creep,ice,1,1\nice,go,shore,0,1\nice,creep,shore,1,1\n";
  EXPECT_EQ(sound_model(edited(texts, "states.csv", "reef,false\n", "")).starts(kFirst).size(), 2u);
  texts["transitions.csv"] += "reef,go,shore,0,1\nreef,creep,shore,1,1\n";
  EXPECT_EQ(read_model_texts(texts).diagnostics.at(0).id, "W0211");
  EXPECT_EQ(read_model_texts(texts).domain->starts(kFirst).size(), 2u);

  // Where nothing else is left, they are all there is.
  texts["states.csv"] = "state,terminal\nbank,false\nshore,true\n";
  texts["transitions.csv"] = "state,action,next,slip,step\nbank,go,shore,0,1\nbank,creep,shore,1,1\n";
  EXPECT_EQ(sound_model(texts).starts(kFirst).size(), 1u);
}

TEST(ModelErrors, NameAnMdpWithoutStates) {
  auto texts = kIceCsv;
  texts["states.csv"] = "mdp,state,terminal\ndry,bank,false\ndry,shore,true\n";
  texts["transitions.csv"] = "mdp,state,action,next,slip,step\ndry,bank,go,shore,0,1\nwet,bank,go,shore,0,1\n";
  const auto diagnostics = read_model_texts(texts).diagnostics;
  EXPECT_EQ(place_of(diagnostics.at(0)), "E0242 transitions.csv 3:1");
  EXPECT_EQ(diagnostics.at(0).hint, "known: dry");
}

TEST(ModelErrors, RefuseMoreStatesThanTheCallerWants) {
  DomainFiles files;
  for (const auto& [name, text] : kIceCsv) files.known.push_back({name, text});
  const auto reading = parse_domain(kIceCsv.at("domain.toml"), "domain.toml", {.max_states = 2}, files);
  ASSERT_EQ(reading.diagnostics.size(), 1u);
  EXPECT_EQ(reading.diagnostics[0].id, "E0257");
}

TEST(ModelErrors, StopAtTwentyOfTheFiles) {
  auto texts = kIceCsv;
  for (int i = 0; i < 100; ++i) texts["transitions.csv"] += "x,go,y,1,0,1\n";
  EXPECT_EQ(read_model_texts(texts).diagnostics.size(), 20u);
}

}  // namespace
}  // namespace kith
