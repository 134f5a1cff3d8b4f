#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "command.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/json.hpp"
#include "kith/files/document.hpp"
#include "kith/live/live_study.hpp"
#include "kith/store/session_study.hpp"
#include "kith/study/study_file.hpp"

namespace kith::cli {
namespace {

struct ValidateOptions {
  std::vector<std::string> files;  ///< "-" is standard input.
  bool strict = false;             ///< Warnings count as errors.
  bool live = false;               ///< Whether people can be taught.
};

struct Verdict {
  std::string kind;  // "domain" or "study"
  std::string id;
  std::string content;  // what it holds, for people
  std::vector<Diagnostic> diagnostics;
};

Verdict check_domain(const InputText& input, bool has_reward) {
  const DomainFiles files{.folder = input.folder, .known = input.files};
  auto reading = parse_domain(input.text, input.name, {}, files);
  if (!reading.domain && !has_reward) {
    if (auto open = parse_unweighed_domain(input.text, input.name, files); open.domain) reading = std::move(open);
  }
  Verdict verdict{"domain", "", "", reading.diagnostics};
  if (reading.domain) {
    verdict.id = reading.domain->id();
    verdict.content = fmt::format(
        "{}, {}{}", counted(reading.domain->num_mdps(), "world"), counted(reading.domain->num_starts(), "start state"),
        reading.domain->weights().raw.empty() ? "; without [reward], only for kith infer" : "");
  }
  return verdict;
}

// What keeps people from being taught, as `kith serve` finds it.
void check_for_people(const StudyReading& reading, const InputText& input, Verdict& verdict) {
  try {
    static_cast<void>(make_session_study(reading, input.folder));
  } catch (const Error& error) {
    if (!error.diagnostics().empty()) {
      verdict.diagnostics.insert(verdict.diagnostics.end(), error.diagnostics().begin(), error.diagnostics().end());
      return;
    }
    verdict.diagnostics.push_back({.id = "E1625",
                                   .message = std::string{"people cannot be taught: "} + error.what(),
                                   .file = input.name,
                                   .hint = "kith serve refuses it for the same reason"});
  }
}

Verdict check_study(const InputText& input, bool live) {
  const auto reading = parse_study(input.text, input.name, {{}, input.folder});
  Verdict verdict{"study", "", "", reading.diagnostics};
  if (reading.study) {
    verdict.id = reading.study->variants.front().id;
    verdict.content = fmt::format("{} teams in {}", team_addresses(*reading.study).size(), reading.domain->id());
    for (auto& warning : warnings_for_people(reading.study->variants.front(), input.folder)) {
      verdict.diagnostics.push_back(std::move(warning));
    }
    if (live) check_for_people(reading, input, verdict);
  }
  return verdict;
}

Verdict check(const std::string& file, bool live) {
  const auto input = read_named(file);
  const auto parsing = parse_toml(input.text, input.name);
  if (!parsing.document) return {"", "", "", parsing.diagnostics};
  const auto* schema = parsing.document->root.find("schema");
  const std::string name = schema != nullptr && schema->string() != nullptr ? *schema->string() : "";
  if (name.rfind("kith.domain/", 0) == 0) return check_domain(input, parsing.document->root.find("reward") != nullptr);
  if (name.rfind("kith.study/", 0) == 0) return check_study(input, live);
  Diagnostic unknown;
  unknown.id = "E0106";
  unknown.file = input.name;
  if (schema != nullptr) {
    unknown.line = schema->place().line;
    unknown.column = schema->place().column;
    unknown.length = schema->place().length;
    unknown.source_line = std::string{parsing.document->sources.front().line(unknown.line)};
  }
  unknown.message = schema == nullptr ? "key 'schema' is missing, so it is unknown what kind of file this is"
                                      : "this is neither a domain nor a study file";
  unknown.hint = "the first key is schema = \"kith.domain/1\" or \"kith.study/1\"";
  return {"", "", "", {unknown}};
}

void declare(OptionList& list, ValidateOptions& options) {
  list.texts("files", options.files, "FILE", "Files or built-in names to check; '-' is standard input").required();
  list.flag("--live", options.live, "Check also that people can be taught, as kith serve does");
  list.flag("--strict", options.strict, "Treat warnings as errors");
  list.json();
}

int run(const ValidateOptions& options, Console& console) {
  std::vector<Diagnostic> all;
  Json files = Json::array();
  std::string text;
  for (const auto& file : options.files) {
    auto verdict = check(file, options.live);
    Json warnings = Json::array();
    for (auto& diagnostic : verdict.diagnostics) {
      if (options.strict) diagnostic.severity = Severity::kError;
      if (diagnostic.severity == Severity::kWarning) warnings.push_back(to_json(diagnostic));
    }
    files.push_back({{"file", file}, {"kind", verdict.kind}, {"id", verdict.id}, {"warnings", warnings}});
    if (!has_errors(verdict.diagnostics)) {
      text += fmt::format("{}: {} '{}' is valid ({})\n", file, verdict.kind, verdict.id, verdict.content);
    }
    for (const auto& diagnostic : verdict.diagnostics) {  // of a domain and of a study of it, once
      if (std::find(all.begin(), all.end(), diagnostic) == all.end()) all.push_back(diagnostic);
    }
  }
  if (console.json()) {
    if (has_errors(all)) throw Error{all};
    console.print_json(Json{{"schema", "kith.validate/1"}, {"files", files}});
    return 0;
  }
  if (!console.quiet()) console.print(text);
  if (has_errors(all)) throw Error{all};
  console.show(all);
  return 0;
}

}  // namespace

void add_validate(Commands& commands) {
  commands.add<ValidateOptions>("validate", "Check domain and study files",
                                {"kith validate my-domain.toml my-study.toml",
                                 "kith validate --strict --json domains/*.toml", "kith validate --live my-study.toml"},
                                declare, run);
}

}  // namespace kith::cli
