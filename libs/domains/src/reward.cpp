#include "reward.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kith/core/text.hpp"
#include "kith/geometry/cone.hpp"

namespace kith::detail {
namespace {

// Regions of weights exist on circles and on spheres, not for a single feature.
bool has_regions(std::size_t num_features) { return num_features >= 2 && num_features <= IntegerVector::kMaxDimension; }

class RewardReader {
 public:
  RewardReader(TomlReader& file, const Dynamics& dynamics)
      : file_{file}, report_{file.report()}, dynamics_{dynamics}, names_{dynamics.feature_names()} {}

  Reward read(RewardOf reward_of) {
    if (reward_of == RewardOf::kFile) {
      read_weights();
    } else {
      leave_open();
    }
    read_prior();
    read_words();
    return std::move(reward_);
  }

 private:
  void read_weights() {
    auto table = file_.table("reward", Presence::kRequired);
    if (!table) return;
    if (const TomlValue* weights = table->value("weights", Presence::kRequired)) {
      reward_.weights_place = weights->place();
      if (read_table(*weights, "'weights'", report_) != nullptr) take_weights(*weights);
    }
    if (table->word("normalize", Presence::kOptional, {"l2", "l1"}) == std::size_t{1}) {
      reward_.weights.norm = WeightNorm::kL1;
    }
    table->finish();
  }

  // The weights are yet to be inferred.
  void leave_open() {
    file_.know("reward");
    reward_.weights_place = dynamics_.features.empty() ? file_.place() : dynamics_.features.front().place;
  }

  void take_weights(const TomlValue& value) {
    const std::size_t errors_before = report_.num_errors();
    const auto numbers = read_numbers(*value.table(), "weight", "weights");
    for (const std::string& name : names_) {
      if (value.table()->find(name) != nullptr) continue;
      report_.error("E0311", value.place(), "feature '" + name + "' has no weight");
    }
    if (report_.num_errors() > errors_before || numbers.empty() || numbers.size() > IntegerVector::kMaxDimension)
      return;
    const auto integer = exact_direction(numbers);
    if (!integer) {
      report_.error("E0315", value.place(), "the weights need more digits than exact arithmetic takes",
                    "at a common denominator every weight must stay below 2^31: round them");
    } else if (integer->is_zero()) {
      report_.error("E0313", value.place(), "all weights are zero, so nothing matters to the robot");
    } else {
      set_weights(numbers, *integer);
    }
  }

  void set_weights(const std::vector<double>& numbers, const IntegerVector& integer) {
    reward_.weights.raw = numbers;
    reward_.weights.integer = integer;
    if (has_regions(integer.size())) reward_.weights.unit = HalfSpace{integer}.unit();
  }

  // The numbers by feature, 0 for those not given. Reports what is no finite number of a known feature.
  std::vector<double> read_numbers(const TomlTable& table, const std::string& what, const std::string& plural) {
    std::vector<double> numbers(names_.size(), 0.0);
    for (const TomlEntry& entry : table.entries()) {
      const auto feature = find_feature(entry, what);
      if (!feature) continue;
      if (!entry.value.is_number()) {
        report_.error("E0108", entry.value.place(),
                      plural + " must be numbers, not " + std::string{entry.value.kind_name()});
        continue;
      }
      const double* real = entry.value.real();
      const double number = real != nullptr ? *real : static_cast<double>(*entry.value.integer());
      // Beyond them, squares of returns and regrets would leave the range of numbers.
      constexpr double kSmallest = 1e-100, kLargest = 1e100;
      const double size = std::abs(number);
      if (number == 0.0 || (size >= kSmallest && size <= kLargest)) {
        numbers[*feature] = number;
        continue;
      }
      report_.error("E0314", entry.value.place(),
                    std::isfinite(number)
                        ? "a " + what + " must be 0, or lie between 1e-100 and 1e100 in size, which " +
                              to_toml(entry.value) + " does not"
                        : "a " + what + " must be finite, not " + to_toml(entry.value),
                    "only ratios count: multiply or divide all " + plural + " by the same number");
    }
    return numbers;
  }

  std::optional<std::size_t> find_feature(const TomlEntry& entry, const std::string& what) {
    const auto it = std::find(names_.begin(), names_.end(), entry.key);
    if (it != names_.end()) return static_cast<std::size_t>(it - names_.begin());
    if (!dynamics_.features_are_known) return std::nullopt;
    std::string hint = suggestion(entry.key, names_);
    const std::string nearest = nearest_word(entry.key, names_);
    for (const Feature& feature : dynamics_.features) {
      if (nearest.empty() || feature.name != nearest) continue;
      hint += " (declared at line " + std::to_string(feature.place.line) + ')';
    }
    report_.error("E0312", entry.place, what + " names an unknown feature '" + entry.key + "'", hint);
    return std::nullopt;
  }

  void read_prior() {
    auto table = file_.table("prior", Presence::kOptional);
    if (!table) return;
    if (const TomlArray* list = table->array("halfspaces", Presence::kRequired)) {
      for (const TomlValue& element : *list) {
        if (read_table(element, "a half-space", report_) != nullptr) read_half_space(element);
      }
      const TomlPlace place = table->content().find("halfspaces")->place();
      if (!prior_clashes_) check_prior_leaves_room(place);
    }
    table->finish();
  }

