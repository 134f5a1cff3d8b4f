#include <algorithm>
#include <cmath>
#include <set>

#include "kith/study_design/targets.hpp"
#include "kith/toml/document.hpp"
#include "kith/toml/reader.hpp"

namespace kith {
namespace {

constexpr const char* kTargetsSchema = "kith.targets/1";

// Larger figures are typing errors, and what is computed of them would not be finite.
constexpr double kLargest = 1e9;
constexpr double kLargestF = 1e6;
constexpr double kSmallestError = 1e-100;
constexpr double kLargestDf1 = 1e6;

const std::vector<std::string>& quantity_words() {
  static const std::vector<std::string> kWords{quantity_names().begin(), quantity_names().end()};
  return kWords;
}

// The number under a dotted key, if there is one.
std::optional<double> number_at(const TomlTable& root, const std::string& dotted) {
  const TomlTable* table = &root;
  std::size_t begin = 0;
  while (true) {
    const auto dot = dotted.find('.', begin);
    const auto* value = table->find(dotted.substr(begin, dot == std::string::npos ? dot : dot - begin));
    if (value == nullptr) return std::nullopt;
    if (dot == std::string::npos) {
      if (const auto* integer = value->integer()) return static_cast<double>(*integer);
      if (const auto* real = value->real()) return *real;
      return std::nullopt;
    }
    table = value->table();
    if (table == nullptr) return std::nullopt;
    begin = dot + 1;
  }
}

class TargetsParser {
 public:
  TargetsParser(const TomlDocument& document, const StudyMaker& make_study)
      : report_{document},
        root_{document.root, TomlPlace{}, "the targets file", report_},
        make_study_{make_study},
        study_{make_study({})} {
    const auto written = parse_toml(to_toml(*study_.study, *study_.domain), "study");
    if (written.document) resolved_ = written.document->root;
  }

  TargetsReading parse() {
    if (right_schema()) {
      if (const auto title = root_.string("title", Presence::kOptional)) set_.title = *title;
      each("target", [&](TomlReader& table) { read_target(table); });
      each("parameter", [&](TomlReader& table) { read_parameter(table); });
      each("finding", [&](TomlReader& table) { read_finding(table); });
      root_.finish();
    }
    TargetsReading reading;
    reading.diagnostics = report_.diagnostics();
    if (!report_.has_errors()) reading.targets = std::move(set_);
    return reading;
  }

 private:
  [[nodiscard]] const StudySpec& spec() const { return study_.study->variants.front(); }

  // Of a file of another kind only that is worth saying.
  bool right_schema() {
    const auto schema = root_.string("schema", Presence::kRequired);
    if (!schema || *schema == kTargetsSchema) return true;
    report_.error("E0106", root_.value("schema", Presence::kOptional)->place(),
                  "schema '" + *schema + "' is not a targets file of this version",
                  std::string{"write schema = \""} + kTargetsSchema + "\"");
    return false;
  }

  template <typename Read>
  void each(std::string_view key, const Read& read) {
    const auto* list = root_.array(key, Presence::kOptional);
    if (list == nullptr) return;
    std::size_t number = 0;
    for (const auto& element : *list) {
      const auto name = "[[" + std::string{key} + "]] " + std::to_string(++number);
      const auto* table = read_table(element, name, report_);
      if (table == nullptr) continue;
      TomlReader reader{*table, element.place(), name, report_};
      read(reader);
      reader.finish();
    }
  }

  static TomlPlace place_of(TomlReader& table, std::string_view key) {
    const auto* value = table.value(key, Presence::kOptional);
    return value != nullptr ? value->place() : table.place();
  }

  void read_target(TomlReader& table) {
    Target target;
    target.priority = set_.targets.size() + 1;
    if (const auto word = table.word("statistic", Presence::kOptional, {"mean", "sd", "F"}))
      target.statistic = static_cast<Statistic>(*word);
    const bool is_f = target.statistic == Statistic::kF;
    if (is_f) {
      read_term(table, target);
    } else {
      read_teams(table, target);
    }
    if (const auto value =
            table.real("value", Presence::kRequired, {is_f ? 0.0 : -kLargest, is_f ? kLargestF : kLargest}))
      target.value = *value;
    if (is_f && target.effect && target.df2 > 0.0) {
      const double non_centrality = target.value * target.df1 * (target.df2 - 2.0) / target.df2 - target.df1;
      target.standard_error = f_moments(target.df1, target.df2, std::max(0.0, non_centrality)).sd;
    }
    read_standard_error(table, target);
    read_tolerance(table, target);
    if (const auto priority = table.integer("priority", Presence::kOptional, {1, 1000}))
      target.priority = static_cast<std::size_t>(*priority);
    if (const auto source = table.string("source", Presence::kOptional)) target.source = *source;
    const auto same = [&](const Target& other) { return to_string(other) == to_string(target); };
    if (std::any_of(set_.targets.begin(), set_.targets.end(), same))
      report_.error("E0804", table.place(), "there is already a target for the " + to_string(target));
    set_.targets.push_back(std::move(target));
  }

