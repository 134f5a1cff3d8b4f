#include "kith/study/tables.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "kith/table/codebook.hpp"
#include "kith/table/csv_writer.hpp"

namespace kith {
namespace {

constexpr auto kText = ColumnType::kText;
constexpr auto kInteger = ColumnType::kInteger;
constexpr auto kReal = ColumnType::kReal;
constexpr auto kBoolean = ColumnType::kBoolean;

Column column(std::string name, ColumnType type, std::string description, std::string unit = "") {
  return {std::move(name), type, std::move(description), std::move(unit), true};
}
Column optional_column(std::string name, ColumnType type, std::string description) {
  return {std::move(name), type, std::move(description), "", false};
}

// A real number that is measured, whatever its values look like.
Column measure(std::string name, std::string description, std::string unit = "") {
  auto result = column(std::move(name), kReal, std::move(description), std::move(unit));
  result.kind = ColumnKind::kNumber;
  return result;
}

using Columns = std::vector<Column>;

bool has_exam(const Study& study) { return study.variants.front().exam != ExamLevel::kNone; }

template <typename Holds>
bool any_variant(const Study& study, Holds holds) {
  return std::any_of(study.variants.begin(), study.variants.end(), holds);
}
bool writes_costs(const Study& study) { return any_variant(study, has_costs); }
bool has_forecasts(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.forecast_sessions > 0; });
}
bool has_estimates(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.estimates; });
}
bool has_subgroups(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.grouping != Grouping::kTogether; });
}

// What every table begins with: where a team stands in the design.
Columns team_keys(const Study& study) {
  Columns columns{column("strategy", kText, "How the team was taught."),
                  column("composition", kText, "The members' learner types, one letter each.")};
  for (const auto& factor : study.variants.front().factors) {
    columns.push_back(column(factor.key, kText, "Setting of this key of the study file, which varies in the study."));
  }
  columns.push_back(column("replicate", kInteger, "Number of the team in its cell, from 1."));
  columns.push_back(column("team", kInteger, "Number of the team in the study, from 1."));
  return columns;
}

Columns operator+(Columns keys, const Columns& rest) {
  keys.insert(keys.end(), rest.begin(), rest.end());
  return keys;
}

// What imagined sessions of the cell say before the first lesson.
Columns forecast_columns() {
  Columns columns;
  for (const std::string what : {"periods", "minutes"}) {
    const std::string unit = what == "minutes" ? "min" : "";
    columns.push_back(measure("forecast_" + what, "Expected " + what + ", before the first lesson: mean.", unit));
    columns.push_back(measure("forecast_" + what + "_low", "Lower limit of the central 80 % of the forecast.", unit));
    columns.push_back(measure("forecast_" + what + "_high", "Upper limit of the central 80 % of the forecast.", unit));
  }
  for (auto& one : columns) one.required = false;
  return columns;
}

Columns team_columns(const Study& study) {
  Columns columns{
      column("seed_address", kText, "Address of the team's random numbers: seed/composition/replicate."),
      column("status", kText, "'complete', or 'max_periods' if teaching stopped before all was learned."),
      column("completed", kBoolean, "Whether every knowledge component was learned or had nothing to teach."),
      column("periods", kInteger, "Interaction periods; for the baseline the sum over members."),
      column("demonstrations", kInteger, "Demonstrations shown, in all periods."),
      column("tests", kInteger, "Tests asked, in all periods; each of them of every member."),
      column("knowledge", kReal,
             "Mean over members of the mass of their final belief in the policy's behaviour equivalence class."),
      column("knowledge_min", kReal, "The smallest of these masses."),
      column("kcs_learned", kInteger, "Knowledge components learned; for the baseline the sum over members."),
      column("kcs_skipped", kInteger, "Knowledge components in which nothing was left to teach."),
      column("area_sr", kReal, "Mean over periods of the area in periods.csv.", "sr")};
  if (writes_costs(study)) {
    columns =
        columns + Columns{column("person_periods", kInteger, "Periods that members took part in, summed over members."),
                          measure("minutes", "Teaching time by the study's pace, summed over sessions.", "min"),
                          measure("person_minutes", "Time of the members, summed over members.", "min")};
  }
  if (has_forecasts(study)) columns = columns + forecast_columns();
  if (!has_exam(study)) return columns;
  return columns +
         Columns{
             measure("exam_share_right",
                     "Share of all starts of the domain where members predict the robot, under their final beliefs; "
                     "mean over members."),
             measure("exam_regret",
                     "What the members' predictions lose against the robot's paths, over all starts; mean over "
                     "members, in the units of the domain file's weights."),
             measure("exam_worst_share_right", "The smallest share_right of a member.")};
}

