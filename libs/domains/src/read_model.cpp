#include "read_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kith/models/model_formats.hpp"

namespace kith::detail {
namespace {

const std::vector<std::string>& formats() {
  static const std::vector<std::string> kFormats{"csv", "prism", "gym-json"};
  return kFormats;
}

// "reward -0.5"
std::string reward_name(double reward) { return "reward " + to_toml(TomlValue{reward}); }

class ModelReader {
 public:
  ModelReader(TomlReader& file, NamedFiles& files, ModelReport& report)
      : file_{file}, report_{file.report()}, files_{files}, model_report_{report} {}

  ModelReading read() {
    read_mdp();
    read_features();
    auto table = file_.table("model", Presence::kRequired);
    if (!table) return std::move(reading_);
    reading_.place = table->place();
    const auto format = table->word("format", Presence::kRequired, formats());
    if (format == std::size_t{0}) read_csv(*table);
    if (format == std::size_t{1}) read_prism(*table);
    if (format == std::size_t{2}) read_gym(*table);
    if (format && is_sound() && !reading_.weights) refuse_rewards();
    read_drawing_of(*table);
    if (format) table->finish();
    return std::move(reading_);
  }

 private:
  [[nodiscard]] bool is_sound() const { return !report_.has_errors() && !model_report_.has_errors(); }

  // Once the variables of states are known.
  void read_drawing_of(TomlReader& table) {
    if (!table.has("drawing")) return;
    file_.know("map");
    auto drawing = table.table("drawing", Presence::kOptional);
    if (drawing && is_sound()) reading_.drawing = read_drawing(file_, *drawing, reading_.model, files_, model_report_);
  }

  // --- [mdp] and [[feature]] ---

  void read_mdp() {
    auto mdp = file_.table("mdp", Presence::kOptional);
    if (!mdp) return;
    Dynamics& dynamics = reading_.dynamics;
    dynamics.discount = read_discount(*mdp);
    dynamics.max_steps =
        static_cast<std::size_t>(mdp->integer("max_steps", Presence::kOptional, {1, 1'000'000}).value_or(1000));
    if (const TomlArray* actions = mdp->array("actions", Presence::kOptional)) {
      for (const TomlValue& element : *actions) {
        const auto name = read_string(element, "an action", report_);
        if (!name) continue;
        if (reading_.model.actions.find(*name)) {
          report_.error("E0222", element.place(), "action '" + *name + "' is listed twice");
        }
        (void)reading_.model.actions.number_of(*name);
      }
      reading_.model.actions_are_declared = true;
    }
    mdp->finish();
  }

  void read_features() {
    const TomlArray* list = file_.array("feature", Presence::kOptional);
    if (list == nullptr) return;
    for (const TomlValue& element : *list) {
      if (read_table(element, "a feature", report_) != nullptr) read_feature(element);
    }
    if (list->size() > IntegerVector::kMaxDimension) {
      report_.error("E0301", list->back().place(), "a domain has 1 to 8 features, not " + std::to_string(list->size()));
    }
  }

  void read_feature(const TomlValue& element) {
    TomlReader reader{*element.table(), element.place(), "[[feature]]", report_};
    Feature feature;
    feature.place = element.place();
    feature.name = reader.string("name", Presence::kRequired).value_or("");
    if (const TomlValue* name = element.table()->find("name")) feature.place = name->place();
    check_feature_name(reader);
    rewards_.push_back(reader.real("reward", Presence::kOptional, {}));
    reader.finish();
    static const std::vector<std::string> kColumns{"mdp", "state", "action", "next", "probability"};
    if (std::find(kColumns.begin(), kColumns.end(), feature.name) != kColumns.end()) {
      report_.error("E0231", feature.place, "a feature of an explicit model cannot be called '" + feature.name + "'",
                    "tables of transitions have a column of that name");
    }
    for (const Feature& other : reading_.dynamics.features) {
      if (other.name != feature.name) continue;
      report_.error("E0302", feature.place, "feature '" + feature.name + "' is declared twice",
                    "the first one is at line " + std::to_string(other.place.line));
    }
    reading_.dynamics.features.push_back(std::move(feature));
  }

  // Where the model has vectors, weights say what features are worth.
  void refuse_rewards() {
    for (std::size_t k = 0; k < rewards_.size(); ++k) {
      if (!rewards_[k]) continue;
      report_.error(
          "E0264", reading_.dynamics.features[k].place,
          "feature '" + reading_.dynamics.features[k].name + "' has a reward, but the model has vectors of features",
          "write it as a weight under [reward]");
    }
  }

  // Formats that have names or vectors for features need them declared.
  bool need_features() {
    if (!reading_.dynamics.features.empty()) return true;
    report_.error("E0301", file_.place(), "a domain has 1 to 8 features, not 0",
                  "declare each feature of the model as [[feature]] with a name");
    return false;
  }

  // --- files ---

