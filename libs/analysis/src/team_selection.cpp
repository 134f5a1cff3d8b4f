#include "kith/analysis/effect.hpp"

#include <algorithm>

namespace kith {

StudySpec recording(StudySpec spec, std::span<const StudyOutcome* const> outcomes) {
  spec.record = RecordLevel::kTeam;
  spec.exam = std::ranges::any_of(outcomes, &StudyOutcome::needs_exam) ? ExamLevel::kEnd : ExamLevel::kNone;
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

}  // namespace kith
