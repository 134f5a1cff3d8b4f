// What somebody with a robot of her own meets in the first hour.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kHospital = std::string{KITH_SOURCE_DIR} + "/libs/explain/tests/questions/hospital.toml";

TEST(FirstHour, WorldsGoByTheirNames) {
  EXPECT_THAT(run_kith({"inspect", kHospital, "--mdp", "visiting hours"}).out,
              HasSubstr("Map of world 2 (visiting hours)"));
  EXPECT_EQ(run_kith({"inspect", kHospital, "--mdp", "Visiting Hours"}).out,
            run_kith({"inspect", kHospital, "--mdp", "2"}).out);
  const auto wrong = err_of(2, {"inspect", kHospital, "--mdp", "noon"});
  EXPECT_THAT(wrong, AllOf(HasSubstr("no world 'noon'"), HasSubstr("night, morning round")));
  EXPECT_THAT(run_kith({"teach", kHospital, "--group", "NP"}).out, HasSubstr("world "));
  EXPECT_THAT(run_kith({"inspect", kHospital, "--json"}).out, HasSubstr("morning round"));
}

TEST(FirstHour, InspectSaysWhatMattersAndWhatWorks) {
  const auto out = run_kith({"inspect", kHospital}).out;
  EXPECT_THAT(out, AllOf(HasSubstr("What matters: "), HasSubstr("crossing a wet floor costs"),
                         HasSubstr("What works with this robot"), HasSubstr("paths that it samples")));
  EXPECT_THAT(run_kith({"inspect", "item-delivery"}).out, HasSubstr("  kith fit and kith audit"));
}

TEST(FirstHour, AnExampleOfTrialsCanBeFitted) {
  const Scratch scratch;
  const auto folder = scratch / "answers";
  EXPECT_THAT(run_kith({"init", folder, "--trials"}).out, HasSubstr("trials.csv"));
  expect_code(0, {"fit", folder + "/trials.csv", "--folds", "0", "--replicates", "1"});
}

TEST(FirstHour, MessagesShowTheMend) {
  const auto table = run_kith({"study", "quick", "--dry-run", "--set", "learner.N.ability=0.7"});
  EXPECT_EQ(table.code, 3);
  EXPECT_THAT(table.err,
              AllOf(HasSubstr("'ability' must be a table"), HasSubstr("write ability = { mean = 0.7, sd = ")));
  EXPECT_THAT(run_kith({"study", "quick", "--dry-run", "--set", "replicates=1000000"}).out, HasSubstr("GB on disk"));
  EXPECT_THAT(run_kith({"study", "quick", "--dry-run", "--set", "learner.N.correct_gain=0.05"}).err,
              HasSubstr("write correct_gain = { value = 0.05 } for everybody"));
  EXPECT_THAT(run_kith({"study", "quick", "--dry-run", "--set", "seed=99999999999999999999999"}).err,
              AllOf(HasSubstr("E0110"), HasSubstr("9223372036854775807")));
  EXPECT_THAT(run_kith({"study", "quick", "--dry-run", "--seed", "99999999999999999999999"}).err,
              HasSubstr("from 0 to 9223372036854775807"));
  EXPECT_THAT(run_kith({"teach", "item-delivery", "--group", "nnp"}).err, HasSubstr("did you mean --group NNP?"));
}

TEST(FirstHour, AFolderInPlaceOfAFileNamesTheFilesInIt) {
  const Scratch scratch;
  const auto folder = scratch / "robot";
  ASSERT_EQ(run_kith({"init", folder}).code, 0);
  for (const auto& args : std::vector<std::vector<std::string>>{{"inspect", folder},
                                                                {"teach", folder, "--group", "NP"},
                                                                {"validate", folder},
                                                                {"study", folder, "-o", "x"}}) {
    EXPECT_THAT(run_kith(args).err, AllOf(HasSubstr("it is a folder"), HasSubstr(folder + "/domain.toml"))) << args[0];
  }
}

}  // namespace
}  // namespace kith::testing
