#include "kith/study/study_file.hpp"
#include "kith/study/team_streams.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>

#include <algorithm>
#include <fstream>

#include "kith/core/error.hpp"
#include "study_file_support.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using testing::ids;
using testing::kStudy;
using testing::parse;
using testing::study_with;

TEST(StudyFile, NamesPlannedContrasts) {
  const std::string text = std::string{kStudy} +
                           "[[contrast]]\nname = \"together\"\nof = [\"common\"]\nagainst = [\"baseline\"]\n"
                           "[[contrast]]\nname = \"size\"\nfactor = \"composition\"\nresponse = \"periods\"\n"
                           "weights = { NN = 2, N = -2 }\n";
  const auto reading = parse(text);
  ASSERT_TRUE(reading.study) << reading.diagnostics.front().message;
  const auto& contrasts = reading.study->variants.front().contrasts;
  ASSERT_EQ(contrasts.size(), 2u);
  EXPECT_EQ(contrasts[0], (StudyContrast{"together", "strategy", {{"common", 1.0}, {"baseline", -1.0}}, ""}));
  EXPECT_EQ(contrasts[1], (StudyContrast{"size", "composition", {{"NN", 2.0}, {"N", -2.0}}, "periods"}));
  // The frozen study has them too.
  const auto again = parse(to_toml(*reading.study, *reading.domain));
  ASSERT_TRUE(again.study);
  EXPECT_EQ(again.study->variants.front().contrasts, contrasts);
}

TEST(StudyFile, MarksHypotheses) {
  const std::string contrast =
      "[[contrast]]\nname = \"size\"\nfactor = \"composition\"\nweights = { NN = 1, N = -1 }\n";
  for (const bool primary : {true, false}) {
    const auto reading = parse(std::string{kStudy} + contrast + (primary ? "primary = true\n" : ""));
    ASSERT_TRUE(reading.study) << reading.diagnostics.front().message;
    EXPECT_EQ(reading.study->variants.front().contrasts.front().primary, primary);
    const auto frozen = to_toml(*reading.study, *reading.domain);
    EXPECT_EQ(frozen.find("primary") != std::string::npos, primary);
    const auto again = parse(frozen);
    ASSERT_TRUE(again.study);
    EXPECT_EQ(again.study->variants.front().contrasts, reading.study->variants.front().contrasts);
  }
}

TEST(StudyFile, RefusesContrastsThatCompareNothing) {
  const auto ids_of = [](const std::string& contrast) {
    return ids(parse(std::string{kStudy} + "[[contrast]]\nname = \"x\"\n" + contrast));
  };
  EXPECT_THAT(ids_of("of = [\"common\"]\nagainst = [\"comon\"]\n"), ElementsAre("E0420"));
  EXPECT_THAT(ids_of("of = [\"common\"]\nagainst = [\"common\"]\n"), ElementsAre("E0420"));
  EXPECT_THAT(ids_of("weights = { common = 1 }\n"), ElementsAre("E0420"));
  EXPECT_THAT(ids_of("response = \"exam_regret\"\nof = [\"common\"]\nagainst = [\"baseline\"]\n"),
              ElementsAre("E0420"));
  EXPECT_THAT(ids_of("weights = { common = 0, baseline = 0 }\n"), ElementsAre("E0420"));
  // What kith analyze would leave out is no hypothesis.
  EXPECT_THAT(ids_of("primary = true\nof = [\"common\"]\nagainst = [\"baseline\"]\n"), ElementsAre("E0420"));
}

// What a contrast compares cannot be known then.
TEST(StudyFile, SaysOfADesignWithAMistakeOnlyTheMistake) {
  const std::string contrast =
      "[[contrast]]\nname = \"x\"\nof = [\"common\"]\nagainst = [\"baseline\"]\n"
      "[[contrast]]\nname = \"y\"\nfactor = \"composition\"\nweights = { NN = 1, N = -1 }\n";
  const auto ids_with = [&](const std::string& old, const std::string& wrong) {
    std::string text = kStudy;
    return ids(parse(text.replace(text.find(old), old.size(), wrong) + contrast));
  };
  EXPECT_THAT(ids_with("\"N\"]", "\"NX\"]"), ElementsAre("E0405"));
  EXPECT_THAT(ids_with("\"common\"", "\"comon\""), ElementsAre("E0402"));
}

