#include "kith/live/world_json.hpp"

#include <gtest/gtest.h>

#include <set>

#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;

// The table says exactly what the domain does.
class WorldTables : public ::testing::TestWithParam<const char*> {};

TEST_P(WorldTables, MoveAsTheDomainDoes) {
  const auto study = live_study({}, GetParam());
  const auto& domain = study->atlas->domain();
  for (const auto world : {MdpIndex{0}, MdpIndex{domain.num_mdps() - 1}}) {
    const auto& mdp = domain.mdp(world);
    const auto json = world_json(*study, world);
    const auto states = mdp.num_states() + mdp.num_terminals();
    ASSERT_EQ(json["frames"].size(), states);
    ASSERT_EQ(json["next"].size(), states);
    ASSERT_EQ(json["end"].size(), states);
    EXPECT_EQ(json["actions"].size(), mdp.num_actions());
    EXPECT_EQ(json["chance"], !mdp.is_deterministic());
    EXPECT_EQ(world_of_key(*study, json["key"].get<std::string>()), world);
    for (StateIndex s{0}; s.value() < states; ++s) {
      EXPECT_EQ(json["end"][s.value()], mdp.is_terminal(s));
      std::size_t moves = 0;
      for (const auto& next : json["next"][s.value()]) moves += next != -1 ? 1u : 0u;
      EXPECT_EQ(moves, mdp.is_terminal(s) ? 0u : mdp.choices(s).size());
    }
    EXPECT_EQ(world_state(*study, world, StateIndex{states - 1}), states - 1);
    EXPECT_EQ(world_state(*study, world, StateIndex{states}), std::nullopt);
  }
}

// The robot's own path is as good as itself; whatever else is legal is never better.
TEST_P(WorldTables, JudgeTheRobotsOwnPathAsRight) {
  const auto study = live_study({}, GetParam());
  const auto& atlas = *study->atlas;
  const auto& weights = atlas.domain().weights();
  std::size_t others = 0, circles = 0;
  for (std::size_t i = 0; i < atlas.num_states(); i += 1 + atlas.num_states() / 60) {
    const StartIndex start_index{i};
    const auto robot = expected_path(atlas, start_index);
    std::vector<std::size_t> actions;
    for (const auto action : robot.actions) actions.push_back(action.value());
    if (actions.size() > max_answer_actions(atlas.domain())) continue;
    const auto judged = judged_path(atlas, start_index, actions);
    if (!judged.is_finished || !judged.is_legal) {  // with chance the likeliest steps may lead round in a circle
      ASSERT_FALSE(atlas.domain().mdp(atlas.id(start_index).mdp).is_deterministic());
      ++circles;
      continue;
    }
    EXPECT_EQ(judged.counts, atlas.feature_counts(start_index));
    EXPECT_EQ(judged.path, robot);
    actions.push_back(0);
    EXPECT_FALSE(judged_path(atlas, start_index, actions).is_legal);  // nothing happens after the end
    // One other first action, and on as the robot would: the counts that the atlas has for it.
    const auto world = atlas.id(start_index).mdp;
    const auto start = atlas.id(start_index).start;
    const auto& mdp = atlas.domain().mdp(world);
    for (std::size_t c = 0; c < mdp.choices(start).size(); ++c) {
      const auto& choice = mdp.choices(start)[c];
      const auto outcomes = mdp.outcomes(choice);
      const auto likeliest = std::max_element(
          outcomes.begin(), outcomes.end(), [](const auto& a, const auto& b) { return a.probability < b.probability; });
      std::vector<std::size_t> other{choice.action.value()};
      if (!mdp.is_terminal(likeliest->next)) {
        for (const auto action : expected_path(atlas, atlas.index({world, likeliest->next})).actions) {
          other.push_back(action.value());
        }
      }
      const auto counts = judged_path(atlas, start_index, other).counts;
      if (!counts) continue;
      const auto expected = atlas.deviation_counts(start_index, c);
      const auto scale = static_cast<double>(atlas.domain().count_scale());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_NEAR(static_cast<double>((*counts)[k]) / scale, static_cast<double>(expected[k]) / scale, 1e-5);
      }
      EXPECT_GE(weights.return_of(atlas.feature_counts(start_index) - *counts) / scale, -1e-6);
      ++others;
    }
  }
  EXPECT_GT(others, 20u);
  EXPECT_LT(circles, 10u);
}

