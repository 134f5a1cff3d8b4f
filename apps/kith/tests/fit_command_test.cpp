#include <gtest/gtest.h>

#include <memory>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

// Some people in a run folder, made once.
class FitCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<Scratch>();
    expect_code(0, {"study", "quick", "-o", *scratch_ / "run", "-q", "--set", "learner.N.particles=100", "--set",
                    "learner.P.particles=100"});
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  static Ran fit(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"fit", *scratch_ / "run", "--folds", "0", "--replicates", "1"});
    return run_kith(arguments);
  }

  static std::unique_ptr<Scratch> scratch_;
};
std::unique_ptr<Scratch> FitCommand::scratch_;

TEST_F(FitCommand, SaysWhatItFoundAndWhatCannotBeTold) {
  const auto ran = fit({});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("What these data can tell"));
  EXPECT_THAT(ran.out, HasSubstr("these data cannot tell the gains apart"));
  EXPECT_THAT(ran.out, HasSubstr("[learner.N]"));
  EXPECT_THAT(ran.out, HasSubstr("posterior medians, used in the [learner] sections below"));
  EXPECT_THAT(ran.out, HasSubstr("posterior medians and the maximum of the likelihood differ where"));
  EXPECT_THAT(ran.err, HasSubstr("W0704"));
  EXPECT_THAT(ran.err, HasSubstr("computing the likelihood of 12 people takes "));
}

TEST_F(FitCommand, WritesTheSameJsonToFileAndOutput) {
  const auto file = *scratch_ / "fit.json";
  const auto ran = fit({"--json", "-q", "-o", file});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  const auto document = Json::parse(ran.out);
  EXPECT_EQ(document, Json::parse(text_of(file)));
  EXPECT_EQ(document["schema"], "kith.fit/1");
  EXPECT_EQ(document["people"].size(), 12u);
  EXPECT_TRUE(document["types"][0]["ability_mean"]["estimate"].is_number());
  for (const auto* key : {"ability_mean", "ability_sd", "confirm_gain_scale", "correct_gain_scale"}) {
    const auto& parameter = document["types"][0][key];
    EXPECT_LE(parameter["lower"], parameter["estimate"]) << key;
    EXPECT_GE(parameter["upper"], parameter["estimate"]) << key;
  }
  EXPECT_TRUE(document["why_estimates_differ"].is_string());
  const auto& upper = document["types"][0]["confirm_gain_scale"]["maximum_likelihood"]["upper"];
  EXPECT_TRUE(upper.is_null() || upper.is_number());
  EXPECT_EQ(document["notes"].size(), 1u);

  const auto again = fit({"-o", file});
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("--yes"));
  EXPECT_EQ(fit({"-q", "-o", file, "--yes"}).code, 0);
}

TEST_F(FitCommand, TellsTypesWithoutLabels) {
  const auto ran = fit({"--types", "2", "-q"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("type 2"));
}

TEST_F(FitCommand, ExitsWithTheCodeOfTheFault) {
  const Scratch scratch;
  EXPECT_EQ(run_kith({"fit"}).code, 2);
  EXPECT_EQ(run_kith({"fit", scratch / "nowhere"}).code, 5);
  std::filesystem::create_directory(scratch / "empty");
  EXPECT_THAT(err_of(3, {"fit", scratch / "empty"}), HasSubstr("error[E0703]"));
  std::ofstream{scratch / "t.csv"} << "user_id,domain,interaction_type,is_opt_response\na,at,final test,1\n";
  const auto few = run_kith({"fit", scratch / "t.csv"});
  EXPECT_EQ(few.code, 4);
  EXPECT_THAT(few.err, HasSubstr("too few people"));
}

}  // namespace
}  // namespace kith::testing
