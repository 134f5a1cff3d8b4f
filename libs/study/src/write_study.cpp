#include <algorithm>
#include <optional>

#include "kith/study/study_file.hpp"
#include "kith/toml/document.hpp"
#include "parameters_toml.hpp"
#include "read_group.hpp"
#include "read_study_spec.hpp"

namespace kith {
namespace {

// Collects the keys of one table.
class TableWriter {
 public:
  void add(std::string key, TomlValue value) { table_.append({std::move(key), {}, std::move(value)}); }
  void add(std::string key, const std::string& value) { add(std::move(key), TomlValue{value}); }
  void add(std::string key, double value) { add(std::move(key), TomlValue{value}); }
  void add(std::string key, bool value) { add(std::move(key), TomlValue{value}); }
  void add_count(std::string key, std::size_t value) {
    add(std::move(key), TomlValue{static_cast<std::int64_t>(value)});
  }
  void add(std::string key, TableWriter table) { add(std::move(key), TomlValue{std::move(table).take()}); }
  [[nodiscard]] TomlTable take() && { return std::move(table_); }

 private:
  TomlTable table_;
};

TomlArray strings(const std::vector<std::string>& values) {
  TomlArray array;
  for (const auto& value : values) array.emplace_back(value);
  return array;
}

// Numbers and words are told apart by what they look like; labels, which could look like either, do not vary.
TomlValue value_of(const std::string& setting) {
  const auto parsed = parse_assignment("x=" + setting, "");
  return parsed.assignment ? TomlValue{parsed.assignment->value.content()} : TomlValue{setting};
}

TableWriter vary(const Study& study) {
  TableWriter table;
  for (std::size_t i = 0; i < study.variants.front().factors.size(); ++i) {
    TomlArray values;
    for (const auto& variant : study.variants) {
      const auto value = value_of(variant.factors[i].value);
      if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }
    table.add(study.variants.front().factors[i].key, TomlValue{values});
  }
  return table;
}

TableWriter design(const Study& study) {
  const auto& spec = study.variants.front();
  TableWriter table;
  std::vector<std::string> names;
  for (const auto& strategy : spec.strategies) names.push_back(strategy.name);
  table.add("strategies", TomlValue{strings(names)});
  table.add("compositions", TomlValue{strings(spec.compositions)});
  table.add("pairing", kPairingWords[static_cast<std::size_t>(spec.pairing)]);
  if (!spec.factors.empty()) table.add("vary", vary(study));
  return table;
}

TomlArray prior(const std::vector<HalfSpace>& half_spaces, const Domain& domain) {
  TomlArray array;
  for (const auto& half_space : half_spaces) {
    TableWriter normal;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      const auto entry = half_space.normal()[k];
      if (entry != 0) normal.add(domain.feature_names()[k], TomlValue{entry});
    }
    array.emplace_back(std::move(normal).take());
  }
  return array;
}

TomlTable learner(const LearnerType& type, const Domain& domain) {
  TableWriter table;
  table.add("kind", std::string{type.model->kind});
  table.add("label", type.label);
  auto result = std::move(table).take();
  write_parameters(type.parameters, result);
  if (type.prior) result.append({"prior", {}, TomlValue{prior(*type.prior, domain)}});
  return result;
}

// Those that need a table: with parameters, or with a name of their own.
std::optional<TableWriter> strategies(const StudySpec& spec) {
  std::optional<TableWriter> tables;
  for (const auto& strategy : spec.strategies) {
    if (strategy.name == strategy.kind.name && strategy.kind.parameters.empty()) continue;
    TomlTable table;
    table.append({"kind", {}, TomlValue{std::string{strategy.kind.name}}});
    write_parameters(strategy.parameters, table);
    if (!tables) tables.emplace();
    tables->add(strategy.name, TomlValue{std::move(table)});
  }
  return tables;
}

TomlArray contrasts(const StudySpec& spec) {
  TomlArray array;
  for (const auto& contrast : spec.contrasts) {
    TableWriter table, weights;
    table.add("name", contrast.name);
    table.add("factor", contrast.factor);
    if (!contrast.response.empty()) table.add("response", contrast.response);
    if (contrast.primary) table.add("primary", true);
    for (const auto& [level, weight] : contrast.weights) weights.add(level, TomlValue{weight});
    table.add("weights", std::move(weights));
    array.emplace_back(std::move(table).take());
  }
  return array;
}

TableWriter teacher(const StudySpec& spec) {
  const auto& options = spec.teaching;
  TableWriter table;
  table.add_count("particles", options.filter.particles);
  table.add_count("counterfactuals", options.counterfactuals);
  table.add("counterfactual_sampling", kSamplingWords[static_cast<std::size_t>(options.sampling)]);
  table.add("assumed_ability", options.assumed_ability);
  table.add("likelihood", kLikelihoodWords[static_cast<std::size_t>(options.likelihood)]);
  table.add("process_noise", options.filter.process_noise);
  table.add("response_noise", options.response_noise);
  table.add("resample_below", options.filter.resample_below);
  table.add("reduce_before_update", options.reduce_before_update);
  table.add("review", options.review);
  table.add("scaffold", kScaffoldWords[static_cast<std::size_t>(options.scaffold)]);
  table.add_count("max_demonstrations", options.max_demonstrations);
  table.add("objective", kObjectiveWords[static_cast<std::size_t>(options.objective)]);
  table.add("hypotheses", kHypothesesWords[static_cast<std::size_t>(options.hypotheses_about)]);
  table.add("grouping", kGroupingWords[static_cast<std::size_t>(spec.grouping)]);
  std::vector<std::string> beliefs;
  for (const auto& rule : options.rules) beliefs.emplace_back(rule.name);
  table.add("beliefs", TomlValue{strings(beliefs)});
  table.add("learner_counterfactuals", kCounterfactualWords[spec.learner_counterfactuals_self ? 1 : 0]);
  return table;
}

}  // namespace

