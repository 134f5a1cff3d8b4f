// kith's own layout of explicit models as one JSON document.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "json_tree.hpp"
#include "model_formats.hpp"

namespace kith::detail {
namespace {

using Kind = JsonTree::Kind;
using Value = JsonTree::Value;

constexpr std::string_view kSchema = "kith.model/1";

class JsonModelReader {
 public:
  JsonModelReader(const ModelText& file, const std::vector<std::string>& features, RawModel& model, ModelReport& report)
      : file_{file}, features_{features}, model_{model}, report_{report} {}

  void read() {
    const auto tree = JsonTree::parse(file_, report_);
    if (!tree) return;
    const Value root = tree->root();
    if (!check_keys(root, {"schema", "features", "variables", "mdps"})) return;
    const auto schema = member(root, "schema", Kind::kString);
    if (schema && schema->string() != kSchema) {
      report_.error("E0235", schema->place(), "'" + schema->string() + "' is not a model of this version",
                    "write \"schema\": \"" + std::string{kSchema} + "\"");
    }
    const auto features = member(root, "features", Kind::kList);
    if (features) read_feature_order(*features);
    if (const auto variables = root.find("variables"); variables && is(*variables, "variables", Kind::kList)) {
      variables->for_each_element([&](const Value& one) {
        if (is(one, "a variable", Kind::kString)) model_.variables.push_back(one.string());
      });
      if (model_.variables.size() > kMaxVariables) {
        report_.error("E0257", variables->place(),
                      "states have more than " + std::to_string(kMaxVariables) + " variables", "leave some out");
      }
    }
    const auto mdps = member(root, "mdps", Kind::kList);
    if (report_.has_errors() || !mdps) return;
    mdps->for_each_element([&](const Value& one) { read_mdp(one); });
  }

 private:
  // --- typed access, reporting what is wrong ---

  bool is(const Value& value, const std::string& what, Kind kind) {
    if (value.is(kind)) return true;
    static constexpr std::string_view kNames[] = {"null",     "true or false", "a number",
                                                  "a string", "a list",        "an object"};
    report_.error("E0235", value.place(),
                  what + " must be " + std::string{kNames[static_cast<std::size_t>(kind)]} + ", not " +
                      std::string{value.kind_name()},
                  "see docs/explicit-models.md for the layout");
    return false;
  }

  std::optional<Value> member(const Value& object, const std::string& key, Kind kind) {
    const auto found = object.find(key);
    if (found) return is(*found, "\"" + key + "\"", kind) ? found : std::nullopt;
    report_.error("E0235", object.place(), "key \"" + key + "\" is missing",
                  "see docs/explicit-models.md for the layout");
    return std::nullopt;
  }

  bool check_keys(const Value& object, std::initializer_list<const char*> known) {
    if (!is(object, "this", Kind::kObject)) return false;
    const std::size_t before = report_.num_errors();
    object.for_each_member([&](const Value& key, const Value&) {
      for (const std::string_view one : known) {
        if (one == key.string()) return;
      }
      report_.error("E0235", key.place(), "unknown key \"" + key.string() + "\"",
                    name_hint(key.string(), {known.begin(), known.end()}));
    });
    return report_.num_errors() == before;
  }

  // --- content ---

  // Which feature of the domain each number of a vector is.
  void read_feature_order(const Value& list) {
    list.for_each_element([&](const Value& one) {
      if (!is(one, "the name of a feature", Kind::kString)) return;
      const auto at = std::find(features_.begin(), features_.end(), one.string());
      if (at == features_.end()) {
        report_.error("E0253", one.place(), "the domain file has no feature '" + one.string() + "'",
                      name_hint(one.string(), features_));
      }
      order_.push_back(static_cast<std::size_t>(at - features_.begin()));
    });
    for (std::size_t k = 0; k < features_.size(); ++k) {
      if (std::count(order_.begin(), order_.end(), k) == 1) continue;
      report_.error("E0253", list.place(),
                    "feature '" + features_[k] + "' of the domain file must be listed exactly once",
                    "list the features in the order in which \"features\" of transitions has them");
    }
  }

  void read_mdp(const Value& value) {
    if (report_.is_full() || !check_keys(value, {"name", "states", "transitions"})) return;
    if (model_.mdps.size() == kMaxModelMdps) {
      return report_.error("E0257", value.place(), "there are more than " + std::to_string(kMaxModelMdps) + " MDPs",
                           "split the model into several domains");
    }
    RawMdp mdp;
    mdp.file = &file_;
    mdp.place = value.place();
    if (const auto name = value.find("name"); name && is(*name, "\"name\"", Kind::kString)) mdp.name = name->string();
    if (!mdp_names_.insert(mdp.name).second) {
      report_.error("E0241", value.place(), "MDP '" + mdp.name + "' is given twice", "give every MDP its own \"name\"");
    }
    keys_.clear();
    const auto states = member(value, "states", Kind::kList);
    const auto transitions = member(value, "transitions", Kind::kList);
    if (!states || !transitions) return;
    const std::size_t before = report_.num_errors();
    states->for_each_element([&](const Value& one) { read_state(one, mdp); });
    if (report_.num_errors() == before) {
      transitions->for_each_element([&](const Value& one) {
        if (!report_.is_full() && has_room(model_, one.place(), report_)) read_transition(one, mdp);
      });
    }
    model_.mdps.push_back(std::move(mdp));
  }

