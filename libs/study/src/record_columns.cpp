#include "kith/study/record_columns.hpp"

#include <algorithm>

#include "kith/teaching/learner_bank.hpp"

namespace kith {
namespace {

template <typename Holds>
bool any_variant(const Study& study, Holds holds) {
  return std::any_of(study.variants.begin(), study.variants.end(), holds);
}

// The learner types of all variants, as they have the model that a variant gives them, by letter.
std::vector<const LearnerType*> types_of(const Study& study) {
  std::vector<const LearnerType*> types;
  for (const auto& variant : study.variants)
    for (const auto& type : variant.learner_types) types.push_back(&type);
  std::stable_sort(types.begin(), types.end(),
                   [](const LearnerType* a, const LearnerType* b) { return a->letter < b->letter; });
  return types;
}

bool has_trait(const LearnerModel& model, std::string_view name) {
  return std::any_of(model.traits.begin(), model.traits.end(), [&](const auto& trait) { return trait.name == name; });
}

Column real_column(std::string name, std::string description, const char* unit, bool required = true) {
  return {.name = std::move(name),
          .type = ColumnType::kReal,
          .description = std::move(description),
          .unit = unit,
          .required = required};
}

}  // namespace

bool has_exam(const Study& study) { return study.variants.front().exam != ExamLevel::kNone; }
bool has_costs(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return has_costs(spec); });
}
bool has_forecasts(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.forecast_sessions > 0; });
}
bool has_estimates(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.estimates; });
}
bool has_discussions(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.group.discussion.choice.is_held(); });
}
bool asks_for_kinds(const Study& study) {
  return study.variants.front().teaching.hypotheses_about == HypothesesAbout::kKinds;
}
bool has_belief_quality(const Study& study) {
  return any_variant(study, [](const StudySpec& spec) { return spec.beliefs; });
}
bool has_world_names(const Study& study) { return !study.variants.front().world_names.empty(); }
bool all_have_ability(const Study& study) {
  const auto types = types_of(study);
  return std::all_of(types.begin(), types.end(), [](const auto* type) { return type->model->has_ability; });
}

std::vector<Column> rule_columns(const Study& study) {
  std::vector<Column> columns;
  for (const auto& rule : study.variants.front().teaching.rules) {
    const std::string name{rule.name};
    columns.push_back(real_column(std::string{columns::kBelief} + "_" + name,
                                  "Mass of the teacher's " + name + " belief in the policy's class, afterwards.",
                                  "share"));
  }
  return columns;
}

std::vector<Column> trait_columns(const Study& study) {
  std::vector<Column> columns;
  const auto types = types_of(study);
  for (const auto* type : types) {
    for (const auto& trait : type->model->traits) {
      const auto is_same = [&](const Column& column) { return column.name == trait.name; };
      if (std::any_of(columns.begin(), columns.end(), is_same)) continue;
      const bool have_all = std::all_of(types.begin(), types.end(),
                                        [&](const LearnerType* other) { return has_trait(*other->model, trait.name); });
      columns.push_back(real_column(std::string{trait.name}, std::string{trait.description}, "none", have_all));
    }
  }
  return columns;
}

std::vector<Column> kind_columns(const Study& study) {
  std::vector<Column> columns;
  if (!asks_for_kinds(study)) return columns;
  for (const auto& [kind, beforehand] : kinds_of(study.variants.front().teaching.kinds)) {
    columns.push_back(real_column("p_kind_" + kind,
                                  "Posterior probability that the member learns and answers as the learner model '" +
                                      kind + "'. In the row of the person only.",
                                  "share", false));
  }
  return columns;
}

std::vector<Column> forecast_done_columns(const Study& /*study*/) {
  std::vector<Column> columns;
  for (const auto* name : columns::kForecastDone) {
    const auto periods = std::to_string(columns.size() + 1);
    columns.push_back(real_column(
        name, "Probability that the team is done after at most " + periods + " more, as expected after this period.",
        "share"));
  }
  return columns;
}

}  // namespace kith
