#include "dynamics.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace kith::detail {
namespace {

constexpr std::array kMoves{Action::kUp, Action::kDown, Action::kLeft, Action::kRight};

// Reads the parts of a file that say what the robot can do and what counts.
class DynamicsReader {
 public:
  DynamicsReader(TomlReader& file, const FamilyMap& family_map)
      : file_{file}, report_{file.report()}, family_map_{family_map} {}

  Dynamics read() {
    read_mdp();
    ConditionReader conditions{{family_map_, dynamics_.actions}, report_};
    read_features(conditions);
    read_rules(conditions);
    dynamics_.atoms = conditions.atoms();
    return std::move(dynamics_);
  }

 private:
  void read_mdp() {
    auto mdp = file_.table("mdp", Presence::kOptional);
    if (!mdp) return default_actions();
    dynamics_.discount = read_discount(*mdp);
    dynamics_.max_steps =
        static_cast<std::size_t>(mdp->integer("max_steps", Presence::kOptional, {1, 1'000'000}).value_or(1000));
    if (const TomlArray* actions = mdp->array("actions", Presence::kOptional)) {
      read_actions(*mdp->value("actions", Presence::kOptional), *actions);
    } else {
      default_actions();
    }
    mdp->finish();
  }

  void default_actions() {
    dynamics_.actions.assign(kMoves.begin(), kMoves.end());
    if (family_map_.items.empty()) return;
    dynamics_.actions.push_back(Action::kPickup);
    dynamics_.actions.push_back(Action::kDropoff);
  }

  void read_actions(const TomlValue& value, const TomlArray& list) {
    for (const TomlValue& element : list) {
      const auto index = read_word(element, "an action", all_action_names(), report_);
      if (!index) continue;
      const auto action = static_cast<Action>(*index);
      if (std::find(dynamics_.actions.begin(), dynamics_.actions.end(), action) != dynamics_.actions.end()) {
        report_.error("E0222", element.place(), "action '" + *element.string() + "' is listed twice");
      } else if ((action == Action::kPickup || action == Action::kDropoff) && family_map_.items.empty() &&
                 family_map_.absent.empty() && family_map_.legend_is_sound) {
        report_.error("E0222", element.place(), "there is no item for '" + *element.string() + "'");
      } else {
        dynamics_.actions.push_back(action);
      }
    }
    std::sort(dynamics_.actions.begin(), dynamics_.actions.end());
    const bool moves =
        std::any_of(dynamics_.actions.begin(), dynamics_.actions.end(), [](Action a) { return a <= Action::kRight; });
    if (!moves) {
      report_.error("E0222", value.place(), "the robot has no action to move with",
                    "list all actions, for instance [\"up\", \"down\", \"left\", \"right\", \"exit\"]");
    }
  }

  void read_features(ConditionReader& conditions) {
    const TomlArray* list = file_.array("feature", Presence::kRequired);
    dynamics_.features_are_known = list != nullptr && !list->empty();
    if (list == nullptr) return;
    for (const TomlValue& element : *list) {
      if (read_table(element, "a feature", report_) != nullptr) {
        read_feature(element, conditions);
      } else {
        dynamics_.features_are_known = false;
      }
    }
    if (list->empty() || list->size() > IntegerVector::kMaxDimension) {
      const TomlPlace place = list->empty() ? file_.content().find("feature")->place() : list->back().place();
      report_.error("E0301", place, "a domain has 1 to 8 features, not " + std::to_string(list->size()));
    }
  }

  void read_feature(const TomlValue& element, ConditionReader& conditions) {
    TomlReader reader{*element.table(), element.place(), "[[feature]]", report_};
    Feature feature;
    feature.place = element.place();
    feature.name = reader.string("name", Presence::kRequired).value_or("");
    if (const TomlValue* name = element.table()->find("name")) feature.place = name->place();
    if (const TomlValue* when = reader.value("when", Presence::kRequired)) {
      if (auto condition = conditions.read(*when)) feature.when = *std::move(condition);
    }
    feature.exclusive = reader.string("exclusive", Presence::kOptional).value_or("");
    if (const auto name = reader.string("times", Presence::kOptional)) feature.times = raster_named(reader, *name);
    reader.finish();
    check_feature_name(reader);
    if (feature.name.empty()) dynamics_.features_are_known = false;
    const auto same = std::find_if(dynamics_.features.begin(), dynamics_.features.end(),
                                   [&](const Feature& other) { return other.name == feature.name; });
    if (!feature.name.empty() && same != dynamics_.features.end()) {
      report_.error("E0302", feature.place, "feature '" + feature.name + "' is declared twice",
                    "the first one is at line " + std::to_string(same->place.line));
      dynamics_.features_are_known = false;
      return;
    }
    dynamics_.features.push_back(std::move(feature));
  }

