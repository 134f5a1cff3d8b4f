// What people hear and see who know the robot as it was before an update.
#include "kith/explain/update.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atlases.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/teaching/older_robot.hpp"

namespace kith {
namespace {

using testing::atlas_of;

std::string updated(const std::string& name) {
  return std::string{KITH_SOURCE_DIR} + "/tests/updates/" + name + ".toml";
}

// What people know of the older robot who are to learn about the newer one.
Cone known_of(const std::string& older, const std::string& newer) {
  return known_within(atlas_of(newer).prior_cone(), older_robot(atlas_of(older)).region).value();
}

Curriculum curriculum_of(const std::string& older, const std::string& newer) {
  CurriculumOptions options;
  options.teaching.known = known_of(older, newer);
  return make_curriculum(atlas_of(newer), options);
}

// Everything new is shown, and nothing else; that holds in both directions.
TEST(Update, ShowsWhatIsNewAndNothingElse) {
  for (const auto& changed : {updated("charger_halved"), updated("rubble_free")}) {
    for (const bool back : {false, true}) {
      const std::string older = back ? changed : "item-delivery", newer = back ? "item-delivery" : changed;
      SCOPED_TRACE(older + " becomes " + newer);
      const auto known = known_of(older, newer);
      const auto update = update_of(atlas_of(newer), known);
      const auto curriculum = curriculum_of(older, newer);
      ASSERT_FALSE(curriculum.components.empty());
      Cone shown = atlas_of(newer).prior_cone();
      ASSERT_TRUE(shown.clip(update.still));
      for (const auto& component : curriculum.components) {
        EXPECT_FALSE(component.demonstrations.empty());
        for (const auto& one : component.demonstrations) {
          for (const auto& constraint : one.conveys) EXPECT_FALSE(known.implies(constraint));
          EXPECT_TRUE(shown.clip(one.conveys));
        }
        for (const auto& constraint : component.constraints) EXPECT_FALSE(known.implies(constraint));
      }
      for (const auto& constraint : update.now) EXPECT_TRUE(shown.implies(constraint));
    }
  }
}

TEST(Update, SaysThatNothingChanged) {
  for (const auto& name : {std::string{"item-delivery"}, std::string{"colored-tiles"}, std::string{"two-goals"}}) {
    const auto same = curriculum_of(name, name);
    EXPECT_TRUE(same.components.empty());
    ASSERT_TRUE(same.update);
    EXPECT_TRUE(same.update->now.empty());
    EXPECT_EQ(same.update->text,
              "The robot has been updated, but it decides as before: all that you know about it still holds.");
  }
  EXPECT_TRUE(curriculum_of(updated("unchanged"), "item-delivery").components.empty());
  EXPECT_FALSE(make_curriculum(atlas_of("item-delivery")).update);
}

TEST(Update, IsSaidInPlainWords) {
  const auto free = curriculum_of("item-delivery", updated("rubble_free")).update.value();
  EXPECT_EQ(free.text,
            "The robot has been updated. Now crossing rubble is better than 2 steps. As before, stopping at the "
            "charger is worth less than 4 steps; stopping at the charger is worth more than 2 steps.");
  const auto halved = curriculum_of("item-delivery", updated("charger_halved")).update.value();
  EXPECT_THAT(halved.now, ::testing::ElementsAre("stopping at the charger is worth less than 2 steps"));
  EXPECT_THAT(halved.still, ::testing::Contains("crossing rubble costs more than 2 steps"));
}

}  // namespace
}  // namespace kith
