#include "parameters.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "kith/toml/document.hpp"

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
    Meaning{"teacher.particles", "particles of each of the teacher's beliefs"},
    Meaning{"teacher.counterfactuals", "weights drawn from the belief to simulate what people expect (N)"},
    Meaning{"teacher.counterfactual_sampling",
            "how they are drawn: 'systematic' by mass, 'spread' far from each other"},
    Meaning{"teacher.assumed_ability", "ability (beta) that the teacher assumes for everybody"},
    Meaning{"teacher.likelihood", "form of the likelihood of a half-space: 'discontinuous' or 'continuous'"},
    Meaning{"teacher.process_noise", "bandwidth factor of the kernel that moves particles after resampling (eta)"},
    Meaning{"teacher.response_noise", "blur of the teacher's beliefs after test answers, in radians per axis (nu)"},
    Meaning{"teacher.resample_below",
            "beliefs are resampled when the effective sample size falls below this share of the particles"},
    Meaning{"teacher.beliefs", "rules by which beliefs about the whole team are kept"},
    Meaning{"teacher.reduce_before_update",
            "whether the common belief gets only the minimal set of the half-spaces that answers show"},
    Meaning{"teacher.learner_counterfactuals",
            "whose expectations say what a demonstration conveys to a person: the teacher's counterfactuals, or the "
            "person's own ('self')"},
    Meaning{"teacher.review", "whether every component is taught as if nothing had been taught before"},
    Meaning{"teacher.scaffold", "'features': components one after the other; 'none': the last one alone"},
    Meaning{"teacher.max_demonstrations", "demonstrations per lesson at most; 0: as many as the strategy wants"},
    Meaning{"teacher.objective", "what strategies that look ahead maximise"},
    Meaning{"teacher.hypotheses",
            "what the teacher's hypotheses about a member differ in: 'ability' or 'known-components'"},
    Meaning{"teacher.grouping", "'together': one session for the whole team; 'by-type': one for each learner type"},
    Meaning{"stop.release", "who leaves a component before the team does: 'none', 'all-right' or 'posterior'"},
    Meaning{"pace.demonstration_s", "seconds that a demonstration is assumed to take"},
    Meaning{"pace.test_s", "seconds that a test is assumed to take"},
    Meaning{"pace.feedback_s", "seconds that the feedback about a test is assumed to take"},
    Meaning{"stop.mastery", "when a component has been taught enough: 'all-right', 'fixed', 'posterior' or 'exam'"},
    Meaning{"stop.periods_per_component", "periods of every component, with mastery 'fixed'"},
    Meaning{"stop.probability",
            "with mastery 'posterior', the probability that all members answer a random test correctly"},
    Meaning{"stop.share_right",
            "with mastery 'exam', the share of a component's starts that everybody is expected to predict correctly"},
    Meaning{"stop.min_periods", "periods of a component at least, with mastery 'posterior' or 'exam'"},
    Meaning{"stop.max_periods", "periods after which a session ends at the latest"},
    Meaning{"stop.consecutive_correct", "consecutive periods in which everybody must answer all tests correctly"},
    Meaning{"stop.duplicate_sets", "different sets of tests in a period"},
    Meaning{"record.beliefs", "whether tables say how well the particles of beliefs could represent what was shown"},
    Meaning{"record.estimates", "whether tables have what the teacher can tell about people, beside the truth"},
    Meaning{"record.exam", "when simulated people are examined over all starts: 'none', 'end' or 'period'"},
    Meaning{"record.exam_questions", "questions of the exam that everybody answers at the end"},
    Meaning{"record.forecast", "imagined sessions of each cell, for forecasts"},
    Meaning{"record.level", "how much is recorded about every team"},
    Meaning{"record.proficient_ability", "ability from which a member counts as proficient in the estimates"},
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

std::string text_of(const TomlValue& value) {
  if (const auto* text = value.string()) return *text;
  const auto* array = value.array();
  if (array == nullptr) return to_toml(value);
  std::string text;
  for (const auto& one : *array) text += (text.empty() ? "" : ", ") + text_of(one);
  return text;
}

class Parameters {
 public:
  explicit Parameters(const std::vector<LearnerType>& types) : types_{types} {}

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
    const auto& names = domain.feature_names();
    std::string features, weights, prior;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      features += (k == 0 ? "" : ", ") + names[k];
      weights += (k == 0 ? "" : ", ") + shortest(domain.weights().raw[k]);
    }
    for (const auto& half_space : domain.prior()) {
      prior += prior.empty() ? "" : "; ";
      for (std::size_t k = 0; k < domain.num_features(); ++k) {
        prior += (k == 0 ? "" : " ") + std::to_string(half_space.normal()[k]);
      }
    }
    add_fact("id", domain.id(), "the domain");
    add_fact("features", features, "what the reward counts");
    add_fact("weights", weights, "the robot's reward weights, as the domain file has them");
    add_fact("prior", prior, "normals of the half-spaces that everybody is assumed to know");
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
    const auto type = std::find_if(types_.begin(), types_.end(), [&](const LearnerType& one) {
      return group == std::string{"learner."} + one.letter;
    });
    const auto meaning = meaning_of(group + "." + key, type == types_.end() ? bayesian_model() : *type->model);
    table_.add(Json::array({group, key, value, meaning.value_or("")}));
  }
  void add_fact(const std::string& key, const std::string& value, const std::string& meaning) {
    table_.add(Json::array({"domain", key, value, meaning}));
  }

  const std::vector<LearnerType>& types_;
  JsonTable table_{{"group", "key", "value", "meaning"}};
};

}  // namespace

std::optional<std::string> meaning_of(std::string_view key, const LearnerModel& model) {
  for (const auto& meaning : kMeanings) {
    if (matches(key, meaning.key)) return std::string{meaning.words};
  }
  const auto dot = key.rfind("learner.", 0) == 0 ? key.find('.', std::string_view{"learner."}.size()) : key.npos;
  return dot == key.npos ? std::nullopt : meaning_of_parameter(key.substr(dot + 1), model);
}

Json parameters_table(const RunFiles& run) {
  Parameters parameters{run.types()};
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
