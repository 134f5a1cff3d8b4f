#include "kith/study/study_file.hpp"

#include <algorithm>
#include <system_error>

#include "kith/bec/memory_needs.hpp"
#include "kith/core/error.hpp"
#include "kith/files/document.hpp"
#include "kith/files/file.hpp"
#include "read_study_spec.hpp"

namespace kith {
namespace {

constexpr std::size_t kMaxVariants = 10'000;
constexpr std::size_t kMaxCells = 1'000'000;

// One varied key: its dotted name, and the values it takes.
struct Factor {
  std::string key;
  const TomlArray* values = nullptr;
};

class StudyParser {
 public:
  StudyParser(TomlDocument document, const StudyReadOptions& options)
      : document_{std::move(document)}, options_{options}, report_{document_} {}

  StudyReading parse() {
    read_domain_of_study();
    read_older_robots();
    const auto base = read_study_spec(document_, domain(), options_.kinds, report_);
    const auto factors = read_factors();
    if (!report_.has_errors()) check_size(base, factors);
    if (!report_.has_errors()) expand(base, factors);
    const auto own = report_.diagnostics();
    reading_.diagnostics.insert(reading_.diagnostics.begin(), own.begin(), own.end());
    if (has_errors(reading_.diagnostics)) reading_.study.reset();
    return std::move(reading_);
  }

 private:
  [[nodiscard]] const Domain* domain() const { return reading_.domain ? &*reading_.domain : nullptr; }

  void read_domain_of_study() {
    const auto* value = document_.root.find("domain");
    if (value == nullptr || value->string() == nullptr) return;  // reported by read_study_spec
    auto text = text_of_domain(*value);
    if (!text) return;
    auto parsed = parse_domain(text->text, text->name, {}, text->files);
    reading_.domain = std::move(parsed.domain);
    reading_.domain_text = std::move(text->text);
    reading_.domain_files = std::move(parsed.files);
    reading_.diagnostics = std::move(parsed.diagnostics);
  }

  struct DomainText {
    std::string text, name;
    DomainFiles files;
  };
  // Of the domain that is named; nothing after reporting that there is none.
  [[nodiscard]] std::optional<DomainText> text_of_domain(const TomlValue& value) {
    const auto& name = *value.string();
    const auto& known = built_in_domains();
    const auto built_in = std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name; });
    if (built_in != known.end()) return DomainText{std::string{built_in->text}, name, {.known = built_in->files}};
    const auto path = value.place().source == 0 ? options_.folder / name : std::filesystem::path{name};
    // What is wrong with a domain is shown with its lines, and whoever runs a study need not have written it: only
    // files that are meant to be read so are opened, so that none can be made to show others.
    std::error_code failure;
    const bool may_be_domain = path.extension() == ".toml" && std::filesystem::is_regular_file(path, failure);
    if (auto text = may_be_domain ? read_toml_text(path) : std::nullopt) {
      return DomainText{*std::move(text), path.string(), {.folder = path.parent_path()}};
    }
    std::vector<std::string> names;
    for (const auto& kind : known) names.emplace_back(kind.name);
    report_.error("E0116", value.place(),
                  "there is no domain '" + name + "': neither built in nor a file that ends in .toml and can be read",
                  suggestion(name, names));
    return std::nullopt;
  }

  // Where a learner type names the robot before an update, what people know of it stands in place of the name, so that
  // a study needs no other file once it was read.
  void read_older_robots() {
    const auto* learners = document_.root.find("learner");
    if (learners == nullptr || learners->table() == nullptr || !reading_.domain) return;
    for (const auto& type : learners->table()->entries()) {
      const auto* value = type.value.table() != nullptr ? type.value.table()->find("knowing") : nullptr;
      if (value == nullptr || value->string() == nullptr) continue;
      if (const auto older = older_robot_called(*value)) {
        const TomlValue known{knowing_table(*older, *reading_.domain), value->place()};
        set(document_.root, {"learner", type.key, "knowing"}, known);
      }
    }
  }

  [[nodiscard]] std::optional<OlderRobot> older_robot_called(const TomlValue& value) {
    const auto text = text_of_domain(value);
    if (!text) return std::nullopt;
    auto parsed = parse_domain(text->text, text->name, {}, text->files);
    if (!parsed.domain) {
      reading_.diagnostics.insert(reading_.diagnostics.end(), parsed.diagnostics.begin(), parsed.diagnostics.end());
      return std::nullopt;
    }
    auto why = why_incomparable(*parsed.domain, *reading_.domain);
    try {
      if (why.empty()) {
        require_teaching_memory(*parsed.domain);
        return older_robot(Atlas{*std::move(parsed.domain)});
      }
    } catch (const Error& error) {
      why = "what people know of '" + *value.string() + "' cannot be told: " + error.what();
    }
    report_.error("E0425", value.place(), why, "name a domain file with the same features in the same order");
    return std::nullopt;
  }

