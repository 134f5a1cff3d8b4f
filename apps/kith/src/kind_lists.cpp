// The registries of learner models, strategies, rules of aggregation, stop rules and ways of talking, as `kith explain`
// and help show them.
#include "kind_lists.hpp"

#include <algorithm>

#include "kith/belief/aggregation.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/learners/discussion.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/teaching/stop_rule.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith::cli {
namespace {

std::string type_and_range(const Parameter& parameter) {
  const auto range = range_of(parameter);
  return type_of(parameter) + (range.empty() ? "" : " in " + range);
}

std::string parameter_text(const Parameter& parameter) {
  const std::string blank(6, ' ');
  const auto lines = [&](const std::string& text) { return wrapped(text, kTextWidth, blank, blank) + "\n"; };
  auto meaning = std::string{parameter.description};
  if (!parameter.source.empty()) meaning += " [" + std::string{parameter.source} + "]";
  const auto value = parameter.is_required ? "required" : "default: " + to_string(parameter.default_value);
  return "    " + std::string{parameter.name} + "\n" + lines(type_and_range(parameter) + "; " + value) + lines(meaning);
}

}  // namespace

std::vector<KindList> kind_lists() {
  KindList learners{"learners", "learner.X.kind", {}};
  for (const auto* model : learner_models())
    learners.rows.push_back({model->kind, model->description, model->parameters});
  KindList strategies{"strategies", "design.strategies, and strategy.NAME.kind", {}};
  for (const auto& kind : strategy_kinds()) strategies.rows.push_back({kind.name, kind.description, kind.parameters});
  KindList beliefs{"beliefs", "teacher.beliefs", {}};
  for (const auto& rule : aggregation_rules()) beliefs.rows.push_back({rule.name, rule.description, {}});
  KindList stop_rules{"stop-rules", "stop.mastery, and stop.release where a rule says who is done", {}};
  for (const auto& kind : stop_rule_kinds()) stop_rules.rows.push_back({kind.name, kind.description, kind.parameters});
  KindList discussions{"discussions", "group.discussion.model", {}};
  for (const auto& one : discussion_models()) discussions.rows.push_back({one.name, one.description, one.parameters});
  return {std::move(learners), std::move(strategies), std::move(beliefs), std::move(stop_rules),
          std::move(discussions)};
}

std::string to_text(const KindList& list, const Console& console) {
  auto text = "What " + std::string{list.key} + " can name:\n";
  for (const auto& row : list.rows) {
    text += "\n" + console.bold(row.name) + "\n" + wrapped(row.description, kTextWidth, "    ", "    ") + "\n";
    for (const auto& parameter : row.parameters) text += "\n" + parameter_text(parameter);
  }
  const bool has_source = std::any_of(list.rows.begin(), list.rows.end(), [](const auto& row) {
    return std::any_of(row.parameters.begin(), row.parameters.end(),
                       [](const auto& one) { return !one.source.empty(); });
  });
  return has_source ? text + "\nNames in brackets are keys of docs/references.bib.\n" : text;
}

std::string keys_text() {
  std::string text = "keys that depend on a kind (details: kith explain TOPIC):\n";
  for (const auto& list : kind_lists()) {
    const std::string blank(6, ' ');
    text += "  " + std::string{list.topic} + ": " + std::string{list.key} + "\n";
    for (const auto& row : list.rows) {
      auto line = std::string{row.name};
      for (const auto& parameter : row.parameters) {
        line.append(&parameter == &row.parameters.front() ? ": " : ", ").append(parameter.name);
      }
      text += wrapped(line, kTextWidth, blank, "    ") + "\n";
    }
  }
  return text;
}

}  // namespace kith::cli