// Whatever a page lets somebody drive is legal, and what is longer is refused for being too long and for nothing else.
TEST_P(WorldTables, TellPagesHowLongAPathMayBe) {
  const auto study = live_study({}, GetParam());
  const auto& atlas = *study->atlas;
  auto random = RandomStream{5}.split("walks");
  std::size_t longest = 0;
  for (int walk = 0; walk < 20; ++walk) {
    const StartIndex start{uniform_index(atlas.num_states(), random)};
    const auto world = atlas.id(start).mdp;
    const auto table = world_json(*study, world);
    const auto most = table.at("max_actions").get<std::size_t>();
    ASSERT_EQ(most, std::min<std::size_t>(500, atlas.domain().max_steps()));
    std::vector<std::size_t> path;
    auto state = world_state(*study, world, atlas.id(start).start).value();
    while (path.size() <= most) {
      std::vector<std::size_t> possible, before_the_end;
      const auto& next = table["next"][state];
      for (std::size_t action = 0; action < next.size(); ++action) {
        if (next[action] < 0) continue;
        possible.push_back(action);
        if (!table["end"][next[action].get<std::size_t>()].get<bool>()) before_the_end.push_back(action);
      }
      const auto& choice = before_the_end.empty() ? possible : before_the_end;
      if (choice.empty()) break;
      path.push_back(choice[uniform_index(choice.size(), random)]);
      state = next[path.back()].get<std::size_t>();
      const auto judged = judged_path(atlas, start, path);
      ASSERT_EQ(judged.is_legal, path.size() <= most);
      ASSERT_EQ(judged.is_too_long, path.size() > most);
    }
    longest = std::max(longest, path.size());
  }
  EXPECT_GT(longest, 40u);
}

INSTANTIATE_TEST_SUITE_P(Domains, WorldTables,
                         ::testing::Values("item-delivery", "domains/icy_crossing.toml", "two-goals",
                                           "domains/gallery/taxi.toml"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == '-' || c == '/' || c == '.'; }, '_');
                           return name;
                         });

TEST(WorldTable, KnowsOnlyItsOwnKeys) {
  const auto study = live_study();
  EXPECT_EQ(world_of_key(*study, ""), std::nullopt);
  EXPECT_EQ(world_of_key(*study, study->key), std::nullopt);
  EXPECT_EQ(world_of_key(*study, study->key + "-"), std::nullopt);
  EXPECT_EQ(world_of_key(*study, study->key + "-00"), std::nullopt);
  EXPECT_EQ(world_of_key(*study, study->key + "-1x"), std::nullopt);
  EXPECT_EQ(world_of_key(*study, study->key + "-99999999"), std::nullopt);
  EXPECT_EQ(world_of_key(*study, study->key + "-1"), MdpIndex{1});
}

TEST(WorldTable, SaysWhereActionsMoveTheRobot) {
  const auto json = world_json(*live_study(), MdpIndex{0});
  for (const auto& action : json["actions"]) {
    if (action["name"] == "up") {
      EXPECT_EQ(action["dx"], 0);
      EXPECT_EQ(action["dy"], -1);  // rows are numbered downward
    }
    if (action["name"] == "pickup") {
      EXPECT_EQ(action["dx"], nullptr);
    }
  }
}

// Very slippery ice: every move ends in three directions alike, and yet the buttons are four.
TEST(WorldJson, TakesDirectionsByTheirNamesWhereChanceDoesNotTell) {
  const auto study = live_study({}, "domains/gallery/frozen_lake.toml");
  for (MdpIndex world{0}; world.value() < study->atlas->domain().num_mdps(); ++world) {
    std::set<std::pair<int, int>> shifts;
    const auto json = world_json(*study, world);
    for (const auto& action : json["actions"]) shifts.emplace(action["dx"].get<int>(), action["dy"].get<int>());
    EXPECT_EQ(shifts, (std::set<std::pair<int, int>>{{0, -1}, {0, 1}, {-1, 0}, {1, 0}})) << world.value();
  }
}