// The learner types of all variants, as they have the model that a variant gives them, by letter.
std::vector<const LearnerType*> types_of(const Study& study) {
  std::vector<const LearnerType*> types;
  for (const auto& variant : study.variants) {
    for (const auto& type : variant.learner_types) types.push_back(&type);
  }
  std::stable_sort(types.begin(), types.end(),
                   [](const LearnerType* a, const LearnerType* b) { return a->letter < b->letter; });
  return types;
}

bool has_trait(const LearnerModel& model, std::string_view name) {
  return std::any_of(model.traits.begin(), model.traits.end(), [&](const auto& trait) { return trait.name == name; });
}

// What describes a person, by any model of the study; missing for people of models that do not have it.
Columns trait_columns(const Study& study) {
  Columns columns;
  const auto types = types_of(study);
  for (const auto* type : types) {
    for (const auto& trait : type->model->traits) {
      const auto same = [&](const Column& one) { return one.name == trait.name; };
      if (std::any_of(columns.begin(), columns.end(), same)) continue;
      columns.push_back(column(std::string{trait.name}, kReal, std::string{trait.description}));
      columns.back().required = std::all_of(
          types.begin(), types.end(), [&](const LearnerType* other) { return has_trait(*other->model, trait.name); });
    }
  }
  return columns;
}

Columns exam_columns() {
  return {column("period", kInteger, "Number of the period after which the exam took place; 0 before the first."),
          optional_column("kc", kInteger,
                          "Number of the knowledge component whose starts the exam is about; missing for all starts."),
          column("member", kInteger, "Number of the member, from 1."),
          column("type", kText, "Letter of the learner type."),
          measure("share_right", "Expected share of the starts where the member predicts the robot."),
          measure("regret",
                  "Expected loss of the member's predictions against the robot's paths, in the units of the domain "
                  "file's weights."),
          optional_column("p_bec", kReal,
                          "Mass of the member's belief in the policy's behaviour equivalence class; for all starts "
                          "only.")};
}

Columns estimate_columns() {
  constexpr auto kAboutPerson = " In the row of the person only.";
  constexpr auto kAboutComponent = " In the rows of components only.";
  Columns columns{
      column("period", kInteger, "Number of the period after which these are the estimates; 0 before the first."),
      optional_column("kc", kInteger, "Number of the knowledge component; missing in the row about the person."),
      column("member", kInteger, "Number of the member, from 1."),
      column("type", kText, "Letter of the learner type."),
      measure("ability",
              std::string{"True ability with which the member learns when a component begins, after ability_scale."} +
                  kAboutPerson),
      measure("ability_mean", std::string{"The teacher's estimate of this ability: posterior mean."} + kAboutPerson),
      measure("ability_low", std::string{"Lower limit of the central 80 % of the posterior."} + kAboutPerson),
      measure("ability_high", std::string{"Upper limit of the central 80 % of the posterior."} + kAboutPerson),
      measure(
          "p_proficient",
          std::string{"Posterior probability that the ability is at least record.proficient_ability."} + kAboutPerson),
      column("proficiency", kText,
             std::string{"'proficient' if p_proficient is at least 0.8, 'not proficient' if it is at most 0.2, else "
                         "'cannot tell yet'."} +
                 kAboutPerson),
      measure("p_knew",
              std::string{"Posterior probability that the member knew the component before the first lesson; with "
                          "teacher.hypotheses = \"known-components\"."} +
                  kAboutComponent),
      measure("knew", std::string{"Mass of the member's belief before the first lesson in the component's constraints; "
                                  "where p_knew is."} +
                          kAboutComponent),
      measure("p_right",
              std::string{"Predicted probability that the member answers a random test of the component correctly."} +
                  kAboutComponent),
      measure("right", std::string{"The same probability under the member's own belief."} + kAboutComponent)};
  for (std::size_t i = 4; i < columns.size(); ++i) columns[i].required = false;
  return columns;
}

