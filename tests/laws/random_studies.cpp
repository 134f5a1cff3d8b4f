#include "random_studies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "kith/core/distributions.hpp"
#include "kith/files/document.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith::laws {
namespace {

constexpr double kMostOfAll = 30.0;  // of whole numbers, and of numbers without a limit

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

const std::string kPlain = R"(schema = "kith.study/1"
id = "plain"
seed = 1
domain = "two-goals"
[design]
strategies = ["common"]
compositions = ["N"]
[learner.N]
ability = { mean = 0.75, sd = 0.03 }
confirm_gain = { value = 0.03 }
correct_gain = { value = 0.05 }
)";

// What is said of the plain study with a key set to this.
std::string complaint(const std::string& key, const std::string& value) {
  const auto reading = parse_study(kPlain, "plain.toml", {.overrides = {key + "=" + value}});
  for (const auto& diagnostic : reading.diagnostics) {
    if (diagnostic.severity == Severity::kError) return diagnostic.message + "; " + diagnostic.hint;
  }
  return {};
}

// The number behind these words, if they are there.
bool number_behind(const std::string& text, const std::string& words, double& number) {
  const auto at = text.find(words);
  if (at == std::string::npos) return false;
  number = std::strtod(text.c_str() + at + words.size(), nullptr);
  return true;
}

StudyKey asked_about(const std::string& name, const TomlValue& value) {
  StudyKey key;
  key.name = name;
  if (value.boolean() != nullptr) {
    key.words = {"true", "false"};
  } else if (value.string() != nullptr) {
    const auto text = complaint(name, "\"?\"");
    const std::string known = "known: ";
    const auto at = text.find(known);
    if (at == std::string::npos) throw std::logic_error{name + ": no words in: " + text};
    std::istringstream in{text.substr(at + known.size())};
    for (std::string word; std::getline(in >> std::ws, word, ',');) key.words.push_back(in_quotes(word));
  } else {
    key.is_integer = value.integer() != nullptr;
    const auto text = complaint(name, key.is_integer ? "-9000000000000000000" : "-1e300");
    key.min = 0.0;
    key.max = kMostOfAll;
    if (!number_behind(text, "at least ", key.min)) key.min_is_open = number_behind(text, "greater than ", key.min);
    if (!number_behind(text, "at most ", key.max)) key.max_is_open = number_behind(text, "less than ", key.max);
    if (text.empty()) throw std::logic_error{name + " takes any number"};
  }
  return key;
}

// A whole number in [min, max], small ones as likely as large ones; every seventh is a limit.
std::int64_t whole(double min, double max, RandomStream& random) {
  const double most = std::max(min, std::min(max, min + kMostOfAll));
  const double u = uniform01(random);
  if (u < 0.1) return static_cast<std::int64_t>(min);
  if (u < 0.15) return static_cast<std::int64_t>(most);
  return static_cast<std::int64_t>(min + std::floor(std::exp(uniform01(random) * std::log(most - min + 1.0)) - 1.0));
}

// A number in its range; some are its limits, or next to them where these are out of range.
double real(double min, double max, bool min_is_open, bool max_is_open, RandomStream& random) {
  if (!std::isfinite(max)) max = min + kMostOfAll;
  const double u = uniform01(random), width = max - min;
  if (u < 0.1) return min_is_open ? min + 1e-6 * width : min;
  if (u < 0.2) return max_is_open ? max - 1e-6 * width : max;
  return min + width * (0.01 + 0.98 * uniform01(random));
}

