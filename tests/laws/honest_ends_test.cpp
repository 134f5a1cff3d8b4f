// Whatever is documented as allowed ends as documented: random valid studies give tables without nonsense, and what
// they say was taught was shown; or they end with an error that says why.
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "kith/analysis/analysis.hpp"
#include "kith/core/error.hpp"
#include "kith/report/report.hpp"
#include "kith/runs/study_run.hpp"
#include "kith/study/tables.hpp"
#include "random_domains.hpp"
#include "random_studies.hpp"
#include "scratch_folder.hpp"

namespace kith::laws {
namespace {

// Words that stand for a number that is none: "nan", "inf", "-inf", in any case.
bool has_no_number(std::string_view text) {
  for (const std::string_view word : {"nan", "inf"}) {
    for (std::size_t at = 0; at + word.size() <= text.size(); ++at) {
      bool is_there = true;
      for (std::size_t i = 0; i < word.size() && is_there; ++i) {
        is_there = std::tolower(static_cast<unsigned char>(text[at + i])) == word[i];
      }
      const auto is_letter = [&](std::size_t i) {
        return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
      };
      if (is_there && (at == 0 || !is_letter(at - 1)) && !is_letter(at + word.size())) return true;
    }
  }
  return false;
}

void expect_probability(double x, const char* what) {
  EXPECT_GE(x, 0.0) << what;
  EXPECT_LE(x, 1.0 + 1e-12) << what;
}
void expect_probability(const std::optional<double>& x, const char* what) {
  if (x) expect_probability(*x, what);
}
void expect_within(double low, double x, double high, const char* what) {
  EXPECT_LE(low, x + 1e-9) << what;
  EXPECT_LE(x, high + 1e-9) << what;
}

void expect_honest(const Atlas& atlas, const StudySpec& spec, const TeamRecord& team) {
  SCOPED_TRACE(team.address.strategy + " " + team.address.composition);
  expect_probability(team.knowledge, "knowledge");
  expect_probability(team.knowledge_min, "knowledge_min");
  EXPECT_LE(team.knowledge_min, team.knowledge + 1e-12);
  EXPECT_GE(team.area_sr, 0.0);
  if (team.exam) {
    expect_probability(team.exam->share_right, "exam_share_right");
    expect_probability(team.exam->worst_share_right, "exam_worst_share_right");
    EXPECT_LE(team.exam->worst_share_right, team.exam->share_right + 1e-12);
    EXPECT_GE(team.exam->regret, 0.0);
  }
  for (const auto& learner : team.learners) {
    expect_probability(learner.p_bec, "p_bec");
    EXPECT_LE(learner.correct, learner.tests);
    EXPECT_LE(learner.exam_correct, learner.exam_questions);
    EXPECT_LE(learner.periods, team.periods);
  }
  if (team.forecast) {
    const auto& f = *team.forecast;
    expect_within(0.0, f.periods_low, f.periods_high, "forecast_periods");
    expect_within(0.0, f.minutes_low, f.minutes_high, "forecast_minutes");
  }
  for (const auto& estimate : team.estimates) {
    expect_probability(estimate.p_proficient, "p_proficient");
    expect_probability(estimate.p_knew, "p_knew");
    expect_probability(estimate.p_right, "p_right");
    expect_probability(estimate.right, "right");
    if (estimate.ability_mean)
      expect_within(*estimate.ability_low, *estimate.ability_mean, *estimate.ability_high, "ability_mean");
  }
  for (const auto& exam : team.exams) {
    expect_probability(exam.share_right, "share_right");
    EXPECT_GE(exam.regret, 0.0);
  }
  if (spec.record == RecordLevel::kTeam) return;
  // What was shown: per session (a member of the baseline is one) and period, and per component.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> shown;
  std::set<std::size_t> components;
  for (const auto& demonstration_record : team.demonstration_records) {
    const auto demo = atlas.index({MdpIndex{demonstration_record.mdp}, StateIndex{demonstration_record.start}});
    EXPECT_FALSE(atlas.trajectory(demo).actions.empty()) << "a demonstration of nothing";
    components.insert(demonstration_record.component);
    ++shown[{demonstration_record.member, demonstration_record.period}];
  }
  std::size_t demonstrations = 0, tests = 0;
  for (const auto& period : team.period_records) {
    EXPECT_GE(period.demonstrations, 1u) << "a period that shows nothing";
    EXPECT_TRUE(components.contains(period.component)) << "a component of which nothing was shown";
    EXPECT_GE(period.area_sr, 0.0);
    EXPECT_GE(period.running_area_sr, 0.0);
    EXPECT_GE(period.gain, -1e-12);
    for (const double p : period.p_bec) expect_probability(p, "p_bec of a belief");
    if (period.mastery) {
      expect_probability(period.mastery->predicted, "p_mastery");
      expect_probability(period.mastery->actual, "mastery");
    }
    if (period.forecast) {
      EXPECT_GE(period.forecast->periods_left, 0.0);
      for (const double p : period.forecast->done_within) expect_probability(p, "forecast_done");
    }
    demonstrations += period.demonstrations;
    tests += period.tests;
  }
  EXPECT_EQ(team.demonstrations, demonstrations);
  EXPECT_EQ(team.tests, tests);
  EXPECT_GE(components.size(), team.components_learned > 0 ? 1u : 0u);
  for (const auto& response : team.responses) {
    EXPECT_EQ(response.correct, response.regret.has_value() && *response.regret == 0.0);
    EXPECT_GE(response.regret.value_or(0.0), 0.0);
  }
  for (const auto& belief : team.beliefs) {
    double sum = 0.0;
    for (const double weight : belief.weights) sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
}

// A run of the study in this folder, with its analysis and its report.
void expect_honest_run(const Atlas& atlas, const StudyReading& reading, const std::filesystem::path& folder) {
  StudyRunOptions options;
  options.program = "1.0 (laws)";
  options.threads = 1;
  StudyRun run{folder, reading, options};
  run.teach(atlas);
  RunFacts facts;
  facts.version = "1.0";
  facts.started = facts.stopped = "2026-01-31T12:00:00Z";
  facts.domain = atlas.domain().id();
  run.publish(facts);
  try {
    AnalysisOptions analysis;
    analysis.permutations = 19;
    const auto findings = findings_json(analyze_run(folder, analysis));
    EXPECT_FALSE(has_no_number(findings)) << findings;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
  }
  EXPECT_FALSE(has_no_number(build_report(folder)));
}

// A built-in domain's name, or a file: random ones, with discount or chance, or one whose robot need not arrive.
std::string random_robot(std::uint64_t i, const RandomStream& random, const testing::ScratchFolder& scratch) {
  const auto text = [&]() -> std::optional<DomainText> {
    switch (i % 6) {
      case 0:
        return random_map(random);
      case 1:
        return random_model(random, 0.2);
      case 2:
        return with_discount(random_model(random, 0.0), 0.9);
      case 3:
        return with_discount(random_map(random), 0.7);
      case 4:
        return robot_that_never_ends();
      default:
        return std::nullopt;
    }
  }();
  if (!text) return i / 6 % 2 == 0 ? "item-delivery" : "two-goals";
  for (const auto& file : text->files) scratch.write(file.name, file.text);
  scratch.write("domain.toml", text->toml());
  return "domain.toml";
}

// Runs `wanted` random valid studies.
void expect_honest_studies(std::size_t wanted, std::uint64_t seed) {
  const testing::ScratchFolder scratch;
  std::size_t found = 0, refused = 0, ended = 0;
  for (std::uint64_t i = 0; found < wanted; ++i) {
    ASSERT_LT(i, 20 * wanted) << "hardly any study is valid";
    const auto random = RandomStream{seed}.split(i);
    const auto domain = random_robot(i, random.split("domain"), scratch);
    const auto text = random_study(domain, random.split("study"));
    const auto reading = parse_study(text, "random.toml", {.overrides = {}, .folder = scratch.path()});
    if (!reading.study) {
      ++refused;
      for (const auto& diagnostic : reading.diagnostics) {
        // In its range is not refused as out of its range.
        EXPECT_NE(diagnostic.id, "E0110") << to_text(diagnostic) << text;
        EXPECT_NE(diagnostic.id, "E0112") << to_text(diagnostic) << text;
      }
      continue;
    }
    ++found;
    SCOPED_TRACE("study " + std::to_string(i) + ":\n" + text);
    try {
      const Atlas atlas{*reading.domain};
      if (found % 4 == 0) {
        expect_honest_run(atlas, reading, scratch / ("run" + std::to_string(i)));
        continue;
      }
      const auto teams =
          run_teams(atlas, *reading.study, team_addresses(*reading.study), {.threads = 1, .on_progress = {}}).teams;
      for (const auto& team : teams) expect_honest(atlas, reading.study->variants.front(), team);
      write_study_tables(*reading.study, teams, [&](std::string_view file, std::string_view piece) {
        EXPECT_FALSE(has_no_number(piece)) << file << ":\n" << piece.substr(0, 2000);
      });
    } catch (const Error& error) {
      // The only end without a result that is documented: the robot or the learners do not allow it.
      ++ended;
      EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << "an internal error: " << error.what();
    }
  }
  EXPECT_LT(ended, wanted / 2) << "hardly any study has a result";
  ::testing::Test::RecordProperty("refused", static_cast<int>(refused));
}

TEST(HonestEnds, StudyKeysSayWhatTheyMayBe) {
  const auto& keys = study_keys();
  EXPECT_GT(keys.size(), 30u);
  for (const auto& key : keys) {
    EXPECT_TRUE(!key.words.empty() || key.min <= key.max) << key.name;
    EXPECT_NE(key.words.size(), 1u) << key.name;
  }
}

TEST(HonestEnds, RandomValidStudiesGiveNoNonsense) { expect_honest_studies(30, 1); }

TEST(HonestEndsSlow, RandomValidStudiesGiveNoNonsense) { expect_honest_studies(300, 2); }

}  // namespace
}  // namespace kith::laws
