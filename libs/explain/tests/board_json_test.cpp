#include "kith/explain/board_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "domain_texts.hpp"
#include "item_delivery.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/curriculum_json.hpp"
#include "undrawn_cliff.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// Three columns and two rows; the rubble is in world 1 only.
Domain two_rows() { return parse_domain(testing::rubble_domain("\"S.r\", \"#.G\""), "two-rows.toml").domain.value(); }

const Domain& icy_crossing() {
  static const Domain kDomain = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  return kDomain;
}

Json parsed(const char* text) { return Json::parse(text); }

TEST(BoardJson, SaysWhatTheSymbolsMean) {
  const auto json = board_domain_json(two_rows());
  EXPECT_EQ(json.at("id"), "rubble");
  EXPECT_EQ(json.at("width"), 3);
  EXPECT_EQ(json.at("height"), 2);
  EXPECT_EQ(json.at("legend"), parsed(R"([
      {"symbol": "#", "kind": "wall", "name": "wall", "parts": [{"kind": "wall", "name": "wall"}]},
      {"symbol": "r", "kind": "terrain", "name": "rubble", "parts": [{"kind": "terrain", "name": "rubble"}]},
      {"symbol": "S", "kind": "start", "name": "start", "parts": [{"kind": "start", "name": "start"}]},
      {"symbol": "G", "kind": "goal", "name": "goal", "parts": [{"kind": "goal", "name": "goal"}]}])"));
  EXPECT_EQ(json.at("features").at(0).at("weight"), -3.0);
}

TEST(BoardJson, NamesAllThatOneSymbolPutsOnACell) {
  const auto json = board_domain_json(item_delivery().domain());
  std::map<std::string, Json> parts;
  for (const auto& entry : json.at("legend")) {
    EXPECT_EQ(entry.at("kind"), entry.at("parts").at(0).at("kind"));
    EXPECT_EQ(entry.at("name"), entry.at("parts").at(0).at("name"));
    parts[entry.at("symbol")] = entry.at("parts");
  }
  EXPECT_EQ(parts.size(), 5u);  // floor is left out
  EXPECT_EQ(parts.at("S"), parsed(R"([{"kind": "start", "name": "start"}, {"kind": "item", "name": "parcel"}])"));
  EXPECT_EQ(parts.at("G"), parsed(R"([{"kind": "destination", "name": "destination of parcel"}])"));
  EXPECT_EQ(parts.at("B"), parsed(R"([{"kind": "station", "name": "charger"}])"));
}

