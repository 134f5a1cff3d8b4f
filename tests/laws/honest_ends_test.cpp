// Whatever is documented as allowed ends as documented: random valid studies give tables without nonsense, and what
// they say was taught was shown; or they end with an error that says why.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/dataset.hpp"
#include "kith/analysis/decimals.hpp"
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
    const auto start = atlas.index({MdpIndex{demonstration_record.mdp}, StateIndex{demonstration_record.start}});
    EXPECT_FALSE(atlas.trajectory(start).actions.empty()) << "a demonstration of nothing";
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

// The first screen of a report says what its numbers say: intervals as they are printed, answers, and the headline.
void expect_said_is_shown(const std::string& report) {
  const auto document = nlohmann::json::parse(report);
  const auto& overview = document.at("overview");
  const auto headline = overview.at("finding").get<std::string>();
  bool differs_in_periods = false;
  for (const auto& answer : overview.at("answers")) {
    const auto said = answer.at("answer").get<std::string>();
    const bool is_tested = answer.at("p").is_number();
    const bool is_shown = is_tested && answer.at("p").get<double>() < 0.05;
    if (is_tested) {
      EXPECT_EQ(is_shown, said != "no difference found" && said != "too few teams to tell") << answer.dump();
    }
    differs_in_periods |= is_shown && answer.at("outcome") == "periods";
    if (!answer.at("low").is_number() || !answer.at("high").is_number()) continue;
    const double low = answer.at("low").get<double>(), high = answer.at("high").get<double>();
    const auto read = [&](double value) { return std::stod(fixed_text(value, answer.at("digits").get<int>())); };
    if (high - low < 1e-6) continue;  // no more decimals are printed
    EXPECT_LT(read(low), read(high)) << answer.dump();
    EXPECT_EQ(low <= 0.0 && high >= 0.0, read(low) <= 0.0 && read(high) >= 0.0) << answer.dump();
  }
  if (headline.find("differ in periods") != std::string::npos) {
    EXPECT_TRUE(differs_in_periods) << headline;
  }
  const auto& cells = document.at("tables").at("cells");
  const auto column =
      static_cast<std::size_t>(std::ranges::find(cells.at("columns"), "periods_mean") - cells.at("columns").begin());
  std::set<double> periods;
  for (const auto& row : cells.at("rows"))
    if (row.at(column).is_number()) periods.insert(row.at(column).get<double>());
  if (headline.find("detectably in periods") != std::string::npos) {
    EXPECT_GT(periods.size(), 1u) << headline;
  }
}

// A text, and what of it was not looked at yet.
class Sentences {
 public:
  explicit Sentences(std::string text) : text_{std::move(text)} {}