Columns learner_columns(const Study& study) {
  const Columns first{column("member", kInteger, "Number of the member, from 1."),
                      column("type", kText, "Letter of the learner type.")};
  const Columns last{column("p_bec", kReal, "Mass of the final belief in the policy's behaviour equivalence class."),
                     column("periods", kInteger, "Periods the member took part in."),
                     column("tests", kInteger, "Tests the member was asked."),
                     column("correct", kInteger, "Tests answered correctly.")};
  if (has_exam(study)) {
    const Columns exam{
        measure("exam_share_right", "Share of all starts where the member predicts the robot, at the end."),
        measure("exam_regret", "What these predictions lose, in the units of the domain file's weights."),
        column("exam_questions", kInteger, "Questions of the exam about starts that were neither shown nor tested."),
        column("exam_correct", kInteger, "Of these, answered correctly.")};
    return first + trait_columns(study) + last + exam;
  }
  return first + trait_columns(study) + last;
}

Columns period_columns(const Study& study) {
  Columns columns{
      column("period", kInteger, "Number of the period, from 1; for the baseline within the member."),
      column("kc", kInteger, "Number of the knowledge component, from 1."),
      column("source", kText, "Whose belief the lesson was chosen for: 'common', 'joint' or 'member N'."),
      column("demonstrations", kInteger, "Demonstrations shown."),
      column("area_sr", kReal, "Solid angle of the weights that satisfy what was shown, with the prior.", "sr"),
      column("running_area_sr", kReal,
             "The same together with the components learned before; what earlier lessons of this component taught "
             "does not count.",
             "sr"),
      column("tests", kInteger, "Tests asked of every member."),
      column("all_correct", kBoolean, "Whether every member answered every test correctly."),
      column("excluded", kInteger, "Members left out of the common belief because their answers conflict."),
      column("untested", kInteger, "Taught constraints that nothing can test."),
      column("gain", kReal,
             "Logarithm of the area of what was learned before (the prior and the components learned) over "
             "running_area_sr; 0 if a lesson is shown again."),
  };
  if (has_subgroups(study)) {
    columns.insert(columns.begin(), column("session", kInteger, "Number of the team's session, from 1."));
  }
  if (writes_costs(study)) columns.push_back(column("members", kInteger, "Members who took part."));
  if (has_forecasts(study)) {
    columns.push_back(measure("forecast_periods_left", "Periods left, as expected after this one: mean."));
    columns.back().required = false;
    for (const auto* k : {"1", "2", "3"}) {
      columns.push_back(optional_column("forecast_done_" + std::string{k}, kReal,
                                        "Probability that the team is done after at most " + std::string{k} +
                                            " more, as expected after this period."));
    }
  }
  if (has_estimates(study)) {
    columns.push_back(measure("p_mastery",
                              "Predicted probability that all members who took part answer a random test of the "
                              "component correctly, after the feedback."));
    columns.push_back(measure("mastery", "The same probability under the members' own beliefs."));
    for (std::size_t i = columns.size() - 2; i < columns.size(); ++i) columns[i].required = false;
  }
  for (const auto& rule : study.variants.front().teaching.rules) {
    const std::string name{rule.name};
    columns.push_back(
        column("p_bec_" + name, kReal, "Mass of the teacher's " + name + " belief in the policy's class, afterwards."));
  }
  return columns;
}