// Row 1 is on top, as in the map.
TEST(BoardJson, DrawsTheMapOfOneWorldAndItsStart) {
  const auto domain = two_rows();
  const auto start = domain.initial_state(MdpIndex{1});
  const auto with_rubble = board_json(domain, {MdpIndex{1}, start});
  EXPECT_EQ(with_rubble, parsed(R"({"world": 1, "map": ["S.r", "#.G"],
                                    "start": {"robot": [1, 1], "items": [], "stations": []}})"));
  EXPECT_EQ(board_json(domain, {MdpIndex{0}, start}).at("map"), parsed(R"(["S..", "#.G"])"));
}

TEST(BoardJson, SaysWhereItemsAndStationsAre) {
  const auto& domain = item_delivery().domain();
  const auto start = board_json(domain, {MdpIndex{63}, domain.initial_state(MdpIndex{63})}).at("start");
  EXPECT_EQ(start, parsed(R"({"robot": [4, 3], "items": [{"name": "parcel", "cell": [4, 3], "carried": false}],
                              "stations": [[4, 1]]})"));
}

// right, down, right is as short as around the rubble gets.
TEST(BoardJson, GivesAFrameForEveryStateOfAPath) {
  const Atlas atlas{two_rows()};
  const MdpIndex world{1};
  const auto path = atlas.trajectory(atlas.index({world, atlas.domain().initial_state(world)}));
  const auto frames = frames_json(atlas.domain(), world, path);
  std::vector<Json> robots, actions;
  for (const auto& frame : frames) {
    robots.push_back(frame.at("robot"));
    actions.push_back(frame.at("action"));
  }
  EXPECT_EQ(Json(robots), parsed("[[1, 1], [2, 1], [2, 2], [3, 2]]"));
  for (std::size_t t = 0; t + 1 < frames.size(); ++t) EXPECT_EQ(frames.at(t).at("counts"), parsed("[0, 1]"));
  EXPECT_EQ(Json(actions), parsed(R"(["right", "down", "right", null])"));
  EXPECT_EQ(step_json(atlas.domain(), world, path, 2), parsed(R"({"frame": 2, "cell": [2, 2]})"));
}

TEST(BoardJson, LeavesOutMapsWhereThereAreNone) {
  const auto domain = testing::undrawn_cliff();
  const auto described = board_domain_json(domain);
  for (const auto* key : {"legend", "width", "height"}) EXPECT_FALSE(described.contains(key)) << key;
  const MdpIndex world{0};
  const auto start = domain.initial_state(world);
  const auto board = board_json(domain, {world, start});
  EXPECT_FALSE(board.contains("map"));
  EXPECT_EQ(board.at("start"), Json({{"state", domain.state_name(world, start)}}));
  const Trajectory nowhere{{start}, {}};
  EXPECT_EQ(step_json(domain, world, nowhere, 0), parsed(R"({"frame": 0})"));
}

TEST(BoardJson, DrawsModelsThatHaveAPicture) {
  const auto& domain = icy_crossing();
  EXPECT_EQ(board_domain_json(domain).at("width"), 6);
  const auto board = board_json(domain, {MdpIndex{0}, domain.initial_state(MdpIndex{0})});
  EXPECT_EQ(board.at("map"), parsed(R"([".~~~~H", ".~o~o.", "......"])"));
  EXPECT_EQ(board.at("world_name"), "firm ice");  // the picture does not tell how slippery it is
  EXPECT_EQ(board.at("start"), parsed(R"({"robot": [1, 1], "items": [], "stations": []})"));
  EXPECT_FALSE(board.contains("fences"));
}

TEST(BoardJson, PlacesWhatStatesPlace) {
  const auto domain = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/gallery/taxi.toml");
  const MdpIndex world{0};
  const auto board = board_json(domain, {world, domain.initial_state(world)});
  EXPECT_EQ(board.at("fences").size(), 6u);
  EXPECT_EQ(board.at("fences").at(0), parsed("[[2, 1], [3, 1]]"));
  EXPECT_EQ(board.at("start").at("items"), parsed(R"([{"name": "passenger", "cell": [1, 1], "carried": false},
                       {"name": "destination of passenger", "cell": [4, 5], "carried": false}])"));
}

TEST(BoardJson, PutsConstraintsIntoSentences) {
  const auto sentences = sentences_json(item_delivery().domain(), item_delivery().policy_bec_half_spaces());
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_EQ(sentences.at(0).at("normal"), parsed("[-1, 0, 2]"));
  for (const auto& sentence : sentences) EXPECT_FALSE(sentence.at("text").get<std::string>().empty());
}

// --- lessons ----------------------------------------------------------------------

// A frame without what is done in it.
Json look_of(Json frame) {
  frame.erase("action");
  frame.erase("counts");
  return frame;
}

void expect_whole_demonstration(const Json& shown) {
  const auto& robot = shown.at("frames");
  const auto& other = shown.at("alternative").at("frames");
  const auto decisive = shown.at("decisive").at("frame").get<std::size_t>();
  EXPECT_EQ(look_of(robot.at(0)), shown.at("start"));
  ASSERT_LT(decisive + 1, robot.size());
  EXPECT_EQ(shown.at("decisive").at("cell"), robot.at(decisive).at("robot"));
  for (std::size_t t = 0; t < decisive; ++t) EXPECT_EQ(robot.at(t), other.at(t)) << "before they separate";
  EXPECT_EQ(look_of(robot.at(decisive)), look_of(other.at(decisive)));
  EXPECT_NE(robot.at(decisive).at("action"), other.at(decisive).at("action"));
  EXPECT_TRUE(robot.back().at("action").is_null());
  EXPECT_FALSE(shown.at("reason").get<std::string>().empty());
  EXPECT_FALSE(shown.at("conveys").empty());
}

TEST(CurriculumJson, HasAllThatThePageShows) {
  const auto& atlas = item_delivery();
  const auto curriculum = make_curriculum(atlas);
  const auto json = curriculum_json(atlas, curriculum, 7, "kith test");
  EXPECT_EQ(json.at("schema"), "kith.curriculum/1");
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_EQ(json.at("program"), "kith test");
  EXPECT_EQ(json.at("domain"), board_domain_json(atlas.domain()));
  ASSERT_EQ(json.at("components").size(), curriculum.components.size());
  EXPECT_EQ(json.at("skipped").size(), curriculum.skipped.size());
  for (std::size_t i = 0; i < curriculum.components.size(); ++i) {
    const auto& component = json.at("components").at(i);
    EXPECT_EQ(component.at("number"), i + 1);
    EXPECT_EQ(component.at("sentences").size(), curriculum.components[i].constraints.size());
    ASSERT_FALSE(component.at("demonstrations").empty());
    for (const auto& shown : component.at("demonstrations")) expect_whole_demonstration(shown);
    ASSERT_FALSE(component.at("tests").empty());
    for (const auto& test : component.at("tests")) {
      EXPECT_EQ(look_of(test.at("frames").at(0)), test.at("start"));
      EXPECT_GE(test.at("share_right").get<double>(), 0.0);
      EXPECT_LE(test.at("share_right").get<double>(), 1.0);
      EXPECT_FALSE(test.at("covers").empty());
      EXPECT_TRUE(test.at("runs").is_null());
    }
  }
}

TEST(CurriculumJson, SaysHowMuchOfTheRobotIsExplained) {
  auto text = testing::rubble_domain("\"S.r\", \"#.G\"");
  const auto explained = [&] {
    const Atlas atlas{parse_domain(text, "two-rows.toml").domain.value()};
    return curriculum_json(atlas, make_curriculum(atlas), 1, "kith test").value("explained", "");
  };
  EXPECT_EQ(explained(), "");
  text += "\n[inferred]\nshare = 0.965\n";
  EXPECT_EQ(explained(), "What it likes and dislikes explains 96 % of what it does. Only that is shown here.");
}

TEST(CurriculumJson, HasActionsInPlaceOfFramesForPages) {
  const auto& atlas = item_delivery();
  const auto whole = curriculum_json(atlas, make_curriculum(atlas), 7, "kith test");
  const auto page = for_page(whole);
  EXPECT_LT(2 * page.at("components").dump().size(), whole.at("components").dump().size());
  const auto& moves = page.at("tables").at("moves");
  for (std::size_t i = 0; i < page.at("components").size(); ++i) {
    const auto& shown = page.at("components").at(i).at("demonstrations").at(0);
    const auto& frames = whole.at("components").at(i).at("demonstrations").at(0).at("frames");
    const auto& world = page.at("tables").at("worlds").at(std::to_string(shown.at("world").get<int>()));
    const auto& table = moves.at(world.at("moves").get<std::size_t>());
    auto state = shown.at("state").get<std::size_t>();
    ASSERT_EQ(shown.at("actions").size() + 1, frames.size());
    for (std::size_t t = 0; t < shown.at("actions").size(); ++t) {
      const auto& robot = frames.at(t).at("robot");
      EXPECT_EQ(table.at("frames").at(state).at(0), robot.at(0));
      EXPECT_EQ(table.at("frames").at(state).at(1), robot.at(1));
      std::size_t a = 0;
      while (table.at("actions").at(a).at("name") != shown.at("actions").at(t)) ++a;
      state = table.at("next").at(state).at(a).get<std::size_t>();
    }
    EXPECT_TRUE(table.at("end").at(state).get<bool>());
  }
}

TEST(CurriculumJson, HasRunsWhereChanceHasAPart) {
  const Atlas atlas{load_domain(std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml")};
  const auto json = curriculum_json(atlas, make_curriculum(atlas), 7, "kith test");
  for (const auto& shown : json.at("components").at(0).at("demonstrations")) {
    const auto& runs = shown.at("runs");
    EXPECT_NE(runs.at("text").get<std::string>().find("10 runs"), std::string::npos);
    ASSERT_EQ(runs.at("runs").size(), 5u);
    for (const auto& run : runs.at("runs")) {
      EXPECT_EQ(look_of(run.at("frames").at(0)), shown.at("start"));
      EXPECT_TRUE(run.at("ended").is_boolean());
    }
  }
}

}  // namespace
}  // namespace kith
