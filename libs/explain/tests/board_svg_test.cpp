#include "kith/explain/board_svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "domain_texts.hpp"
#include "item_delivery.hpp"
#include "kith/explain/inspect_svg.hpp"
#include "undrawn_cliff.hpp"

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
  EXPECT_EQ(domain_pictures(listed, MdpIndex{0}).size(), 2u);  // its states are drawn row by row
  EXPECT_TRUE(domain_pictures(testing::undrawn_cliff(), MdpIndex{0}).empty());
  const auto icy = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  EXPECT_EQ(domain_pictures(icy, MdpIndex{0}).size(), 2u);  // its policy, too, although the ice is slippery
  const auto pictures = atlas_pictures(item_delivery(), MdpIndex{63});
  ASSERT_EQ(pictures.size(), 3u);
  for (const auto& file : pictures) expect_well_formed(file.text);
}

// --- what can be told apart -----------------------------------------------------------

// The drawings in a legend by their names, each around its own origin.
std::vector<std::string> legend_drawings(const GridMap& map) {
  Svg svg;
  (void)BoardSvg{map}.legend(svg, 0.0, 0.0, 1e6);
  const auto text = markup(svg);
  std::vector<std::string> drawings;
  for (auto at = text.find("<g transform="); at != std::string::npos; at = text.find("<g transform=", at + 1)) {
    const auto begin = text.find(">\n", at);
    drawings.push_back(text.substr(begin, text.find("</g>", begin) - begin));
  }
  return drawings;
}

void expect_told_apart(const GridMap& map, const std::string& what) {
  const auto drawings = legend_drawings(map);
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(drawings[i], drawings[j]) << what << ": rows " << j << " and " << i;
  }
  const auto surfaces = surfaces_of(map);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(surfaces[i].tint == surfaces[j].tint && surfaces[i].pattern == surfaces[j].pattern)
          << what << ": " << surfaces[j].name << " and " << surfaces[i].name;
    }
  }
}

TEST(Surfaces, TellAllThingsOfEveryDomainApart) {
  std::size_t maps = 0;
  const auto check = [&](const Domain& domain) {
    const auto map = domain.drawing();
    if (!map) return;
    ++maps;
    EXPECT_GE(legend_drawings(*map).size(), surfaces_of(*map).size() + 1) << domain.id();
    expect_told_apart(*map, domain.id());
  };
  for (const auto& domain : built_in_domains()) check(load_domain(std::string{domain.name}));
  const auto gallery = std::string{KITH_SOURCE_DIR} + "/domains/gallery/";
  for (const auto* file : {"frozen_lake", "cliff_walking", "taxi", "four_rooms"})
    check(load_domain(gallery + file + ".toml"));
  EXPECT_GE(maps, 10u);
}

constexpr const char* kRest = R"([[feature]]
name = "water"
when = "leave:water"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { water = -3, step = -1 }
)";

// Up to as many terrains as there are tints and patterns, and as many things whose names begin alike.
TEST(Surfaces, TellManyTerrainsAndThingsApart) {
  for (const std::size_t n : {2u, 8u, 9u, 17u, 32u}) {
    std::string legend, row = "S";
    for (std::size_t i = 0; i < n; ++i) {
      const std::string symbol(1, static_cast<char>(i < 26 ? 'a' + i : '0' + (i - 26)));
      const std::string name = i == 0 ? "water" : i == 1 ? "blue" : i == 2 ? "ice" : "ground" + std::to_string(i);
      legend += "\"" + symbol + "\" = { terrain = \"" + name + "\" }\n";
      row += symbol;
    }
    const std::string text =
        "schema = \"kith.domain/1\"\nid = \"patchwork\"\ntitle = \"patchwork\"\n[map]\nrows = [\"" + row +
        "HIJG\"]\n[map.legend]\n" + legend +
        "S = { start = true }\nG = { goal = true }\nH = { station = \"charger\" }\nI = { station = \"chair\" }\n"
        "J = { station = \"chapel\" }\n" +
        kRest;
    const auto reading = parse_domain(text, "patchwork.toml");
    ASSERT_TRUE(reading.domain) << to_text(reading.diagnostics.front());
    const auto map = reading.domain->map();
    EXPECT_EQ(surfaces_of(*map).size(), n);
    expect_told_apart(*map, std::to_string(n));
  }
}

}  // namespace
}  // namespace kith
