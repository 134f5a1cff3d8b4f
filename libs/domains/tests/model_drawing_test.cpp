// An explicit model with a picture: where the robot and other things are drawn, and what a picture does not change.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models_under_test.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using Rows = std::vector<std::string>;

GridMap picture_of(const Domain& domain) { return domain.drawing().value(); }

TEST(ModelDrawing, PlacesTheRobotAndThingsAsStatesSay) {
  const Domain domain = sound_model(kIceDrawn);
  const GridMap picture = picture_of(domain);
  EXPECT_TRUE(picture.is_picture());
  EXPECT_EQ(picture.width(), 4);
  EXPECT_THAT(picture.item_names(), ElementsAre("dog"));
  const GridState bank = picture.state(kFirst, StateIndex{0});
  EXPECT_EQ(bank.robot, (Cell{1, 1}));
  EXPECT_THAT(bank.items, ElementsAre(Cell{3, 1}));
  const GridState ice = picture.state(kFirst, StateIndex{1});
  EXPECT_THAT(ice.carried, ElementsAre(true));
  EXPECT_THAT(ice.items, ElementsAre(Cell{2, 1})) << "what is carried is where the robot is";
  EXPECT_THAT(picture.draw(kFirst, std::nullopt), ElementsAre(".~G#"));
  EXPECT_THAT(picture.draw(kFirst, StateIndex{0}), ElementsAre("@~D#"));
}

TEST(ModelDrawing, FindsTheStateThatLooksSo) {
  const Domain domain = sound_model(kIceDrawn);
  const GridMap picture = picture_of(domain);
  for (const std::size_t s : {0U, 1U, 2U}) {
    EXPECT_EQ(picture.find_state(kFirst, picture.state(kFirst, StateIndex{s})), StateIndex{s});
  }
  GridState elsewhere = picture.state(kFirst, StateIndex{0});
  elsewhere.items = {Cell{1, 1}};
  EXPECT_FALSE(picture.find_state(kFirst, elsewhere));
  elsewhere.robot = {9, 9};
  EXPECT_FALSE(picture.find_state(kFirst, elsewhere));
}

TEST(ModelDrawing, ChangesNothingElse) {
  auto texts = kIceDrawn;
  texts["domain.toml"] = kIceCsv.at("domain.toml");
  const Domain plain = sound_model(texts);
  const Domain drawn = sound_model(kIceDrawn);
  EXPECT_FALSE(plain.drawing());
  EXPECT_FALSE(drawn.map());
  EXPECT_EQ(drawn.state_name(kFirst, StateIndex{1}), "on the ice");
  EXPECT_EQ(plain.num_starts(), drawn.num_starts());
  EXPECT_EQ(plain.dissimilarity({kFirst, StateIndex{0}}, {kFirst, StateIndex{1}}),
            drawn.dissimilarity({kFirst, StateIndex{0}}, {kFirst, StateIndex{1}}));
}

TEST(ModelDrawing, NumberedStatesDrawThemselves) {
  const Domain cliff = load_domain(std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml");
  const GridMap picture = picture_of(cliff);
  EXPECT_EQ(picture.width(), 12);
  EXPECT_THAT(picture.draw(kFirst, std::nullopt),
              ElementsAre("............", "............", "............", "...........E"));
  const auto start = cliff.initial_state(kFirst);  // number 36, at the left of the lowest row
  EXPECT_EQ(picture.state(kFirst, start).robot, (Cell{1, 1}));
}

TEST(ModelDrawing, OfAMapIsTheMap) {
  const Domain domain = load_domain("item-delivery");
  const GridMap picture = picture_of(domain);
  EXPECT_FALSE(picture.is_picture());
  EXPECT_TRUE(picture.fences(kFirst).empty());
}

Domain taxi() { return load_domain(std::string{KITH_SOURCE_DIR} + "/domains/gallery/taxi.toml"); }

TEST(ModelDrawing, DrawsWallsWhereNoActionLeadsToTheNextCell) {
  const Domain domain = taxi();
  const std::vector<std::pair<Cell, Cell>> walls = picture_of(domain).fences(kFirst);
  // Columns and rows from the top left: between 2 and 3 in rows 1 and 2, 1 and 2 and 3 and 4 in rows 4 and 5.
  EXPECT_THAT(walls, ElementsAre(std::pair{Cell{2, 5}, Cell{3, 5}}, std::pair{Cell{2, 4}, Cell{3, 4}},
                                 std::pair{Cell{1, 2}, Cell{2, 2}}, std::pair{Cell{3, 2}, Cell{4, 2}},
                                 std::pair{Cell{1, 1}, Cell{2, 1}}, std::pair{Cell{3, 1}, Cell{4, 1}}));
}

TEST(ModelDrawing, LeavesOutWallsOnRequest) {
  EXPECT_EQ(picture_of(sound_model(kIceDrawn)).fences(kFirst).size(), 0U);
  const auto stuck = edited(edited(kIceDrawn, "transitions.csv", "bank,go,ice,1,0,1", "bank,go,shore,1,0,1"),
                            "transitions.csv", "ice,go,bank,0.25,1,1", "ice,go,ice,0.25,1,1");
  EXPECT_EQ(picture_of(sound_model(stuck)).fences(kFirst).size(), 1U);
  const auto open = edited(stuck, "domain.toml", "origin", "walls = false\norigin");
  EXPECT_EQ(picture_of(sound_model(open)).fences(kFirst).size(), 0U);
}

TEST(ModelDrawing, ShowsWhatIsOptionalInTheMdpOfThatName) {
  const Domain domain = taxi();
  const GridMap picture = picture_of(domain);
  EXPECT_EQ(picture.draw(kFirst, std::nullopt), (Rows{"R...G", ".....", ".....", ".....", "Y..B."}));
  EXPECT_EQ(picture.draw(MdpIndex{1}, std::nullopt), (Rows{"R...G", "b....", "...t.", ".....", "Y..B."}));
  EXPECT_THAT(picture.item_names(), ElementsAre("passenger", "destination of passenger"));
}

TEST(ModelDrawing, SaysNothingOfStatesThatAreAlikeInAllThatMatters) {
  const auto reading = read_domain(std::string{KITH_SOURCE_DIR} + "/domains/gallery/cliff_walking.toml");
  EXPECT_TRUE(reading.diagnostics.empty());  // the start, and the start after a fall
}

}  // namespace
}  // namespace kith