  std::optional<std::size_t> raster_named(const TomlReader& feature, const std::string& name) {
    std::vector<std::string> names;
    for (const Raster& raster : family_map_.rasters) names.push_back(raster.name);
    const auto at = std::find(names.begin(), names.end(), name);
    if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
    if (!family_map_.is_sound) return std::nullopt;  // the raster may be one that could not be read
    report_.error("E0216", feature.content().find("times")->place(), "there is no raster '" + name + "'",
                  names.empty() ? "declare it: [[map.raster]] with name = \"" + name + "\"" : suggestion(name, names));
    return std::nullopt;
  }

  void read_rules(ConditionReader& conditions) {
    const TomlArray* list = file_.array("rule", Presence::kOptional);
    if (list == nullptr) return;
    for (const TomlValue& element : *list) {
      if (read_table(element, "a rule", report_) == nullptr) continue;
      TomlReader reader{*element.table(), element.place(), "[[rule]]", report_};
      const TomlValue* when = reader.value("when", Presence::kRequired);
      const auto forbid = reader.boolean("forbid", Presence::kRequired);
      reader.finish();
      if (forbid == false) {
        report_.error("E0220", element.table()->find("forbid")->place(), "a rule that forbids nothing has no effect",
                      "write forbid = true, or delete the rule");
      }
      if (when == nullptr) continue;
      if (auto condition = conditions.read(*when)) dynamics_.forbidden.push_back(*std::move(condition));
    }
  }

  TomlReader& file_;
  TomlReport& report_;
  const FamilyMap& family_map_;
  Dynamics dynamics_;
};

}  // namespace

double read_discount(TomlReader& mdp) {
  const double discount = mdp.real("discount", Presence::kOptional, {0.0, 1.0, true, false}).value_or(1.0);
  if (discount <= kLargestDiscount || discount == 1.0) return discount;
  const TomlValue& value = *mdp.content().find("discount");
  mdp.report().error(
      "E0110", value.place(),
      "'discount' must be 1 or at most " + to_toml(TomlValue{kLargestDiscount}) + ", not " + to_toml(value),
      "write discount = 1; arithmetic cannot tell a larger discount from 1");
  return 1.0;
}

void check_feature_name(const TomlReader& feature) {
  const TomlValue* value = feature.content().find("name");
  const std::string* name = value == nullptr ? nullptr : value->string();
  if (name == nullptr) return;  // said already
  constexpr std::string_view kBlanks = " \t\n\r\f\v";
  const auto is_blank = [&](char c) { return kBlanks.find(c) != std::string_view::npos; };
  if (!name->empty() && !is_blank(name->front()) && !is_blank(name->back())) return;
  feature.report().error("E0225", value->place(), "'" + *name + "' cannot be the name of a feature",
                         "a name is not empty, and has no blanks before or after it");
}

std::vector<std::string> Dynamics::feature_names() const {
  std::vector<std::string> names;
  for (const Feature& feature : features) names.push_back(feature.name);
  return names;
}

Dynamics read_dynamics(TomlReader& file, const FamilyMap& family_map) {
  return DynamicsReader{file, family_map}.read();
}

FeatureTable::FeatureTable(const Dynamics& dynamics) : dynamics_{dynamics} {
  const auto counts_raster = [](const Feature& feature) { return feature.times.has_value(); };
  if (std::none_of(dynamics.features.begin(), dynamics.features.end(), counts_raster)) (void)counts_of({});
}

std::uint32_t FeatureTable::row_of(AtomMask mask, std::uint32_t counts) {
  const auto [it, is_new] = numbers_[counts].try_emplace(mask, static_cast<std::uint32_t>(rows_.size()));
  if (is_new) rows_.push_back(evaluate(mask, counts_[counts]));
  return it->second;
}

std::uint32_t FeatureTable::counts_of(const std::vector<std::uint16_t>& values) {
  const auto [it, is_new] = counts_numbers_.try_emplace(values, static_cast<std::uint32_t>(counts_.size()));
  if (is_new) {
    counts_.push_back(values);
    numbers_.emplace_back();
  }
  return it->second;
}

FeatureTable::Row FeatureTable::evaluate(AtomMask mask, const std::vector<std::uint16_t>& values) const {
  Row row;
  row.forbidden = std::any_of(dynamics_.forbidden.begin(), dynamics_.forbidden.end(),
                              [&](const Condition& condition) { return condition.holds(mask); });
  std::vector<std::string> fired;  // exclusive groups that have fired
  std::size_t num_counted = 0;
  for (const Feature& feature : dynamics_.features) {
    const bool blocked = std::find(fired.begin(), fired.end(), feature.exclusive) != fired.end();
    const bool fires = !blocked && feature.when.holds(mask);
    if (fires && !feature.exclusive.empty()) fired.push_back(feature.exclusive);
    const double count = feature.times ? static_cast<double>(values[num_counted++]) : 1.0;
    row.features.push_back(fires ? count : 0.0);
  }
  return row;
}

}  // namespace kith::detail