Columns response_columns() {
  return {column("period", kInteger, "Number of the period, from 1; for the baseline within the member."),
          column("kc", kInteger, "Number of the knowledge component, from 1."),
          column("test", kInteger, "Number of the test in the period, from 1."),
          column("member", kInteger, "Number of the member, from 1."),
          column("mdp", kInteger, "Number of the MDP of the test, from 0."),
          column("start", kInteger, "Number of the start state in the MDP, from 0."),
          column("correct", kBoolean, "Whether the answer is as good as the robot's path."),
          optional_column("regret", kReal,
                          "Return of the robot's path minus that of the answer; missing without an answer."),
          optional_column(
              "answer", kText,
              "Feature counts of the answer, or expectations of them, separated by blanks; missing without one."),
          column("constraint", kText,
                 "Half-spaces that the answer shows: entries of a normal separated by blanks, normals by ';'."),
          column("covered", kText, "Half-spaces that the test examines and that its feedback teaches.")};
}

Columns demonstration_columns() {
  return {column("period", kInteger, "Number of the period, from 1; for the baseline within the member."),
          optional_column("member", kInteger, "Who watched, for the baseline; missing if everybody did."),
          column("kc", kInteger, "Number of the knowledge component, from 1."),
          column("demonstration", kInteger, "Number of the demonstration in the period, from 1."),
          column("mdp", kInteger, "Number of the MDP, from 0."),
          column("start", kInteger, "Number of the start state in the MDP, from 0."),
          column("constraint", kText,
                 "Half-spaces that it conveys: entries of a normal separated by blanks, normals by ';'.")};
}

Columns progress_columns(const Study& study) {
  const auto types = types_of(study);
  const bool all_have_ability =
      std::all_of(types.begin(), types.end(), [](const auto* one) { return one->model->has_ability; });
  return {column("period", kInteger, "Number of the period, from 1; for the baseline within the member."),
          column("kc", kInteger, "Number of the knowledge component, from 1."),
          column("member", kInteger, "Number of the member, from 1."),
          column("type", kText, "Letter of the learner type."),
          {"ability", kReal, "Ability while watching the demonstrations, before ability_scale.", "", all_have_ability},
          column("p_bec", kReal,
                 "Mass of the member's own belief in the policy's behaviour equivalence class, after the feedback."),
          column("all_correct", kBoolean, "Whether the member answered every test of the period correctly.")};
}

// x, y, z in space; w1, w2, ... elsewhere.
Columns direction_columns(std::size_t num_features) {
  if (num_features == 3) {
    return {column("x", kReal, "First entry of a direction of reward weights, at length 1."),
            column("y", kReal, "Second entry."), column("z", kReal, "Third entry.")};
  }
  Columns columns;
  for (std::size_t k = 1; k <= num_features; ++k) {
    columns.push_back(column("w" + std::to_string(k), kReal,
                             "Entry " + std::to_string(k) + " of a direction of reward weights, at length 1."));
  }
  return columns;
}

Columns particle_columns(std::size_t num_features) {
  const Columns first{column("period", kInteger, "Number of the period at whose end the belief was this."),
                      column("belief", kText,
                             "Whose: 'own N' (of member N), 'teacher N' (the teacher's about member N), 'common' or "
                             "'joint'."),
                      column("particle", kInteger, "Number of the particle, from 1.")};
  const Columns last{column("weight", kReal, "Weight of the particle; those of a belief sum to 1.")};
  return first + direction_columns(num_features) + last;
}

// What decides how a column is analysed: rows of one team, or of one member of it, belong together; these are counts.
ColumnKind kind_of(const std::string& name) {
  constexpr std::array<std::string_view, 2> kIdentifiers{"team", "member"};
  constexpr std::array<std::string_view, 3> kCounts{"periods", "demonstrations", "tests"};
  if (std::find(kIdentifiers.begin(), kIdentifiers.end(), name) != kIdentifiers.end()) return ColumnKind::kIdentifier;
  if (std::find(kCounts.begin(), kCounts.end(), name) != kCounts.end()) return ColumnKind::kCount;
  return ColumnKind::kUnspecified;
}

}  // namespace

