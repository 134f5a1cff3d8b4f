#include <string>
#include <vector>

#include "parameters_toml.hpp"
#include "read_study_spec.hpp"

namespace kith {
namespace {

class GroupTable {
 public:
  void add(std::string key, TomlValue::Content value) {
    table_.append({std::move(key), {}, TomlValue{std::move(value)}});
  }
  void count(std::string key, std::size_t value) { add(std::move(key), static_cast<std::int64_t>(value)); }
  void text(std::string key, const std::string& value) {
    if (!value.empty()) add(std::move(key), value);
  }
  void texts(std::string key, const std::vector<std::string>& values) {
    if (values.empty()) return;
    TomlArray array;
    for (const auto& value : values) array.emplace_back(value);
    add(std::move(key), std::move(array));
  }
  [[nodiscard]] TomlTable take() { return std::move(table_); }

 private:
  TomlTable table_;
};

TomlArray questions_array(const std::vector<GroupQuestion>& questions) {
  TomlArray array;
  for (const auto& question : questions) {
    GroupTable table;
    table.add("id", question.id);
    table.add("kind", std::string{name_of(question.kind)});
    table.add("text", question.text);
    table.texts("options", question.options);
    table.text("low", question.low);
    table.text("high", question.high);
    table.add("required", question.required);
    array.emplace_back(table.take());
  }
  return array;
}

}  // namespace

TomlTable discussion_table(const GroupDiscussion& discussion) {
  GroupTable table;
  table.add("model", std::string{discussion.choice.model->name});
  auto result = table.take();
  write_parameters(discussion.choice.values, result);
  return result;
}

TomlTable group_table(const GroupOptions& group) {
  GroupTable table, consent, dropout, time, screening, completion;
  table.add("title", group.title);
  table.texts("story", group.story);
  table.text("goal", group.goal);
  table.text("consent_file", group.consent_file);
  table.text("language", group.language);
  table.add("auto_start", group.auto_start);
  table.count("size", group.size);
  if (!group.people.empty()) {
    TomlArray people;
    for (const auto seat : group.people) people.emplace_back(static_cast<std::int64_t>(seat));
    table.add("people", std::move(people));
  }
  if (group.exam) table.add("exam", true);
  table.add("ask_name", group.ask_name);
  table.texts("collect_query", group.collect_query);

  consent.add("version", group.consent_version);
  consent.texts("text", group.consent_text);
  table.add("consent", consent.take());

  dropout.add("policy", std::string{name_of(group.dropout.policy)});
  dropout.add("grace_s", group.dropout.grace_s);
  dropout.count("min_active", group.dropout.min_active);
  table.add("dropout", dropout.take());

  for (const auto& key : kGroupTimeKeys) {
    const auto limit = group.time.*key.member;
    if (key.is_always_written || limit > 0) time.add(std::string{key.name}, limit);
  }
  table.add("time", time.take());

  if (group.screens != GroupScreens{}) {
    GroupTable screens;
    for (const auto& key : kGroupScreenKeys) screens.add(std::string{key.name}, group.screens.*key.member);
    table.add("screens", screens.take());
  }
  if (group.discussion.choice.is_held()) table.add("discussion", discussion_table(group.discussion));

  screening.count("tests", group.screening.tests);
  screening.add("cut", group.screening.cut);
  screening.text("high", group.high_types);
  table.add("screening", screening.take());

  completion.add("prefix", group.completion.prefix);
  completion.text("redirect", group.completion.redirect);
  completion.add("pay_full", group.completion.pay_full);
  table.add("completion", completion.take());
  if (!group.questions.empty()) table.add("questions", questions_array(group.questions));
  return table.take();
}

}  // namespace kith
