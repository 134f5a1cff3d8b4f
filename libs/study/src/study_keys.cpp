// Every key of `[pace]` and `[record]`, and those of `[teacher]` that are no fields of TeachingOptions.
#include "study_keys.hpp"

#include <map>
#include <string>
#include <vector>

#include "kith/core/text.hpp"

namespace kith {

template <>
inline constexpr std::array kWordsFor<RecordLevel>{WordFor{RecordLevel::kTeam, "team"},
                                                   WordFor{RecordLevel::kPeriod, "period"},
                                                   WordFor{RecordLevel::kParticles, "particles"}};
template <>
inline constexpr std::array kWordsFor<ExamLevel>{WordFor{ExamLevel::kNone, "none"}, WordFor{ExamLevel::kEnd, "end"},
                                                 WordFor{ExamLevel::kPeriod, "period"}};

namespace {

OptionKey<StudySpec> learner_counterfactuals() {
  static constexpr std::array<std::string_view, 2> kWords{"teacher", "self"};
  return {{.name = "learner_counterfactuals",
           .default_value = std::string{kWords[0]},
           .description = "whose expectations say what a demonstration conveys to a person: the teacher's "
                          "counterfactuals, or the person's own ('self')",
           .words = kWords},
          [](const StudySpec& spec) -> ParameterValue {
            return std::string{kWords[spec.learner_counterfactuals_self ? 1 : 0]};
          },
          [](StudySpec& spec, const ParameterValue& value) {
            spec.learner_counterfactuals_self = std::get<std::string>(value) == kWords[1];
          }};
}

// "'a', 'b' or 'c'"
std::string alternatives(const std::vector<std::string_view>& names) { return listed(names, in_quotes, " or "); }

std::vector<Parameter> declared_in(std::string_view table) {
  std::vector<Parameter> result;
  const auto add = [&](const auto& keys) {
    for (const auto& key : keys) result.push_back(key.parameter);
  };

  if (table == "teacher") {
    add(teacher_keys());
    add(more_teacher_keys());
    result.push_back({.name = "beliefs",
                      .default_value = std::string{},
                      .description = "rules by which beliefs about the whole team are kept"});
    result.push_back({.name = "kinds",
                      .default_value = std::string{},
                      .description = "kinds of learners that the hypotheses 'kinds' are about"});
    result.push_back({.name = "knowing",
                      .default_value = std::string{"learners"},
                      .description = "which robot before an update the teacher takes people to know: the one that all "
                                     "learners know, or none ('nothing')"});
  } else if (table == "stop") {
    std::vector<std::string_view> all, releasing{"none"};
    for (const auto& kind : stop_rule_kinds()) {
      all.push_back(kind.name);
      if (kind.released != nullptr) releasing.push_back(kind.name);
    }

    static const auto mastery = "when a component has been taught enough: " + alternatives(all);
    static const auto release = "who leaves a component before the team does: " + alternatives(releasing);
    result.push_back({.name = "mastery", .default_value = std::string{"all-right"}, .description = mastery});
    add(stop_keys());
    result.push_back({.name = "release", .default_value = std::string{"none"}, .description = release});
  } else if (table == "pace") {
    add(pace_keys());
  } else if (table == "record") {
    add(record_keys());
  }

  return result;
}

}  // namespace

std::span<const OptionKey<StudySpec>> more_teacher_keys() {
  static const std::array keys{learner_counterfactuals()};
  return keys;
}

std::span<const OptionKey<StudySpec>> pace_keys() {
  constexpr double kHour = 3600.0;
  static const std::array keys{
      option_key<StudySpec, &StudySpec::teaching, &TeachingOptions::pace, &Pace::demonstration_s>(
          "demonstration_s", "seconds that a demonstration is assumed to take", {0, kHour}),
      option_key<StudySpec, &StudySpec::teaching, &TeachingOptions::pace, &Pace::test_s>(
          "test_s", "seconds that a test is assumed to take", {0, kHour}),
      option_key<StudySpec, &StudySpec::teaching, &TeachingOptions::pace, &Pace::feedback_s>(
          "feedback_s", "seconds that the feedback about a test is assumed to take", {0, kHour}),
      option_key<StudySpec, &StudySpec::teaching, &TeachingOptions::pace, &Pace::discussion_s>(
          "discussion_s", "seconds that groups that talk are assumed to talk about a test", {0, kHour},
          [](const StudySpec& spec) { return spec.group.discussion.choice.is_held(); })};
  return keys;
}

std::span<const OptionKey<StudySpec>> record_keys() {
  static const std::array keys{
      option_key<StudySpec, &StudySpec::record>("level", "how much is recorded about every team"),
      option_key<StudySpec, &StudySpec::exam>(
          "exam", "when simulated people are examined over all starts: 'none', 'end' or 'period'"),
      option_key<StudySpec, &StudySpec::exam_questions>(
          "exam_questions", "questions of the exam that everybody answers at the end", {0, 1000}),
      option_key<StudySpec, &StudySpec::forecast_sessions>("forecast", "imagined sessions of each cell, for forecasts",
                                                           {0, 100'000}),
      option_key<StudySpec, &StudySpec::estimates>(
          "estimates", "whether tables have what the teacher can tell about people, beside the truth"),
      option_key<StudySpec, &StudySpec::beliefs>(
          "beliefs", "whether tables say how well the particles of beliefs could represent what was shown", {},
          [](const StudySpec& spec) { return spec.beliefs; }),
      option_key<StudySpec, &StudySpec::proficient_ability>(
          "proficient_ability", "ability from which a member counts as proficient in the estimates", {0.5, 1})};
  return keys;
}

std::span<const Parameter> study_keys(std::string_view table) {
  static const std::map<std::string_view, std::vector<Parameter>> tables = [] {
    std::map<std::string_view, std::vector<Parameter>> all;
    for (const auto* name : {"teacher", "stop", "pace", "record"}) all.emplace(name, declared_in(name));
    return all;
  }();
  const auto found = tables.find(table);
  return found == tables.end() ? std::span<const Parameter>{} : found->second;
}

}  // namespace kith