std::vector<TableDescription> study_tables(const Study& study) {
  const auto keys = team_keys(study);
  std::vector<TableDescription> tables{
      {"teams.csv", "One row per team.", keys + team_columns(study)},
      {"learners.csv", "One row per member of a team.", keys + learner_columns(study)},
      {"periods.csv", "One row per interaction period; none if only teams are recorded.", keys + period_columns(study)},
      {"responses.csv", "One row per member and test; none if only teams are recorded.", keys + response_columns()},
      {"demonstrations.csv", "One row per demonstration shown; none if only teams are recorded.",
       keys + demonstration_columns()},
      {"progress.csv", "One row per member and period; none if only teams are recorded.",
       keys + progress_columns(study)}};
  if (study.variants.front().record == RecordLevel::kParticles) {
    tables.push_back({"particles.csv", "One row per particle, belief and period.",
                      keys + particle_columns(study.variants.front().num_features)});
  }
  if (has_exam(study)) {
    tables.push_back({"exam.csv", "One row per exam of a member, over all starts and over those of every component.",
                      keys + exam_columns()});
  }
  if (has_estimates(study)) {
    tables.push_back(
        {"estimates.csv",
         "What the teacher can tell from the answers, beside the truth: one row about each member, and one "
         "about each member and component, per period.",
         keys + estimate_columns()});
  }
  for (auto& table : tables) {
    for (auto& one : table.columns) {
      if (one.kind == ColumnKind::kUnspecified) one.kind = kind_of(one.name);
    }
  }
  return tables;
}

namespace {

std::int64_t count(std::size_t n) { return static_cast<std::int64_t>(n); }

std::string blank_separated(const IntegerVector& v) {
  std::string text;
  for (const auto entry : v) text += (text.empty() ? "" : " ") + std::to_string(entry);
  return text;
}

// Counts in units of 1 / scale.
std::string counts_text(const IntegerVector& counts, std::int64_t scale) {
  if (scale == 1) return blank_separated(counts);
  std::string text;
  for (const auto entry : counts) {
    std::array<char, 32> digits{};
    const double value = static_cast<double>(entry) / static_cast<double>(scale);
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text += (text.empty() ? "" : " ") + std::string{digits.data(), end};
  }
  return text;
}

std::string text_of(const std::vector<HalfSpace>& half_spaces) {
  std::string text;
  for (const auto& half_space : half_spaces) text += (text.empty() ? "" : ";") + blank_separated(half_space.normal());
  return text;
}

class Tables {
 public:
  Tables(const Study& study, const TableSink& sink)
      : study_{study},
        writes_costs_{writes_costs(study)},
        has_forecasts_{has_forecasts(study)},
        has_estimates_{has_estimates(study)},
        has_subgroups_{has_subgroups(study)} {
    for (const auto& one : trait_columns(study)) trait_names_.push_back(one.name);
    for (auto& table : study_tables(study)) {
      if (table.file == "exam.csv") exam_ = writers_.size();
      if (table.file == "estimates.csv") estimates_ = writers_.size();
      writers_.emplace_back(std::move(table.columns),
                            [sink, file = table.file](std::string_view piece) { sink(file, piece); });
    }
  }

  void add(const TeamRecord& team) {
    add_team(team);
    for (const auto& learner : team.learners) add_learner(team, learner);
    for (const auto& period : team.period_records) add_period(team, period);
    for (const auto& response : team.responses) add_response(team, response);
    for (const auto& demonstration : team.demonstration_records) add_demonstration(team, demonstration);
    for (const auto& progress : team.progress) add_progress(team, progress);
    for (const auto& belief : team.beliefs) add_belief(team, belief);
    for (const auto& exam : team.exams) add_exam(team, exam);
    for (const auto& estimate : team.estimates) add_estimate(team, estimate);
  }

  void flush() {
    for (auto& writer : writers_) writer.flush();
  }

 private:
  CsvWriter& begin_row(std::size_t table, const TeamAddress& address) {
    auto& writer = writers_[table];
    writer.text(address.strategy).text(std::string_view{address.composition});
    for (const auto& factor : study_.variants.at(address.variant).factors) writer.text(std::string_view{factor.value});
    return writer.integer(count(address.replicate)).integer(count(address.team));
  }