TEST(StudyFile, GivesEveryKeyItsDocumentedDefault) {
  const auto reading = parse(kStudy);
  ASSERT_TRUE(reading.study) << reading.diagnostics.size();
  EXPECT_THAT(reading.diagnostics, IsEmpty());
  ASSERT_EQ(reading.study->variants.size(), 1u);
  const auto& spec = reading.study->variants.front();
  EXPECT_EQ(spec.seed, 7u);
  EXPECT_EQ(spec.pairing, Pairing::kReplicate);
  EXPECT_EQ(spec.record, RecordLevel::kPeriod);
  EXPECT_EQ(spec.teaching.filter.particles, 1000u);
  EXPECT_EQ(spec.teaching.counterfactuals, 8u);
  EXPECT_EQ(spec.teaching.assumed_ability, 0.80);
  EXPECT_EQ(spec.teaching.filter.process_noise, 0.1);
  EXPECT_EQ(spec.teaching.response_noise, 0.05);
  EXPECT_EQ(spec.teaching.filter.resample_below, 0.5);
  EXPECT_EQ(spec.teaching.max_periods, 50u);
  EXPECT_EQ(spec.teaching.mastery, stop_rule_named("all-right"));
  EXPECT_EQ(spec.teaching.scaffold, Scaffold::kOfStrategy);
  EXPECT_EQ(spec.teaching.objective, TeachingObjective::kRegret);
  EXPECT_EQ(spec.teaching.max_demonstrations, 0u);
  EXPECT_FALSE(spec.teaching.review);
  EXPECT_EQ(spec.exam, ExamLevel::kNone);
  EXPECT_EQ(spec.teaching.release, std::nullopt);
  EXPECT_EQ(spec.forecast_sessions, 0u);
  EXPECT_FALSE(spec.estimates);
  EXPECT_EQ(spec.teaching.pace, Pace{});
  const auto& novice = learner_type(spec, 'N');
  EXPECT_EQ(novice.parameters.real("ability.min"), 0.6);
  EXPECT_EQ(novice.parameters.real("ability_max"), 0.95);
  EXPECT_EQ(novice.parameters.real("ability_scale"), 1.0);
  EXPECT_EQ(novice.parameters.real("gain_max"), 0.08);
  EXPECT_EQ(novice.parameters.spread("confirm_gain").half_normal, 0.03);
  EXPECT_EQ(novice.parameters.spread("correct_gain").value, 0.05);
  EXPECT_FALSE(novice.prior);
}

TEST(StudyFile, ReadsHowLongAndWithWhatPeopleAreTaught) {
  const auto text = study_with("[learner.N]",
                               "[teacher]\nreview = true\nscaffold = \"none\"\nmax_demonstrations = 3\n"
                               "objective = \"worst-member\"\n[stop]\nmastery = \"posterior\"\nprobability = 0.95\n"
                               "min_periods = 2\nperiods_per_component = 4\n[record]\nexam = \"period\"\n"
                               "exam_questions = 6\n[learner.N]");
  const auto first = parse(text);
  ASSERT_TRUE(first.study) << ::testing::PrintToString(ids(first));
  for (const auto& reading : {parse(text), parse(to_toml(*first.study, *first.domain))}) {
    ASSERT_TRUE(reading.study) << ::testing::PrintToString(ids(reading));
    const auto& spec = reading.study->variants.front();
    EXPECT_TRUE(spec.teaching.review);
    EXPECT_EQ(spec.teaching.scaffold, Scaffold::kNone);
    EXPECT_EQ(spec.teaching.max_demonstrations, 3u);
    EXPECT_EQ(spec.teaching.objective, TeachingObjective::kWorstMember);
    EXPECT_EQ(spec.teaching.mastery, stop_rule_named("posterior"));
    EXPECT_EQ(spec.teaching.probability, 0.95);
    EXPECT_EQ(spec.teaching.min_periods, 2u);
    EXPECT_EQ(spec.teaching.periods_per_component, 4u);
    EXPECT_EQ(spec.exam, ExamLevel::kPeriod);
    EXPECT_EQ(spec.exam_questions, 6u);
  }
}