  bool flag(const Value& object, const char* key) {
    const auto found = object.find(key);
    return found && is(*found, std::string{"\""} + key + "\"", Kind::kBoolean) && found->boolean();
  }

  void read_state(const Value& value, RawMdp& mdp) {
    if (report_.is_full() || !check_keys(value, {"state", "name", "terminal", "start", "initial", "variables"})) {
      return;
    }
    const auto key = member(value, "state", Kind::kString);
    if (!key) return;
    RawState state;
    state.key = key->string();
    state.place = key->place();
    if (const auto name = value.find("name"); name && is(*name, "\"name\"", Kind::kString)) state.name = name->string();
    state.terminal = flag(value, "terminal");
    state.start = flag(value, "start");
    state.initial = flag(value, "initial");
    if (!keys_.try_emplace(state.key, static_cast<std::uint32_t>(mdp.states.size())).second) {
      return report_.error("E0241", state.place, "state '" + state.key + "' is given twice",
                           "list a state only once per MDP");
    }
    mdp.states.push_back(std::move(state));
    if (!model_.variables.empty()) read_variables(value, mdp);
  }

  void read_variables(const Value& state, RawMdp& mdp) {
    const auto list = member(state, "variables", Kind::kList);
    if (!list) return;
    if (list->size() != model_.variables.size()) {
      return report_.error("E0250", list->place(),
                           "the state has " + std::to_string(list->size()) + " variables, not " +
                               std::to_string(model_.variables.size()),
                           "one number for each name in \"variables\" at the top");
    }
    list->for_each_element([&](const Value& one) {
      if (!is(one, "a variable of a state", Kind::kNumber)) return;
      const double number = one.number();
      if (number != std::floor(number) || std::abs(number) >= 2147483648.0) {
        return report_.error("E0249", one.place(), "a variable of a state must be an integer below 2^31 in size",
                             "write real quantities in smaller units");
      }
      mdp.variables.push_back(static_cast<std::int32_t>(number));
    });
  }

  std::optional<std::uint32_t> state_number(const Value& transition, const char* key) {
    const auto name = member(transition, key, Kind::kString);
    if (!name) return std::nullopt;
    const auto at = keys_.find(name->string());
    if (at != keys_.end()) return at->second;
    std::vector<std::string> known;
    for (const auto& [one, number] : keys_) known.push_back(one);
    std::sort(known.begin(), known.end());
    report_.error("E0240", name->place(), "there is no state '" + name->string() + "' in this MDP",
                  name_hint(name->string(), known));
    return std::nullopt;
  }

  void read_transition(const Value& value, RawMdp& mdp) {
    if (!check_keys(value, {"state", "action", "next", "probability", "features"})) return;
    RawTransition transition;
    const auto state = state_number(value, "state");
    const auto name = member(value, "action", Kind::kString);
    const auto action = name ? action_number(model_, name->string(), name->place(), report_) : std::nullopt;
    const auto next = state_number(value, "next");
    const auto features = member(value, "features", Kind::kList);
    const auto probability = value.find("probability");
    if (probability && !is(*probability, "\"probability\"", Kind::kNumber)) return;
    if (!state || !action || !next || !features) return;
    const auto row = feature_row(*features);
    if (!row) return;
    transition.state = *state;
    transition.action = *action;
    transition.next = *next;
    transition.features = *row;
    transition.probability = probability ? probability->number() : 1.0;
    transition.at = static_cast<std::uint32_t>(value.place().offset);
    transition.probability_at =
        static_cast<std::uint32_t>(probability ? probability->place().offset : value.place().offset);
    model_.add(mdp, transition);
  }

  std::optional<std::uint32_t> feature_row(const Value& list) {
    if (list.size() != features_.size()) {
      report_.error("E0250", list.place(),
                    "there are " + std::to_string(list.size()) + " features, not " + std::to_string(features_.size()),
                    "one number for each name in \"features\" at the top");
      return std::nullopt;
    }
    std::vector<double> row(features_.size(), 0.0);
    std::size_t position = 0;
    bool sound = true;
    list.for_each_element([&](const Value& one) {
      sound =
          sound && is(one, "a feature", Kind::kNumber) && check_finite(one.number(), "a feature", one.place(), report_);
      row[order_[position++]] = sound ? one.number() : 0.0;
    });
    return sound ? std::optional{model_.features.number_of(row)} : std::nullopt;
  }

  const ModelText& file_;
  const std::vector<std::string>& features_;
  RawModel& model_;
  ModelReport& report_;
  std::vector<std::size_t> order_;
  std::unordered_set<std::string> mdp_names_;
  std::unordered_map<std::string, std::uint32_t> keys_;  // of states of the MDP at hand
};

}  // namespace

void read_json_model(const ModelText& file, const std::vector<std::string>& features, RawModel& model,
                     ModelReport& report) {
  JsonModelReader{file, features, model, report}.read();
}

}  // namespace kith::detail
