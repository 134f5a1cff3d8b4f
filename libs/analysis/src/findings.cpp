#include "kith/analysis/findings.hpp"

#include "kith/files/document.hpp"
#include "kith/files/reader.hpp"

namespace kith {
namespace {

constexpr const char* kTargetsSchema = "kith.targets/1";

// Larger figures are typing errors, and what is computed of them would not be finite.
constexpr double kLargest = 1e9;
constexpr double kLargestF = 1e6;
constexpr double kLargestDf1 = 1e6;

class FindingsParser {
 public:
  FindingsParser(const TomlDocument& document, const StudySpec& spec)
      : report_{document}, root_{document.root, TomlPlace{}, "the targets file", report_}, spec_{spec} {}

  FindingsReading parse() {
    if (right_schema()) {
      for (const auto* key : {"title", "target", "parameter"}) root_.know(key);
      read_findings();
      root_.finish();
    }
    FindingsReading reading;
    reading.diagnostics = report_.diagnostics();
    if (!report_.has_errors()) reading.findings = std::move(findings_);
    return reading;
  }

 private:
  bool right_schema() {
    const auto schema = root_.string("schema", Presence::kRequired);
    if (!schema || *schema == kTargetsSchema) return true;
    report_.error("E0106", root_.value("schema", Presence::kOptional)->place(),
                  "schema '" + *schema + "' is not a targets file of this version",
                  std::string{"write schema = \""} + kTargetsSchema + "\"");
    return false;
  }

  void read_findings() {
    const auto* list = root_.array("finding", Presence::kOptional);
    if (list == nullptr) return;
    std::size_t number = 0;
    for (const auto& element : *list) {
      const auto name = "[[finding]] " + std::to_string(++number);
      const auto* table = read_table(element, name, report_);
      if (table == nullptr) continue;
      TomlReader reader{*table, element.place(), name, report_};
      read_finding(reader);
      reader.finish();
    }
  }

  static TomlPlace place_of(TomlReader& table, std::string_view key) {
    const auto* value = table.value(key, Presence::kOptional);
    return value != nullptr ? value->place() : table.place();
  }

  void read_finding(TomlReader& table) {
    PublishedFinding finding;
    if (const auto text = table.string("effect", Presence::kRequired)) {
      auto reading = parse_effect(*text, spec_);
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
    findings_.push_back(std::move(finding));
  }

  TomlReport report_;
  TomlReader root_;
  const StudySpec& spec_;
  std::vector<PublishedFinding> findings_;
};

}  // namespace

FindingsReading parse_findings(std::string_view text, const std::string& name, const StudySpec& spec) {
  const auto parsing = parse_toml(text, name);
  if (!parsing.document) return {{}, parsing.diagnostics};
  return FindingsParser{*parsing.document, spec}.parse();
}

}  // namespace kith