  void each(const std::string& pattern, const std::function<void(const std::smatch&)>& check) {
    const std::regex regex{pattern};
    for (std::smatch match; std::regex_search(text_, match, regex);) {
      check(match);
      text_ = match.prefix().str() + match.suffix().str();
    }
  }
  [[nodiscard]] bool has_numbers() const { return text_.find_first_of("0123456789") != std::string::npos; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// The means of teams.csv by outcome, of those that were taught together and of those taught alone.
class TeamMeans {
 public:
  TeamMeans(const Dataset& teams, const StudySpec& spec) {
    const auto& strategies = teams.cells("strategy");
    const auto& compositions = teams.cells("composition");
    for (std::size_t i = 0; i < teams.num_rows(); ++i) {
      const bool alone = *strategies[i] == "baseline";
      const auto value = [&](const char* column) { return teams.required_numbers(column)[i]; };
      const auto add = [&](const std::string& outcome, double x) { values_[alone][outcome].push_back(x); };
      add("periods", value("periods"));
      add("person-periods", value("periods") * (alone ? 1.0 : static_cast<double>(compositions[i]->size())));
      add("knowledge at the end", value("knowledge"));
      if (teams.has("exam_share_right")) add("share right in the exam", value("exam_share_right"));
      completed_ += *teams.cells("completed")[i] == "true" ? std::size_t{1} : std::size_t{0};
      auto series = *strategies[i];
      for (const auto& factor : spec.factors) series += " " + *teams.cells(factor.key)[i];
      if (!alone) items_[series].push_back(value("demonstrations") + value("tests"));
    }
  }

  [[nodiscard]] double of(const std::string& outcome, bool alone) const { return mean(values_[alone].at(outcome)); }
  [[nodiscard]] std::size_t teams(bool alone) const {
    return values_[alone].count("periods") == 0 ? 0 : values_[alone].at("periods").size();
  }
  [[nodiscard]] std::size_t completed() const { return completed_; }
  [[nodiscard]] std::pair<double, double> fewest_and_most_items() const {
    std::set<double> means;
    for (const auto& [series, values] : items_) means.insert(mean(values));
    return {*means.begin(), *means.rbegin()};
  }

 private:
  static double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }

  std::array<std::map<std::string, std::vector<double>>, 2> values_;
  std::map<std::string, std::vector<double>> items_;
  std::size_t completed_ = 0;
};

// Whether a number, as it is printed, is this one rounded, and not 0 or 1 of a share that is neither.
void expect_reads(const std::string& printed, double value, bool is_share = false) {
  const auto point = printed.find('.');
  const auto decimals = point == std::string::npos ? 0.0 : static_cast<double>(printed.size() - point - 1);
  EXPECT_NEAR(std::stod(printed), value, 0.5 * std::pow(10.0, -decimals) + 1e-9) << printed;
  const bool is_end = std::stod(printed) == 0.0 || std::stod(printed) == 1.0;
  if (is_share && decimals < 8.0) {
    EXPECT_EQ(is_end, value == 0.0 || value == 1.0) << printed << " of " << value;
  }
}

// Every number in a sentence of the first screen is computed again from teams.csv.
void expect_printed_is_computed(const nlohmann::json& overview, const TeamMeans& means) {
  const auto all = means.teams(false) + means.teams(true);
  for (const auto& answer : overview.at("answers")) {
    const auto question = answer.at("question").get<std::string>(), outcome = answer.at("outcome").get<std::string>();
    const bool is_share = outcome.find("periods") == std::string::npos;
    Sentences printed{answer.at("means")};
    if (question.starts_with("Together compared")) {
      printed.each("([0-9.]+) and ([0-9.]+)", [&](const std::smatch& match) {
        expect_reads(match[1], means.of(outcome, false), is_share);
        expect_reads(match[2], means.of(outcome, true), is_share);
      });
    }
    if (question.starts_with("Taught ")) {
      printed.each("[0-9.]+", [&](const std::smatch& match) {
        expect_reads(match[0], means.of(outcome, question != "Taught together"), is_share);
      });
    }
  }

  const auto expect_change = [&](const std::smatch& match) {
    const auto outcome = match[3].str() + "periods";
    const double change = means.of(outcome, false) / means.of(outcome, true) - 1.0;
    EXPECT_EQ(match[2] == "fewer", change < 0.0) << match[0];
    expect_reads(match[1], 100.0 * std::abs(change));
  };
  const auto expect_done = [&](const std::smatch& match) {
    EXPECT_EQ(match[1], std::to_string(means.completed()));
    EXPECT_EQ(match[2], std::to_string(all));
  };
  std::string said = overview.at("finding");
  for (const auto& limit : overview.at("limits")) said += "\n" + limit.get<std::string>();
  Sentences sentences{said};
  sentences.each("needed ([0-9.]+) periods on average", [&](const std::smatch& match) {
    expect_reads(match[1], means.of("periods", means.teams(false) == 0));
  });
  sentences.each("([0-9]+) % (fewer|more) (person-|)periods", expect_change);
  sentences.each("([0-9]+) of ([0-9]+) (teams? |)(passed|were)", expect_done);
  sentences.each("is ([0-9.]+)( together and ([0-9.]+) one after the other|) on average",
                 [&](const std::smatch& match) {
                   const auto outcome = overview.contains("leads") ? "share right in the exam" : "knowledge at the end";
                   expect_reads(match[1], means.of(outcome, means.teams(false) == 0), true);
                   if (match[3].matched) expect_reads(match[3], means.of(outcome, true), true);
                 });
  sentences.each(
      "([0-9.]+) periods are ([0-9.]+) person-periods; one after the other, ([0-9.]+) periods are ([0-9.]+) ",
      [&](const std::smatch& match) {
        for (const bool alone : {false, true}) {
          expect_reads(match[alone ? 3 : 1], means.of("periods", alone));
          expect_reads(match[alone ? 4 : 2], means.of("person-periods", alone));
        }
      });
  sentences.each(
      "from ([0-9.]+) demonstrations and tests on average \\([^()]*\\) to ([0-9.]+) \\([^()]*, ([0-9]+) % more\\)",
      [&](const std::smatch& match) {
        const auto [fewest, most] = means.fewest_and_most_items();
        expect_reads(match[1], fewest);
        expect_reads(match[2], most);
        expect_reads(match[3], 100.0 * (most / fewest - 1.0));
      });
  sentences.each(": ([0-9.]+) and ([0-9.]+) on average \\(n = ([0-9]+)\\)", [&](const std::smatch& match) {
    expect_reads(match[1], means.of("periods", false));
    expect_reads(match[2], means.of("periods", true));
    EXPECT_EQ(match[3], std::to_string(std::min(means.teams(false), means.teams(true))));
  });
  sentences.each("for ([0-9]+) periods together(, and ([0-9]+)| or) one after", [&](const std::smatch& match) {
    expect_reads(match[1], means.of("periods", false));
    expect_reads(match[3].matched ? match[3] : match[1], means.of("periods", true));
  });
  sentences.each("after ([0-9]+) periods", [&](const std::smatch& match) {
    expect_reads(match[1], means.of("periods", means.teams(false) == 0));
  });
  // What the models estimate, and how many of what there is, is in the answers.
  sentences.each("compare (the [0-9]+ strategies|[a-z ]+|)(: [0-9.]+ to [0-9.]+ [a-z -]+|) \\(n = [0-9]\\)",
                 [](const std::smatch&) {});
  sentences.each("[Tt]he [0-9]+ strategies|[0-9]+ of [0-9]+ planned", [](const std::smatch&) {});
  EXPECT_FALSE(sentences.has_numbers()) << sentences.text();
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
    const auto findings = findings_json(analyze_run(folder, {}));
    EXPECT_FALSE(has_no_number(findings)) << findings;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
  }
  const auto report = build_report(folder);
  EXPECT_FALSE(has_no_number(report));
  expect_said_is_shown(report);
  expect_printed_is_computed(nlohmann::json::parse(report).at("overview"),
                             {Dataset::read(folder / "tables" / "teams.csv"), reading.study->variants.front()});
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
