#include "manifest.hpp"

#include <sys/utsname.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "kith/files/sha256.hpp"
#include "kith/table/csv_writer.hpp"

namespace kith {
namespace {

std::string system_name() {
  utsname names = {};
  if (uname(&names) != 0) return "unknown";
  return std::string{names.sysname} + " " + names.release + " " + names.machine;
}

}  // namespace

std::string processor_name() {
  std::ifstream file{"/proc/cpuinfo"};
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string manifest(const Study& study, std::size_t num_teams, const RunInputs& inputs,
                     const std::map<std::string, std::string>& tables, const RunFacts& facts) {
  using Json = nlohmann::ordered_json;
  const auto& spec = study.variants.front();
  Json document{{"schema", "kith.manifest/1"},
                {"study", spec.id},
                {"title", spec.title},
                {"domain", facts.domain},
                {"seed", spec.seed},
                {"teams", num_teams},
                {"exit_reason", facts.failed.empty() ? "finished" : "teams failed"},
                {"started", facts.started},
                {"stopped", facts.stopped},
                {"command_line", facts.command_line},
                {"threads", facts.threads},
                {"ranks", facts.ranks},
                {"version", facts.version},
                {"git", facts.git},
                {"dirty", facts.dirty},
                {"compiler", facts.compiler},
                {"build_type", facts.build_type},
                {"flags", facts.flags},
                {"processor", processor_name()},
                {"system", system_name()},
                {"inputs", {{"study.toml", sha256(inputs.study)}, {"domain.toml", sha256(inputs.domain)}}},
                {"tables", tables}};
  for (const auto& file : inputs.files) document["inputs"][file.name] = file.sha256;
  if (!facts.failed.empty()) document["failed"] = facts.failed;
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string timings_table(const RunFacts& facts) {
  std::string text;
  CsvWriter writer{{{"phase", ColumnType::kText, "What was done.", "", true},
                    {"seconds", ColumnType::kReal, "How long it took.", "s", true}},
                   [&](std::string_view piece) { text += piece; }};
  for (const auto& [phase, seconds] : facts.timings) {
    writer.text(std::string_view{phase}).real(seconds);
    writer.end_row();
  }
  writer.flush();
  return text;
}

}  // namespace kith