  void add_team(const TeamRecord& team) {
    auto& row = begin_row(0, team.address);
    row.text(std::string_view{team.seed_address})
        .text(std::string_view{team.completed ? "complete" : "max_periods"})
        .boolean(team.completed)
        .integer(count(team.periods))
        .integer(count(team.demonstrations))
        .integer(count(team.tests))
        .real(team.knowledge)
        .real(team.knowledge_min)
        .integer(count(team.components_learned))
        .integer(count(team.components_skipped))
        .real(team.area_sr);
    if (writes_costs_) {
      row.integer(count(team.cost.person_periods)).real(team.cost.minutes).real(team.cost.person_minutes);
    }
    if (has_forecasts_) add_forecast(row, team.forecast);
    if (team.exam) {
      row.real(team.exam->share_right).real(team.exam->regret).real(team.exam->worst_share_right);
    }
    row.end_row();
  }

  static void add_forecast(CsvWriter& row, const std::optional<TeamForecast>& forecast) {
    for (const auto value : {&TeamForecast::periods, &TeamForecast::periods_low, &TeamForecast::periods_high,
                             &TeamForecast::minutes, &TeamForecast::minutes_low, &TeamForecast::minutes_high}) {
      row.real(forecast ? std::optional{(*forecast).*value} : std::nullopt);
    }
  }

  void add_learner(const TeamRecord& team, const LearnerRecord& learner) {
    auto& row = begin_row(1, team.address).integer(count(learner.member)).text(std::string_view{&learner.type, 1});
    const auto& traits = learner_type(study_.variants.at(team.address.variant), learner.type).model->traits;
    for (const auto& name : trait_names_) row.real(trait(name, traits, learner.traits));
    row.real(learner.p_bec)
        .integer(count(learner.periods))
        .integer(count(learner.tests))
        .integer(count(learner.correct));
    if (team.exam) {
      row.real(learner.exam_share_right)
          .real(learner.exam_regret)
          .integer(count(learner.exam_questions))
          .integer(count(learner.exam_correct));
    }
    row.end_row();
  }

  [[nodiscard]] static std::optional<double> trait(const std::string& name, std::span<const LearnerTrait> traits,
                                                   const std::vector<double>& values) {
    const auto found = std::find_if(traits.begin(), traits.end(), [&](const auto& one) { return one.name == name; });
    if (found == traits.end()) return std::nullopt;
    return values.at(static_cast<std::size_t>(found - traits.begin()));
  }

  void add_period(const TeamRecord& team, const PeriodRecord& period) {
    auto& writer = begin_row(2, team.address);
    if (has_subgroups_) writer.integer(count(period.session));
    writer.integer(count(period.period))
        .integer(count(period.component))
        .text(std::string_view{period.source})
        .integer(count(period.demonstrations))
        .real(period.area_sr)
        .real(period.running_area_sr)
        .integer(count(period.tests))
        .boolean(period.all_correct)
        .integer(count(period.excluded))
        .integer(count(period.untested))
        .real(period.gain);
    if (writes_costs_) writer.integer(count(period.members));
    if (has_forecasts_) {
      const auto& ahead = period.forecast;
      writer.real(ahead ? std::optional{ahead->periods_left} : std::nullopt);
      for (std::size_t k = 0; k < 3; ++k) writer.real(ahead ? std::optional{ahead->done_within.at(k)} : std::nullopt);
    }
    if (has_estimates_) {
      writer.real(period.mastery ? std::optional{period.mastery->predicted} : std::nullopt);
      writer.real(period.mastery ? period.mastery->actual : std::nullopt);
    }
    for (const double p_bec : period.p_bec) writer.real(p_bec);
    writer.end_row();
  }

