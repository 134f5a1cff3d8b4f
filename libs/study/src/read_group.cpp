#include "read_study_spec.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "kith/core/option_key.hpp"
#include "parameters_toml.hpp"

namespace kith {

template <>
inline constexpr std::array kWordsFor<DropoutPolicy>{
    WordFor{DropoutPolicy::kPauseThenContinue, "pause-then-continue"},
    WordFor{DropoutPolicy::kContinueNow, "continue-now"},
    WordFor{DropoutPolicy::kSimulate, "simulate"},
    WordFor{DropoutPolicy::kEndGroup, "end-group"},
};
template <>
inline constexpr std::array kWordsFor<GroupQuestion::Kind>{WordFor{GroupQuestion::Kind::kLikert, "likert"},
                                                           WordFor{GroupQuestion::Kind::kText, "text"},
                                                           WordFor{GroupQuestion::Kind::kChoice, "choice"}};

namespace {

constexpr std::int64_t kMostMembers = 30;
constexpr std::int64_t kDay = 86'400;
constexpr std::size_t kMostQuestions = 100;

// One of some words of an enumeration; none named: of all.
template <typename Enum>
std::optional<Enum> one_of(TomlReader& table, std::string_view key, Presence presence, std::vector<Enum> values = {}) {
  if (values.empty()) {
    for (const auto& known : kWordsFor<Enum>) values.push_back(known.value);
  }
  std::vector<std::string> words;
  for (const auto value : values) words.emplace_back(word_for(value));
  const auto found = table.word(key, presence, words);
  return found ? std::optional{values[static_cast<std::size_t>(*found)]} : std::nullopt;
}

template <typename Target, typename Value>
void take(Target& target, const std::optional<Value>& value) {
  if (value) target = static_cast<Target>(*value);
}

class GroupReader {
 public:
  GroupReader(TomlReader& group, TomlReport& report) : group_{group}, report_{report} {}

  GroupOptions read() {
    take(options_.title, group_.string("title", Presence::kOptional));
    take(options_.story, paragraphs(group_, "story"));
    take(options_.goal, group_.string("goal", Presence::kOptional));
    read_consent();
    take(options_.language, group_.string("language", Presence::kOptional));
    take(options_.auto_start, group_.boolean("auto_start", Presence::kOptional));
    take(options_.size, group_.integer("size", Presence::kOptional, {0, kMostMembers}));
    read_people();
    if (auto dropout = group_.table("dropout", Presence::kOptional)) read_dropout(*dropout);
    if (auto time = group_.table("time", Presence::kOptional)) read_time(*time);
    if (auto screening = group_.table("screening", Presence::kOptional)) {
      take(options_.screening.tests, screening->integer("tests", Presence::kOptional, {0, 20}));
      take(options_.screening.cut, screening->real("cut", Presence::kOptional, {0.0, 1.0, true, true}));
      take(options_.high_types, screening->string("high", Presence::kOptional));
      screening->finish();
      if (!options_.high_types.empty() && options_.screening.tests == 0) {
        report_.error("E0422", place_of_key(*screening, "high"),
                      "'high' seats people by their estimate of ability, but the screening has no tests",
                      "write tests = 6, or remove 'high'");
      }
    }
    if (auto screens = group_.table("screens", Presence::kOptional)) {
      for (const auto& key : kGroupScreenKeys) {
        take(options_.screens.*key.member, screens->boolean(key.name, Presence::kOptional));
      }
      screens->finish();
    }
    if (auto discussion = group_.table("discussion", Presence::kOptional)) read_discussion(*discussion);
    read_questions();
    if (auto completion = group_.table("completion", Presence::kOptional)) read_completion(*completion);
    take(options_.exam, group_.boolean("exam", Presence::kOptional));
    take(options_.ask_name, group_.boolean("ask_name", Presence::kOptional));
    read_query_names();
    group_.finish();
    return std::move(options_);
  }

