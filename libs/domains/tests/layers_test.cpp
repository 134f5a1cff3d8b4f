// Maps of several layers, from images and occupancy grids; rasters; worlds that are listed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "layered_domains.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::layered::all_of;
using testing::layered::domain_text;
using testing::layered::files_with;
using testing::layered::kLegend;
using testing::layered::read;

Domain sound(const std::string& text, const std::map<std::string, std::string>& files = files_with()) {
  auto reading = read(text, files);
  if (!reading.domain) throw std::runtime_error{all_of(reading)};
  return *std::move(reading.domain);
}

std::vector<std::string> picture(const Domain& domain, std::size_t m = 0) {
  return domain.map()->draw(MdpIndex{m}, std::nullopt);
}

// What the robot counts of feature 0 for the first action that leads from cell to cell.
double count_between(const Domain& domain, std::size_t m, Cell from, Cell to) {
  const Mdp& mdp = domain.mdp(MdpIndex{m});
  for (std::size_t s = 0; s < mdp.num_states(); ++s) {
    if (domain.map()->state(MdpIndex{m}, StateIndex{s}).robot != from) continue;
    for (const Choice& choice : mdp.choices(StateIndex{s})) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      if (domain.map()->state(MdpIndex{m}, outcome.next).robot == to) return mdp.features(outcome)[0];
    }
  }
  ADD_FAILURE() << "no such transition";
  return -1.0;
}

// --- layers ---

TEST(Layers, PutTwoThingsThatAreOptionalByThemselvesOnOneCell) {
  const auto domain = sound(
      domain_text("rows = [\"S.rG\"]\n" + kLegend + "[[map.layer]]\nrows = [\"m\"]\nat = [3, 1]\noptional = \"fire\"\n",
                  "leave:rubble & leave:smoke"));
  ASSERT_EQ(domain.num_mdps(), 4u);
  const Cell third{3, 1};
  const Cell goal{4, 1};
  EXPECT_EQ(count_between(domain, 0, third, goal), 0.0);
  EXPECT_EQ(count_between(domain, 1, third, goal), 0.0);
  EXPECT_EQ(count_between(domain, 2, third, goal), 0.0);
  EXPECT_EQ(count_between(domain, 3, third, goal), 1.0);
  EXPECT_EQ(picture(domain, 1), std::vector<std::string>{"S.mG"});
  EXPECT_EQ(picture(domain, 2), std::vector<std::string>{"S.rG"});
  EXPECT_EQ(domain.map()->content(MdpIndex{3}, third).terrain, "rubble and smoke");
  const char both = picture(domain, 3)[0][2];
  bool is_in_legend = false;
  for (const LegendEntry& entry : domain.map()->legend()) {
    is_in_legend = is_in_legend || (entry.symbol == both && entry.content.terrain == "rubble and smoke");
  }
  EXPECT_TRUE(is_in_legend) << both;
}

TEST(Layers, LetGroupsOverlap) {
  const auto domain = sound(domain_text("rows = [\"S...G\"]\n" + kLegend +
                                            "[[map.layer]]\nrows = [\"mm\"]\nat = [2, 1]\noptional = \"a\"\n"
                                            "[[map.layer]]\nrows = [\"mm\"]\nat = [3, 1]\noptional = \"b\"\n",
                                        "leave:smoke"));
  ASSERT_EQ(domain.num_mdps(), 4u);
  EXPECT_EQ(picture(domain, 0), std::vector<std::string>{"S...G"});
  EXPECT_EQ(picture(domain, 1), std::vector<std::string>{"S.mmG"});
  EXPECT_EQ(picture(domain, 2), std::vector<std::string>{"Smm.G"});
  EXPECT_EQ(picture(domain, 3), std::vector<std::string>{"SmmmG"});
}