  void add_response(const TeamRecord& team, const ResponseRecord& response) {
    const auto answer = response.answer
                            ? std::optional{counts_text(*response.answer, study_.variants.front().count_scale)}
                            : std::nullopt;
    begin_row(3, team.address)
        .integer(count(response.period))
        .integer(count(response.component))
        .integer(count(response.test))
        .integer(count(response.member))
        .integer(count(response.mdp))
        .integer(count(response.start))
        .boolean(response.correct)
        .real(response.regret)
        .text_or_missing(answer)
        .text(std::string_view{text_of(response.constraints)})
        .text(std::string_view{text_of(response.covered)})
        .end_row();
  }

  void add_demonstration(const TeamRecord& team, const DemonstrationRecord& shown) {
    begin_row(4, team.address)
        .integer(count(shown.period))
        .integer(shown.member == 0 ? std::nullopt : std::optional{count(shown.member)})
        .integer(count(shown.component))
        .integer(count(shown.demonstration))
        .integer(count(shown.mdp))
        .integer(count(shown.start))
        .text(std::string_view{text_of(shown.constraints)})
        .end_row();
  }

  void add_progress(const TeamRecord& team, const ProgressRecord& progress) {
    begin_row(5, team.address)
        .integer(count(progress.period))
        .integer(count(progress.component))
        .integer(count(progress.member))
        .text(std::string_view{&progress.type, 1})
        .real(progress.ability)
        .real(progress.p_bec)
        .boolean(progress.all_correct)
        .end_row();
  }

  void add_belief(const TeamRecord& team, const BeliefSnapshot& belief) {
    for (std::size_t i = 0; i < belief.weights.size(); ++i) {
      auto& row = begin_row(6, team.address)
                      .integer(count(belief.period))
                      .text(std::string_view{belief.belief})
                      .integer(count(i + 1));
      for (std::size_t at = i; at < belief.points.size(); at += belief.weights.size()) row.real(belief.points[at]);
      row.real(belief.weights[i]).end_row();
    }
  }

  void add_exam(const TeamRecord& team, const ExamRecord& exam) {
    begin_row(exam_, team.address)
        .integer(count(exam.period))
        .integer(exam.component == 0 ? std::nullopt : std::optional{count(exam.component)})
        .integer(count(exam.member))
        .text(std::string_view{&exam.type, 1})
        .real(exam.share_right)
        .real(exam.regret)
        .real(exam.p_bec)
        .end_row();
  }

  void add_estimate(const TeamRecord& team, const EstimateRecord& estimate) {
    const auto word =
        estimate.p_proficient ? std::optional{std::string{proficiency_word(*estimate.p_proficient)}} : std::nullopt;
    begin_row(estimates_, team.address)
        .integer(count(estimate.period))
        .integer(estimate.component == 0 ? std::nullopt : std::optional{count(estimate.component)})
        .integer(count(estimate.member))
        .text(std::string_view{&estimate.type, 1})
        .real(estimate.ability)
        .real(estimate.ability_mean)
        .real(estimate.ability_low)
        .real(estimate.ability_high)
        .real(estimate.p_proficient)
        .text_or_missing(word)
        .real(estimate.p_knew)
        .real(estimate.knew)
        .real(estimate.p_right)
        .real(estimate.right)
        .end_row();
  }

  const Study& study_;
  bool writes_costs_;
  bool has_forecasts_;
  bool has_estimates_;
  bool has_subgroups_;
  std::vector<std::string> trait_names_;  // columns of learners.csv
  std::vector<CsvWriter> writers_;        // in the order of study_tables()
  std::size_t exam_ = 0, estimates_ = 0;  // positions of tables that are not always there
};

}  // namespace

void write_study_tables(const Study& study, std::span<const TeamRecord> teams, const TableSink& sink) {
  write_study_tables(
      study,
      [&](const std::function<void(const TeamRecord& team)>& visit) {
        for (const auto& team : teams) visit(team);
      },
      sink);
}

void write_study_tables(const Study& study, const TeamSource& teams, const TableSink& sink) {
  Tables tables{study, sink};
  teams([&](const TeamRecord& team) { tables.add(team); });
  tables.flush();
}

std::string study_codebook(const Study& study, const std::string& run) { return codebook(study_tables(study), run); }

}  // namespace kith
