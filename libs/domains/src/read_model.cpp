#include "read_model.hpp"

#include <algorithm>
#include <utility>

#include "kith/domains/model_formats.hpp"

namespace kith::detail {
namespace {

class ModelReader {
 public:
  ModelReader(TomlReader& file, NamedFiles& files, ModelReport& report)
      : file_{file}, report_{file.report()}, files_{files}, model_report_{report} {}

  ModelReading read() {
    auto table = file_.table("model", Presence::kRequired);
    if (table && is_of_another_program(*table)) return std::move(reading_);
    read_mdp();
    read_features();
    if (!table) return std::move(reading_);
    const auto format = table->word("format", Presence::kRequired, {"csv"});
    if (format) read_csv(*table);
    read_drawing_of(*table);
    if (format) table->finish();
    return std::move(reading_);
  }

 private:
  [[nodiscard]] bool is_sound() const { return !report_.has_errors() && !model_report_.has_errors(); }

  // Layouts that kith read once. The rest of the file is as good as it was, so this is all that is said.
  bool is_of_another_program(const TomlReader& table) {
    const TomlValue* format = table.content().find("format");
    const std::string* name = format == nullptr ? nullptr : format->string();
    if (name == nullptr || (*name != "prism" && *name != "gym-json")) return false;
    report_.error("E0235", format->place(), "models of PRISM and Gymnasium are converted to tables first",
                  "python -m kith.convert " + report_.document().sources.front().name + " -o NEW.toml");
    for (const TomlEntry& entry : file_.content().entries()) file_.know(entry.key);
    return true;
  }

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

  bool need_features() {
    if (!reading_.dynamics.features.empty()) return true;
    report_.error("E0301", file_.place(), "a domain has 1 to 8 features, not 0",
                  "declare each feature of the model as [[feature]] with a name");
    return false;
  }

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

  void read_csv(TomlReader& table) {
    const ModelText* states = file_of(table, "states", Presence::kRequired);
    const ModelText* transitions = file_of(table, "transitions", Presence::kRequired);
    if (!need_features() || states == nullptr || transitions == nullptr || report_.has_errors()) return;
    read_csv_model(*states, *transitions, reading_.dynamics.feature_names(), reading_.model, model_report_);
  }

  TomlReader& file_;
  TomlReport& report_;
  NamedFiles& files_;
  ModelReport& model_report_;
  ModelReading reading_;
};

}  // namespace

ModelReading read_model(TomlReader& file, NamedFiles& files, ModelReport& report) {
  return ModelReader{file, files, report}.read();
}

}  // namespace kith::detail