TEST(StudyFile, ReadsWhenTheExamStops) {
  const auto text = study_with("[learner.N]", "[stop]\nmastery = \"exam\"\nshare_right = 0.85\n[learner.N]");
  const auto first = parse(text);
  ASSERT_TRUE(first.study) << ::testing::PrintToString(ids(first));
  for (const auto& reading : {parse(text), parse(to_toml(*first.study, *first.domain))}) {
    ASSERT_TRUE(reading.study) << ::testing::PrintToString(ids(reading));
    EXPECT_EQ(reading.study->variants.front().teaching.mastery, stop_rule_named("exam"));
    EXPECT_EQ(reading.study->variants.front().teaching.share_right, 0.85);
  }
  for (const auto* wrong : {"0", "1", "1.5", "-0.1", "\"high\""}) {
    const auto refused = parse(
        study_with("[learner.N]", std::string{"[stop]\nmastery = \"exam\"\nshare_right = "} + wrong + "\n[learner.N]"));
    EXPECT_FALSE(refused.study) << wrong;
    EXPECT_FALSE(refused.diagnostics.empty()) << wrong;
  }
}

// Everybody of a mixed type is of one of its parts; n = 200 people, shares within 5 standard errors.
TEST(StudyFile, ReadsMixturesAndDrawsPeopleFromThem) {
  const auto text = study_with("[learner.N]",
                               "[learner.N]\nmixture = { M = 0.7, S = 0.3 }\n[learner.S]\nkind = \"slipping\"\n"
                               "ability = { mean = 0.8, sd = 0.03 }\nconfirm_gain = { value = 0 }\n"
                               "correct_gain = { value = 0.01 }\n[learner.M]");
  const auto first = parse(text);
  ASSERT_TRUE(first.study) << ::testing::PrintToString(ids(first));
  EXPECT_TRUE(first.diagnostics.empty()) << ::testing::PrintToString(ids(first));
  const auto second = parse(to_toml(*first.study, *first.domain));
  ASSERT_TRUE(second.study) << ::testing::PrintToString(ids(second));
  const auto& spec = second.study->variants.front();
  EXPECT_EQ(learner_type(spec, 'N').mixture, (std::vector<LearnerShare>{{'M', 0.7}, {'S', 0.3}}));
  EXPECT_EQ(to_toml(*second.study, *second.domain), to_toml(*first.study, *first.domain));
  constexpr int n = 200;
  int slipping = 0;
  for (std::uint64_t person = 0; person < n; ++person) {
    const char letter = type_of_person(spec, 'N', RandomStream{person}).letter;
    EXPECT_TRUE(letter == 'M' || letter == 'S');
    slipping += letter == 'S' ? 1 : 0;
  }
  EXPECT_NEAR(slipping / double{n}, 0.3, 5.0 * std::sqrt(0.3 * 0.7 / n));
  EXPECT_EQ(type_of_person(spec, 'M', RandomStream{1}).letter, 'M');
}

TEST(StudyFile, ReadsWhoIsReleasedAndWhatIsForecast) {
  const auto text = study_with("[learner.N]",
                               "[teacher]\ngrouping = \"together\"\nhypotheses = \"known-components\"\n"
                               "[stop]\nrelease = \"posterior\"\n[pace]\ndemonstration_s = 8\n"
                               "test_s = 12.5\nfeedback_s = 0\n[record]\nforecast = 50\nestimates = true\n"
                               "proficient_ability = 0.8\n[learner.N]\nknown = 0.5");
  const auto first = parse(text);
  ASSERT_TRUE(first.study) << ::testing::PrintToString(ids(first));
  for (const auto& reading : {parse(text), parse(to_toml(*first.study, *first.domain))}) {
    ASSERT_TRUE(reading.study) << ::testing::PrintToString(ids(reading));
    const auto& spec = reading.study->variants.front();
    EXPECT_EQ(spec.teaching.hypotheses_about, HypothesesAbout::kKnownComponents);
    EXPECT_EQ(spec.teaching.release, stop_rule_named("posterior"));
    EXPECT_EQ(spec.teaching.pace, (Pace{8.0, 12.5, 0.0}));
    EXPECT_EQ(spec.forecast_sessions, 50u);
    EXPECT_TRUE(spec.estimates);
    EXPECT_EQ(spec.proficient_ability, 0.8);
    EXPECT_EQ(learner_type(spec, 'N').parameters.real("known"), 0.5);
    EXPECT_TRUE(has_costs(spec));
  }
  EXPECT_FALSE(has_costs(parse(kStudy).study->variants.front()));
}