TEST(LiveStudy, ChoosesASandboxThatTestsNothing) {
  const auto study = live_study("[group]\nscreening = { tests = 4 }\n");
  const auto& atlas = *study->atlas;
  EXPECT_TRUE(!atlas.is_candidate(study->sandbox) ||
              atlas.tested_constraints(study->sandbox).without(atlas.prior()).empty());
  EXPECT_EQ(study->screening.size(), 4u);
  EXPECT_EQ(live_study("[group]\nscreening = { tests = 4 }\n")->screening, study->screening);
}

TEST(LiveStudy, ChoosesASandboxWithRoomToMove) {
  for (const auto* domain : {"item-delivery", "domains/gallery/frozen_lake.toml"}) {
    const auto study = live_study({}, domain);
    EXPECT_GE(study->atlas->trajectory(study->sandbox).actions.size(), 2u) << domain;
  }
}

TEST(LiveStudy, RefusesStrategiesThatReadWhatSimulatedPeopleBelieve) {
  auto reading = parse_study(testing::kLiveStudy, "live.toml", {.overrides = {}, .folder = KITH_SOURCE_DIR});
  ASSERT_TRUE(reading.study);
  reading.study->variants.front().strategies[1].kind.needs_truth = true;
  try {
    (void)make_live_study(*reading.study, testing::atlas_of("item-delivery"));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_EQ(std::string{error.what()},
              "the strategy 'joint' reads what simulated people believe, so it cannot teach real ones: "
              "remove it from [design]");
  }
}

TEST(LiveStudy, RefusesWhatSessionsOfPeopleCannotDo) {
  const auto reading = parse_study(testing::kLiveStudy, "live.toml",
                                   {.overrides = {"stop.release=\"all-right\""}, .folder = KITH_SOURCE_DIR});
  ASSERT_TRUE(reading.study);
  EXPECT_THROW((void)make_live_study(*reading.study, testing::atlas_of("item-delivery")), Error);
}

// On the ice the likeliest steps lead round in a circle from some starts.
TEST(LiveStudy, NeverAsksWhereTheLikeliestStepsDoNotEnd) {
  const auto all = testing::atlas_of("domains/icy_crossing.toml");
  const auto asked = live_study("[group]\nscreening = { tests = 2 }\n", "domains/icy_crossing.toml");
  std::size_t left_out = 0, kept = 0;
  for (ConstraintIndex c{0}; c.value() < all->constraints().size(); ++c) {
    const auto tests = asked->atlas->tests_for(c);
    for (const auto start : all->tests_for(c)) {
      const bool is_asked = std::find(tests.begin(), tests.end(), start) != tests.end();
      EXPECT_EQ(is_asked, answerable_path(*all, start).has_value());
      ++(is_asked ? kept : left_out);
    }
  }
  EXPECT_GT(left_out, 0u);
  EXPECT_GT(kept, 0u);
  for (const auto test : asked->screening) EXPECT_TRUE(answerable_path(*all, test));
}

TEST(LiveStudy, ListsTheCellsThatRoomsAreMadeFor) {
  const auto cells = live_cells(*live_study("[group]\nsize = 2\n"));
  EXPECT_NE(std::find(cells.begin(), cells.end(), LiveCell{"joint", "NNP"}), cells.end());
  EXPECT_NE(std::find(cells.begin(), cells.end(), LiveCell{"common", "NN"}), cells.end());
  for (const auto& cell : cells) {
    EXPECT_NE(cell.strategy, "baseline");  // it teaches one person
    EXPECT_GE(cell.composition.size(), 2u);
  }
  const auto one = live_cells(*live_study());
  EXPECT_NE(std::find(one.begin(), one.end(), LiveCell{"baseline", "N"}), one.end());
}