  // --- varied keys -----------------------------------------------------------

  [[nodiscard]] std::vector<Factor> read_factors() {
    std::vector<Factor> factors;
    const auto* design = document_.root.find("design");
    const auto* vary = design != nullptr && design->table() != nullptr ? design->table()->find("vary") : nullptr;
    const auto* table = vary != nullptr ? read_table(*vary, "'vary'", report_) : nullptr;
    if (table == nullptr) return factors;
    std::size_t variants = 1;
    for (const auto& entry : table->entries()) {
      if (!may_vary(entry)) continue;
      const auto* values = entry.value.array();
      if (values == nullptr || values->empty()) {
        report_.error("E0413", entry.value.place(), "'" + entry.key + "' needs a list of values",
                      "write for instance vary = { \"teacher.process_noise\" = [0.1, 0.5] }");
        continue;
      }
      if (values->size() <= kMaxVariants) check_distinct(*values);  // else there are too many anyway
      warn_of_override(entry);
      factors.push_back({entry.key, values});
      variants *= std::min(values->size(), kMaxVariants + 1);
      if (variants > kMaxVariants) {
        report_.error("E0414", entry.place,
                      "more than " + std::to_string(kMaxVariants) + " combinations of varied keys");
        variants = 1;
      }
    }
    return factors;
  }

  void check_distinct(const TomlArray& values) {
    for (auto value = values.begin(); value != values.end(); ++value) {
      if (std::find(values.begin(), value, *value) != value) {
        report_.error("E0403", value->place(), to_toml(*value) + " is listed twice");
      }
    }
  }

  // What makes up the design itself, or only names things, does not vary within it.
  [[nodiscard]] bool may_vary(const TomlEntry& entry) {
    const auto begins = [&](std::string_view start) { return entry.key.rfind(start, 0) == 0; };
    const bool is_fixed = entry.key.ends_with(".label") || (begins("learner.") && entry.key.ends_with(".knowing"));
    if ((begins("learner.") || begins("teacher.") || begins("stop.")) && !is_fixed) return true;
    report_.error("E0412", entry.place, "'" + entry.key + "' cannot vary within a study",
                  "keys of [learner.X], [teacher] and [stop] can, written with dots and in quotes");
    return false;
  }

  void warn_of_override(const TomlEntry& entry) {
    const TomlTable* table = &document_.root;
    const TomlValue* value = nullptr;
    for (const auto& key : split(entry.key)) {
      value = table != nullptr ? table->find(key) : nullptr;
      table = value != nullptr ? value->table() : nullptr;
    }
    if (value != nullptr && value->place().source != 0) {
      report_.warning("W0403", value->place(), "'" + entry.key + "' varies in this study, so setting it has no effect");
    }
  }

  [[nodiscard]] static std::vector<std::string> split(const std::string& dotted) {
    std::vector<std::string> keys{""};
    for (const char c : dotted) {
      if (c == '.') {
        keys.emplace_back();
      } else {
        keys.back() += c;
      }
    }
    return keys;
  }

  // Before anything is made of the product: a short file can ask for more than there is room for.
  void check_size(const StudySpec& base, const std::vector<Factor>& factors) {
    std::size_t variants = 1;
    for (const auto& factor : factors) variants *= factor.values->size();
    const auto cells = variants * base.strategies.size() * base.compositions.size();
    const auto teams = cells * base.replicates;  // below 10^14
    if (cells <= kMaxCells && teams <= kMaxTeams) return;
    const auto product = "variants " + std::to_string(variants) + " x strategies " +
                         std::to_string(base.strategies.size()) + " x compositions " +
                         std::to_string(base.compositions.size());
    if (cells > kMaxCells) {
      report_.error("E0416", place_of_size(factors),
                    "the design has " + std::to_string(cells) + " cells (" + product + "); at most " +
                        std::to_string(kMaxCells) + " are planned",
                    "vary fewer keys at a time, or split the study into several");
    } else {
      report_.error("E0415", place_of_size(factors),
                    "the study has " + std::to_string(teams) + " teams (" + product + " x replicates " +
                        std::to_string(base.replicates) + "); at most " + std::to_string(kMaxTeams) + " are numbered",
                    "use fewer replicates, vary fewer keys, or split the study into several with different seeds");
    }
  }

  // What makes a design large: the varied keys, else the replicates, else the compositions.
  [[nodiscard]] TomlPlace place_of_size(const std::vector<Factor>& factors) const {
    const auto* design = document_.root.find("design")->table();
    if (!factors.empty()) return design->find("vary")->place();
    if (const auto* replicates = document_.root.find("replicates")) return replicates->place();
    return design->find("compositions")->place();
  }

