#include <gtest/gtest.h>

#include "domain_texts.hpp"
#include "domains_under_test.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

// A domain with two features whose [words] are these lines.
Domain domain_with_words(const std::string& lines) {
  return sound_domain(testing::rubble_domain("\"S.rG\"", "[words]\n" + lines));
}

std::string many_of(const std::string& once) { return domain_with_words("step = \"" + once + "\"\n").wording(1).many; }

TEST(Wording, MakesPluralsOfTheNounBehindTheArticle) {
  EXPECT_EQ(many_of("a step"), "{n} steps");
  EXPECT_EQ(many_of("a step on the path"), "{n} steps on the path");
  EXPECT_EQ(many_of("an orange tile"), "{n} orange tiles");
  EXPECT_EQ(many_of("crossing a blue tile"), "crossing {n} blue tiles");
  EXPECT_EQ(many_of("a box, left behind"), "{n} boxes, left behind");
  EXPECT_EQ(many_of("a delivery"), "{n} deliveries");
  EXPECT_EQ(many_of("a step elsewhere"), "{n} steps elsewhere");
  EXPECT_EQ(many_of("a day"), "{n} days");
}

TEST(Wording, CountsWhatHasNoArticleInTimes) {
  EXPECT_EQ(many_of("crossing rubble"), "crossing rubble {n} times");
  EXPECT_EQ(many_of("stopping at the charger"), "stopping at the charger {n} times");
  EXPECT_EQ(many_of("a"), "a {n} times");
}

TEST(Wording, IsTheFeaturesNameWithoutWords) {
  const auto domain = domain_with_words("");
  EXPECT_EQ(domain.wording(0), (Wording{"rubble", "rubble {n} times", "", ""}));
  EXPECT_EQ(domain.feature_words(0), "rubble");
}

TEST(Wording, TakesWhatTheFileSaysAndCompletesTheRest) {
  const auto domain = domain_with_words(
      "rubble = { one = \"crossing rubble\", do = \"cross rubble\" }\n"
      "step = { one = \"a foot\", many = \"{n} feet\", do = \"go a foot\", do_many = \"go {n} feet\" }\n");
  EXPECT_EQ(domain.wording(0),
            (Wording{"crossing rubble", "crossing rubble {n} times", "cross rubble", "cross rubble {n} times"}));
  EXPECT_EQ(domain.wording(1), (Wording{"a foot", "{n} feet", "go a foot", "go {n} feet"}));
}

TEST(Drawings, ShowEveryCellByItsOwnSymbolWhereSymbolsMeanTheSame) {
  const auto domain = load_domain("skateboard");
  const MdpIndex all{domain.num_mdps() - 1};
  const std::vector<std::string> rows{".....G", ".....q", ".....q", "ppppqq"};
  EXPECT_EQ(domain.map()->draw_bare(all, domain.initial_state(all)), rows);
  const auto goals = load_domain("two-goals");
  const MdpIndex open{0};
  const std::vector<std::string> with_both{".....", ".....", ".....", "....B", "A...."};
  EXPECT_EQ(goals.map()->draw_bare(open, goals.initial_state(open)), with_both);
}

TEST(Drawings, LeaveOutStationsThatAreGone) {
  const auto domain = load_domain("item-delivery");
  const MdpIndex all{63};
  EXPECT_EQ(domain.map()->draw_bare(all, domain.initial_state(all)),
            (std::vector<std::string>{"#.rB", "#rrr", "G.r."}));
  auto later = domain.map()->state(all, domain.initial_state(all));
  later.stations.clear();
  const auto state = domain.map()->find_state(all, later);
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(domain.map()->draw_bare(all, *state), (std::vector<std::string>{"#.r.", "#rrr", "G.r."}));
}

TEST(Legend, NamesWhatSymbolsStandForAndWhatIsOptional) {
  const auto domain = load_domain("two-goals");
  const auto legend = domain.map()->legend();
  const auto& near = legend[domain.map()->legend_index({1, 1})];
  EXPECT_EQ(near.symbol, 'A');
  EXPECT_TRUE(near.content.goal);
  EXPECT_EQ(near.goal_name, "near");
  EXPECT_TRUE(legend[domain.map()->legend_index({1, 4})].is_optional);
  EXPECT_THROW(static_cast<void>(domain.map()->legend_index({0, 1})), std::invalid_argument);
}

TEST(OptionalGroups, StandInTheOrderOfTheVariantsBits) {
  const auto domain = load_domain("skateboard");
  const auto groups = domain.optional_groups();
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].name, "path");
  EXPECT_EQ(groups[0].cells, (std::vector<Cell>{{1, 1}, {2, 1}, {3, 1}, {4, 1}}));
  EXPECT_EQ(groups[2].name, "skateboard");
}

TEST(Words, LoseTheBlanksAroundThem) {
  const auto domain = domain_with_words(
      "rubble = \"  crossing rubble\\t\"\nstep = { one = \" a step \", many = \" {n} steps\", do = \"take a step \" "
      "}\n");
  EXPECT_EQ(domain.wording(0).one, "crossing rubble");
  EXPECT_EQ(domain.wording(0).many, "crossing rubble {n} times");
  EXPECT_EQ(domain.wording(1).one, "a step");
  EXPECT_EQ(domain.wording(1).many, "{n} steps");
  EXPECT_EQ(domain.wording(1).do_one, "take a step");
}

}  // namespace
}  // namespace kith
