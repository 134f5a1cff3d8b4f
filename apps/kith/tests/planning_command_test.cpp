// kith power.
#include <gtest/gtest.h>

#include <fstream>

#include "run_kith.hpp"

namespace kith::testing {
namespace {

constexpr const char* kTarget = "[[target]]\nquantity = \"periods\"\nteams = \"group\"\nvalue = 6.0\ntolerance = 0.5\n";
constexpr const char* kFinding = "[[finding]]\neffect = \"periods: group - baseline\"\nsignificant = true\n";

std::string file_with(const Scratch& scratch, const std::string& name, const std::string& content) {
  const auto path = scratch / name;
  std::ofstream{path} << "schema = \"kith.targets/1\"\n" << content;
  return path;
}

// Beliefs of 100 particles: a study in a moment.
const std::vector<std::string> kSmall{"--set", "teacher.particles=100",  "--set", "learner.N.particles=100",
                                      "--set", "learner.P.particles=100"};

Ran run_small(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
  return run_kith(arguments);
}

TEST(PowerCommand, RefusesAStudyWhoseKeysVary) {
  EXPECT_THAT(err_of(3, {"power", "quick", "--set", "design.vary={\"stop.max_periods\"=[5,9]}"}), HasSubstr("E0812"));
}

TEST(PowerCommand, DrawsACurveAndPrintsADocument) {
  const std::vector<std::string> arguments{
      "power", "quick", "--effect", "periods: group - baseline", "--teams", "3,6", "--pool", "12", "--draws", "20"};
  const auto text = run_small(arguments);
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("periods: group - baseline: difference"), HasSubstr("power 0.8"),
                              HasSubstr("95 % interval")));
  auto with_json = arguments;
  with_json.insert(with_json.end(), {"--json", "-j", "1"});
  const auto one = run_small(with_json);
  with_json.back() = "3";
  EXPECT_EQ(one.out, run_small(with_json).out);
  const auto document = Json::parse(one.out);
  EXPECT_EQ(document["schema"], "kith.power/1");
  EXPECT_EQ(document["effects"][0]["points"].size(), 2u);
}

// Beyond three features knowledge says little, and the exam leads.
TEST(PowerCommand, BeginsWithTheExamBeyondThreeFeatures) {
  const auto first = [](const std::string& domain) {
    const auto ran =
        run_small({"power", "quick", "--teams", "2", "--pool", "8", "--draws", "10", "--json", "--set",
                   "domain=\"" + domain + "\"", "--set", "record.exam=\"end\"", "--set", "stop.max_periods=1"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    return Json::parse(ran.out).at("effects").at(0).at("effect").get<std::string>();
  };
  EXPECT_THAT(first("rescue-floor"), HasSubstr("exam_regret"));
  EXPECT_THAT(first("item-delivery"), HasSubstr("periods"));
}

TEST(PowerCommand, StatesWhatItAssumes) {
  std::vector<std::string> arguments{"power", "quick", "--teams", "3", "--pool", "12", "--draws", "20"};
  EXPECT_THAT(run_small(arguments).out,
              AllOf(HasSubstr("Each team contributes one value"), HasSubstr("Every cell teaches different people"),
                    HasSubstr("add --paired")));
  arguments.emplace_back("--paired");
  EXPECT_THAT(run_small(arguments).out, HasSubstr("strategies are compared within people"));
  arguments.emplace_back("--json");
  EXPECT_EQ(Json::parse(run_small(arguments).out)["assumptions"].size(), 2u);
}

TEST(PowerCommand, RepeatsAStudy) {
  const Scratch scratch;
  const auto findings = file_with(scratch, "findings.toml", kFinding);
  const auto ran = run_small({"power", "quick", "--findings", findings, "--studies", "3"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("3 study runs"), HasSubstr("All findings as published")));
}

// It says how much there is to do before it begins; how long it takes is for people only.
TEST(PowerCommand, SaysHowLongItTakes) {
  const auto power = run_small({"power", "quick", "--teams", "3", "--pool", "12", "--draws", "20"});
  EXPECT_THAT(power.err, HasSubstr("simulating 24 teams takes "));
  const Scratch scratch;
  const auto findings = file_with(scratch, "findings.toml", kFinding);
  EXPECT_THAT(run_small({"power", "quick", "--findings", findings, "--studies", "3"}).err,
              HasSubstr("simulating 18 teams takes "));
}

TEST(PowerCommand, SaysWhatIsWrong) {
  const Scratch scratch;
  const auto targets = file_with(scratch, "targets.toml", kTarget);
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{"power", "quick", "--effect", "periods: nobody - common"}, "E0809"},
      {{"power", "quick", "--alpha", "2"}, "--alpha must be a number from 0.000001 to 0.999999, not '2'"},
      {{"power", "quick", "--alpha", "1e-300"}, "--alpha must be a number from 0.000001"},
      {{"analyze", "run", "--alpha", "1e-300"}, "--alpha must be a number from 0.000001"},
      {{"power", "quick", "--target", "x"}, "--target must be a number from 0.000001 to 0.999999, not 'x'"},
      {{"power", "quick", "--teams", "10", "--pool", "12"}, "the largest of --teams is 10); use --pool 20"},
      {{"power", "quick", "--pool", "12"}, "--teams is 5,10,15,20,30,50,100 by default); use --pool 200"},
      {{"power", "quick", "--findings", targets}, "E0813"}};
  for (const auto& [arguments, message] : refused) {
    const auto ran = run_kith(arguments);
    EXPECT_THAT(ran.code, ::testing::AnyOf(2, 3)) << message;
    EXPECT_THAT(ran.err, HasSubstr(message));
  }
}

