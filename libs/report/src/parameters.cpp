#include "parameters.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "kith/core/text.hpp"
#include "kith/files/document.hpp"
#include "kith/study/study_keys.hpp"

namespace kith::detail {
namespace {

struct Meaning {
  std::string_view key;  // "*" stands for one word; at the end, for all that follow
  std::string_view words;
};

constexpr std::array kMeanings{
    Meaning{"study.schema", "kind and version of the study file"},
    Meaning{"study.id", "short name of the study"},
    Meaning{"study.title", "title of the study"},
    Meaning{"study.domain", "what the robot does: a built-in domain, or the file with it"},
    Meaning{"study.seed", "the only source of randomness"},
    Meaning{"study.replicates", "teams per cell (strategy and composition)"},
    Meaning{"design.strategies", "whose belief the lessons of a team are chosen for"},
    Meaning{"design.compositions", "the members of a team, one letter of a learner type each"},
    Meaning{"design.pairing",
            "'replicate': the same simulated people under every strategy (common random numbers); 'none': other people "
            "in every cell"},
    Meaning{"design.vary.*", "settings of this key that are compared with each other"},
    Meaning{"learner.*.label", "what people of this type are called"},
    Meaning{"learner.*.kind", "learner model: how people of this type learn and answer"},
    Meaning{"learner.*.prior", "half-spaces that people of this type know from the start"},
    Meaning{"learner.*.knowing.robot", "the robot before an update, which people of this type know"},
    Meaning{"learner.*.knowing.halfspaces", "half-spaces that hold for its weights"},
};

// Whether the key is one that the pattern stands for.
bool matches(std::string_view key, std::string_view pattern) {
  while (true) {
    const auto word = pattern.substr(0, pattern.find('.'));
    if (word == "*" && word.size() == pattern.size()) return !key.empty();
    const auto own = key.substr(0, key.find('.'));
    if (word != "*" && word != own) return false;
    const bool last = word.size() == pattern.size();
    if (last || own.size() == key.size()) return last && own.size() == key.size();
    pattern.remove_prefix(word.size() + 1);
    key.remove_prefix(own.size() + 1);
  }
}

// "ability.mean", or "confirm_gain.half_normal" of the parameter confirm_gain.
std::optional<std::string> meaning_of_parameter(std::string_view key, const LearnerModel& model) {
  for (const auto& parameter : model.parameters) {
    const std::string name{parameter.name};
    const std::string words{parameter.description};
    const bool is_spread = std::holds_alternative<Spread>(parameter.default_value);
    if (!is_spread && key == name) return words;
    if (is_spread && key == name + ".half_normal") return words + ": scale of a half-normal distribution";
    if (is_spread && key == name + ".value") return words + ": equal for all";
  }
  return std::nullopt;
}

// "stop.probability" of the parameter probability.
std::optional<std::string> meaning_in(std::span<const Parameter> keys, std::string_view table, std::string_view key) {
  for (const auto& one : keys) {
    if (std::string{table}.append(".").append(one.name) == key) return std::string{one.description};
  }
  return std::nullopt;
}

std::string text_of(const TomlValue& value) {
  if (const auto* text = value.string()) return *text;
  const auto* array = value.array();
  return array == nullptr ? to_toml(value) : joined(*array, ", ", text_of);
}

class Parameters {
 public:
  explicit Parameters(const StudySpec& spec) : spec_{spec} {}

  // @param domain  what the study called its domain before it was frozen; may be empty.
  void add_study(const TomlTable& root, const std::string& domain) {
    for (const auto& entry : root.entries()) {
      if (entry.value.table() != nullptr) continue;
      add("study", entry.key, entry.key == "domain" && !domain.empty() ? domain : text_of(entry.value));
    }
    for (const auto& entry : root.entries()) {
      const auto* table = entry.value.table();
      if (table == nullptr) continue;
      if (entry.key != "learner") {
        add_table(entry.key, "", *table);
        continue;
      }
      for (const auto& type : table->entries()) add_table("learner." + type.key, "", *type.value.table());
    }
  }

  void add_domain(const Domain& domain) {
    const auto normal = [](const HalfSpace& half_space) {
      return joined(half_space.normal(), " ", [](std::int64_t entry) { return std::to_string(entry); });
    };
    add_fact("id", domain.id(), "the domain");
    add_fact("features", joined(domain.feature_names()), "what the reward counts");
    add_fact("weights", joined(domain.weights().raw, ", ", shortest),
             "the robot's reward weights, as the domain file has them");
    add_fact("prior", joined(domain.prior(), "; ", normal),
             "normals of the half-spaces that everybody is assumed to know");
    add_fact("mdps", std::to_string(domain.num_mdps()), "worlds: combinations of what is optional in the domain");
    add_fact("starts", std::to_string(domain.num_starts()), "start states of all worlds: candidate demonstrations");
  }

  [[nodiscard]] Json take() && { return std::move(table_).take(); }

 private:
  void add_table(const std::string& group, const std::string& prefix, const TomlTable& table) {
    for (const auto& entry : table.entries()) {
      if (const auto* inner = entry.value.table()) {
        add_table(group, prefix + entry.key + ".", *inner);
      } else {
        add(group, prefix + entry.key, text_of(entry.value));
      }
    }
  }
  void add(const std::string& group, const std::string& key, const std::string& value) {
    const auto& types = spec_.learner_types;
    const auto type = std::find_if(types.begin(), types.end(), [&](const LearnerType& one) {
      return group == std::string{"learner."} + one.letter;
    });
    const auto& model = type == types.end() ? bayesian_model() : *type->model;
    const auto meaning = meaning_of(group + "." + key, model, spec_.teaching);
    table_.add(Json::array({group, key, value, meaning.value_or("")}));
  }
  void add_fact(const std::string& key, const std::string& value, const std::string& meaning) {
    table_.add(Json::array({"domain", key, value, meaning}));
  }

  const StudySpec& spec_;
  JsonTable table_{{"group", "key", "value", "meaning"}};
};

}  // namespace

std::optional<std::string> meaning_of(std::string_view key, const LearnerModel& model,
                                      const TeachingOptions& teaching) {
  for (const auto& meaning : kMeanings) {
    if (matches(key, meaning.key)) return std::string{meaning.words};
  }
  const auto table = key.substr(0, key.find('.'));
  if (auto meaning = meaning_in(study_keys(table), table, key)) return meaning;
  for (const auto* rule : {&teaching.mastery, teaching.release ? &*teaching.release : nullptr}) {
    if (rule == nullptr) continue;
    if (auto meaning = meaning_in(rule->kind.parameters, "stop", key)) return meaning;
  }
  const auto dot = key.rfind("learner.", 0) == 0 ? key.find('.', std::string_view{"learner."}.size()) : key.npos;
  return dot == key.npos ? std::nullopt : meaning_of_parameter(key.substr(dot + 1), model);
}

Json parameters_table(const RunFiles& run) {
  Parameters parameters{run.spec()};
  parameters.add_study(parse_toml(run.study_toml, "study.toml").document.value().root, manifest_text(run, "domain"));
  parameters.add_domain(run.domain);
  return std::move(parameters).take();
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace kith::detail