 private:
  [[nodiscard]] TomlPlace place_of_key(TomlReader& table, std::string_view key) const {
    const auto* value = table.content().find(key);
    return value != nullptr ? value->place() : table.place();
  }

  // One string, or a list of them.
  [[nodiscard]] std::optional<std::vector<std::string>> paragraphs(TomlReader& table, std::string_view key) {
    const auto* value = table.content().find(key);
    if (value != nullptr && value->string() != nullptr) {
      table.know(key);
      return std::vector<std::string>{*value->string()};
    }
    return table.strings(key, Presence::kOptional);
  }

  void read_consent() {
    take(options_.consent_file, group_.string("consent_file", Presence::kOptional));
    const auto* value = group_.content().find("consent");
    if (value != nullptr && value->string() != nullptr) {  // as templates of earlier versions have it: a file
      group_.know("consent");
      options_.consent_file = *value->string();
      return;
    }
    auto consent = group_.table("consent", Presence::kOptional);
    if (!consent) return;
    take(options_.consent_version, consent->string("version", Presence::kOptional));
    take(options_.consent_text, paragraphs(*consent, "text"));
    consent->finish();
    if (options_.consent_version.empty()) {
      report_.error("E0422", place_of_key(*consent, "version"), "the version of the consent text is empty");
    }
    if (!options_.consent_file.empty() && !options_.consent_text.empty()) {
      report_.error("E0422", place_of_key(group_, "consent_file"),
                    "the consent text is given twice, as 'consent_file' and as 'consent.text'", "remove one of them");
    }
  }

  // "all", or the numbers of seats.
  void read_people() {
    const auto* value = group_.content().find("people");
    if (value == nullptr) return;
    group_.know("people");
    const auto* seats = value->array();
    if (seats == nullptr) {
      (void)read_word(*value, "'people'", {"all"}, report_);
      return;
    }
    for (const auto& element : *seats) {
      const auto seat = read_integer(element, "a seat in 'people'", {1, kMostMembers}, report_);
      if (!seat) continue;
      const auto number = static_cast<std::size_t>(*seat);
      if (std::find(options_.people.begin(), options_.people.end(), number) != options_.people.end()) {
        report_.error("E0403", element.place(), "seat " + std::to_string(number) + " is listed twice");
      } else {
        options_.people.push_back(number);
      }
    }
    std::sort(options_.people.begin(), options_.people.end());
    if (seats->empty()) {
      report_.error("E0401", value->place(), "'people' is empty", "write people = \"all\", or leave it out");
    }
  }

  void read_dropout(TomlReader& dropout) {
    auto& options = options_.dropout;
    const auto* policy = dropout.content().find("policy");
    if (policy != nullptr && policy->string() != nullptr && *policy->string() == "replace-from-pool") {
      report_.error("E0422", policy->place(),
                    "other people take no seats over any more ('replace-from-pool'); sessions that were recorded with "
                    "it are read by the kith that recorded them",
                    "write policy = \"simulate\" or \"pause-then-continue\", and remove 'reserves' and 'otherwise'");
      return;
    }
    take(options.policy, one_of<DropoutPolicy>(dropout, "policy", Presence::kOptional));
    take(options.grace_s, dropout.integer("grace_s", Presence::kOptional, {0, kDay}));
    take(options.min_active, dropout.integer("min_active", Presence::kOptional, {1, kMostMembers}));
    dropout.finish();
  }

  void read_time(TomlReader& time) {
    for (const auto& key : kGroupTimeKeys) {
      take(options_.time.*key.member, time.integer(key.name, Presence::kOptional, {0, key.most}));
    }
    time.finish();
  }

  void read_discussion(TomlReader& discussion) {
    std::vector<std::string> words;
    for (const auto& model : discussion_models()) words.emplace_back(model.name);
    const auto word = discussion.word("model", Presence::kRequired, words);
    if (word) {
      const auto& model = discussion_models()[static_cast<std::size_t>(*word)];
      options_.discussion.choice = {&model, read_parameters(discussion, model.parameters)};
      discussion.finish();
    }
  }