TEST(StudyFile, ReadsTheBuiltInStudiesWithoutAComplaint) {
  for (const auto& study : built_in_studies()) {
    const auto reading = load_study(std::string{study.name});
    ASSERT_TRUE(reading.study) << study.name;
    EXPECT_THAT(reading.diagnostics, IsEmpty()) << study.name;
  }
  const auto paper = load_study("paper");
  EXPECT_EQ(team_addresses(*paper.study).size(), 300u);
  EXPECT_EQ(learner_type(paper.study->variants.front(), 'P').parameters.real("ability_scale"), 0.92);
}

struct Mistake {
  const char* id;
  const char* old;
  const char* replacement;
  std::size_t line;
};

class StudyFileMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(StudyFileMistakes, AreReportedWithTheirPlace) {
  const auto& mistake = GetParam();
  const auto reading = parse(study_with(mistake.old, mistake.replacement));
  const auto found = std::find_if(reading.diagnostics.begin(), reading.diagnostics.end(),
                                  [&](const Diagnostic& diagnostic) { return diagnostic.id == mistake.id; });
  ASSERT_NE(found, reading.diagnostics.end()) << ::testing::PrintToString(ids(reading));
  EXPECT_EQ(found->line, mistake.line) << to_text(*found);
  EXPECT_EQ(found->file, "study.toml");
  EXPECT_EQ(reading.study.has_value(), mistake.id[0] == 'W');
}

