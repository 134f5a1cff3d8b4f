#include "kith/explain/words.hpp"

#include <gtest/gtest.h>
#include <cmath>

#include "atlases.hpp"
#include "domain_texts.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/reason.hpp"

namespace kith {
namespace {

std::string sentence(const std::string& domain, const IntegerVector& normal) {
  return in_words(load_domain(domain), HalfSpace{normal});
}

// A domain with these weights and words for mud, dock and step.
Domain domain_with(const std::string& weights, const std::string& words) {
  auto reading = parse_domain(testing::map_domain("tiny", "\"S.mDG\"",
                                                  "\"m\" = { terrain = \"mud\", optional = true }\n"
                                                  "\"D\" = { station = \"dock\", optional = true }\n",
                                                  {{"mud", "leave:mud"}, {"dock", "leave:dock"}, {"step", "action"}},
                                                  weights, "[words]\n" + words),
                              "test.toml");
  for (const auto& diagnostic : reading.diagnostics) {
    EXPECT_NE(diagnostic.severity, Severity::kError) << to_text(diagnostic);
  }
  return *std::move(reading.domain);
}

TEST(InWords, ReadsRightForItemDelivery) {
  EXPECT_EQ(sentence("item-delivery", {-1, 0, 2}), "crossing rubble costs more than 2 steps");
  EXPECT_EQ(sentence("item-delivery", {1, 0, -4}), "crossing rubble costs less than 4 steps");
  EXPECT_EQ(sentence("item-delivery", {0, 1, 3}), "stopping at the charger is worth more than 3 steps");
  EXPECT_EQ(sentence("item-delivery", {0, -1, -5}), "stopping at the charger is worth less than 5 steps");
  EXPECT_EQ(sentence("item-delivery", {1, 1, 0}), "stopping at the charger is worth more than crossing rubble");
  EXPECT_EQ(sentence("item-delivery", {0, 0, -1}), "a step costs something");
  EXPECT_EQ(sentence("item-delivery", {-2, 0, 5}), "crossing rubble twice costs more than 5 steps");
  EXPECT_EQ(sentence("item-delivery", {-1, 0, 1}), "crossing rubble costs more than a step");
}

TEST(InWords, ReadsRightForTheOtherDomains) {
  EXPECT_EQ(sentence("colored-tiles", {-1, 0, 6}), "crossing an orange tile costs more than 6 steps");
  EXPECT_EQ(sentence("colored-tiles", {-3, 1, 0}), "crossing a blue tile costs less than crossing 3 orange tiles");
  EXPECT_EQ(sentence("colored-tiles", {-1, -1, 11}),
            "crossing an orange tile and crossing a blue tile cost more than 11 steps");
  EXPECT_EQ(sentence("skateboard", {5, 0, -1}), "a step elsewhere costs more than 5 moves with the skateboard");
  EXPECT_EQ(sentence("skateboard", {0, 1, -1}), "a step elsewhere costs more than a step on the path");
  EXPECT_EQ(sentence("skateboard", {2, -1, 0}), "a step on the path costs more than 2 moves with the skateboard");
  EXPECT_EQ(sentence("skateboard", {0, 5, -3}), "3 steps elsewhere cost more than 5 steps on the path");
  EXPECT_EQ(sentence("two-goals", {-1, 1, 3}),
            "reaching the far goal is worth more than reaching the near goal plus what 3 steps cost");
  EXPECT_EQ(sentence("cookie-crumb", {0, 1, 1}), "eating a crumb is worth more than a step");
  EXPECT_EQ(sentence("cookie-crumb", {0, -1, -2}), "eating a crumb is worth less than 2 steps");
  EXPECT_EQ(sentence("cookie-crumb", {0, 3, 5}), "eating 3 crumbs is worth more than 5 steps");
}

TEST(InWords, PutsCostsAndGainsOfOneSideTogether) {
  EXPECT_EQ(sentence("item-delivery", {1, 1, -2}),
            "crossing rubble costs less than 2 steps plus what stopping at the charger is worth");
  EXPECT_EQ(sentence("item-delivery", {-2, 1, 4}),
            "4 steps cost less than crossing rubble twice plus what stopping at the charger is worth");
  EXPECT_EQ(sentence("item-delivery", {-2, 1, 0}), "stopping at the charger is better than crossing rubble twice");
  EXPECT_EQ(sentence("cookie-crumb", {0, 2, -3}), "eating 2 crumbs is better than 3 steps");
  EXPECT_EQ(sentence("cookie-crumb", {1, -3, -4}),
            "eating 3 crumbs is worth less than reaching the jar plus what 4 steps cost");
  EXPECT_EQ(sentence("two-goals", {-1, 1, 1}),
            "reaching the far goal is worth more than reaching the near goal plus what a step costs");
}

TEST(InWords, PrefersWhereItContradictsTheRobotTwice) {
  EXPECT_EQ(sentence("item-delivery", {1, -1, 0}), "crossing rubble is better than stopping at the charger");
  EXPECT_EQ(sentence("item-delivery", {0, -1, 2}), "2 steps are better than stopping at the charger");
  EXPECT_EQ(sentence("item-delivery", {1, -1, 2}),
            "crossing rubble and 2 steps are better than stopping at the charger");
  EXPECT_EQ(sentence("item-delivery", {0, 0, 1}), "a step costs less than nothing");
}

TEST(InWords, SaysAtLeastWhereTheRobotIsIndifferent) {
  const auto domain = domain_with("mud = -2, dock = 3, step = -1",
                                  "mud = \"crossing mud\"\nstep = \"a step\"\n"
                                  "dock = \"stopping at the dock\"\n");
  EXPECT_EQ(in_words(domain, HalfSpace{{-1, 0, 2}}), "crossing mud costs at least as much as 2 steps");
  EXPECT_EQ(in_words(domain, HalfSpace{{1, 0, -2}}), "crossing mud costs at most as much as 2 steps");
  EXPECT_EQ(in_words(domain, HalfSpace{{0, 1, 3}}), "stopping at the dock is worth at least as much as 3 steps");
}

const Domain& mud_and_dock() {
  static const Domain domain = domain_with(
      "mud = -2, dock = 3, step = -1", "mud = \"crossing mud\"\nstep = \"a step\"\ndock = \"stopping at the dock\"\n");
  return domain;
}

// Counts of so many thousandths of a feature.
IntegerVector thousandths(const Domain& domain, const IntegerVector& n) {
  IntegerVector counts(n.size());
  for (std::size_t k = 0; k < n.size(); ++k) counts[k] = n[k] * domain.count_scale() / 1000;
  return counts;
}

TEST(OnAverage, ComparesWhatWeighsMostInAFewTries) {
  const auto& domain = mud_and_dock();  // its counts are whole
  EXPECT_EQ(on_average_in_words(domain, {-1, 0, 1}),
            "in 10 tries it would rather accept 10 steps than accept crossing mud 10 times");
  EXPECT_EQ(on_average_in_words(domain, {-1, 12, 25}),
            "in 10 tries it will accept 250 steps to choose stopping at the dock 120 times");
  EXPECT_EQ(on_average_in_words(domain, {0, 0, 0}), kAllInAll);
  const auto icy = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");  // discounted
  EXPECT_EQ(on_average_in_words(icy, thousandths(icy, {-226, 94, 2714})), kAllInAll);
}

TEST(Risk, IsNamedWhereChanceDecides) {
  const auto icy = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  EXPECT_EQ(risk_in_words(icy, MdpIndex{1}, thousandths(icy, {50, 0, -1000})), "it risks falling into the water");
  EXPECT_EQ(risk_in_words(icy, MdpIndex{1}, thousandths(icy, {-100, 0, 1000})),
            "it avoids the risk of falling into the water");
  EXPECT_EQ(risk_in_words(icy, MdpIndex{1}, thousandths(icy, {0, 50, 1000})), "");
  // A slip off the cliff takes the place of a step, which is no risk.
  const auto cliff = load_domain(std::string{KITH_SOURCE_DIR} + "/docs/examples/cliff.toml");
  EXPECT_EQ(risk_in_words(cliff, MdpIndex{0}, thousandths(cliff, {-1000, 1000})),
            "it avoids the risk of falling off the cliff");
  EXPECT_EQ(risk_in_words(mud_and_dock(), MdpIndex{0}, {-1, 0, 1}), "");
  // Only what the numbers tell: 2 more falls in 10000 tries are none in 100.
  EXPECT_EQ(risk_in_words(cliff, MdpIndex{0}, {cliff.count_scale() / 5000, -5 * cliff.count_scale()}), "");
}

// Where one move in five goes wrong, a jump off the cliff brings a step in one of five cases only.
TEST(Risk, IsNoStepThatAFallTakesThePlaceOf) {
  const auto cliff = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/gallery/cliff_walking.toml");
  for (MdpIndex world{0}; world.value() < cliff.num_mdps(); ++world) {
    EXPECT_EQ(risk_in_words(cliff, world, thousandths(cliff, {0, -840})), "");
    EXPECT_EQ(risk_in_words(cliff, world, thousandths(cliff, {-100, -840})),
              world.value() == 0 ? "" : "it avoids the risk of falling off the cliff");
  }
}

// On very slippery ice most moves may end in a hole, but hardly any in half of the cases.
TEST(Risk, IsAnAccidentHoweverManyActionsMayBringIt) {
  const auto lake = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/gallery/frozen_lake.toml");
  const std::vector<std::string> risks{"", "it risks falling into a hole", "it risks falling into a hole"};
  for (MdpIndex world{0}; world.value() < lake.num_mdps(); ++world) {
    EXPECT_EQ(risk_in_words(lake, world, thousandths(lake, {40, -5000})), risks[world.value()]);
  }
}

TEST(Chance, OfAPathIsAProductAndIsLeftOutWhereItIsCertain) {
  const auto icy = load_domain(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  const Atlas& atlas = testing::atlas_of(std::string{KITH_SOURCE_DIR} + "/domains/icy_crossing.toml");
  const MdpIndex firm{0}, glaze{2};
  const auto across = atlas.trajectory(atlas.index({firm, icy.initial_state(firm)}));
  const auto chance = chance_of_path(icy, firm, across);
  ASSERT_TRUE(chance.has_value());
  EXPECT_EQ(chance_in_words(icy, firm, across),
            "most likely path, " + std::to_string(std::llround(100.0 * *chance)) + " % chance");
  const auto around = atlas.trajectory(atlas.index({glaze, icy.initial_state(glaze)}));
  EXPECT_FALSE(chance_of_path(icy, glaze, around).has_value());
  EXPECT_EQ(chance_in_words(icy, glaze, around), "");
}

TEST(InWords, AvoidsTheVerbWhereWordsDoNotTellTheirNumber) {
  const auto domain = domain_with("mud = -2, dock = 2.5, step = -1", "mud = \"mud crossings\"\nstep = \"a step\"\n");
  EXPECT_EQ(in_words(domain, HalfSpace{{-1, 0, 1}}), "the cost of mud crossings outweighs the cost of a step");
  EXPECT_EQ(in_words(domain, HalfSpace{{0, 1, 2}}), "the gain of dock outweighs the cost of 2 steps");
}

TEST(Times, CountsNounsAndVerbs) {
  const Wording step{"a step on the path", "{n} steps on the path", "take a step", "take {n} steps"};
  EXPECT_EQ(times(step, 1), "a step on the path");
  EXPECT_EQ(times(step, 5), "5 steps on the path");
  EXPECT_EQ(times_more(step, 1), "one more step on the path");
  EXPECT_EQ(times_more(step, 2), "2 more steps on the path");
  EXPECT_EQ(doing(step, 1, false), "take a step");
  EXPECT_EQ(doing(step, 1, true), "take one more step");
  EXPECT_EQ(doing(step, 3, true), "take 3 more steps");
  const Wording rubble{"crossing rubble", "crossing rubble {n} times", "cross rubble", "cross rubble {n} times"};
  EXPECT_EQ(times(rubble, 2), "crossing rubble twice");
  EXPECT_EQ(times(rubble, 3), "crossing rubble 3 times");
  EXPECT_EQ(times_more(rubble, 1), "crossing rubble once more");
  EXPECT_EQ(times_more(rubble, 2), "crossing rubble 2 more times");
  EXPECT_EQ(doing(rubble, 2, false), "cross rubble twice");
  EXPECT_EQ(doing(Wording{"a step", "{n} steps", "", ""}, 2, false), "");
}

TEST(TimesFewer, SparesNounsAndDeeds) {
  const Wording step{"a step on the path", "{n} steps on the path", "take a step", "take {n} steps"};
  EXPECT_EQ(times_fewer(step, 1), "one fewer step on the path");
  EXPECT_EQ(times_fewer(step, 3), "3 fewer steps on the path");
  const Wording rubble{"crossing rubble", "crossing rubble {n} times", "cross rubble", "cross rubble {n} times"};
  EXPECT_EQ(times_fewer(rubble, 1), "not crossing rubble");
  EXPECT_EQ(times_fewer(rubble, 2), "not crossing rubble twice");
}

// It was "the cost of 3 steps and the gain of stopping at the dock outweigh the cost of crossing mud and the gain of
// ...".
TEST(InWords, ComparesBenefitsWhereBothSidesHaveCostsAndGains) {
  const auto domain = load_domain("navigation");  // gravel, grass, road, recharge, board, car, step
  EXPECT_EQ(in_words(domain, HalfSpace{{0, 1, 1, 0, -7, 0, -3}}),
            "going by road and 3 fewer steps are worth more than 7 moves on the board and not crossing grass");
  EXPECT_EQ(in_words(domain, HalfSpace{{-2, -1, 0, 0, 0, 0, 0}}),
            "crossing gravel twice and crossing grass together cost something");
}

TEST(InGeneral, LeavesOutTheNumber) {
  EXPECT_EQ(in_general({"a step on the path", "{n} steps on the path", "", ""}), "steps on the path");
  EXPECT_EQ(in_general({"crossing rubble", "crossing rubble {n} times", "", ""}), "crossing rubble");
  EXPECT_EQ(in_general({"crossing a tile", "crossing {n} tiles", "", ""}), "crossing tiles");
}

// Item delivery: rubble, recharge, step; weights -3, 3.5, -1.
std::string choice(const IntegerVector& robot, const IntegerVector& alternative) {
  return choice_in_words(load_domain("item-delivery"), robot, alternative);
}

TEST(Reason, SaysWhatTheRobotDoesRatherThanWhatBecauseOfWhat) {
  EXPECT_EQ(reason(load_domain("item-delivery"), {0, 0, 7}, {1, 0, 5}),
            "it would rather take 2 more steps than cross rubble: crossing rubble costs more than 2 steps");
}

TEST(Reason, HasAFormForEveryMixtureOfCostsAndGains) {
  EXPECT_EQ(choice({1, 0, 5}, {0, 0, 9}), "it would rather cross rubble than take 4 more steps");
  EXPECT_EQ(choice({0, 1, 8}, {0, 0, 5}), "it will take 3 more steps to stop at the charger");
  EXPECT_EQ(choice({0, 0, 5}, {0, 1, 10}), "it will not take 5 more steps to stop at the charger");
  EXPECT_EQ(choice({0, 1, 5}, {0, 0, 5}), "it will stop at the charger");
  EXPECT_EQ(choice({1, 0, 5}, {2, 0, 5}), "it would rather not cross rubble once more");
  EXPECT_EQ(choice({0, 1, 6}, {1, 0, 5}), kAllInAll);
}

// "It would rather not cross rubble and take 2 more steps" could be read as taking them.
TEST(Reason, CannotBeReadTheOtherWay) {
  EXPECT_EQ(choice({0, 0, 5}, {1, 0, 7}), "it would rather not cross rubble or take 2 more steps");
  EXPECT_EQ(choice({0, 1, 5}, {0, 0, 7}), "it would rather stop at the charger than take 2 more steps");
}

TEST(Reason, LeavesOutWhatNobodyKeepsInMind) {
  const auto domain = load_domain("item-delivery");
  EXPECT_EQ(told(domain, HalfSpace{{1, 1, -2}}), "");
  EXPECT_EQ(reason(domain, {0, 1, 6}, {1, 0, 5}), kAllInAll);
  EXPECT_EQ(explained(kAllInAll, "a step costs something"), "a step costs something");
}

TEST(Reason, ComparesTwoGains) {
  const auto goals = load_domain("two-goals");
  EXPECT_EQ(choice_in_words(goals, {0, 1, 8}, {1, 0, 8}),
            "it would rather go to the far goal than go to the near goal");
}

TEST(Reason, AcceptsAndChoosesWhatHasNoVerb) {
  const auto domain = domain_with("mud = -2.2, dock = 2.5, step = -1",
                                  "mud = \"crossing mud\"\ndock = \"stopping at the dock\"\nstep = \"a step\"\n");
  EXPECT_EQ(choice_in_words(domain, {0, 0, 7}, {1, 0, 5}),
            "it would rather accept 2 more steps than accept crossing mud");
  EXPECT_EQ(choice_in_words(domain, {0, 1, 5}, {0, 0, 5}), "it will choose stopping at the dock");
}

TEST(Reason, AdmitsIndifference) {
  const auto domain = domain_with("mud = -2, dock = 2.5, step = -1",
                                  "mud = { one = \"crossing mud\", do = \"cross mud\" }\n"
                                  "dock = \"stopping at the dock\"\n"
                                  "step = { one = \"a step\", do = \"take a step\" }\n");
  EXPECT_EQ(reason(domain, {0, 0, 7}, {1, 0, 5}),
            "it may as well take 2 more steps as cross mud: crossing mud costs at least as much as 2 steps");
}

TEST(Reason, RefusesWhatIsNoReason) {
  const auto domain = load_domain("item-delivery");
  EXPECT_THROW(static_cast<void>(reason(domain, {0, 0, 5}, {0, 0, 5})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(reason(domain, {0, 0, 7}, {0, 0, 5})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(reason(domain, {0, 0}, {0, 0, 5})), std::invalid_argument);
}

TEST(ActionsText, CountsRepetitions) {
  const auto domain = load_domain("item-delivery");
  EXPECT_EQ(actions_text(domain, {ActionIndex{0}, ActionIndex{3}, ActionIndex{3}}), "up, right x2");
  EXPECT_EQ(counts_text(domain, {1, 0, 7}), "rubble 1, step 7");
  EXPECT_EQ(counts_text(domain, {0, 0, 0}), "nothing");
}

// Whatever words people write, sentences can be made of them.
TEST(InWords, TakesAnyWordsThatADomainMayHave) {
  for (const std::string words :
       {" crossing mud", "crossing  mud", ",", "a ", ",ing", "{n}", "ing", "a ,", "one", "\\u001b"}) {
    const auto domain = domain_with("mud = -2, dock = 3, step = -1", "mud = \"" + words + "\"\n");
    for (const IntegerVector& normal : {IntegerVector{-1, 0, 2}, IntegerVector{2, 1, 0}, IntegerVector{-3, -1, 1}}) {
      EXPECT_FALSE(in_words(domain, HalfSpace{normal}).empty()) << words;
    }
    for (const std::int64_t n : {1, 2, 5}) {
      EXPECT_FALSE(times(domain.wording(0), n).empty()) << words;
      EXPECT_FALSE(times_more(domain.wording(0), n).empty()) << words;
      EXPECT_FALSE(doing({words, words + "{n}", words, words + "{n}"}, n, true).empty()) << words;
    }
    (void)in_general(domain.wording(0));
  }
}

TEST(InWords, NeedsNoWordsToSayThatThereAreNone) {
  const Wording none{"", "", "", ""};
  EXPECT_EQ(times(none, 1), "");
  EXPECT_EQ(doing(none, 2, false), "");
}

TEST(Words, SayTheJobByWhatEndsAnEpisodeUnlessTheFileSaysIt) {
  const auto job = [](const std::string& name) { return job_in_words(load_domain(name)); };
  EXPECT_EQ(job("item-delivery"), "The robot fetches the parcel and takes it to where it belongs.");
  EXPECT_EQ(job("colored-tiles"), "The robot is on its way to the goal.");
  EXPECT_EQ(job("two-goals"), "The robot is on its way to one of the goals.");
  EXPECT_EQ(job("rescue-floor"), "The robot takes everything to where it belongs.");
  auto text = testing::kOneRoad;
  text.insert(text.find("[map]"), "goal = \"The robot walks home.\"\n");
  EXPECT_EQ(job_in_words(parse_domain(text, "road.toml").domain.value()), "The robot walks home.");
}

TEST(Words, CountThingsInFewWords) {
  const auto said = [](const std::string& one, const std::string& many) {
    const auto [once, often] = counted_as({one, many, "", ""});
    return once + "/" + often;
  };
  EXPECT_EQ(said("crossing rubble", "crossing rubble {n} times"), "rubble/rubble");
  EXPECT_EQ(said("stopping at the charger", "stopping at the charger {n} times"), "charger/charger");
  EXPECT_EQ(said("a step", "{n} steps"), "step/steps");
  EXPECT_EQ(said("crossing an orange tile", "crossing {n} orange tiles"), "orange tile/orange tiles");
  EXPECT_EQ(said("rubble", "rubble {n} times"), "rubble/rubble");
}

}  // namespace
}  // namespace kith