TEST(Layers, DrawWorldsWithStartsAndWallsOfTheirOwn) {
  const std::string map = "rows = [\".....\", \"....G\"]\n" + kLegend +
                          "[[map.layer]]\nrows = [\"S#\", \" m\"]\noptional = \"west\"\n"
                          "[[map.layer]]\nrows = [\"  S\"]\nat = [3, 1]\noptional = \"east\"\n";
  const std::string worlds =
      "[[family.world]]\nname = \"from the west\"\npresent = [\"west\"]\n[[family.world]]\npresent = [\"east\"]\n";
  auto reading = read(domain_text(map, "leave:smoke", "") + worlds);
  ASSERT_TRUE(reading.domain) << all_of(reading);
  const auto& domain = *reading.domain;
  ASSERT_EQ(domain.num_mdps(), 2u);
  EXPECT_THAT(picture(domain, 0), ElementsAre("S#...", ".m..G"));
  EXPECT_THAT(picture(domain, 1), ElementsAre("....S", "....G"));
  EXPECT_EQ(domain.map()->state(MdpIndex{1}, domain.initial_state(MdpIndex{1})).robot, (Cell{5, 2}));
  EXPECT_EQ(domain.mdp(MdpIndex{0}).num_states(), 8u) << "ten cells without wall and goal";
  EXPECT_THAT(domain.describe_world(MdpIndex{0}), HasSubstr("from the west: "));
  EXPECT_EQ(domain.world_name(MdpIndex{0}), "from the west");
  EXPECT_EQ(domain.world_name(MdpIndex{1}), "");
  EXPECT_EQ(domain.find_world("From the West"), MdpIndex{0});
  EXPECT_EQ(domain.find_world("1"), MdpIndex{1});
  for (const auto* nowhere : {"", "2", "from the east"})
    EXPECT_FALSE(domain.find_world(nowhere).has_value()) << nowhere;
}

TEST(Layers, NameSingleThingsInListedWorlds) {
  const auto domain =
      sound(domain_text("rows = [\"SrrrG\"]\n" + kLegend, "leave:rubble") +
                "[[family.world]]\npresent = [\"rubble(3,1)\"]\n[[family.world]]\npresent = [\"rubble\"]\n",
            {});
  ASSERT_EQ(domain.num_mdps(), 2u);
  EXPECT_EQ(domain.present_things(MdpIndex{0}), (std::vector<bool>{false, true, false}));
  EXPECT_EQ(domain.present_things(MdpIndex{1}), (std::vector<bool>{true, true, true}));
}

TEST(Layers, LetTheRobotStartWithAnItem) {
  const std::string legend =
      "[map.legend]\n\".\" = \"floor\"\n\"m\" = { terrain = \"smoke\" }\n\"S\" = { start = true, "
      "item = \"box\", carried = true }\n\"G\" = { destination = \"box\" }\n";
  const auto domain = sound(domain_text("rows = [\"SmG\"]\n" + legend, "carrying:box & leave:smoke"));
  const auto state = domain.map()->state(MdpIndex{0}, domain.initial_state(MdpIndex{0}));
  EXPECT_THAT(state.carried, ElementsAre(true));
  EXPECT_EQ(count_between(domain, 0, {2, 1}, {3, 1}), 1.0);
}

TEST(Layers, CountNothingForThingsThatAreDeclaredAbsent) {
  const auto domain =
      sound(domain_text("absent = [\"board\", \"ice\"]\nrows = [\"S.G\"]\n[map.legend]\n\".\" = "
                        "\"floor\"\n\"S\" = { start = true }\n\"G\" = { goal = true }\n",
                        "carrying:board | leave:ice | deliver:board | action:pickup"));
  EXPECT_FALSE(domain.mdp(MdpIndex{0}).has_feature(0));
  EXPECT_EQ(count_between(domain, 0, {1, 1}, {2, 1}), 0.0);
}

// --- images ---