INSTANTIATE_TEST_SUITE_P(
    All, StudyFileMistakes,
    ::testing::Values(
        Mistake{"E0101", "seed = 7", "seed = ", 4}, Mistake{"E0106", "kith.study/1", "kith.study/9", 1},
        Mistake{"E0115", "\"tiny\"", "\"Tiny Study\"", 2}, Mistake{"E0116", "\"item-delivery\"", "\"item-delivry\"", 3},
        Mistake{"E0107", "[design]", "teacher.conflict = \"largest-consistent\"\n[design]", 6},
        Mistake{"E0107", "[design]", "teacher.grouping = \"by-type\"\n[design]", 6},
        Mistake{"E0107", "replicates", "replicats", 5}, Mistake{"E0108", "seed = 7", "seed = 7.5", 4},
        Mistake{"E0109", "correct_gain", "gain_max = 0.07 #", 9},
        Mistake{"E0110", "replicates = 2", "replicates = 0", 5}, Mistake{"E0110", "mean = 0.7", "mean = 1.7", 10},
        Mistake{"E0112", "[design]", "record.level = \"all\"\n[design]", 6},
        Mistake{"E0401", "[\"common\", \"baseline\"]", "[]", 7}, Mistake{"E0402", "\"common\"", "\"comon\"", 7},
        Mistake{"E0403", "\"baseline\"", "\"common\"", 7}, Mistake{"E0403", "\"N\"]", "\"NN\"]", 8},
        Mistake{"E0404", "\"N\"]", "\"\"]", 8}, Mistake{"E0405", "\"N\"]", "\"NX\"]", 8},
        Mistake{"E0406", "learner.N", "learner.Nov", 9}, Mistake{"E0407", "{ half_normal = 0.03 }", "{}", 11},
        Mistake{"E0407", "{ value = 0.05 }", "{ value = 0.05, half_normal = 0.1 }", 12},
        Mistake{"E0408", "sd = 0.03", "sd = 0.03, min = 0.96", 10}, Mistake{"E0409", "value = 0.05", "value = 0.0", 9},
        Mistake{"E0417", "correct_gain", "kind = \"baysian\"\ncorrect_gain", 12},
        Mistake{"E0410", "correct_gain", "prior = [{ stpe = -1 }]\ncorrect_gain", 12},
        Mistake{"E0410", "correct_gain", "prior = [{ step = 0 }]\ncorrect_gain", 12},
        Mistake{"E0411", "correct_gain", "prior = [{ step = 1 }]\ncorrect_gain", 12},
        Mistake{"E0412", "[learner.N]", "vary = { seed = [1, 2] }\n[learner.N]", 9},
        Mistake{"E0412", "[learner.N]", "vary = { \"learner.N.label\" = [\"a\"] }\n[learner.N]", 9},
        Mistake{"E0413", "[learner.N]", "vary = { \"stop.max_periods\" = 3 }\n[learner.N]", 9},
        Mistake{"E0403", "[learner.N]", "vary = { \"stop.max_periods\" = [3, 3] }\n[learner.N]", 9},
        Mistake{"E0110", "[learner.N]", "vary = { \"stop.max_periods\" = [3, 0] }\n[learner.N]", 9},
        Mistake{"E0107", "[learner.N]", "vary = { \"stop.max_perids\" = [3, 4] }\n[learner.N]", 9},
        Mistake{"E0423", "[learner.N]", "[learner.N]\nmixture = { M = 0.5 }\n[learner.M]", 10},
        Mistake{"E0423", "[learner.N]", "[learner.N]\nmixture = { M = 0.5, S = 0.5 }\n[learner.M]", 10},
        Mistake{"E0423", "[learner.N]", "[learner.N]\nmixture = { M = 0.5, MM = 0.5 }\n[learner.M]", 10},
        Mistake{"E0421", "[design]", "group.questions = [{ id = \"a b\", kind = \"text\", text = \"?\" }]\n[design]",
                6},
        Mistake{"E0421", "[design]", "group.questions = [{ id = \"a\", kind = \"choice\", text = \"?\" }]\n[design]",
                6},
        Mistake{"E0109", "[design]", "group.questions = [{ id = \"a\", kind = \"text\" }]\n[design]", 6},
        Mistake{"E0422", "[design]", "group.consent_file = \"a\"\ngroup.consent.text = \"b\"\n[design]", 6},
        Mistake{"E0422", "[design]", "group.dropout.min_active = 3\n[design]", 6},
        Mistake{"E0422", "[design]", "group.dropout = { policy = \"replace-from-pool\", reserves = 1 }\n[design]", 6},
        Mistake{"E0422", "[design]", "group.people = [3]\n[design]", 6},
        Mistake{"E0422", "[design]", "group.screening = { high = \"N\" }\n[design]", 6},
        Mistake{"E0422", "[design]", "group.screening = { tests = 2, high = \"Q\" }\n[design]", 6},
        Mistake{"E0422", "[design]", "group.completion.redirect = \"javascript:alert(1)\"\n[design]", 6},
        Mistake{"E0110", "[design]", "group.dropout.grace_s = -1\n[design]", 6},
        Mistake{"E0112", "[design]", "group.dropout.policy = \"wait\"\n[design]", 6},
        Mistake{"E0107", "[design]", "group.storry = \"once\"\n[design]", 6},
        Mistake{"W0401", "[learner.N]",
                "[learner.P]\nability = { mean = 0.8, sd = 0.02 }\nconfirm_gain = { value = 0.01 }\n"
                "correct_gain = { value = 0.02 }\n[learner.N]",
                9},
        Mistake{"W0402", "replicates = 2", "replicates = 1", 5}));

TEST(StudyFile, ReportsAllMistakesAtOnce) {
  const auto reading = parse(R"(schema = "kith.study/1"
id = "x"
domain = "item-delivery"
seed = -1
[design]
strategies = ["joined"]
compositions = ["Q"]
[learner.N]
ability = { mean = 0.7 }
[teacher]
particels = 5
)");
  EXPECT_THAT(ids(reading), ElementsAre("E0110", "E0402", "E0405", "E0109", "E0109", "W0401", "E0109", "E0107"));
}

TEST(StudyFile, SuggestsTheNearestWord) {
  const auto reading = parse(study_with("\"common\"", "\"comon\""));
  ASSERT_EQ(reading.diagnostics.size(), 1u);
  EXPECT_EQ(reading.diagnostics.front().hint, "did you mean 'common'?");
}

TEST(StudyFile, PointsAtTheLetterThatNamesNobody) {
  const auto reading = parse(study_with("\"NN\"", "\"NX\""));
  ASSERT_EQ(reading.diagnostics.size(), 1u);
  EXPECT_EQ(reading.diagnostics.front().column, 19u);  // compositions = ["NX"
}

TEST(StudyFile, TakesOverridesInOrder) {
  const auto reading = parse(kStudy, {"seed=8", "teacher.process_noise=0.5", "seed=9"});
  ASSERT_TRUE(reading.study);
  EXPECT_EQ(reading.study->variants.front().seed, 9u);
  EXPECT_EQ(reading.study->variants.front().teaching.filter.process_noise, 0.5);
}