  void read_teams(TomlReader& table, Target& target) {
    if (const auto word = table.word("quantity", Presence::kRequired, quantity_words()))
      target.quantity = static_cast<Quantity>(*word);
    if (const auto text = table.string("teams", Presence::kRequired)) {
      const auto selection = parse_selection(*text, spec());
      if (selection) {
        target.teams = *selection;
      } else {
        report_.error("E0801", place_of(table, "teams"), "the study has no teams '" + *text + "'",
                      "known: " + selections_of(spec()));
      }
    }
    for (const auto* key : {"effect", "df"}) {
      if (!table.has(key)) continue;
      (void)table.value(key, Presence::kOptional);
      report_.error("E0815", place_of(table, key), "'" + std::string{key} + "' belongs to statistic = \"F\"");
    }
  }

  // A published F: effect = "periods: composition", df = [3, 224].
  void read_term(TomlReader& table, Target& target) {
    constexpr const char* kForm = "write effect = \"periods: composition\", df = [3, 224]";
    if (const auto text = table.string("effect", Presence::kRequired)) {
      auto reading = parse_effect(*text, spec());
      if (!reading.effect) {
        report_.error("E0809", place_of(table, "effect"), reading.problem, reading.hint);
      } else if (reading.effect->kind == Effect::Kind::kContrast || reading.effect->imposed) {
        report_.error("E0815", place_of(table, "effect"), "an F belongs to a term such as strategy or composition",
                      kForm);
      } else {
        target.effect = *reading.effect;
        target.quantity = target.effect->quantity;
      }
    }
    if (const auto* df = table.array("df", Presence::kRequired)) {
      constexpr double kLeastDf2 = 5.0;  // below, the F distribution has no variance
      if (df->size() == 2) {
        const auto df1 = read_real((*df)[0], "'df'", {1.0, kLargestDf1}, report_);
        const auto df2 = read_real((*df)[1], "'df'", {kLeastDf2, kLargest}, report_);
        if (df1 && df2) {
          target.df1 = *df1;
          target.df2 = *df2;
        }
      } else {
        report_.error("E0815", place_of(table, "df"), "'df' needs two numbers", kForm);
      }
    }
  }