  void read_questions() {
    const auto* list = group_.array("questions", Presence::kOptional);
    if (list == nullptr) return;
    if (list->size() > kMostQuestions) {
      report_.error("E0421", place_of_key(group_, "questions"),
                    "there are more than " + std::to_string(kMostQuestions) + " questions");
      return;
    }
    std::set<std::string> ids;
    for (const auto& element : *list) {
      const auto* content = read_table(element, "an element of 'questions'", report_);
      if (content == nullptr) continue;
      TomlReader table{*content, element.place(), "[[group.questions]]", report_};
      auto question = read_question(table);
      if (!question) continue;
      if (!ids.insert(question->id).second) {
        report_.error("E0403", element.place(), "question '" + question->id + "' is listed twice");
      }
      options_.questions.push_back(*std::move(question));
    }
  }

  [[nodiscard]] std::optional<GroupQuestion> read_question(TomlReader& table) {
    const auto errors = report_.num_errors();
    GroupQuestion question;
    take(question.id, table.string("id", Presence::kRequired));
    take(question.kind, one_of<GroupQuestion::Kind>(table, "kind", Presence::kRequired));
    take(question.text, table.string("text", Presence::kRequired));
    take(question.options, table.strings("options", Presence::kOptional));
    take(question.low, table.string("low", Presence::kOptional));
    take(question.high, table.string("high", Presence::kOptional));
    take(question.required, table.boolean("required", Presence::kOptional));
    table.finish();
    if (report_.num_errors() > errors) return std::nullopt;
    const bool is_name =
        !question.id.empty() && question.id.size() <= 40 &&
        std::all_of(question.id.begin(), question.id.end(), [](char c) {
          return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
        });
    if (!is_name) {
      report_.error("E0421", place_of_key(table, "id"), "'" + question.id + "' cannot be the id of a question",
                    "use at most 40 letters, digits, '_' and '-'");
    }
    if (question.kind == GroupQuestion::Kind::kChoice && question.options.size() < 2) {
      report_.error("E0421", table.place(), "question '" + question.id + "' offers no choice",
                    "list at least two options");
    }
    if (question.kind == GroupQuestion::Kind::kText && !question.options.empty()) {
      report_.error("E0421", place_of_key(table, "options"),
                    "question '" + question.id + "' is answered in words and has no options",
                    "write kind = \"choice\", or remove the options");
    }
    return question;
  }

  void read_completion(TomlReader& completion) {
    auto& options = options_.completion;
    take(options.prefix, completion.string("prefix", Presence::kOptional));
    take(options.redirect, completion.string("redirect", Presence::kOptional));
    take(options.pay_full, completion.boolean("pay_full", Presence::kOptional));
    completion.finish();
    const auto begins = [&](std::string_view start) { return options.redirect.rfind(start, 0) == 0; };
    if (!options.redirect.empty() && !begins("https://") && !begins("http://")) {
      report_.error("E0422", place_of_key(completion, "redirect"), "'redirect' is not a link to a web page",
                    "begin it with https://");
    }
  }

  void read_query_names() {
    auto names = group_.strings("collect_query", Presence::kOptional);
    if (!names) return;
    for (const auto& name : *names) {
      const bool is_name = !name.empty() && name.size() <= 60 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
      });
      if (is_name && name != "code") continue;
      report_.error("E0422", place_of_key(group_, "collect_query"),
                    "'" + name + "' cannot be the name of a query parameter",
                    "use at most 60 letters, digits, '_' and '-'; 'code' is the completion code");
    }
    options_.collect_query = *std::move(names);
  }

  TomlReader& group_;
  TomlReport& report_;
  GroupOptions options_;
};

}  // namespace

std::string_view name_of(DropoutPolicy policy) noexcept { return word_for(policy); }

std::string_view name_of(GroupQuestion::Kind kind) noexcept { return word_for(kind); }

GroupOptions read_group(TomlReader& group, TomlReport& report) { return GroupReader{group, report}.read(); }

}  // namespace kith