  // Every combination, the first factor slowest.
  void expand(const StudySpec& base, const std::vector<Factor>& factors) {
    Study study;
    if (factors.empty()) study.variants.push_back(base);
    std::vector<std::size_t> position(factors.size(), 0);
    for (bool more = !factors.empty(); more;) {
      study.variants.push_back(variant(factors, position));
      std::size_t i = factors.size();
      while (i > 0 && ++position[i - 1] == factors[i - 1].values->size()) position[--i] = 0;
      more = i > 0;
    }
    reading_.study = std::move(study);
  }

  [[nodiscard]] StudySpec variant(const std::vector<Factor>& factors, const std::vector<std::size_t>& position) {
    auto document = document_;
    std::vector<FactorSetting> settings;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      const auto& value = (*factors[i].values)[position[i]];
      settings.push_back({factors[i].key, value.string() != nullptr ? *value.string() : to_toml(value)});
      set(document.root, split(factors[i].key), value);
    }
    TomlReport report{document};
    auto spec = read_study_spec(document, domain(), options_.kinds, report);
    spec.factors = std::move(settings);
    for (auto& diagnostic : report.diagnostics()) {
      auto& all = reading_.diagnostics;
      const bool error = diagnostic.severity == Severity::kError;  // warnings were given for the base
      const auto errors = static_cast<std::size_t>(std::count_if(
          all.begin(), all.end(), [](const Diagnostic& one) { return one.severity == Severity::kError; }));
      if (error && errors < TomlReport::kMaxErrors && std::find(all.begin(), all.end(), diagnostic) == all.end()) {
        all.push_back(std::move(diagnostic));
      }
    }
    return spec;
  }

  static void set(TomlTable& root, const std::vector<std::string>& keys, const TomlValue& value) {
    TomlTable* table = &root;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
      if (table->find(keys[i]) == nullptr)
        table->append({keys[i], value.place(), TomlValue{TomlTable{}, value.place()}});
      table = table->find(keys[i])->table();
      if (table == nullptr) return;  // the reader of the base has said what is wrong
    }
    table->set({keys.back(), value.place(), value});
  }

  TomlDocument document_;
  const StudyReadOptions& options_;
  TomlReport report_;
  StudyReading reading_;
};

}  // namespace

namespace {

// Of a file of another kind only that is worth saying.
std::optional<Diagnostic> other_kind(const TomlDocument& document) {
  const auto* schema = document.root.find("schema");
  if (schema == nullptr || schema->string() == nullptr || *schema->string() == kStudySchema) return std::nullopt;
  TomlReport report{document};
  const auto& name = *schema->string();
  const bool is_domain = name.rfind("kith.domain/", 0) == 0;
  const auto hint = is_domain ? "name a study; its key 'domain' names this file"
                              : std::string{"write schema = \""} + kStudySchema + "\"";
  report.error(
      "E0106", schema->place(),
      is_domain ? "this is a domain file, not a study" : "schema '" + name + "' is not a study file of this version",
      hint);
  return report.diagnostics().front();
}

}  // namespace

StudyReading parse_study(std::string_view text, const std::string& name, const StudyReadOptions& options) {
  auto parsing = parse_toml(text, name);
  if (!parsing.document) {
    StudyReading reading;
    reading.diagnostics = std::move(parsing.diagnostics);
    return reading;
  }
  if (auto other = other_kind(*parsing.document)) {
    StudyReading reading;
    reading.diagnostics.push_back(*std::move(other));
    return reading;
  }
  std::vector<Diagnostic> diagnostics;
  for (const auto& text_of_override : options.overrides) {
    auto override = parse_assignment(text_of_override, options.override_name);
    if (override.assignment) override.diagnostics = assign(*parsing.document, *override.assignment);
    diagnostics.insert(diagnostics.end(), override.diagnostics.begin(), override.diagnostics.end());
  }
  auto reading = StudyParser{*std::move(parsing.document), options}.parse();
  reading.diagnostics.insert(reading.diagnostics.end(), diagnostics.begin(), diagnostics.end());
  if (has_errors(reading.diagnostics)) reading.study.reset();
  return reading;
}

StudyReading load_study(const std::string& name_or_path, StudyReadOptions options) {
  const auto& known = built_in_studies();
  const auto built_in =
      std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name_or_path; });
  if (built_in != known.end()) return parse_study(built_in->text, name_or_path, options);

  const std::filesystem::path path{name_or_path};
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    std::vector<std::string> names;
    for (const auto& kind : known) names.emplace_back(kind.name);
    Diagnostic unknown;
    unknown.id = "E0116";
    unknown.file = name_or_path;
    unknown.message = "there is no built-in study and no file of this name";
    unknown.hint = suggestion(name_or_path, names);
    throw Error{{unknown}};
  }
  const auto text = read_toml_text(path);
  if (!text) throw Error{ErrorKind::kIo, "cannot read the study file '" + name_or_path + "': " + why_unreadable(path)};
  options.folder = path.parent_path();
  return parse_study(*text, name_or_path, options);
}

}  // namespace kith