  // The text of a file of the model; nothing after reporting why not.
  const ModelText* open(const std::optional<std::string>& name, const TomlPlace& place) {
    if (!name) return nullptr;
    const ModelText* text = files_.open(*name, place, model_files());
    if (text != nullptr) reading_.model.last_file = text;
    return text;
  }

  const ModelText* file_of(TomlReader& table, const char* key, Presence presence) {
    const auto name = table.string(key, presence);
    const TomlValue* value = table.content().find(key);
    return value == nullptr ? nullptr : open(name, value->place());
  }

  // --- formats ---

  void read_csv(TomlReader& table) {
    const ModelText* states = file_of(table, "states", Presence::kRequired);
    const ModelText* transitions = file_of(table, "transitions", Presence::kRequired);
    if (!need_features() || states == nullptr || transitions == nullptr || report_.has_errors()) return;
    read_csv_model(*states, *transitions, reading_.dynamics.feature_names(), reading_.model, model_report_);
  }

  // visit(reader, name) for each [[model.mdp]], whose names must differ.
  template <typename Visit>
  void for_each_mdp(TomlReader& table, const Visit& visit) {
    if (!table.has("mdp")) return report_missing_mdp(table);
    const TomlArray* list = table.array("mdp", Presence::kRequired);
    if (list == nullptr) return;
    if (list->size() > kMaxModelMdps || list->empty()) {
      report_.error("E0231", table.content().find("mdp")->place(),
                    "a model has 1 to " + std::to_string(kMaxModelMdps) + " MDPs");
      return;
    }
    std::map<std::string, std::size_t> lines;
    for (const TomlValue& element : *list) {
      if (read_table(element, "an MDP", report_) == nullptr) continue;
      TomlReader reader{*element.table(), element.place(), "[[model.mdp]]", report_};
      const auto name = reader.string("name", list->size() > 1 ? Presence::kRequired : Presence::kOptional);
      const auto [at, is_new] = lines.try_emplace(name.value_or(""), element.place().line);
      if (name && !is_new) {
        report_.error("E0231", reader.content().find("name")->place(), "MDP '" + *name + "' is given twice",
                      "the first one is at line " + std::to_string(at->second));
      }
      visit(reader, name.value_or(""));
      reader.finish();
    }
  }

  // The files of these layouts are often written under [model] itself.
  void report_missing_mdp(TomlReader& table) {
    const bool is_gym = table.content().find("format")->string()->starts_with("gym");
    std::string file = is_gym ? "file = \"model.json\"" : "transitions = \"model.tra\"";
    for (const char* key : {"name", "file", "initial", "transitions", "states", "labels", "rewards"}) {
      if (!table.has(key)) continue;
      const TomlValue& value = *table.content().find(key);
      if (std::string_view{key} == (is_gym ? "file" : "transitions")) file = std::string{key} + " = " + to_toml(value);
    }
    report_.error("E0109", table.place(), "key 'mdp' is missing in [model]: each MDP needs a table of its own",
                  "write [[model.mdp]] below [model], and in it " + file);
  }

  void read_prism(TomlReader& table) {
    const auto terminal = table.string("terminal", Presence::kOptional);
    const auto start = table.string("start", Presence::kOptional);
    (void)need_features();
    std::vector<PrismFiles> all;
    for_each_mdp(table, [&](TomlReader& reader, const std::string& name) {
      PrismFiles files;
      files.mdp = name;
      files.terminal = terminal.value_or("");
      files.start = start.value_or("");
      files.transitions = file_of(reader, "transitions", Presence::kRequired);
      files.states = file_of(reader, "states", Presence::kOptional);
      const bool needs_labels = terminal || start;
      files.labels = file_of(reader, "labels", needs_labels ? Presence::kRequired : Presence::kOptional);
      files.rewards.resize(reading_.dynamics.features.size());
      if (auto rewards = reader.table("rewards", Presence::kRequired)) read_rewards(*rewards, files);
      all.push_back(std::move(files));
    });
    if (report_.has_errors()) return;
    for (const PrismFiles& files : all) read_prism_mdp(files, reading_.model, model_report_);
  }

  // rewards = { FEATURE = "FILE" or ["FILE", ...] }
  void read_rewards(TomlReader& table, PrismFiles& files) {
    const std::vector<std::string> names = reading_.dynamics.feature_names();
    for (const TomlEntry& entry : table.content().entries()) {
      const auto at = std::find(names.begin(), names.end(), entry.key);
      if (at == names.end()) {
        report_.error("E0253", entry.place, "there is no feature '" + entry.key + "'", suggestion(entry.key, names));
        continue;
      }
      const TomlArray single{entry.value};
      const TomlArray* list = entry.value.array() != nullptr ? entry.value.array() : &single;
      for (const TomlValue& one : *list) {
        const ModelText* text = open(read_string(one, "a file", report_), one.place());
        if (text != nullptr) files.rewards[static_cast<std::size_t>(at - names.begin())].push_back(text);
      }
    }
    for (const std::string& name : names) {
      if (table.content().find(name) != nullptr) continue;
      report_.error("E0253", table.place(), "feature '" + name + "' has no rewards",
                    "name its .srew or .trew file, or an empty list if it never occurs");
    }
  }