std::string to_toml(const Study& study, const Domain& domain, GroupText group) {
  const auto& spec = study.variants.at(0);
  TableWriter root, learners, stop, pace, record;
  root.add("schema", std::string{kStudySchema});
  root.add("id", spec.id);
  root.add("title", spec.title);
  root.add("domain", spec.domain);
  root.add_count("seed", spec.seed);
  root.add_count("replicates", spec.replicates);
  root.add("design", design(study));
  if (auto tables = strategies(spec)) root.add("strategy", *std::move(tables));
  auto types = spec.learner_types;  // their order means nothing, so it is always the same one
  std::sort(types.begin(), types.end(), [](const LearnerType& a, const LearnerType& b) { return a.letter < b.letter; });
  for (const auto& type : types) learners.add(std::string{type.letter}, TomlValue{learner(type, domain)});
  root.add("learner", learners);
  root.add("teacher", teacher(spec));
  stop.add("mastery", kMasteryWords[static_cast<std::size_t>(spec.teaching.mastery)]);
  stop.add_count("periods_per_component", spec.teaching.periods_per_component);
  stop.add("probability", spec.teaching.probability);
  if (spec.teaching.mastery == MasteryRule::kExam) stop.add("share_right", spec.teaching.share_right);
  stop.add_count("min_periods", spec.teaching.min_periods);
  stop.add_count("max_periods", spec.teaching.max_periods);
  stop.add_count("consecutive_correct", spec.teaching.consecutive_correct);
  stop.add_count("duplicate_sets", spec.teaching.duplicate_sets);
  stop.add("release", kReleaseWords[static_cast<std::size_t>(spec.teaching.release)]);
  root.add("stop", stop);
  pace.add("demonstration_s", spec.pace.demonstration_s);
  pace.add("test_s", spec.pace.test_s);
  pace.add("feedback_s", spec.pace.feedback_s);
  root.add("pace", pace);
  record.add("level", kRecordWords[static_cast<std::size_t>(spec.record)]);
  record.add("exam", kExamWords[static_cast<std::size_t>(spec.exam)]);
  record.add_count("exam_questions", spec.exam_questions);
  record.add_count("forecast", spec.forecast_sessions);
  record.add("estimates", spec.estimates);
  if (spec.beliefs) record.add("beliefs", true);
  record.add("proficient_ability", spec.proficient_ability);
  root.add("record", record);
  if (group == GroupText::kWritten && spec.has_group) root.add("group", TomlValue{group_table(spec.group)});
  if (!spec.contrasts.empty()) root.add("contrast", TomlValue{contrasts(spec)});
  return to_toml(std::move(root).take());
}

}  // namespace kith