// The mean of the only composition, as JSON has it.
std::string mean_periods(const Json& report, const std::string& strategy) {
  const auto& cells = report.at("tables").at("cells");
  const auto column = [&](const std::string& name) {
    const auto& all = cells.at("columns");
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
  };
  for (const auto& row : cells.at("rows"))
    if (row.at(column("strategy")) == strategy) return row.at(column("periods_mean")).dump();
  return "";
}

// The models are those that kith analyze then fits.
TEST(PowerCommand, WritesAPreregistrationWhoseModelsTheAnalysisFits) {
  const Scratch scratch;
  const auto file = scratch / "plan.md";
  const auto ran = run_small({"power", "quick", "--effect", "periods: group - baseline", "--teams", "3", "--pool", "16",
                              "--draws", "20", "--set", "replicates=4", "--preregister", file});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto plan = text_of(file);
  EXPECT_THAT(plan, AllOf(HasSubstr("# Preregistration: "), HasSubstr("## Hypotheses"), HasSubstr("## Stopping rule"),
                          HasSubstr("4 teams per cell."), HasSubstr("| periods: group - baseline | difference ")));
  const auto folder = scratch / "run";
  ASSERT_EQ(run_small({"study", "quick", "-o", folder, "-q", "--set", "replicates=4"}).code, 0);
  const auto document = json_of({"analyze", folder});
  for (const auto& finding : document.at("findings")) {
    if (finding.at("id") == "demonstrations") continue;
    EXPECT_THAT(plan, HasSubstr("* Model: `" + finding.at("model").get<std::string>() + "`"));
    EXPECT_THAT(plan, HasSubstr(finding.at("question").get<std::string>()));
  }
  EXPECT_EQ(run_kith({"power", "quick", "--findings", "f.toml", "--preregister", file}).code, 2);
  // A plan that is written later says so, and its teams are others than those of the study, with the same seed too.
  EXPECT_THAT(plan, HasSubstr("no finished run was found in `results/"));
  const auto late =
      run_small({"power", "quick", "--effect", "periods: group - baseline", "--teams", "4", "--pool", "8", "--seed",
                 "1", "--set", "replicates=4", "--results", folder, "--preregister", file, "--draws", "20", "--json"});
  ASSERT_EQ(late.code, 0) << late.err;
  EXPECT_THAT(text_of(file), HasSubstr("**after the study was run**: `" + folder + "` holds a run of these inputs"));
  const auto pool = scratch / "pool";
  ASSERT_EQ(run_small({"study", "quick", "-o", pool, "-q", "--set", "replicates=8"}).code, 0);
  const auto report = json_of({"report", pool});
  EXPECT_THAT(late.out, ::testing::Not(HasSubstr("\"mean\":" + mean_periods(report, "baseline") + ",")));
  // What was planned is proved to be what was run.
  const auto manifest = Json::parse(text_of(folder + "/manifest.json"));
  EXPECT_THAT(plan, AllOf(HasSubstr(", written by kith "), HasSubstr("* Seed: "), HasSubstr("; weights: rubble"),
                          HasSubstr("[learner.N]"),
                          HasSubstr("| all inputs | " + manifest.at("run").get<std::string>() + " |")));
  for (const auto& [name, digest] : manifest.at("inputs").items())
    EXPECT_THAT(plan, HasSubstr("| " + name + " | " + digest.get<std::string>() + " |"));
}