TEST(LiveStudy, TellsFacilitatorsWhichRoomsTheDesignHas) {
  const auto json = live_study_json(*live_study("[group]\nsize = 2\n"));
  EXPECT_EQ(json["compositions"], Json::array({"NNP", "NN"}));
  EXPECT_EQ(json["size"], 3);
}

// What pages say about data follows from the keys that change what is kept.
TEST(LiveStudy, SaysWhatIsStored) {
  const auto plain = live_study_json(*live_study("[group]\nsize = 2\n")).at("stores");
  const std::map<std::string, std::string> keys{
      {"names", "ask_name = true"},
      {"query", "collect_query = [\"PID\"]"},
      {"questions", "questions = [{ id = \"a\", kind = \"likert\", text = \"Clear?\" }]"},
      {"text", "questions = [{ id = \"a\", kind = \"text\", text = \"Else?\" }]"},
      {"screening", "[group.screening]\ntests = 2"},
      {"discussion", "[group.discussion]\nmodel = \"majority\""}};
  for (const auto& [name, key] : keys) {
    const auto told = live_study_json(*live_study("[group]\nsize = 2\n" + key + "\n")).at("stores");
    EXPECT_NE(told.at(name), plain.at(name)) << key;
  }
  EXPECT_EQ(plain.size(), keys.size());
}

TEST(LiveStudy, WarnsOfWhatATemplateLeftOpen) {
  const auto warnings = [](const std::string& text) {
    auto spec = live_study()->spec;
    spec.group.consent_text = {text};
    const auto found = warnings_for_people(spec);
    return found.empty() ? std::string{} : found.front().message;
  };
  EXPECT_EQ(warnings("It takes (MINUTES) minutes."), "participants would read '(MINUTES)'");
  EXPECT_EQ(warnings("Ask (NAME, ADDRESS)."), "participants would read '(NAME, ADDRESS)'");
  EXPECT_EQ(warnings("Ask [the name of your board]."), "participants would read '[the name of your board]'");
  for (const auto* sound :
       {"It takes (about) ten minutes (UK).", "See [our page](https://example.org).", "(1) and [] and (("}) {
    EXPECT_EQ(warnings(sound), "") << sound;
  }
  auto spec = live_study()->spec;
  spec.group.consent_file = "no-such-file.md";
  ASSERT_EQ(warnings_for_people(spec, "/nowhere").size(), 1u);
  EXPECT_EQ(warnings_for_people(spec, "/nowhere")[0].id, "W1601");
}

// What links of recruitment platforms carry is stored only if the study asks for it.
TEST(LiveStudy, CollectsTheQueryParametersThatItNames) {
  const auto study = live_study("[group]\ncollect_query = [\"PID\", \"SESSION\"]\n");
  const auto collected = [&](const Json& query) { return collected_query(*study, query); };
  EXPECT_EQ(collected({{"PID", "a"}, {"email", "b"}, {"SESSION", "c"}}), (Json{{"PID", "a"}, {"SESSION", "c"}}));
  EXPECT_EQ(collected({{"PID", std::string(201, 'x')}, {"SESSION", "line\x01"}}), Json::object());
  EXPECT_EQ(collected({{"PID", 7}}), Json::object());
  EXPECT_EQ(collected(Json::array({"PID"})), Json::object());
  EXPECT_EQ(collected(nullptr), Json::object());
}

TEST(LiveStudy, GivesCodesThatCannotBeGuessed) {
  const auto study = live_study();
  const auto code = completion_code(*study, "salt", "r1", 1);
  EXPECT_EQ(code.rfind("KITH-", 0), 0u);
  EXPECT_EQ(code.size(), 15u);
  EXPECT_EQ(completion_code(*study, "salt", "r1", 1), code);
  EXPECT_NE(completion_code(*study, "other", "r1", 1), code);
  EXPECT_NE(completion_code(*study, "salt", "r1", 2), code);
  EXPECT_NE(completion_code(*study, "salt", "r2", 1), code);
}

}  // namespace
}  // namespace kith
