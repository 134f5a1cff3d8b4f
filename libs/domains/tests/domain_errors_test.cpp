#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "domain_texts.hpp"
#include "domains_under_test.hpp"
#include "kith/core/error.hpp"

namespace kith {
namespace {

// A small sound domain; each case below breaks one thing of it.
const std::string kSound = R"(schema = "kith.domain/1"
id = "tiny"
[mdp]
discount = 1.0
[map]
rows = ["S.rG"]
[map.legend]
"." = "floor"
"#" = "wall"
"r" = { terrain = "rubble", optional = true }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "rubble"
when = "leave:rubble"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { rubble = -2, step = -1 }
)";

struct Case {
  std::string name;
  std::vector<std::pair<std::string, std::string>> edits;  // each first occurrence of .first becomes .second
  std::string expected;                                    // "ID LINE:COLUMN", in file order, joined by ", "
  std::string hint = "";                                   // part of the first hint
  bool infeasible = false;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

std::string edited_text(const Case& c) {
  std::string text = kSound;
  for (const auto& [from, to] : c.edits) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::invalid_argument{"the case '" + c.name + "' edits what is not there"};
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string many_cells() {
  std::string row = "\"S";
  row += std::string(998, '.') + "G\",\n";
  std::string rows = "[";
  for (int i = 0; i < 1001; ++i) rows += i == 0 ? row : "\"" + std::string(1000, '.') + "\",\n";
  return rows + "]";
}

// Ten items in a row: 13 cells of 4 bits for each, more than fit in a word.
const std::pair<std::string, std::string> kTenItems{
    "\"G\" = { goal = true }",
    "\"G\" = { goal = true }\na={item=\"a\"}\nb={item=\"b\"}\nc={item=\"c\"}\nd={item=\"d\"}\ne={item=\"e\"}\n"
    "f={item=\"f\"}\ng={item=\"g\"}\nh={item=\"h\"}\ni={item=\"i\"}\nj={item=\"j\"}\nk={item=\"k\"}\n"
    "l={item=\"l\"}\nm={item=\"m\"}\nn={item=\"n\"}\no={item=\"o\"}"};

// Every way to get a domain file wrong, and what is said about it.
std::vector<Case> cases() {
  const std::pair<std::string, std::string> prior{"[reward]", "[prior]\nhalfspaces = [ { step = 1 } ]\n[reward]"};
  return {
      // E01
      {"schema", {{"domain/1", "domain/2"}}, "E0106 1:10", "kith.domain/1"},
      {"no_schema", {{"schema = \"kith.domain/1\"\n", ""}}, "E0109 1:1"},
      {"id", {{"\"tiny\"", "\"Tiny One\""}}, "E0115 2:6", "lower-case"},
      {"unknown_top_key", {{"id =", "titel = \"x\"\nid ="}}, "E0107 2:1", "'title'"},
      {"unknown_map_key", {{"[map.legend]", "row = 3\n[map.legend]"}}, "E0107 7:1", "'rows'"},
      {"unknown_symbol_key", {{"optional = true", "optinal = true"}}, "E0107 10:29", "'optional'"},
      {"unknown_mdp_key", {{"discount =", "discont ="}}, "E0107 4:1", "'discount'"},
      {"unknown_feature_key", {{"when = \"action\"", "when = \"action\"\nonly = 1"}}, "E0107 19:1"},
      {"unknown_reward_key", {{"[reward]", "[reward]\nnormalise = \"l2\""}}, "E0107 20:1", "'normalize'"},
      {"wrong_type", {{"discount = 1.0", "discount = \"1\""}}, "E0108 4:12"},
      {"rows_no_array", {{"[\"S.rG\"]", "\"S.rG\""}}, "E0108 6:8"},
      {"rows_not_strings", {{"[\"S.rG\"]", "[\"S.rG\", 1]"}}, "E0108 6:17"},
      {"optional_type", {{"optional = true", "optional = 1"}}, "E0108 10:40"},
      {"feature_no_table",
       {{"[[feature]]\nname = \"rubble\"", "[feature]\nname = \"rubble\""}, {"[[feature]]", "[words]"}},
       "E0108 13:1"},
      {"discount_zero", {{"discount = 1.0", "discount = 0.0"}}, "E0110 4:12"},
      {"discount_near_one", {{"discount = 1.0", "discount = 0.9999999"}}, "E0110 4:12", "discount = 1"},
      {"discount_nan", {{"discount = 1.0", "discount = nan"}}, "E0111 4:12"},
      {"max_steps", {{"discount = 1.0", "max_steps = 0"}}, "E0110 4:13"},
      {"unknown_action", {{"discount = 1.0", "actions = [\"up\", \"fly\"]"}}, "E0112 4:18", "known: up"},
      {"unknown_norm", {{"[reward]", "[reward]\nnormalize = \"l3\""}}, "E0112 20:13", "'l2'"},
      {"no_map",
       {{"[map]\nrows = [\"S.rG\"]\n[map.legend]", "[words]"}},
       "E0109 1:1, E0312 6:1, E0312 7:1, E0312 8:1, E0312 9:1, E0312 10:1"},
      {"no_weights", {{"weights = { rubble = -2, step = -1 }\n", ""}}, "E0109 19:1"},
      // E02
      {"no_rows", {{"[\"S.rG\"]", "[]"}}, "E0201 6:8"},
      {"empty_row", {{"[\"S.rG\"]", "[\"\"]"}}, "E0201 6:9"},
      {"beyond_ascii",
       {{"[\"S.rG\"]",
         "[\"S.\xC3\xA4"
         "G\", \"....\"]"}},
       "E0203 6:9",
       "one ASCII character per cell"},
      {"ragged", {{"[\"S.rG\"]", "[\"S.rG\", \"...\"]"}}, "E0202 6:17", "the same length"},
      {"undeclared", {{"S.rG", "S?rG"}}, "E0203 6:11", "'.'"},
      {"undeclared_twice", {{"S.rG", "S??G"}}, "E0203 6:11, W0201 10:1"},
      {"undeclared_unseen", {{"S.rG", "S\\tG"}}, "E0203 6:9, W0201 10:1", "'.'"},
      {"long_symbol", {{"\"#\"", "\"##\""}}, "E0204 9:1"},
      {"robot_symbol", {{"\"#\"", "\"@\""}}, "E0204 9:1", "robot"},
      {"short_symbol", {{"\"wall\"", "\"wal\""}}, "E0205 9:7", "'wall'"},
      {"terrain_symbol", {{"\"wall\"", "\"gravel\""}}, "E0205 9:7", "{ terrain = \"gravel\" }"},
      {"number_symbol", {{"\"wall\"", "3"}}, "E0205 9:7"},
      {"no_start", {{"S.rG", "..rG"}}, "E0206 6:8, W0201 11:1"},
      {"unreachable", {{"S.rG", "S#rG"}}, "E0207 6:13", "first failing world: rubble@{}", true},
      {"unreachable_in_some",
       {{"{ terrain = \"rubble\"", "{ wall = true"}, {"\"leave:rubble\"", "\"!action\""}},
       "E0207 6:13",
       "wall@{(3,1)}",
       true},
      {"two_starts", {{"S.rG", "SSrG"}}, "E0208 6:11"},
      {"start_on_wall", {{"{ start = true }", "{ start = true, wall = true }"}}, "E0209 11:1"},
      {"no_goal", {{"{ goal = true }", "{ terrain = \"grass\" }"}}, "E0210 5:1", "goal = true"},
      {"item_twice", {{"S.rG", "S##G"}, {"\"wall\"", "{ item = \"key\" }"}}, "E0211 6:12, W0201 10:1"},
      {"item_two_symbols",
       {{"\"floor\"", "{ item = \"key\" }"}, {"\"wall\"", "{ item = \"key\" }"}},
       "E0211 9:1, W0201 9:1"},
      {"no_such_item", {{"{ goal = true }", "{ destination = \"key\" }"}}, "E0212 12:1"},
      {"optional_start", {{"{ start = true }", "{ start = true, optional = true }"}}, "E0213 11:1"},
      {"optional_destination",
       {{"\"floor\"", "{ item = \"key\" }"}, {"{ goal = true }", "{ destination = \"key\", optional = \"x\" }"}},
       "E0213 12:1"},
      {"optional_nothing", {{"\"floor\"", "{ optional = true }"}}, "E0213 8:1"},
      {"name_of_two_kinds", {{"\"floor\"", "{ station = \"rubble\" }"}}, "E0214 10:1"},
      {"condition_end", {{"leave:rubble\"", "leave:rubble &\""}}, "E0215 15:23"},
      {"condition_open", {{"leave:rubble\"", "(leave:rubble\""}}, "E0215 15:22"},
      {"condition_close", {{"leave:rubble\"", "leave:rubble)\""}}, "E0215 15:21"},
      {"condition_no_name", {{"leave:rubble", "leave"}}, "E0215 15:9"},
      {"condition_empty_name", {{"leave:rubble", "leave:"}}, "E0215 15:15"},
      {"condition_exit_name", {{"leave:rubble", "exit:x"}}, "E0215 15:9"},
      {"condition_deep", {{"leave:rubble", std::string(100, '!') + "action"}}, "E0215 15:41"},
      {"condition_empty", {{"leave:rubble", ""}}, "E0215 15:9"},
      {"no_such_terrain", {{"leave:rubble", "action & leave:rubbel"}}, "E0216 15:24", "'rubble'"},
      {"no_such_condition", {{"leave:rubble", "leaves:rubble"}}, "E0216 15:9", "'leave'"},
      {"no_such_carried", {{"leave:rubble", "carrying:key"}}, "E0216 15:18"},
      {"no_exit_action", {{"leave:rubble", "exit"}}, "E0216 15:9"},
      {"no_such_goal", {{"leave:rubble", "goal:home"}}, "E0216 15:14"},
      {"too_many_cells", {{"[\"S.rG\"]", many_cells()}}, "E0217 6:8"},
      {"too_many_variants", {{"S.rG", "Srrrrrrrrrrrrrrrrr.G"}}, "E0218 6:8", "optional = \"NAME\""},
      {"too_many_things", {{"S.rG", "S.rabcdefghijklmnoG"}, kTenItems}, "E0219 5:1"},
      {"rule_without_effect", {{"[reward]", "[[rule]]\nwhen = \"action\"\nforbid = false\n[reward]"}}, "E0220 21:10"},
      {"finished", {{"{ start = true }", "{ start = true, goal = true }"}}, "E0221 6:10", "rubble@{}", true},
      {"action_twice", {{"discount = 1.0", "actions = [\"left\", \"right\", \"left\"]"}}, "E0222 4:29"},
      {"no_item_to_pick_up", {{"discount = 1.0", "actions = [\"right\", \"pickup\"]"}}, "E0222 4:21"},
      {"no_moves", {{"discount = 1.0", "actions = [\"exit\"]"}}, "E0222 4:11", "\"up\""},
      {"wall_and_terrain", {{"\"wall\"", "{ wall = true, terrain = \"x\" }"}}, "E0223 9:1, W0201 9:1"},
      {"bad_name", {{"terrain = \"rubble\"", "terrain = \"wet rubble\""}}, "E0225 10:19"},
      {"unused_symbol", {{"S.rG", "S..G"}}, "W0201 10:1, W0301 14:8"},
      {"dead_end",
       {{"S.rG", "SrxG"},
        {"\"#\" = \"wall\"", "\"x\" = { terrain = \"hole\" }"},
        {"[\"SrxG\"]", "[\"SrrG\", \"..x.\"]"},
        {"[reward]", "[[rule]]\nwhen = \"leave:hole\"\nforbid = true\n[reward]"}},
       "W0202 5:1",
       "robot at (3,2)"},
      // [family]
      {"family_worlds_zero", {{"[map]", "[family]\nworlds = 0\n[map]"}}, "E0110 6:10"},
      {"family_worlds_many", {{"[map]", "[family]\nworlds = 65537\n[map]"}}, "E0110 6:10"},
      {"family_worlds_type", {{"[map]", "[family]\nworlds = \"all\"\n[map]"}}, "E0108 6:10"},
      {"family_worlds_real", {{"[map]", "[family]\nworlds = 2.5\n[map]"}}, "E0108 6:10"},
      {"family_seed_negative", {{"[map]", "[family]\nworlds = 2\nseed = -1\n[map]"}}, "E0110 7:8"},
      {"family_seed_alone", {{"[map]", "[family]\nseed = 7\n[map]"}}, "E0226 6:8", "worlds = NUMBER"},
      {"family_starts_zero", {{"[map]", "[family]\nstarts = 0\n[map]"}}, "E0110 6:10"},
      {"family_starts_type", {{"[map]", "[family]\nstarts = [3]\n[map]"}}, "E0108 6:10"},
      {"family_unknown_key", {{"[map]", "[family]\nworlsd = 3\n[map]"}}, "E0107 6:1", "'worlds'"},
      {"family_no_table", {{"id =", "family = 3\nid ="}}, "E0108 2:10"},
      {"family_more_than_all", {{"[map]", "[family]\nworlds = 3\n[map]"}}, "W0203 6:10", "ask for fewer"},
      {"family_too_many_things",
       {{"S.rG", std::string(65, 'r') + "SG"}, {"[map]", "[family]\nworlds = 8\n[map]"}},
       "E0218 8:8",
       "optional = \"NAME\""},
      {"family_unreachable",
       {{"{ terrain = \"rubble\"", "{ wall = true"},
        {"\"leave:rubble\"", "\"!action\""},
        {"[map]", "[family]\nworlds = 2\n[map]"}},
       "E0207 8:13",
       "wall@{(3,1)}",
       true},
      // E03
      {"no_feature",
       {{"[[feature]]\nname = \"rubble\"\nwhen = \"leave:rubble\"\n[[feature]]\nname = \"step\"\nwhen = \"action\"\n",
         ""},
        {"id =", "feature = []\nid ="}},
       "E0301 2:11"},
      {"feature_twice", {{"name = \"step\"", "name = \"rubble\""}}, "E0302 17:8", "line 14"},
      {"missing_weight", {{"rubble = -2, ", ""}}, "E0311 20:11"},
      {"unknown_weight", {{"{ rubble = -2", "{ rubbel = -2"}}, "E0311 20:11, E0312 20:13", ""},
      {"unknown_words",
       {{"[reward]", "[words]\nstpe = \"a step\"\n[reward]"}},
       "E0312 20:1",
       "did you mean 'step'? (declared at line 17)"},
      {"zero_weights", {{"rubble = -2, step = -1", "rubble = 0, step = -0.0"}}, "E0313 20:11"},
      {"nan_weight", {{"rubble = -2", "rubble = nan"}}, "E0314 20:22"},
      {"infinite_weight", {{"rubble = -2", "rubble = -inf"}}, "E0314 20:22"},
      {"huge_weight", {{"rubble = -2", "rubble = -1e308"}}, "E0314 20:22"},
      {"subnormal_weight", {{"rubble = -2", "rubble = -5e-324"}}, "E0314 20:22"},
      {"text_weight", {{"rubble = -2", "rubble = \"-2\""}}, "E0108 20:22"},
      {"positive_cycle",
       {{"step = -1", "step = 1"}},
       "E0321 20:11",
       "make the total reward of this cycle negative",
       true},
      {"zero_cycle", {{"step = -1", "step = 0"}}, "E0322 20:11", "cost", true},
      {"prior_zero", {prior, {"step = 1", "step = 0"}}, "E0331 20:16"},
      {"prior_nan", {prior, {"step = 1", "step = nan"}}, "E0314 20:25"},
      {"prior_digits", {prior, {"step = 1", "step = 1, rubble = 1e-12"}}, "E0315 20:16"},
      {"words_number", {{"[reward]", "[words]\nstep = 1\n[reward]"}}, "E0108 20:8", ""},
      {"words_key",
       {{"[reward]", "[words]\nstep = { one = \"a step\", may = \"{n} steps\" }\n[reward]"}},
       "E0107 20:26",
       "'many'"},
      {"words_without_one", {{"[reward]", "[words]\nstep = { many = \"{n} steps\" }\n[reward]"}}, "E0109 20:8", ""},
      {"words_without_do",
       {{"[reward]", "[words]\nstep = { one = \"a step\", do_many = \"take {n} steps\" }\n[reward]"}},
       "E0109 20:8",
       ""},
      {"words_without_number",
       {{"[reward]", "[words]\nstep = { one = \"a step\", many = \"steps\" }\n[reward]"}},
       "E0316 20:33",
       "{n} steps"},
      {"words_empty", {{"[reward]", "[words]\nstep = \" \"\n[reward]"}}, "E0317 20:8", ""},
      {"words_of_blanks", {{"[reward]", "[words]\nstep = { one = \"\\t\\n\" }\n[reward]"}}, "E0317 20:16", "a step"},
      {"words_with_blanks", {{"[reward]", "[words]\nstep = \" a step\"\n[reward]"}}, "W0305 20:8", "\"a step\""},
      {"feature_without_name",
       {{"\"rubble\"\nwhen", "\"\"\nwhen"}, {"{ rubble = -2", "{ \"\" = -2"}},
       "E0225 14:8",
       "blanks"},
      {"feature_with_blanks",
       {{"\"rubble\"\nwhen", "\" rubble\"\nwhen"}, {"{ rubble = -2", "{ \" rubble\" = -2"}},
       "E0225 14:8",
       "blanks"},
      {"prior_unknown", {prior, {"step = 1", "stop = 1"}}, "E0312 20:18", "'step'"},
      {"prior_clash", {prior}, "E0332 20:16", "", true},
      {"tight_max_steps", {{"discount = 1.0", "max_steps = 2"}}, "W0303 20:11", "rubble@{}"},
  };
}

std::string places_of(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) {
    text += text.empty() ? "" : ", ";
    text += d.id + " " + std::to_string(d.line) + ":" + std::to_string(d.column);
  }
  return text;
}

class DomainError : public ::testing::TestWithParam<Case> {};

TEST_P(DomainError, IsReportedAtItsPlaceWithAHint) {
  const Case& c = GetParam();
  const DomainReading reading = parse_domain(edited_text(c), "tiny.toml");
  std::string all;
  for (const Diagnostic& d : reading.diagnostics) all += to_text(d);
  EXPECT_EQ(places_of(reading.diagnostics), c.expected) << all;
  ASSERT_FALSE(reading.diagnostics.empty());
  EXPECT_EQ(reading.domain.has_value(), !has_errors(reading.diagnostics));
  EXPECT_EQ(reading.diagnostics[0].infeasible, c.infeasible) << all;
  EXPECT_NE(reading.diagnostics[0].hint.find(c.hint), std::string::npos) << all;
  if (!reading.domain) {
    EXPECT_EQ(Error{reading.diagnostics}.kind(), c.infeasible ? ErrorKind::kInfeasible : ErrorKind::kInvalidInput);
  }
  for (const Diagnostic& d : reading.diagnostics) {
    EXPECT_EQ(d.file, "tiny.toml");
    EXPECT_EQ(d.severity, d.id[0] == 'W' ? Severity::kWarning : Severity::kError);
    EXPECT_FALSE(d.source_line.empty() && d.line > 1);
  }
}

INSTANTIATE_TEST_SUITE_P(All, DomainError, ::testing::ValuesIn(cases()), [](const auto& c) { return c.param.name; });

// The first complaint about a case, as people read it.
const std::map<std::string, std::string> kMessages{
    {"schema", "'kith.domain/2' is not a schema of domain files"},
    {"id", "'Tiny One' cannot be an id"},
    {"unknown_map_key", "unknown key 'row' in [map]"},
    {"wrong_type", "'discount' must be a number, not a string"},
    {"discount_zero", "'discount' must be greater than 0.0 and at most 1.0, not 0.0"},
    {"discount_near_one", "'discount' must be 1 or at most 0.999999, not 0.9999999"},
    {"words_with_blanks", "blanks before or after these words are removed"},
    {"feature_without_name", "'' cannot be the name of a feature"},
    {"unknown_action", "an action cannot be 'fly'"},
    {"no_weights", "key 'weights' is missing in [reward]"},
    {"empty_row", "a row of the map is empty"},
    {"ragged", "this row has 3 cells, the first one has 4"},
    {"undeclared", "symbol '?' is not declared in [map.legend]"},
    {"robot_symbol", "'@' cannot be a symbol: it must be one printable ASCII character other than '@'"},
    {"terrain_symbol", "a symbol alone can be \"wall\" or \"floor\", not \"gravel\""},
    {"no_start", "the map has no start"},
    {"unreachable_in_some", "the goal cannot be reached from the start in 1 of 2 worlds"},
    {"two_starts", "there is a second start"},
    {"no_goal", "the map has no goal"},
    {"no_such_item", "destination of an unknown item 'key'"},
    {"condition_end", "bad condition: expected a condition such as leave:X, '!' or '('"},
    {"no_such_terrain", "condition names an unknown terrain or station 'rubbel'"},
    {"too_many_variants", "17 optional things make about 131072 MDPs; at most 65536 are built"},
    {"finished", "there is nothing to do: the episode ends at the start in 2 of 2 worlds"},
    {"no_moves", "the robot has no action to move with"},
    {"feature_twice", "feature 'rubble' is declared twice"},
    {"missing_weight", "feature 'rubble' has no weight"},
    {"zero_weights", "all weights are zero, so nothing matters to the robot"},
    {"positive_cycle",
     "the robot can collect unlimited reward by going in circles: (1,1) right (2,1) left (1,1); in 2 of 2 worlds, "
     "first in: rubble@{}"},
    {"zero_cycle",
     "the robot can go in circles at no cost: (1,1) right (2,1) left (1,1); in 2 of 2 worlds, first in: "
     "rubble@{}"},
    {"prior_clash", "the prior { step = 1 } contradicts the weights: (0,1) . (-2,-1) is negative"},
    {"family_worlds_zero", "'worlds' must be at least 1 and at most 65536, not 0"},
    {"family_worlds_type", "'worlds' must be an integer, not a string"},
    {"family_seed_alone", "'seed' draws worlds, but 'worlds' does not say how many"},
    {"family_unknown_key", "unknown key 'worlsd' in [family]"},
    {"family_more_than_all", "there are only 2 worlds, and all of them are built"},
    {"family_too_many_things", "65 optional things; at most 64 are supported"}};

TEST(DomainErrors, SayWhatIsWrongInWords) {
  std::size_t num_seen = 0;
  for (const Case& c : cases()) {
    const auto expected = kMessages.find(c.name);
    if (expected == kMessages.end()) continue;
    EXPECT_EQ(parse_domain(edited_text(c), "tiny.toml").diagnostics.at(0).message, expected->second) << c.name;
    ++num_seen;
  }
  EXPECT_EQ(num_seen, kMessages.size());
}

TEST(DomainErrors, SoundFileHasNone) { EXPECT_TRUE(parse_domain(kSound, "tiny.toml").diagnostics.empty()); }

TEST(DomainErrors, RefuseMoreStatesThanTheCallerWants) {
  const auto two_mdps = parse_domain(kSound, "tiny.toml", {.max_states = 8});
  EXPECT_TRUE(two_mdps.domain);
  const auto refused = parse_domain(kSound, "tiny.toml", {.max_states = 7});
  EXPECT_FALSE(refused.domain);
  ASSERT_EQ(refused.diagnostics.size(), 1u);
  EXPECT_EQ(refused.diagnostics.front().id, "E0219");
}

TEST(DomainErrors, WarnThatASingleFeatureTeachesNothing) {
  const auto diagnostics = parse_domain(testing::steps_domain("\"S.G\""), "t").diagnostics;
  EXPECT_EQ(places_of(diagnostics), "W0304 10:8");
  EXPECT_FALSE(has_errors(diagnostics));
}

TEST(DomainErrors, NameTheClashOfPriorAndWeights) {
  const std::string text = edited_text({"", {{"[reward]", "[prior]\nhalfspaces = [ { step = 1 } ]\n[reward]"}}, ""});
  EXPECT_EQ(parse_domain(text, "t").diagnostics.at(0).message,
            "the prior { step = 1 } contradicts the weights: (0,1) . (-2,-1) is negative");
}

TEST(DomainErrors, NameACycleInWords) {
  const std::string text = edited_text({"", {{"step = -1", "step = 1"}}, ""});
  const std::string message = parse_domain(text, "tiny.toml").diagnostics.at(0).message;
  EXPECT_TRUE(message.find("(1,1) right (2,1) left (1,1)") != std::string::npos ||
              message.find("(2,1) left (1,1) right (2,1)") != std::string::npos ||
              message.find("(2,1) right (3,1) left (2,1)") != std::string::npos ||
              message.find("(3,1) left (2,1) right (3,1)") != std::string::npos)
      << message;
  EXPECT_NE(message.find("in 2 of 2 worlds"), std::string::npos) << message;
}

TEST(DomainErrors, WarnWhereTheWeightsLieOnTheEdge) {
  const auto diagnostics = parse_domain(kSkateboard, "t").diagnostics;
  ASSERT_EQ(places_of(diagnostics).substr(0, 5), "W0302");
  EXPECT_TRUE(parse_domain(kColoredTiles, "t").diagnostics.empty());
}

// Both half-spaces hold at the weights, but only on a plane.
std::string flat_prior() {
  std::string text = kColoredTiles;
  return text.replace(text.find("{ step = -1 }"), 13, "{ a = 4, step = -26 }, { a = -4, step = 26 }");
}

TEST(DomainErrors, RefuseAPriorWithoutRoom) {
  const auto diagnostics = parse_domain(flat_prior(), "t").diagnostics;
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(diagnostics[0].id, "E0333");
  EXPECT_TRUE(diagnostics[0].infeasible);
  EXPECT_NE(diagnostics[0].message.find("(2,0,-13) and (-2,0,13)"), std::string::npos) << diagnostics[0].message;
}

// 500 x 400 cells, and a robot that carries things anywhere: 200 000^2 states.
std::string too_many_states() {
  std::string rows = "\"Sk" + std::string(497, '.') + "G\"";
  for (int i = 1; i < 400; ++i) rows += ",\n\"" + std::string(500, '.') + '"';
  return edited_text({"", {{"\"S.rG\"", rows}, {"\"#\" = \"wall\"", "\"k\" = { item = \"key\" }"}}, ""});
}

TEST(DomainErrors, RefuseMoreStatesThanCanBeBuilt) {
  const auto diagnostics = parse_domain(too_many_states(), "t").diagnostics;
  ASSERT_EQ(places_of(diagnostics).substr(0, 5), "E0219") << places_of(diagnostics);
}

TEST(DomainErrors, AreAllReportedAtOnce) {
  const std::string text = edited_text({"",
                                        {{"S.rG", "S.?G"},
                                         {"discount = 1.0", "discount = 2.0"},
                                         {"step = -1 }", "stop = -1 }"},
                                         {"\"action\"", "\"actoin\""}},
                                        ""});
  EXPECT_EQ(places_of(parse_domain(text, "t").diagnostics),
            "E0110 4:12, E0203 6:12, W0201 10:1, E0216 18:9, E0311 20:11, E0312 20:26");
}

TEST(DomainErrors, StopAtTwenty) {
  std::string text = kSound;
  for (int i = 0; i < 50; ++i) text.append("k").append(std::to_string(i)).append(" = 1\n");
  EXPECT_EQ(parse_domain(text, "t").diagnostics.size(), 20u);
}

TEST(LoadDomain, NamesTheKnownDomainsForAnUnknownOne) {
  try {
    (void)load_domain("item-delivry");
    FAIL() << "there is no such domain";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_EQ(error.diagnostics().at(0).id, "E0116");
    EXPECT_EQ(error.diagnostics().at(0).hint, "did you mean 'item-delivery'?");
  }
}

TEST(LoadDomain, ReadsAFileAndThrowsItsErrors) {
  const auto folder = std::filesystem::temp_directory_path();
  const auto path =
      folder / ("kith_domain_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + ".toml");
  std::ofstream{path} << kSound;
  EXPECT_EQ(load_domain(path.string()).id(), "tiny");
  std::ofstream{path} << edited_text({"", {{"S.rG", "S#rG"}}, ""});
  try {
    (void)load_domain(path.string());
    FAIL() << "the goal is behind a wall";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    EXPECT_EQ(error.diagnostics().at(0).file, path.string());
  }
  try {
    (void)load_domain(path.string().substr(0, path.string().size() - 5));
    FAIL() << "there is no file without its ending";
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).hint, "did you mean " + path.string() + "?");
  }
  std::filesystem::remove(path);
  EXPECT_THROW((void)read_domain(path), Error);
  EXPECT_THROW((void)read_domain(folder), Error);
}

}  // namespace
}  // namespace kith
