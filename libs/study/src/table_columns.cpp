#include "table_columns.hpp"

#include <algorithm>
#include <array>

#include "kith/study/tables.hpp"
#include "kith/table/codebook.hpp"

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

// Columns that several tables have.
Column period_column() {
  return column("period", kInteger, "Number of the period, from 1; for the baseline within the member.");
}
Column component_column() { return column("kc", kInteger, "Number of the knowledge component, from 1."); }
Column member_column() { return column("member", kInteger, "Number of the member, from 1."); }
Column type_column() { return column("type", kText, "Letter of the learner type."); }
Column start_column() { return column("start", kInteger, "Number of the start state in the MDP, from 0."); }

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
bool has_belief_quality(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.beliefs; });
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
  for (auto& column : columns) column.required = false;
  return columns;
}

Columns team_columns(const Study& study) {
  Columns columns{
      column("seed_address", kText, "Address of the team's random numbers: seed/composition/replicate."),
      column("status", kText,
             "'complete' if every knowledge component was learned or is implied by the lessons of others; 'skipped' if "
             "something stayed open that nothing could show; 'max_periods' if teaching stopped before."),
      column("completed", kBoolean, "Whether the status is 'complete'."),
      column("periods", kInteger, "Interaction periods; for the baseline the sum over members."),
      column("demonstrations", kInteger, "Demonstrations shown, in all periods."),
      column("tests", kInteger, "Tests asked, in all periods; each of them of every member."),
      column("knowledge", kReal,
             "Mean over members of the mass of their final belief in the policy's behaviour equivalence class."),
      column("knowledge_min", kReal, "The smallest of these masses."),
      column("kcs_learned", kInteger, "Knowledge components learned; for the baseline the sum over members."),
      column(
          "kcs_skipped", kInteger,
          "Knowledge components left out, because nothing that could be shown adds to what was taught, or by design."),
      column("area_sr", kReal, "Mean over periods of the area in periods.csv.", "sr")};
  if (writes_costs(study)) {
    columns =
        columns + Columns{column("person_periods", kInteger, "Periods that members took part in, summed over members."),
                          measure("minutes", "Teaching time by the study's pace, summed over sessions.", "min"),
                          measure("person_minutes", "Time of the members, summed over members.", "min")};
  }
  if (has_forecasts(study)) columns = columns + forecast_columns();
  if (has_belief_quality(study)) {
    columns =
        columns + Columns{measure("fewest_particles",
                                  "The smallest effective number of particles of a member's belief that "
                                  "satisfied what the member was just shown. Below 10 the belief is impoverished.")};
  }
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
          member_column(),
          type_column(),
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
      member_column(),
      type_column(),
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
  const Columns first{member_column(), type_column()};
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
      period_column(),
      component_column(),
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
  return {period_column(),
          component_column(),
          column("test", kInteger, "Number of the test in the period, from 1."),
          member_column(),
          column("mdp", kInteger, "Number of the MDP of the test, from 0."),
          start_column(),
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
  return {period_column(),
          optional_column("member", kInteger, "Who watched, for the baseline; missing if everybody did."),
          component_column(),
          column("demonstration", kInteger, "Number of the demonstration in the period, from 1."),
          column("mdp", kInteger, "Number of the MDP, from 0."),
          start_column(),
          column("constraint", kText,
                 "Half-spaces that it conveys: entries of a normal separated by blanks, normals by ';'.")};
}

Columns progress_columns(const Study& study) {
  const auto types = types_of(study);
  const bool all_have_ability =
      std::all_of(types.begin(), types.end(), [](const auto* one) { return one->model->has_ability; });
  return {period_column(),
          component_column(),
          member_column(),
          type_column(),
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
    for (auto& column : table.columns) {
      if (column.kind == ColumnKind::kUnspecified) column.kind = kind_of(column.name);
    }
  }
  return tables;
}

OptionalColumns optional_columns(const Study& study) {
  OptionalColumns result;
  result.costs = writes_costs(study);
  result.forecasts = has_forecasts(study);
  result.estimates = has_estimates(study);
  result.beliefs = has_belief_quality(study);
  result.subgroups = has_subgroups(study);
  for (const auto& column : trait_columns(study)) result.traits.push_back(column.name);
  return result;
}

std::string study_codebook(const Study& study, const std::string& run) { return codebook(study_tables(study), run); }

}  // namespace kith