// The planned contrasts are the hypotheses, in the plan, the analysis and the report; all else is exploratory. One that
// no power is estimated for is named.
TEST(PowerCommand, PreregistersThePrimaryContrastsAsTheHypotheses) {
  const Scratch scratch;
  const auto run_planned = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--set", "replicates=4", "--set", "design.strategies=[\"common\",\"individual-low\"]",
                               "--set", "design.compositions=[\"NN\",\"NP\",\"PP\"]", "--set",
                               "contrast=[{name=\"the team's belief\",of=[\"common\"],against=[\"individual-low\"],"
                               "response=\"knowledge\",primary=true},"
                               "{name=\"any P\",factor=\"composition\",of=[\"NP\",\"PP\"],against=[\"NN\"]}]"});
    return run_small(words);
  };
  const auto file = scratch / "plan.md";
  const auto ran =
      run_planned({"power", "quick", "--teams", "3", "--pool", "16", "--draws", "20", "--preregister", file});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto plan = text_of(file);
  for (const auto& text : {ran.err, plan})
    EXPECT_THAT(text, HasSubstr("no power is estimated for the planned contrasts 'any P'"));
  EXPECT_THAT(plan, HasSubstr("| knowledge: common - individual-low | difference"));
  const auto hypotheses = plan.substr(plan.find("## Hypotheses"), plan.find("## Design") - plan.find("## Hypotheses"));
  EXPECT_THAT(hypotheses, HasSubstr("1. `knowledge`: the team's belief: the weighted sum of means 1 common - 1 "
                                    "individual-low is not 0."));
  EXPECT_THAT(hypotheses, ::testing::Not(HasSubstr("2. ")));
  EXPECT_LT(plan.find("### 1. Primary hypothesis"), plan.find("## Exploratory analyses"));
  EXPECT_GT(plan.find("Does the strategy", plan.find("## Exploratory analyses")), plan.find("## Exploratory analyses"));
  const auto folder = scratch / "run";
  ASSERT_EQ(run_planned({"study", "quick", "-o", folder, "-q"}).code, 0);
  const auto document = json_of({"analyze", folder});
  EXPECT_EQ(document.at("findings").at(0).at("id"), "primary");
  const auto report = json_of({"report", folder});
  EXPECT_EQ(report.at("findings").at(0).at("id"), "primary");
  EXPECT_EQ(report.at("overview").at("answers").at(0).at("finding"), "primary");  // in the first screen
}

TEST(PowerCommand, RefusesEffectsThatNoStudyCanHaveAndWarnsOfHugeOnes) {
  const auto power = [](const std::string& effect) {
    return run_kith({"power", "quick", "--effect", effect, "--teams", "3", "--pool", "12", "--draws", "20"});
  };
  const auto refused = power("knowledge: group - baseline = 1.5");
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("E0816"), HasSubstr("it lies between 0 and 1")));
  EXPECT_EQ(refused.out, "");
  const auto warned = power("periods: group - baseline = 8");
  EXPECT_EQ(warned.code, 0) << warned.err;
  EXPECT_THAT(warned.err, HasSubstr("standard deviations within cells: hardly any teaching does that"));
  EXPECT_THAT(warned.out, AllOf(HasSubstr("periods of simulated teams (can be 0 or more)"), HasSubstr("imposed 1")));
  EXPECT_THAT(power("periods: group - baseline").err, ::testing::Not(HasSubstr("hardly any")));
}

}  // namespace
}  // namespace kith::testing