std::string text_of(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  const std::string result{text};
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

std::string drawn(const StudyKey& key, RandomStream& random) {
  if (!key.words.empty()) return key.words[uniform_index(key.words.size(), random)];
  if (key.is_integer) return std::to_string(whole(key.min, key.max, random));
  return text_of(real(key.min, key.max, key.min_is_open, key.max_is_open, random));
}

std::string drawn(const Parameter& parameter, RandomStream& random) {
  const auto number = [&] {
    return real(parameter.min, parameter.max, parameter.min_is_open, parameter.max_is_open, random);
  };
  if (std::holds_alternative<bool>(parameter.default_value)) return uniform_index(2, random) == 1 ? "true" : "false";
  if (std::holds_alternative<std::int64_t>(parameter.default_value)) {
    return std::to_string(whole(parameter.min, parameter.max, random));
  }
  if (std::holds_alternative<std::string>(parameter.default_value)) {
    return in_quotes(std::string{parameter.words[uniform_index(parameter.words.size(), random)]});
  }
  if (std::holds_alternative<Spread>(parameter.default_value)) {
    return std::string{uniform_index(2, random) == 1 ? "{ value = " : "{ half_normal = "} + text_of(number()) + " }";
  }
  return text_of(number());
}

std::string parameters(std::span<const Parameter> declared, double share, RandomStream& random) {
  std::string text;
  for (const auto& parameter : declared) {
    auto stream = random.split(parameter.name);
    const bool is_particles = parameter.name == "particles";  // a thousand of them, if not given
    if (parameter.is_required || is_particles || uniform01(stream) < share) {
      text += std::string{parameter.name} + " = " + drawn(parameter, stream) + "\n";
    }
  }
  return text;
}

// The keys of a learner type that exists: many limits are met by nobody.
std::string random_learner(const RandomStream& random) {
  constexpr double kShare = 0.2;
  const auto models = learner_models();
  const auto head = kPlain.substr(0, kPlain.find("ability"));
  for (std::uint64_t i = 0; i < 1000; ++i) {
    auto stream = random.split(i);
    const auto& model = *models[uniform_index(models.size(), stream)];
    auto keys = "kind = " + in_quotes(std::string{model.kind}) + "\n" + parameters(model.parameters, kShare, stream);
    if (parse_study(head + keys, "learner.toml").study) return keys;
  }
  throw std::logic_error{"there is no random learner"};
}

}  // namespace

const std::vector<StudyKey>& study_keys() {
  static const std::vector<StudyKey> kKeys = [] {
    const auto reading = parse_study(kPlain, "plain.toml");
    const auto written = parse_toml(to_toml(*reading.study, *reading.domain), "written.toml");
    std::vector<StudyKey> keys;
    for (const std::string table : {"teacher", "stop", "pace", "record"}) {
      for (const auto& entry : written.document->root.find(table)->table()->entries()) {
        if (entry.value.array() == nullptr) keys.push_back(asked_about(table + "." + entry.key, entry.value));
      }
    }
    return keys;
  }();
  return kKeys;
}

std::string random_study(const std::string& domain, RandomStream random) {
  constexpr double kShare = 0.3;
  std::string text = "schema = \"kith.study/1\"\nid = \"random\"\ndomain = " + in_quotes(domain) +
                     "\nseed = " + std::to_string(1 + uniform_index(1000, random)) +
                     "\nreplicates = " + std::to_string(1 + uniform_index(2, random)) + "\n";
  const auto kinds = strategy_kinds();
  const auto& first = kinds[uniform_index(kinds.size(), random)];
  const auto& second = kinds[uniform_index(kinds.size(), random)];
  text += "[design]\nstrategies = [" + in_quotes(std::string{first.name}) +
          (second.name == first.name ? "" : ", " + in_quotes(std::string{second.name})) + "]\ncompositions = [";
  const std::vector<std::string> compositions{"N", "NP", "PPN", "P"};
  text += in_quotes(compositions[uniform_index(compositions.size(), random)]) + "]\n";
  std::string last_table;
  for (const auto& key : study_keys()) {
    auto stream = random.split(key.name);
    if (key.name != "teacher.particles" && uniform01(stream) >= kShare) continue;
    const auto dot = key.name.find('.');
    const auto table = key.name.substr(0, dot);
    if (table != last_table) text += "[" + table + "]\n";
    last_table = table;
    text += key.name.substr(dot + 1) + " = " + drawn(key, stream) + "\n";
  }
  for (const char* letter : {"N", "P"}) {
    text += std::string{"[learner."} + letter + "]\n" + random_learner(random.split(letter));
  }
  for (const auto* kind : {&first, &second}) {
    if (kind->parameters.empty() || (kind == &second && second.name == first.name)) continue;
    auto stream = random.split(kind->name);
    text += "[strategy." + std::string{kind->name} + "]\n" + parameters(kind->parameters, kShare, stream);
  }
  return text;
}

}  // namespace kith::laws