TEST(Images, MakeWallsOfAnOccupancyGrid) {
  const std::string map = "occupancy = \"floor.yaml\"\n" + kLegend + "[[map.layer]]\nrows = [\"S m \", \"   G\"]\n";
  EXPECT_THAT(read(domain_text(map, "leave:smoke")).diagnostics.at(0).id, "W0201") << "no rubble";
  const auto reading = read(domain_text(map, "leave:smoke"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  EXPECT_THAT(picture(*reading.domain), ElementsAre("S.m.", "###G")) << "what is unknown is a wall";
  const auto open = read(domain_text("unknown = \"floor\"\n" + map, "leave:smoke"));
  ASSERT_TRUE(open.domain) << all_of(open);
  EXPECT_THAT(picture(*open.domain), ElementsAre("S.m.", "#.#G"));
  EXPECT_EQ(reading.files.size(), 2u) << "a study keeps copies of them";
}

TEST(Images, ApplyThresholdsAndNegation) {
  // White is 10: the cells are black, white, in between, nearly black.
  const std::string grey = "P2 4 1 10 0 10 5 1";
  const auto drawn = [&](const std::string& negate, const std::string& things) {
    const std::string yaml = "image: floor.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: " + negate +
                             "\noccupied_thresh: 0.7\nfree_thresh: 0.3\nmode: trinary\n";
    return picture(sound(domain_text("occupancy = \"floor.yaml\"\nunknown = \"floor\"\n" + kLegend +
                                         "[[map.layer]]\nrows = [\"" + things + "\"]\n",
                                     "goal"),
                         files_with({{"floor.yaml", yaml}, {"floor.pgm", grey}})));
  };
  EXPECT_THAT(drawn("0", " GS "), ElementsAre("#GS#"));
  EXPECT_THAT(drawn("1", "  SG"), ElementsAre(".#SG"));
}

// The form in which pages get the table of a grid.
TEST(Images, TakeTheTableOfAGridAsJson) {
  const auto text =
      domain_text("occupancy = \"floor.yaml\"\n" + kLegend + "[[map.layer]]\nrows = [\"S mG\"]\n", "leave:smoke");
  const std::string json = R"({"free_thresh":"0.196","image":"floor.pgm","negate":"0","occupied_thresh":"0.65",)"
                           R"("origin":["-1.0","-1.0","0.0"],"resolution":"0.05"})";
  EXPECT_EQ(picture(sound(text, files_with({{"floor.yaml", json}}))), picture(sound(text)));
}

TEST(Images, AreReadAsWindowsCamerasAndPythonWriteThem) {
  const std::string yaml =
      "\xEF\xBB\xBFimage: MAP.PGM\r\nresolution: 1\r\norigin: [0, 0, 0]\r\nnegate: False\r\noccupied_thresh: 0.65\r\n"
      "free_thresh: 0.196\r\nmode: Trinary\r\nmap_id: ground\r\n";
  const std::string pixels{"\xFE\xFE\xFE\xFE\0\xFE\xFE\xFE", 8};
  for (const std::string header : {"P5\n4 2\n255\n", "P5\r\n4 2\r\n255\r\n"}) {
    for (const std::string end : {"", "\n"}) {
      if (header.ends_with("\r\n") && !end.empty()) continue;  // which of the two is the pixel nobody can tell
      const auto reading =
          read(domain_text("occupancy = \"floor.yaml\"\n" + kLegend + "[[map.layer]]\nrows = [\"S m \", \"   G\"]\n",
                           "leave:smoke"),
               files_with({{"floor.yaml", yaml}, {"MAP.PGM", header + pixels + end}}));
      ASSERT_TRUE(reading.domain) << all_of(reading);
      EXPECT_THAT(picture(*reading.domain), ElementsAre("S.m.", "#..G"));
    }
  }
}

TEST(Images, TakeTheWorstOfThePixelsOfACell) {
  const std::string grey = "P2 6 3 255 254 254 254 254 0 254 254 254 254 254 254 254 254 254 254 254 254 254";
  const auto reading = read(domain_text("occupancy = \"floor.yaml\"\npixels_per_cell = 2\n" + kLegend +
                                            "[[map.layer]]\nrows = [\"S  \", \" mG\"]\n",
                                        "leave:smoke"),
                            files_with({{"floor.pgm", grey}}));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  EXPECT_THAT(picture(*reading.domain), ElementsAre("S.#", ".mG"));
}

TEST(Images, PaintZonesByGrey) {
  const std::string map = "rows = [\"S...\", \"...G\"]\n" + kLegend +
                          "[[map.layer]]\nimage = \"zones.pgm\"\ngrey = { 64 = \"m\", 128 = \"#\" }\n";
  const auto reading = read(domain_text(map, "leave:smoke"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  EXPECT_THAT(picture(*reading.domain), ElementsAre("Sm#.", "...G"));
}

TEST(Images, AreKeptAsText) {
  const auto reading = read(
      domain_text("rows = [\"S..G\", \"....\"]\n" + kLegend + "[[map.raster]]\nname = \"heat\"\nimage = \"heat.pgm\"\n",
                  "enter:heat"));
  ASSERT_EQ(reading.files.size(), 1u) << all_of(reading);
  EXPECT_EQ(reading.files[0].name, "heat.pgm");
  EXPECT_EQ(reading.files[0].text, "P2\n4 2\n255\n255 128 0 255\n255 255 255 255\n");
}

// --- rasters ---

const std::string kRoom = "rows = [\"S....\", \".##..\", \"m#..G\"]\n" + kLegend;

TEST(Rasters, CoverCellsNearThings) {
  const auto reading = read(domain_text(kRoom + "[[map.raster]]\nname = \"hot\"\nnear = \"smoke\"\nwithin = 1\n"
                                                "symbol = \"h\"\n",
                                        "enter:hot"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  const auto& domain = *reading.domain;
  EXPECT_EQ(count_between(domain, 0, {1, 3}, {1, 2}), 1.0);
  EXPECT_EQ(count_between(domain, 0, {1, 2}, {1, 3}), 0.0);
  EXPECT_EQ(count_between(domain, 0, {1, 2}, {1, 1}), 1.0) << "the thing itself";
  EXPECT_EQ(picture(domain)[1], "h##..");
  EXPECT_EQ(domain.map()->content(MdpIndex{0}, {1, 1}).terrain, "smoke and hot");
}

TEST(Rasters, CountStepsAroundWalls) {
  const auto reading = read(domain_text(kRoom + "[[map.raster]]\nname = \"way\"\ndistance_to = \"smoke\"\nmost = 6\n",
                                        "action", "times = \"way\"\n"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  const auto& domain = *reading.domain;
  EXPECT_EQ(count_between(domain, 0, {1, 2}, {1, 1}), 0.0);
  EXPECT_EQ(count_between(domain, 0, {1, 3}, {2, 3}), 3.0);
  EXPECT_EQ(count_between(domain, 0, {4, 3}, {4, 2}), 6.0);
  EXPECT_EQ(count_between(domain, 0, {4, 2}, {4, 1}), 6.0) << "seven, but at most six are told apart";
  EXPECT_TRUE(domain.is_exact());
}

TEST(Rasters, LookAlongStraightLines) {
  const auto reading =
      read(domain_text(kRoom + "[[map.raster]]\nname = \"view\"\nseen_from = \"smoke\"\nwithin = 9\n", "enter:view"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  const auto& domain = *reading.domain;
  EXPECT_EQ(count_between(domain, 0, {2, 3}, {1, 3}), 1.0);
  EXPECT_EQ(count_between(domain, 0, {1, 3}, {2, 3}), 0.0) << "behind the walls";
}

TEST(Rasters, FollowWhatIsThereInEachWorld) {
  const auto reading = read(domain_text(
      "rows = [\"S.rG\"]\n" + kLegend + "[[map.raster]]\nname = \"close\"\nnear = [\"rubble\"]\nwithin = 1\n",
      "enter:close"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  EXPECT_EQ(count_between(*reading.domain, 0, {1, 1}, {2, 1}), 0.0);
  EXPECT_EQ(count_between(*reading.domain, 1, {1, 1}, {2, 1}), 1.0);
}

TEST(Rasters, ReadGreyAsLevels) {
  const auto reading = read(domain_text("rows = [\"S..G\", \"....\"]\n" + kLegend +
                                            "[[map.raster]]\nname = \"heat\"\nimage = \"heat.pgm\"\nlevels = 10\n",
                                        "action", "times = \"heat\"\n"));
  ASSERT_TRUE(reading.domain) << all_of(reading);
  EXPECT_EQ(count_between(*reading.domain, 0, {1, 2}, {2, 2}), 5.0);
  EXPECT_EQ(count_between(*reading.domain, 0, {2, 2}, {3, 2}), 10.0);
  EXPECT_EQ(count_between(*reading.domain, 0, {3, 2}, {4, 2}), 0.0);
}

}  // namespace
}  // namespace kith