  // standard_error, or what it is computed from: sd and n of a mean, n of a standard deviation.
  void read_standard_error(TomlReader& table, Target& target) {
    const auto error =
        table.real("standard_error", Presence::kOptional, {.min = 0.0, .max = kLargest, .open_min = true});
    const auto sd = table.real("sd", Presence::kOptional, {.min = 0.0, .max = kLargest, .open_min = true});
    const auto n = table.integer("n", Presence::kOptional, {2, 1'000'000'000});
    const bool is_mean = target.statistic == Statistic::kMean, is_sd = target.statistic == Statistic::kSd;
    const bool derived = table.has("sd") || table.has("n");
    if (derived && (table.has("standard_error") || target.statistic == Statistic::kF || table.has("sd") != is_mean ||
                    !table.has("n"))) {
      report_.error("E0814", table.place(), table.name() + " does not say what its standard error is",
                    "write standard_error = 0.1; or sd = 1.68 and n = 240 for a mean, or n = 240 for a standard "
                    "deviation");
      return;
    }
    if (error) target.standard_error = *error;
    if (sd && n && is_mean) target.standard_error = *sd / std::sqrt(static_cast<double>(*n));
    if (n && is_sd && target.value > 0.0)
      target.standard_error = target.value / std::sqrt(2.0 * static_cast<double>(*n - 1));
    if (target.standard_error && !(*target.standard_error > kSmallestError))
      report_.error("E0814", table.place(), table.name() + " has a standard error that is too small to count with");
  }

  void read_tolerance(TomlReader& table, Target& target) {
    const auto tolerance =
        table.real("tolerance", Presence::kOptional, {.min = 0.0, .max = kLargest, .open_min = true});
    const auto factor =
        table.real("within_factor", Presence::kOptional, {.min = 1.0, .max = kLargest, .open_min = true});
    const bool both = table.has("tolerance") && table.has("within_factor");
    const bool none = !table.has("tolerance") && !table.has("within_factor");
    const bool is_f = target.statistic == Statistic::kF;  // has a standard error unless it is wrong
    if (both || (none && !target.standard_error && !is_f)) {
      report_.error("E0802", table.place(),
                    both ? table.name() + " needs either tolerance or within_factor, not both"
                         : table.name() + " needs a tolerance, within_factor or a standard error",
                    "write tolerance = 0.3 (a difference), within_factor = 1.6 (a ratio) or standard_error = 0.1");
    }
    target.is_factor = factor.has_value();
    if (none && target.standard_error) target.tolerance = 2.0 * *target.standard_error;
    if (tolerance) target.tolerance = *tolerance;
    if (factor) target.tolerance = *factor;
    if (factor && target.value <= 0.0)
      report_.error("E0803", place_of(table, "within_factor"), "only a positive value can be met within a factor");
  }

  // --- parameters --------------------------------------------------------------

  // "learner.*.x" stands for the key x of every learner type.
  [[nodiscard]] std::vector<std::string> expanded(const std::string& key) const {
    constexpr std::string_view kAll = "learner.*.";
    if (key.rfind(kAll, 0) != 0) return {key};
    std::vector<std::string> keys;
    for (const auto& type : spec().learner_types)
      keys.push_back(std::string{"learner."} + type.letter + "." + key.substr(kAll.size()));
    return keys;
  }

  void read_parameter(TomlReader& table) {
    const auto errors = report_.num_errors();
    FreeParameter parameter;
    const auto keys = table.strings("keys", Presence::kRequired);
    if (const auto name = table.string("name", Presence::kRequired)) parameter.name = *name;
    if (const auto min = table.real("min", Presence::kRequired, {-kLargest, kLargest})) parameter.min = *min;
    if (const auto max = table.real("max", Presence::kRequired, {-kLargest, kLargest})) parameter.max = *max;
    if (const auto word = table.word("scale", Presence::kOptional, {"linear", "log"}))
      parameter.logarithmic = *word == 1;
    if (const auto integer = table.boolean("integer", Presence::kOptional)) parameter.integer = *integer;
    (void)table.string("note", Presence::kOptional);
    if (report_.num_errors() > errors || !keys) return;
    if (parameter.min >= parameter.max || (parameter.logarithmic && parameter.min <= 0.0)) {
      report_.error("E0805", place_of(table, "min"), "the range of " + table.name() + " is empty",
                    "min must be less than max and, with scale = \"log\", above 0");
      return;
    }
    for (const auto& key : *keys) {
      for (auto& one : expanded(key)) parameter.keys.push_back(std::move(one));
    }
    check_keys(table, parameter);
    if (report_.num_errors() == errors) set_.parameters.push_back(std::move(parameter));
  }

  void check_keys(TomlReader& table, FreeParameter& parameter) {
    const auto place = place_of(table, "keys");
    if (parameter.keys.empty()) {
      report_.error("E0806", place, "a parameter sets at least one key of the study");
      return;
    }
    for (const auto& key : parameter.keys) {
      if (!taken_.insert(key).second) report_.error("E0807", place, "'" + key + "' is set by two parameters");
    }
    for (const double end : {parameter.min, parameter.max}) {
      const auto reading = make_study_(overrides_of({parameter}, {end}));
      for (const auto& diagnostic : reading.diagnostics) {
        if (diagnostic.severity != Severity::kError) continue;
        report_.error("E0808", place, "the study refuses this parameter: " + diagnostic.message, diagnostic.hint);
        return;
      }
    }
    const auto present = number_at(resolved_, parameter.keys.front());
    if (!present) {
      report_.error("E0808", place, "'" + parameter.keys.front() + "' is not a numeric key of the study");
      return;
    }
    parameter.present = *present;
  }

  // --- findings ----------------------------------------------------------------

  void read_finding(TomlReader& table) {
    PublishedFinding finding;
    if (const auto text = table.string("effect", Presence::kRequired)) {
      auto reading = parse_effect(*text, spec());
      if (!reading.effect) {
        report_.error("E0809", place_of(table, "effect"), reading.problem, reading.hint);
      } else {
        finding.effect = *reading.effect;
      }
    }
    if (const auto significant = table.boolean("significant", Presence::kRequired)) finding.significant = *significant;
    if (const auto alpha = table.real("alpha", Presence::kOptional, {1e-6, 1.0 - 1e-6})) finding.alpha = *alpha;
    const auto errors = report_.num_errors();
    finding.f = table.real("f", Presence::kOptional, {0.0, kLargestF});
    if (const auto* df = table.array("df", Presence::kOptional)) {
      if (df->size() == 2) {
        finding.df1 = read_real((*df)[0], "'df'", {1.0, kLargestDf1}, report_);
        finding.df2 = read_real((*df)[1], "'df'", {1.0, kLargest}, report_);
      }
    }
    if (report_.num_errors() == errors && finding.f.has_value() != (finding.df1 && finding.df2)) {
      report_.error("E0810", table.place(), "a published F needs two degrees of freedom, and they need an F",
                    "write f = 4.67 and df = [3, 224]");
    }
    if (const auto source = table.string("source", Presence::kOptional)) finding.source = *source;
    set_.findings.push_back(std::move(finding));
  }

  TomlReport report_;
  TomlReader root_;
  const StudyMaker& make_study_;
  StudyReading study_;
  TomlTable resolved_;
  TargetSet set_;
  std::set<std::string> taken_;
};

}  // namespace

TargetsReading parse_targets(std::string_view text, const std::string& name, const StudyMaker& make_study) {
  const auto parsing = parse_toml(text, name);
  if (!parsing.document) return {{}, parsing.diagnostics};
  return TargetsParser{*parsing.document, make_study}.parse();
}

}  // namespace kith