  void read_half_space(const TomlValue& value) {
    const std::size_t errors_before = report_.num_errors();
    const auto numbers = read_numbers(*value.table(), "half-space", "half-spaces");
    if (report_.num_errors() > errors_before || numbers.size() > IntegerVector::kMaxDimension) return;
    const auto normal = exact_direction(numbers);
    if (!normal) {
      report_.error("E0315", value.place(), "the half-space needs more digits than exact arithmetic takes");
    } else if (normal->is_zero()) {
      report_.error("E0331", value.place(), "a half-space of zeros says nothing", "give at least one feature a number");
    } else {
      check_half_space(value, *normal);
    }
  }

  void check_half_space(const TomlValue& value, const IntegerVector& normal) {
    const IntegerVector& weights = reward_.weights.integer;
    if (weights.size() == normal.size() && sign_of_dot(normal, weights) < 0) {
      prior_clashes_ = true;
      report_.infeasible(
          "E0332", value.place(),
          "the prior " + to_toml(value) + " contradicts the weights: " + product_text(normal) + " is negative",
          "learners would be taught something that they hold to be impossible");
    }
    if (has_regions(normal.size())) reward_.prior.emplace_back(normal);
  }

  // "(-1,0,2) . (-6,7,-2)": the clash in numbers.
  [[nodiscard]] std::string product_text(const IntegerVector& normal) const {
    return to_string(normal) + " . " + to_string(reward_.weights.integer);
  }

  void check_prior_leaves_room(const TomlPlace& place) {
    const auto clash = irreducible_conflict(reward_.prior);
    if (clash.empty()) return;
    const auto text = joined(clash, " and ", [](const HalfSpace& one) { return to_string(one.normal()); });
    report_.infeasible("E0333", place, "the prior leaves no room for weights: " + text + " clash");
  }

  void read_words() {
    for (const std::string& name : names_) reward_.words.push_back(completed({name, "", "", ""}));
    auto table = file_.table("words", Presence::kOptional);
    if (!table) return;
    for (const TomlEntry& entry : table->content().entries()) {
      const auto feature = find_feature(entry, "[words]");
      if (!feature) continue;
      if (auto wording = read_wording(entry)) reward_.words[*feature] = completed(*std::move(wording));
    }
  }

  // A text, or a table of texts. Nothing if something is wrong with it.
  std::optional<Wording> read_wording(const TomlEntry& entry) {
    const std::size_t errors_before = report_.num_errors();
    Wording wording;
    if (const TomlTable* table = entry.value.table()) {
      TomlReader reader{*table, entry.value.place(), "the words of '" + entry.key + "'", report_};
      wording.one = words(reader, "one", Presence::kRequired);
      wording.many = plural_words(reader, "many");
      wording.do_one = words(reader, "do", Presence::kOptional);
      wording.do_many = plural_words(reader, "do_many");
      if (!wording.do_many.empty() && wording.do_one.empty()) {
        report_.error("E0109", entry.value.place(), reader.name() + " have do_many, but not do");
      }
      reader.finish();
    } else if (entry.value.string() != nullptr) {
      wording.one = trimmed(entry.value);
    } else {
      report_.error("E0108", entry.value.place(),
                    "words must be a string or a table, not " + std::string{entry.value.kind_name()});
    }
    if (report_.num_errors() > errors_before) return std::nullopt;
    return wording;
  }

  std::string words(TomlReader& reader, std::string_view key, Presence presence) {
    const bool is_text = reader.string(key, presence).has_value();
    return is_text ? trimmed(*reader.content().find(key)) : "";
  }

  std::string plural_words(TomlReader& reader, std::string_view key) {
    auto text = words(reader, key, Presence::kOptional);
    if (!text.empty() && text.find("{n}") == std::string::npos) {
      report_.error("E0316", reader.content().find(key)->place(),
                    "'" + std::string{key} + "' has no {n} where the number goes", "for instance \"{n} steps\"");
    }
    return text;
  }

  // The text without blanks around it, which would stand in the middle of sentences.
  std::string trimmed(const TomlValue& value) {
    constexpr const char* kBlanks = " \t\n\r\f\v";
    const std::string& text = *value.string();
    const auto begin = text.find_first_not_of(kBlanks);
    if (begin == std::string::npos) {
      report_.error("E0317", value.place(), "these words are empty",
                    "say what people call it, for instance \"a step\", or leave the key out");
      return "";
    }
    auto result = text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
    if (result.size() < text.size()) {
      report_.warning("W0305", value.place(), "blanks before or after these words are removed",
                      "write \"" + result + "\"");
    }
    return result;
  }

  TomlReader& file_;
  TomlReport& report_;
  const Dynamics& dynamics_;
  std::vector<std::string> names_;
  Reward reward_;
  bool prior_clashes_ = false;
};

}  // namespace

Reward read_reward(TomlReader& file, const Dynamics& dynamics, RewardOf reward_of) {
  return RewardReader{file, dynamics}.read(reward_of);
}

}  // namespace kith::detail
