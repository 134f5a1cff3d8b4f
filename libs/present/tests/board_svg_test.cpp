#include "kith/present/board_svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "domain_texts.hpp"
#include "item_delivery.hpp"
#include "kith/present/inspect_svg.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::item_delivery;
using ::testing::Not;

Domain rubble(const std::string& rows) {
  return parse_domain(testing::rubble_domain(rows), "rubble.toml").domain.value();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

std::string markup(const Svg& svg) { return svg.file(100, 100, "title"); }

// Every element is closed, in order.
void expect_well_formed(const std::string& text) {
  std::vector<std::string> open;
  for (auto at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const auto end = text.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const auto tag = text.substr(at + 1, end - at - 1);
    if (tag.back() == '/') continue;
    const auto name = tag.substr(0, tag.find(' '));
    if (name.front() != '/') {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << tag;
    EXPECT_EQ("/" + open.back(), name);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

// --- elements ---------------------------------------------------------------------

TEST(Svg, WritesNumbersWithAtMostTwoDigitsBehindThePoint) {
  EXPECT_EQ(svg_number(2.0), "2");
  EXPECT_EQ(svg_number(1.50), "1.5");
  EXPECT_EQ(svg_number(0.126), "0.13");
  EXPECT_EQ(svg_number(-0.001), "0");
  EXPECT_EQ(svg_number(-3.25), "-3.25");
  EXPECT_EQ(svg_number(100.0), "100");
}

TEST(Svg, KeepsTextText) {
  EXPECT_EQ(svg_escaped(R"(a < b & "c" > d)"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  Svg svg;
  svg.text(1, 2, "</text><script>", {{"class", "\"x\""}});
  const auto file = svg.file(10, 20, "<title>");
  expect_well_formed(file);
  EXPECT_THAT(file, Not(HasSubstr("<script>")));
  EXPECT_THAT(file, HasSubstr("<title>&lt;title&gt;</title>"));
  EXPECT_THAT(file, HasSubstr(R"(width="10" height="20" viewBox="0 0 10 20")"));
}

TEST(Svg, PutsOneDrawingIntoAnother) {
  Svg inner, outer;
  inner.add("circle", {{"r", "3"}});
  outer.add(5.5, 6, inner);
  EXPECT_THAT(markup(outer), HasSubstr("<g transform=\"translate(5.5 6)\">\n<circle r=\"3\"/>\n</g>"));
}

// --- boards -----------------------------------------------------------------------

TEST(BoardSvg, GrowsByTheSizeOfACell) {
  const auto small = rubble("\"S.G\"");
  const auto large = rubble("\"S..G\", \"r...\"");
  const BoardSvg a{*small.map()};
  const BoardSvg b{*large.map()};
  EXPECT_EQ(b.width() - a.width(), 40.0);
  EXPECT_EQ(b.height() - a.height(), 40.0);
}

TEST(BoardSvg, DrawsWhatIsThere) {
  const auto domain = rubble("\"S.r\", \"##G\"");
  const auto map = *domain.map();
  const BoardSvg boards{map};
  const auto board = [&](std::size_t m, bool bare) {
    return markup(boards.board(MdpIndex{m}, map.state(MdpIndex{m}, domain.initial_state(MdpIndex{m})), bare));
  };
  expect_well_formed(board(1, false));
  EXPECT_EQ(count(board(1, false), "#3c444d"), 2u) << "walls";
  EXPECT_EQ(count(board(1, false), "#e9dcc9"), 1u) << "rubble";
  EXPECT_EQ(count(board(0, false), "#e9dcc9"), 0u) << "no rubble in world 0";
  EXPECT_GT(count(board(1, false), "#1c2127"), count(board(1, true), "#1c2127")) << "the robot";
  // Numbers of columns and rows.
  for (const auto* number : {">1<", ">2<"}) EXPECT_EQ(count(board(1, true), number), 2u) << number;
  EXPECT_EQ(count(board(1, true), ">3<"), 1u);
}

TEST(BoardSvg, DrawsAnArrowPerMoveAndARingWhereTheRobotStays) {
  const auto& atlas = item_delivery();
  const MdpIndex world{0};
  const auto map = *atlas.domain().map();
  const auto path = atlas.trajectory(atlas.index({world, atlas.domain().initial_state(world)}));
  std::size_t moves = 0;
  for (std::size_t t = 0; t + 1 < path.states.size(); ++t) {
    moves += map.state(world, path.states[t]).robot != map.state(world, path.states[t + 1]).robot ? 1u : 0u;
  }
  const auto text = markup(BoardSvg{map}.path(world, path, "#123456"));
  expect_well_formed(text);
  EXPECT_EQ(count(text, "<line "), moves);
  EXPECT_EQ(count(text, "rotate("), moves);
  EXPECT_EQ(count(text, "<circle "), path.actions.size() - moves);  // picking up and putting down
  EXPECT_GT(moves, 0u);
  EXPECT_LT(moves, path.actions.size());
}

TEST(BoardSvg, WritesActionsThatAreNoMoves) {
  const auto domain = rubble("\"S.G\"");
  const BoardSvg boards{*domain.map()};
  Svg moved, named;
  boards.action(moved, {1, 1}, "left");
  boards.action(named, {1, 1}, "pickup");
  EXPECT_THAT(markup(moved), HasSubstr("rotate(180)"));
  EXPECT_THAT(markup(named), HasSubstr(">pickup<"));
}

TEST(BoardSvg, ExplainsEverySignInLinesThatFit) {
  const BoardSvg boards{*item_delivery().domain().map()};
  Svg wide, narrow;
  const auto low = boards.legend(wide, 0, 0, 2000);
  const auto high = boards.legend(narrow, 0, 0, 120);
  EXPECT_LT(low, high);
  for (const auto* name : {"robot", "wall", "rubble", "charger", "parcel", "destination of parcel"}) {
    EXPECT_EQ(count(markup(wide), std::string{">"} + name + "<"), 1u) << name;
    EXPECT_EQ(count(markup(narrow), std::string{">"} + name + "<"), 1u) << name;
  }
}

TEST(InspectSvg, DrawsMapAndPolicyOnlyWhereThereIsAMap) {
  for (const auto& file : domain_pictures(item_delivery().domain(), MdpIndex{63})) expect_well_formed(file.text);
  EXPECT_EQ(domain_pictures(item_delivery().domain(), MdpIndex{63}).size(), 2u);
  const auto listed = load_domain(std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml");
  EXPECT_TRUE(domain_pictures(listed, MdpIndex{0}).empty());
  const auto icy = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  EXPECT_EQ(domain_pictures(icy, MdpIndex{0}).size(), 2u);  // its policy, too, although the ice is slippery
  const auto pictures = atlas_pictures(item_delivery(), MdpIndex{63});
  ASSERT_EQ(pictures.size(), 3u);
  for (const auto& file : pictures) expect_well_formed(file.text);
}

}  // namespace
}  // namespace kith
