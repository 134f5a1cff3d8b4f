#include <algorithm>
#include <optional>

#include "kith/files/document.hpp"
#include "kith/study/study_file.hpp"
#include "kith/teaching/learner_bank.hpp"
#include "parameters_toml.hpp"
#include "read_study_spec.hpp"
#include "study_keys.hpp"

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
  table.add("pairing", std::string{word_for(spec.pairing)});
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
  TableWriter table, shares;
  if (!type.mixture.empty()) {
    for (const auto& [letter, share] : type.mixture) shares.add(std::string{letter}, share);
    table.add("label", type.label);
    table.add("mixture", std::move(shares));
    return std::move(table).take();
  }
  table.add("kind", std::string{type.model->kind});
  table.add("label", type.label);
  auto result = std::move(table).take();
  write_parameters(type.parameters, result);
  if (type.prior) result.append({"prior", {}, TomlValue{prior(*type.prior, domain)}});
  if (type.knowing) result.append({"knowing", {}, TomlValue{knowing_table(*type.knowing, domain)}});
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

TomlValue teacher(const StudySpec& spec) {
  TomlTable table;
  write_options(teacher_keys(), spec.teaching, table);
  std::vector<std::string> beliefs;
  for (const auto& rule : spec.teaching.rules) beliefs.emplace_back(rule.name);
  const auto more = more_teacher_keys();
  write_options(more.first(1), spec, table);
  table.append({"beliefs", {}, TomlValue{strings(beliefs)}});
  write_options(more.subspan(1), spec, table);
  if (!spec.assumes_knowing) table.append({"knowing", {}, TomlValue{std::string{"nothing"}}});
  if (spec.teaching.hypotheses_about == HypothesesAbout::kKinds) {
    std::vector<std::string> kinds;
    for (const auto& one : kinds_of(spec.teaching.kinds)) kinds.push_back(one.kind);
    table.append({"kinds", {}, TomlValue{strings(kinds)}});
  }
  return TomlValue{std::move(table)};
}

TomlValue stop(const TeachingOptions& options) {
  const auto& mastery = options.mastery;
  const auto& release = options.release;
  TomlTable table;
  table.append({"mastery", {}, TomlValue{std::string{mastery.kind.name}}});
  write_parameters(mastery.parameters, table);
  write_options(stop_keys(), options, table);
  table.append({"release", {}, TomlValue{std::string{release ? release->kind.name : "none"}}});
  if (release && release->kind.name != mastery.kind.name) write_parameters(release->parameters, table);
  return TomlValue{std::move(table)};
}

TomlValue written(std::span<const OptionKey<StudySpec>> keys, const StudySpec& spec) {
  TomlTable table;
  write_options(keys, spec, table);
  return TomlValue{std::move(table)};
}

}  // namespace

TomlTable knowing_table(const OlderRobot& robot, const Domain& domain) {
  TableWriter knowing;
  knowing.add("robot", robot.name);
  knowing.add("halfspaces", TomlValue{prior(robot.region, domain)});
  return std::move(knowing).take();
}

std::string to_toml(const Study& study, const Domain& domain, GroupText group) {
  const auto& spec = study.variants.at(0);
  TableWriter root, learners;
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
  root.add("stop", stop(spec.teaching));
  root.add("pace", written(pace_keys(), spec));
  root.add("record", written(record_keys(), spec));
  if (group == GroupText::kWritten && spec.has_group) {
    root.add("group", TomlValue{group_table(spec.group)});
  } else if (spec.group.discussion.choice.is_held()) {  // this alone changes what is simulated
    TableWriter talk;
    talk.add("discussion", TomlValue{discussion_table(spec.group.discussion)});
    root.add("group", std::move(talk));
  }
  if (!spec.contrasts.empty()) root.add("contrast", TomlValue{contrasts(spec)});
  return to_toml(std::move(root).take());
}

}  // namespace kith