  void read_gym(TomlReader& table) {
    struct File {
      const ModelText* text = nullptr;
      std::string name;
      std::optional<std::uint32_t> initial;
    };
    std::vector<File> all;
    for_each_mdp(table, [&](TomlReader& reader, const std::string& name) {
      File one{file_of(reader, "file", Presence::kRequired), name, std::nullopt};
      const auto initial = reader.integer("initial", Presence::kOptional, {0, 1'000'000'000});
      if (initial) one.initial = static_cast<std::uint32_t>(*initial);
      all.push_back(std::move(one));
    });
    if (report_.has_errors()) return;
    std::optional<GymRewards> kind;
    for (const auto& [text, name, initial] : all) {
      const auto now =
          read_gym_mdp(*text, name, initial, reading_.dynamics.feature_names(), reading_.model, model_report_);
      if (!now) return;
      if (kind && now != kind) {
        model_report_.error("E0235", {text}, "these rewards are not of the same kind as those of the first file",
                            "write vectors in all of them, or numbers");
        return;
      }
      kind = now;
    }
    if (kind == GymRewards::kNumbers) {
      make_features_of_rewards();
    } else {
      (void)need_features();
    }
  }

  // Every distinct reward other than 0 becomes a feature that is 1 where it is given: its weight is the reward. What
  // is never a choice does not count.
  void make_features_of_rewards() {
    RawModel& model = reading_.model;
    std::map<double, std::size_t> feature_of;
    std::vector<double> values;
    for (const RawMdp& mdp : model.mdps) {
      for (const RawTransition& one : mdp.transitions) {
        const double reward = model.features.row(one.features).front();
        const bool can_be_chosen = one.next != one.state || one.probability < 1.0;
        if (reward != 0.0 && can_be_chosen && feature_of.try_emplace(reward, values.size()).second) {
          values.push_back(reward);
        }
      }
    }

    if (!declare_features(values, feature_of)) return;
    FeatureRows rows;
    for (RawMdp& mdp : model.mdps) {
      for (RawTransition& one : mdp.transitions) {
        std::vector<double> row(values.size(), 0.0);
        const auto at = feature_of.find(model.features.row(one.features).front());
        if (at != feature_of.end()) row[at->second] = 1.0;
        one.features = rows.number_of(row);
      }
    }
    model.features = std::move(rows);
    reading_.weights = values;
  }

  // The features are those that the domain file declares with their reward, or, without any, named after it.
  bool declare_features(std::vector<double>& values, std::map<double, std::size_t>& feature_of) {
    if (values.empty() || values.size() > IntegerVector::kMaxDimension) {
      report_.error(
          "E0261", reading_.place,
          "the model has " + std::to_string(values.size()) +
              " different rewards other than 0; each is a feature, of which there are 1 to 8",
          values.empty() ? "give at least one transition a reward" : "write feature vectors in place of rewards");
      return false;
    }

    auto& features = reading_.dynamics.features;
    if (features.empty()) {
      std::sort(values.begin(), values.end());
      for (std::size_t k = 0; k < values.size(); ++k) {
        Feature feature;
        feature.name = reward_name(values[k]);
        feature.place = reading_.place;
        features.push_back(std::move(feature));
        feature_of[values[k]] = k;
      }
      return true;
    }

    std::vector<double> declared;
    for (std::size_t k = 0; k < features.size(); ++k) {
      const double reward = rewards_[k].value_or(0.0);
      const auto at = feature_of.find(reward);
      if (at != feature_of.end() && rewards_[k]) {
        at->second = k;
        declared.push_back(reward);
        continue;
      }
      report_.error("E0262", features[k].place,
                    rewards_[k]
                        ? "no transition has the reward of feature '" + features[k].name + "'"
                        : "feature '" + features[k].name + "' needs a reward: the model has numbers, not vectors",
                    "the rewards of the model are " + list_of(values));
      return false;
    }

    for (const double value : values) {
      if (std::find(declared.begin(), declared.end(), value) != declared.end()) continue;
      report_.error("E0262", features.back().place, "no feature stands for " + reward_name(value),
                    "declare one: name = \"...\", reward = " + to_toml(TomlValue{value}));
      return false;
    }
    values = declared;
    return true;
  }

  static std::string list_of(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ", ") + to_toml(TomlValue{value});
    return text;
  }

  TomlReader& file_;
  TomlReport& report_;
  NamedFiles& files_;
  ModelReport& model_report_;
  ModelReading reading_;
  std::vector<std::optional<double>> rewards_;  // per feature, where the file says one
};

}  // namespace

ModelReading read_model(TomlReader& file, NamedFiles& files, ModelReport& report) {
  return ModelReader{file, files, report}.read();
}

}  // namespace kith::detail