TEST(StudyFile, ChecksOverridesLikeTheFile) {
  EXPECT_THAT(ids(parse(kStudy, {"seed"})), ElementsAre("E0113"));
  EXPECT_THAT(ids(parse(kStudy, {"seed.x=1"})), ElementsAre("E0114"));
  const auto wrong_type = parse(kStudy, {"seed=\"8\""});
  ASSERT_THAT(ids(wrong_type), ElementsAre("E0108"));
  EXPECT_EQ(wrong_type.diagnostics.front().file, "override");
  EXPECT_THAT(ids(parse(kStudy, {"teacher.particels=8"})), ElementsAre("E0107"));
}

TEST(StudyFile, ExpandsVariedKeysWithTheFirstSlowest) {
  const auto text = study_with("[learner.N]",
                               "vary = { \"stop.max_periods\" = [3, 4], \"teacher.counterfactual_sampling\" = "
                               "[\"systematic\", \"spread\"] }\n[learner.N]");
  const auto reading = parse(text);
  ASSERT_TRUE(reading.study);
  const auto& variants = reading.study->variants;
  ASSERT_EQ(variants.size(), 4u);
  EXPECT_EQ(variants[1].teaching.max_periods, 3u);
  EXPECT_EQ(variants[1].teaching.sampling, CounterfactualSampling::kSpread);
  EXPECT_EQ(variants[2].teaching.max_periods, 4u);
  EXPECT_THAT(variants[2].factors, ElementsAre(FactorSetting{"stop.max_periods", "4"},
                                               FactorSetting{"teacher.counterfactual_sampling", "systematic"}));
  EXPECT_EQ(team_addresses(*reading.study).size(), 4u * 2 * 2 * 2);
}

TEST(StudyFile, WarnsOfAnOverrideThatVariesAnyway) {
  const auto text = study_with("[learner.N]", "vary = { \"stop.max_periods\" = [3, 4] }\n[learner.N]");
  EXPECT_THAT(ids(parse(text, {"stop.max_periods=9"})), ElementsAre("W0403"));
}

TEST(StudyFile, WritesWhatReadsBackTheSame) {
  const auto varied =
      study_with("[learner.N]",
                 "vary = { \"stop.max_periods\" = [3, 4], \"teacher.likelihood\" = [\"continuous\"] }\n[learner.N]\n"
                 "prior = [{ step = -1 }, { rubble = -2, step = -3 }]\nability_scale = 0.1234567890123456789");
  for (const auto& text : {std::string{kStudy}, varied, std::string{built_in_studies().front().text}}) {
    const auto first = parse(text);
    ASSERT_TRUE(first.study) << ::testing::PrintToString(ids(first));
    const auto written = to_toml(*first.study, *first.domain);
    const auto second = parse(written);
    ASSERT_TRUE(second.study) << written << ::testing::PrintToString(ids(second));
    EXPECT_EQ(to_toml(*second.study, *second.domain), written);
    ASSERT_EQ(second.study->variants.size(), first.study->variants.size());
    for (std::size_t i = 0; i < first.study->variants.size(); ++i) {
      EXPECT_EQ(second.study->variants[i].factors, first.study->variants[i].factors);
      EXPECT_EQ(second.study->variants[i].teaching.max_periods, first.study->variants[i].teaching.max_periods);
      EXPECT_EQ(second.study->variants[i].learner_types.front().prior,
                first.study->variants[i].learner_types.front().prior);
    }
  }
}

constexpr const char* kGroup = R"([group]
title = "Robots"
story = ["One.", "Two."]
goal = "Learn."
consent = { version = "3", text = "I agree." }
auto_start = false
size = 3
people = [3, 1]
dropout = { policy = "simulate", grace_s = 5, min_active = 2 }
time = { watch_s = 1, predict_s = 2, feedback_s = 3, lobby_s = 4, leave_after_s = 5, max_minutes = 6 }
screening = { tests = 3, cut = 0.25, high = "N" }
screens = { predict_first = true, brackets = true }
completion = { prefix = "X", redirect = "https://example.org/?cc={code}", pay_full = false }
ask_name = true
collect_query = ["PROLIFIC_PID"]
[[group.questions]]
id = "clear"
kind = "likert"
text = "Was it clear?"
low = "no"
high = "yes"
required = true
[[group.questions]]
id = "age"
kind = "choice"
text = "How old are you?"
options = ["18 to 40", "older"]
)";

