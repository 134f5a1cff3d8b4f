#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kith/domains/file_units.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/table_of.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study.hpp"

/// What is recorded of a team, one line per member of a record: from it come the column of the table, its entry in the
/// codebook and its place in the journal. `declare(fields, Declared<Record>{})` tells `fields` about the record:
///
///   fields.column(member, words, options)  a member that the journal keeps and a column shows
///   fields.columns(member, list, options)  a member that the journal keeps, with one column per value; values that
///                                          `list` does not require may be missing
///   fields.derived(function, words)        a column that follows from others; the journal does not keep it. The
///                                          function may also take the study
///   fields.part(member, options)           a member that is a record with lines of its own, or an optional one
///   fields.kept(member, since)             a member that only the journal keeps, such as the rows of other tables
///   fields.traits(member)                  the traits of a person, as their learner model names them
///
/// The order of the lines is that of the journal, and of the table but for RecordColumn::before.
namespace kith {

/// What is seldom said of a member. Functions may be null.
struct RecordColumn {
  bool (*when)(const Study&) = nullptr;      ///< Whether the study's tables have the column; null: always.
  bool (*required)(const Study&) = nullptr;  ///< Whether every row has a value; null: unless the member is optional.
  bool zero_is_missing = false;
  std::string_view before{};  ///< The column that it stands in front of, if the table has that.
  int since = 0;  ///< The first layout of the journal with this member: one more than the highest one so far.
};

// Which columns a study has.
[[nodiscard]] bool has_exam(const Study& study);
[[nodiscard]] bool has_costs(const Study& study);
[[nodiscard]] bool has_forecasts(const Study& study);
[[nodiscard]] bool has_estimates(const Study& study);
[[nodiscard]] bool has_discussions(const Study& study);
[[nodiscard]] bool asks_for_kinds(const Study& study);
[[nodiscard]] bool has_belief_quality(const Study& study);
[[nodiscard]] bool has_world_names(const Study& study);
/// Whether the learner models of all types have an ability.
[[nodiscard]] bool all_have_ability(const Study& study);
/// Of the mass of every rule's belief, in the order of StudySpec::teaching.rules.
[[nodiscard]] std::vector<Column> rule_columns(const Study& study);
/// Of what describes a person, by any model of the study; missing for people of models that do not have it.
[[nodiscard]] std::vector<Column> trait_columns(const Study& study);
/// Of the probability of every kind of learner, if the hypotheses are about these; in the rows of people only.
[[nodiscard]] std::vector<Column> kind_columns(const Study& study);
[[nodiscard]] std::vector<Column> forecast_done_columns(const Study& study);

namespace columns {

template <typename Record>
struct Declared {};

/// What returns and regrets are counted in.
inline constexpr auto* kRewardUnit = "reward of the domain file";
inline constexpr ColumnWords kOfPeriod{kPeriod, "Number of the period, from 1; for the baseline within the member."};
inline constexpr ColumnWords kOfComponent{kComponent, "Number of the knowledge component, from 1."};
inline constexpr auto kOfMember = identifier(kMember, "Number of the member, from 1.");
inline constexpr ColumnWords kOfType{kType, "Letter of the learner type."};
inline constexpr ColumnWords kOfWorld{"mdp_name", "Name of this MDP in the domain file; missing if it has none."};
inline constexpr ColumnWords kOfStart{kStart, "Number of the start state in the MDP, from 0."};

template <typename Record>
[[nodiscard]] std::optional<std::string_view> name_of_world(const Record& record, const Study& study) {
  const auto& names = study.variants.front().world_names;
  if (record.mdp >= names.size() || names[record.mdp].empty()) return std::nullopt;
  return names[record.mdp];
}

template <typename Fields>
void declare(Fields& fields, Declared<LearnerRecord>) {
  using R = LearnerRecord;
  fields.column(&R::member, kOfMember);
  fields.column(&R::type, kOfType);
  fields.traits(&R::traits);
  fields.column(&R::p_bec, {kBelief, "Mass of the final belief in the policy's behaviour equivalence class.", "share"});
  fields.column(&R::periods, count(kPeriods, "Periods the member took part in."));
  fields.column(&R::tests, count(kTests, "Tests the member was asked."));
  fields.column(&R::correct, {kCorrect, "Tests answered correctly.", "count"});
  fields.column(
      &R::exam_share_right,
      measure(kExamShareRight, "Share of all starts where the member predicts the robot, at the end.", "share"),
      {.when = has_exam});
  fields.column(&R::exam_regret, measure(kExamRegret, "What these predictions lose.", kRewardUnit), {.when = has_exam});
  fields.column(&R::exam_questions,
                {"exam_questions", "Questions of the exam about starts that were neither shown nor tested.", "count"},
                {.when = has_exam});
  fields.column(&R::exam_correct, {"exam_correct", "Of these, answered correctly.", "count"}, {.when = has_exam});
}

template <typename Fields>
void declare(Fields& fields, Declared<ExamRecord>) {
  using R = ExamRecord;
  fields.column(&R::period, {kPeriod, "Number of the period after which the exam took place; 0 before the first."});
  fields.column(
      &R::component,
      {kComponent, "Number of the knowledge component whose starts the exam is about; missing for all starts."},
      {.zero_is_missing = true});
  fields.column(&R::member, kOfMember);
  fields.column(&R::type, kOfType);
  fields.column(&R::share_right,
                measure(kShareRight, "Expected share of the starts where the member predicts the robot.", "share"));
  fields.column(&R::regret,
                measure(kRegret, "Expected loss of the member's predictions against the robot's paths.", kRewardUnit));
  fields.column(&R::p_bec, {kBelief,
                            "Mass of the member's belief in the policy's behaviour equivalence class; for all starts "
                            "only.",
                            "share"});
}

template <typename Fields>
void declare(Fields& fields, Declared<EstimateRecord>) {
  using R = EstimateRecord;
  fields.column(&R::period, {kPeriod, "Number of the period after which these are the estimates; 0 before the first."});
  fields.column(&R::component, {kComponent, "Number of the knowledge component; missing in the row about the person."},
                {.zero_is_missing = true});
  fields.column(&R::member, kOfMember);
  fields.column(&R::type, kOfType);
  fields.column(&R::ability,
                measure(kAbility,
                        "True ability with which the member learns when a component begins, after ability_scale. In "
                        "the row of the person only.",
                        "none"));
  fields.column(
      &R::ability_mean,
      measure(kAbilityMean, "The teacher's estimate of this ability: posterior mean. In the row of the person only.",
              "none"));
  fields.column(&R::ability_low, measure(kAbilityLow,
                                         "Lower limit of the central 80 % of the posterior. In the row of the person "
                                         "only.",
                                         "none"));
  fields.column(&R::ability_high, measure(kAbilityHigh,
                                          "Upper limit of the central 80 % of the posterior. In the row of the person "
                                          "only.",
                                          "none"));
  fields.column(&R::p_proficient,
                measure("p_proficient",
                        "Posterior probability that the ability is at least record.proficient_ability. In the row of "
                        "the person only.",
                        "share"));
  fields.derived(
      [](const R& record) {
        return record.p_proficient ? std::optional{proficiency_word(*record.p_proficient)} : std::nullopt;
      },
      {kProficiency,
       "'proficient' if p_proficient is at least 0.8, 'not proficient' if it is at most 0.2, else 'cannot tell yet'. "
       "In the row of the person only."});
  fields.column(&R::p_knew, measure("p_knew",
                                    "Posterior probability that the member knew the component before the first lesson; "
                                    "with teacher.hypotheses = \"known-components\". In the rows of components only.",
                                    "share"));
  fields.column(&R::knew, measure("knew",
                                  "Mass of the member's belief before the first lesson in the component's constraints; "
                                  "where p_knew is. In the rows of components only.",
                                  "share"));
  fields.column(&R::p_right, measure("p_right",
                                     "Predicted probability that the member answers a random test of the component "
                                     "correctly. In the rows of components only.",
                                     "share"));
  fields.column(&R::right, measure("right",
                                   "The same probability under the member's own belief. In the rows of components "
                                   "only.",
                                   "share"));
  fields.columns(&R::p_kinds, kind_columns, {.since = 10});
  fields.column(&R::kind,
                {"kind",
                 "The kind of learner that the member is with a probability of at least 0.8, else 'cannot tell yet'; "
                 "with teacher.hypotheses = \"kinds\". In the row of the person only."},
                {.when = asks_for_kinds, .since = 10});
}

template <typename Fields>
void declare(Fields& fields, Declared<PeriodForecast>) {
  using R = PeriodForecast;
  fields.column(&R::periods_left,
                measure("forecast_periods_left", "Periods left, as expected after this one: mean.", "periods"));
  fields.columns(&R::done_within, forecast_done_columns);
}

template <typename Fields>
void declare(Fields& fields, Declared<PeriodMastery>) {
  using R = PeriodMastery;
  fields.column(&R::predicted, measure(kPredictedMastery,
                                       "Predicted probability that all members who took part answer a random "
                                       "test of the component correctly, after the feedback.",
                                       "share"));
  fields.column(&R::actual, measure(kMastery, "The same probability under the members' own beliefs.", "share"));
}

template <typename Fields>
void declare(Fields& fields, Declared<PeriodRecord>) {
  using R = PeriodRecord;
  fields.column(&R::period, kOfPeriod);
  fields.kept(&R::member);
  fields.kept(&R::session);
  fields.kept(&R::members);
  fields.column(&R::component, kOfComponent);
  fields.column(&R::source, {"source", "Whose belief the lesson was chosen for: 'common', 'joint' or 'member N'."});
  fields.column(&R::demonstrations, count(kDemonstrations, "Demonstrations shown."));
  fields.column(&R::area_sr,
                {kAreaSr, "Solid angle of the weights that satisfy what was shown, with the prior.", "sr"});
  fields.column(&R::running_area_sr, {"running_area_sr",
                                      "The same together with the components learned before; what earlier lessons of "
                                      "this component taught does not count.",
                                      "sr"});
  fields.column(&R::tests, count(kTests, "Tests asked of every member."));
  fields.column(&R::all_correct, {"all_correct", "Whether every member answered every test correctly."});
  fields.column(&R::excluded,
                {"excluded", "Members left out of the common belief because their answers conflict.", "count"});
  fields.column(&R::untested, {"untested", "Taught constraints that nothing can test.", "count"});
  fields.column(
      &R::tests_demonstrated,
      {"tests_demonstrated",
       "Tests whose start was demonstrated in this period or before, since no other start tests the same.", "count"},
      {.since = 11});
  fields.column(&R::gain, {"gain",
                           "Logarithm of the area of what was learned before (the prior and the components learned) "
                           "over running_area_sr; 0 if a lesson is shown again.",
                           "nat"});
  fields.derived(&R::members, {kMembers, "Members who took part.", "count"}, {.when = has_costs});
  fields.part(&R::forecast, {.when = has_forecasts});
  fields.part(&R::mastery, {.when = has_estimates});
  fields.columns(&R::p_bec, rule_columns);
}

template <typename Fields>
void declare(Fields& fields, Declared<BeliefSnapshot>) {
  using R = BeliefSnapshot;
  fields.kept(&R::period);
  fields.kept(&R::belief);
  fields.kept(&R::points);
  fields.kept(&R::weights);
}

template <typename Fields>
void declare(Fields& fields, Declared<DemonstrationRecord>) {
  using R = DemonstrationRecord;
  fields.column(&R::period, kOfPeriod);
  fields.column(&R::member, identifier(kMember, "Who watched, for the baseline; missing if everybody did."),
                {.zero_is_missing = true});
  fields.column(&R::component, kOfComponent);
  fields.column(&R::demonstration, {"demonstration", "Number of the demonstration in the period, from 1."});
  fields.column(&R::mdp, {kMdp, "Number of the MDP, from 0."});
  fields.derived(&name_of_world<R>, kOfWorld, {.when = has_world_names});
  fields.column(&R::start, kOfStart);
  fields.column(&R::constraints,
                {kConstraint, "Half-spaces that it conveys: entries of a normal separated by blanks, normals by ';'."});
}

template <typename Fields>
void declare(Fields& fields, Declared<ResponseRecord>) {
  using R = ResponseRecord;
  fields.column(&R::period, kOfPeriod);
  fields.column(&R::component, kOfComponent);
  fields.column(&R::test, {kTest, "Number of the test in the period, from 1."});
  fields.column(&R::member, kOfMember);
  fields.column(&R::mdp, {kMdp, "Number of the MDP of the test, from 0."});
  fields.derived(&name_of_world<R>, kOfWorld, {.when = has_world_names});
  fields.column(&R::start, kOfStart);
  fields.column(&R::correct, {kCorrect, "Whether the answer is as good as the robot's path."});
  fields.kept(&R::regret);  // with weights of length 1
  fields.derived(
      [](const R& record, const Study& study) {
        const auto& weights = study.variants.front().weights;
        return record.regret ? std::optional{in_file_units(weights, *record.regret)} : std::nullopt;
      },
      {kRegret, "Return of the robot's path minus that of the answer; missing without an answer.", kRewardUnit});
  fields.column(
      &R::answer,
      {kAnswer, "Feature counts of the answer, or expectations of them, separated by blanks; missing without one."});
  fields.column(
      &R::constraints,
      {kConstraint, "Half-spaces that the answer shows: entries of a normal separated by blanks, normals by ';'."});
  fields.column(&R::covered, {kCovered, "Half-spaces that the test examines and that its feedback teaches."});
}

template <typename Fields>
void declare(Fields& fields, Declared<DiscussionRecord>) {
  using R = DiscussionRecord;
  fields.column(&R::period, kOfPeriod);
  fields.column(&R::component, kOfComponent);
  fields.column(&R::test, {kTest, "Number of the test in the period, from 1."});
  fields.column(&R::member, kOfMember);
  fields.column(&R::first, {kAnswer, "Feature counts of the first answer, as in responses.csv; missing without one."});
  fields.column(&R::first_correct, {kCorrect, "Whether the first answer is as good as the robot's path."});
  fields.column(&R::revised, {"revised_answer", "The same of the answer after the discussion."});
  fields.column(&R::revised_correct, {"revised_correct", "Whether that is as good as the robot's path."});
  fields.derived([](const R& record) { return record.first != record.revised; },
                 {"changed", "Whether the member gave another answer after the discussion."});
}

template <typename Fields>
void declare(Fields& fields, Declared<ProgressRecord>) {
  using R = ProgressRecord;
  fields.column(&R::period, kOfPeriod);
  fields.column(&R::component, kOfComponent);
  fields.column(&R::member, kOfMember);
  fields.column(&R::type, kOfType);
  fields.column(&R::ability, {kAbility, "Ability while watching the demonstrations, before ability_scale.", "none"},
                {.required = all_have_ability});
  fields.column(&R::p_bec, {kBelief,
                            "Mass of the member's own belief in the policy's behaviour equivalence class, after the "
                            "feedback.",
                            "share"});
  fields.column(&R::all_correct, {"all_correct", "Whether the member answered every test of the period correctly."});
}

template <typename Fields>
void declare(Fields& fields, Declared<TeamCost>) {
  using R = TeamCost;
  fields.column(&R::person_periods,
                {"person_periods", "Periods that members took part in, summed over members.", "count"});
  fields.column(&R::minutes, measure(kMinutes, "Teaching time by the study's pace, summed over sessions.", "min"));
  fields.column(&R::person_minutes, measure(kPersonMinutes, "Time of the members, summed over members.", "min"));
}

template <typename Fields>
void declare(Fields& fields, Declared<TeamForecast>) {
  using R = TeamForecast;
  constexpr auto* kLow = "Lower limit of the central 80 % of the forecast.";
  constexpr auto* kHigh = "Upper limit of the central 80 % of the forecast.";
  fields.column(&R::periods, measure(kForecastPeriods, "Expected periods, before the first lesson: mean.", "periods"));
  fields.column(&R::periods_low, measure(kForecastPeriodsLow, kLow, "periods"));
  fields.column(&R::periods_high, measure(kForecastPeriodsHigh, kHigh, "periods"));
  fields.column(&R::minutes, measure("forecast_minutes", "Expected minutes, before the first lesson: mean.", "min"));
  fields.column(&R::minutes_low, measure("forecast_minutes_low", kLow, "min"));
  fields.column(&R::minutes_high, measure("forecast_minutes_high", kHigh, "min"));
}

template <typename Fields>
void declare(Fields& fields, Declared<TeamExam>) {
  using R = TeamExam;
  fields.column(&R::share_right, measure(kExamShareRight,
                                         "Share of all starts of the domain where members predict the robot, under "
                                         "their final beliefs; mean over members.",
                                         "share"));
  fields.column(&R::regret, measure(kExamRegret,
                                    "What the members' predictions lose against the robot's paths, over all starts; "
                                    "mean over members.",
                                    kRewardUnit));
  fields.column(&R::worst_share_right, measure(kExamWorstShareRight, "The smallest share_right of a member.", "share"));
}

template <typename Fields>
void declare(Fields& fields, Declared<TeamRecord>) {
  using R = TeamRecord;
  fields.column(&R::seed_address, {kSeedAddress, "Address of the team's random numbers: seed/composition/replicate."});
  fields.column(
      &R::status,
      {kStatus,
       "'complete' if every knowledge component was learned or is implied by the lessons of others; 'skipped' if "
       "something stayed open that nothing could show; 'max_periods' if teaching stopped before."});
  fields.derived(&R::completed, {kCompleted, "Whether the status is 'complete'."});
  fields.column(&R::periods, count(kPeriods, "Interaction periods; for the baseline the sum over members."));
  fields.column(&R::demonstrations, count(kDemonstrations, "Demonstrations shown, in all periods."));
  fields.column(&R::tests, count(kTests, "Tests asked, in all periods; each of them of every member."));
  fields.column(
      &R::knowledge,
      {kKnowledge, "Mean over members of the mass of their final belief in the policy's behaviour equivalence class.",
       "share"});
  fields.column(&R::knowledge_min, {"knowledge_min", "The smallest of these masses.", "share"});
  fields.column(&R::components_learned,
                {"kcs_learned", "Knowledge components learned; for the baseline the sum over members.", "count"});
  fields.column(
      &R::components_skipped,
      {"kcs_skipped",
       "Knowledge components left out, because nothing that could be shown adds to what was taught, or by design.",
       "count"});
  fields.column(&R::area_sr, {kAreaSr, "Mean over periods of the area in periods.csv.", "sr"});
  fields.part(&R::cost, {.when = has_costs});
  fields.part(&R::forecast, {.when = has_forecasts});
  fields.kept(&R::learners);
  fields.kept(&R::period_records);
  fields.kept(&R::beliefs);
  fields.kept(&R::demonstration_records);
  fields.kept(&R::responses);
  fields.kept(&R::progress);
  fields.kept(&R::exams);
  fields.kept(&R::estimates);
  fields.part(&R::exam, {.when = has_exam, .required = has_exam});
  // Before the columns of the exam, where these are.
  fields.column(&R::fewest_particles,
                measure(kFewestParticles,
                        "The smallest effective number of particles of a member's belief that satisfied what "
                        "the member was just shown. Below 10 the belief is impoverished.",
                        "particles"),
                {.when = has_belief_quality, .before = kExamShareRight});
  fields.kept(&R::discussions, 9);
}

}  // namespace columns
}  // namespace kith
