#include "kith/study_design/quantity.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "kith/table/outcome.hpp"

namespace kith {
namespace {

// In the order of the enumerators, which is that of outcome_columns().
const std::array<std::string_view, kNumQuantities> kNames = [] {
  std::array<std::string_view, kNumQuantities> names;
  std::transform(outcome_columns().begin(), outcome_columns().end(), names.begin(),
                 [](const OutcomeColumn& one) { return one.name; });
  return names;
}();

const TeamExam& exam_of(const TeamRecord& team) {
  if (!team.exam) throw std::invalid_argument{"value_of: the team was not examined"};
  return *team.exam;
}

}  // namespace

std::string_view name_of(Quantity quantity) noexcept { return kNames[static_cast<std::size_t>(quantity)]; }

std::optional<Quantity> find_quantity(std::string_view name) noexcept {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Quantity>(found - kNames.begin());
}

std::span<const std::string_view> quantity_names() noexcept { return kNames; }

double value_of(const TeamRecord& team, Quantity quantity) {
  switch (quantity) {
    case Quantity::kPeriods:
      return static_cast<double>(team.periods);
    case Quantity::kKnowledge:
      return team.knowledge;
    case Quantity::kCompleted:
      return team.completed() ? 1.0 : 0.0;
    case Quantity::kAreaSr:
      return team.area_sr;
    case Quantity::kExamShareRight:
      return exam_of(team).share_right;
    case Quantity::kExamRegret:
      return exam_of(team).regret;
    case Quantity::kExamWorstShareRight:
      return exam_of(team).worst_share_right;
  }
  return 0.0;
}

StudySpec recording(StudySpec spec, std::span<const Quantity> quantities) {
  spec.record = RecordLevel::kTeam;
  spec.exam = std::any_of(quantities.begin(), quantities.end(), is_of_exam) ? ExamLevel::kEnd : ExamLevel::kNone;
  spec.exam_questions = 0;
  return spec;
}

namespace {

// Whether a strategy is one of "joint+common".
bool is_part(const std::string& strategy, std::string_view who) {
  return ("+" + std::string{who} + "+").find("+" + strategy + "+") != std::string::npos;
}

}  // namespace

bool TeamSelection::contains(const TeamAddress& address) const {
  const bool right_strategy = strategy ? is_part(address.strategy, *strategy) : address.strategy != kBaseline;
  return right_strategy && (composition.empty() || composition == address.composition);
}

std::string to_string(const TeamSelection& selection) {
  std::string text = selection.strategy.value_or("group");
  if (!selection.composition.empty()) text += "/" + selection.composition;
  return text;
}

std::optional<TeamSelection> parse_selection(std::string_view text, const StudySpec& spec) {
  const auto slash = text.find('/');
  TeamSelection selection;
  const auto who = text.substr(0, slash);
  if (who == "group") {
    const auto is_group = [](const StrategyChoice& strategy) { return !strategy.is_baseline(); };
    if (std::none_of(spec.strategies.begin(), spec.strategies.end(), is_group)) return std::nullopt;
  } else {
    const auto& all = spec.strategies;
    const auto known = std::count_if(all.begin(), all.end(), [&](const auto& one) { return is_part(one.name, who); });
    if (known != std::count(who.begin(), who.end(), '+') + 1) return std::nullopt;
    selection.strategy = std::string{who};
  }
  if (slash == std::string_view::npos) return selection;
  selection.composition = text.substr(slash + 1);
  const auto& all = spec.compositions;
  if (std::find(all.begin(), all.end(), selection.composition) == all.end()) return std::nullopt;
  return selection;
}

std::string selections_of(const StudySpec& spec) {
  std::string text = "group";
  for (const auto& strategy : spec.strategies) text += ", " + strategy.name;
  text += "; each may be followed by a composition, such as group/" + spec.compositions.front();
  return text;
}

}  // namespace kith
