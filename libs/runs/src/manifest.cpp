#include "manifest.hpp"

#include <sys/utsname.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "kith/files/csv_writer.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/sha256.hpp"

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

std::string manifest(const Study& study, const RunContent& content, const RunFacts& facts) {
  const auto& inputs = content.inputs;
  using Json = nlohmann::ordered_json;
  const auto& spec = study.variants.front();
  Json document{{"schema", "kith.manifest/2"},
                {"run", inputs.digest()},
                {"study", spec.id},
                {"title", spec.title},
                {"domain", facts.domain},
                {"seed", spec.seed},
                {"teams", content.teams},
                {"exit_reason", !content.shard.empty()   ? "shard"
                                : !facts.failed.empty()  ? "teams failed"
                                : !facts.missing.empty() ? "partial"
                                                         : "finished"},
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
                {"tables", content.tables}};
  for (const auto& file : inputs.files) document["inputs"][file.name] = file.sha256;
  if (!content.grown.empty()) document["grown"] = content.grown;
  if (!content.shard.empty()) document["shard"] = content.shard;
  if (!facts.failed.empty()) document["failed"] = facts.failed;
  if (!facts.missing.empty()) document["missing"] = facts.missing;
  return sealed_manifest(document.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::optional<std::string> fact_in_manifest(const std::string& manifest, const std::string& key) {
  if (!is_sealed(manifest)) return std::nullopt;
  const auto document = nlohmann::json::parse(manifest);
  const auto fact = document.find(key);
  return fact != document.end() && fact->is_string() ? std::optional{fact->get<std::string>()} : std::nullopt;
}

std::vector<std::string> growth_of(const std::string& before, const RunInputs& now, bool is_part) {
  if (!is_sealed(before)) return {};
  const auto document = nlohmann::json::parse(before);
  auto grown = document.value("grown", std::vector<std::string>{});
  if (document.value("run", "") == now.digest()) return grown;
  if (!is_part) return {};
  grown.push_back(std::to_string(document.value("teams", 0)) + " teams on " + document.value("stopped", ""));
  return grown;
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