TEST(StudyFile, ReadsAndWritesHowGroupsOfPeopleAreTaught) {
  const auto reading = parse(std::string{kStudy} + kGroup);
  ASSERT_TRUE(reading.study) << to_text(reading.diagnostics.front());
  const auto& spec = reading.study->variants.front();
  EXPECT_TRUE(spec.has_group);
  const auto& group = spec.group;
  EXPECT_THAT(group.story, ElementsAre("One.", "Two."));
  EXPECT_THAT(group.consent_text, ElementsAre("I agree."));
  EXPECT_THAT(group.people, ElementsAre(1u, 3u));
  EXPECT_EQ(group.dropout, (GroupDropout{DropoutPolicy::kSimulate, 5, 2}));
  EXPECT_EQ(group.time, (GroupTime{1, 2, 3, 0, 4, 5, 6}));
  EXPECT_EQ(group.screening, (GroupScreening{3, 0.25}));
  EXPECT_EQ(group.screens, (GroupScreens{true, true}));
  EXPECT_EQ(group.high_types, "N");
  ASSERT_EQ(group.questions.size(), 2u);
  EXPECT_EQ(group.questions[1].kind, GroupQuestion::Kind::kChoice);
  EXPECT_TRUE(group.questions[0].required);
  const auto again = parse(to_toml(*reading.study, *reading.domain, GroupText::kWritten));
  ASSERT_TRUE(again.study) << to_text(again.diagnostics.front());
  EXPECT_EQ(again.study->variants.front().group, group);
}

// The frozen study is the identity of a run.
TEST(StudyFile, LeavesHowGroupsAreTaughtOutOfTheIdentityOfARun) {
  const auto without = parse(kStudy), with = parse(std::string{kStudy} + kGroup);
  ASSERT_TRUE(without.study && with.study);
  EXPECT_FALSE(without.study->variants.front().has_group);
  EXPECT_EQ(without.study->variants.front().group, GroupOptions{});
  EXPECT_EQ(to_toml(*with.study, *with.domain), to_toml(*without.study, *without.domain));
}

TEST(StudyFile, FindsADomainFileBesideTheStudy) {
  const auto folder = std::filesystem::path{::testing::TempDir()} / "kith study file test";
  std::filesystem::create_directories(folder);
  const auto built_in = load_study("quick");
  std::ofstream{folder / "world.toml"} << built_in.domain_text;
  std::ofstream{folder / "study.toml"} << study_with("\"item-delivery\"", "\"world.toml\"");
  const auto reading = load_study((folder / "study.toml").string());
  ASSERT_TRUE(reading.study);
  EXPECT_EQ(reading.domain->num_mdps(), 64u);
  EXPECT_EQ(reading.domain_text, built_in.domain_text);
  std::filesystem::remove_all(folder);
}

TEST(StudyFile, NamesTheBuiltInStudiesWhereThereIsNoSuchFile) {
  const std::vector<std::pair<std::string, std::string>> unknown{
      {"no-such-study.toml", "known: paper, paper-uncalibrated, quick"}, {"qick", "did you mean 'quick'?"}};
  for (const auto& [name, hint] : unknown) {
    try {
      (void)load_study(name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      ASSERT_EQ(error.diagnostics().size(), 1u);
      EXPECT_EQ(error.diagnostics()[0].hint, hint);
    }
  }
}

TEST(StudyFile, CannotReadAFolder) {
  try {
    (void)load_study(std::filesystem::temp_directory_path().string());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kIo);
  }
}

TEST(StudyFile, SaysOnlyThatAFileIsOfAnotherKind) {
  const auto reading = parse_study("schema = \"kith.domain/1\"\nid = 5\nsurplus = 1\n", "d.toml", {{"no=\"x\""}, {}});
  ASSERT_EQ(reading.diagnostics.size(), 1u);
  EXPECT_EQ(reading.diagnostics[0].id, "E0106");
  EXPECT_THAT(reading.diagnostics[0].message, HasSubstr("domain file"));
}

}  // namespace
}  // namespace kith
