// What kith bench prints and saves for programs.
#include <nlohmann/json.hpp>

#include "bench_report.hpp"
#include "kith_build_info.hpp"
#include "machine.hpp"

namespace kith::cli {
namespace {

const char* name_of(bench::Clock clock) { return clock == bench::Clock::kCpu ? "cpu" : "wall"; }

Json figure_json(const bench::Figure& figure) {
  return {{"median", figure.median}, {"low", figure.low}, {"high", figure.high}, {"samples", figure.samples}};
}

Json rival_json(const bench::CaseResult& one) {
  const auto rival = one.rival();
  if (!rival) return nullptr;
  Json document{{"what", one.which->rival}};
  document.update(figure_json(*rival));
  document["ratio"] = *one.ratio();
  document["agrees"] = one.disagreement ? Json(one.disagreement->empty()) : Json{};
  return document;
}

Json baseline_json(const BenchOutcome& outcome, const bench::CaseResult& one) {
  const auto* before = baseline_of(outcome, one);
  if (before == nullptr) return nullptr;
  return {{"median", before->median},
          {"ratio", one.figure().median / before->median},
          {"slower", is_slower(one.figure(), *before, outcome.tolerance)}};
}

Json case_json(const BenchOutcome& outcome, const bench::CaseResult& one) {
  Json document{
      {"name", one.which->name}, {"what", one.which->what}, {"unit", "s"}, {"clock", name_of(one.which->clock)}};
  document.update(figure_json(one.figure()));
  document["rounds"] = one.timings.work.rounds;
  document["cpu"] = one.timings.work.cpu.median;
  document["wall"] = one.timings.work.wall.median;
  document["rival"] = rival_json(one);
  document["baseline"] = baseline_json(outcome, one);
  return document;
}

Json growth_json(const bench::GrowthResult& growth) {
  Json points = Json::array();
  for (std::size_t i = 0; i < growth.figures.size(); ++i) {
    Json point{{"size", growth.which->points[i].size}};
    point.update(figure_json(growth.figures[i]));
    points.push_back(std::move(point));
  }
  return {{"name", growth.which->name},  {"what", growth.which->what}, {"size", growth.which->size}, {"unit", "s"},
          {"exponent", growth.exponent}, {"points", std::move(points)}};
}

}  // namespace

const bench::Figure* baseline_of(const BenchOutcome& outcome, const bench::CaseResult& one) {
  if (outcome.baseline == nullptr) return nullptr;
  const auto found = outcome.baseline->cases.find(one.which->name);
  return found == outcome.baseline->cases.end() ? nullptr : &found->second;
}

std::vector<std::string> slower_cases(const BenchOutcome& outcome) {
  std::vector<std::string> names;
  for (const auto& one : outcome.result.cases) {
    const auto* before = baseline_of(outcome, one);
    if (before != nullptr && is_slower(one.figure(), *before, outcome.tolerance)) names.push_back(one.which->name);
  }
  return names;
}

Json bench_document(const BenchOutcome& outcome) {
  using namespace build_info;  // NOLINT(google-build-using-namespace): constants only
  Json document{{"schema", kBenchSchema},
                {"version", kVersion},
                {"git", kGitId},
                {"dirty", kGitDirty},
                {"compiler", kCompiler},
                {"build_type", kBuildType},
                {"flags", kFlags},
                {"processor", processor_name()},
                {"cores", usable_cores()},
                {"threads", outcome.threads},
                {"quick", outcome.quick},
                {"load", {{"before", outcome.load_before}, {"after", outcome.load_after}}},
                {"waited", bench::waited(outcome.result)},
                {"peak_memory_mib", peak_memory_mib()},
                {"tolerance", outcome.tolerance},
                {"cases", Json::array()},
                {"growth", Json::array()},
                {"slower", slower_cases(outcome)}};
  for (const auto& one : outcome.result.cases) document["cases"].push_back(case_json(outcome, one));
  for (const auto& one : outcome.result.growths) document["growth"].push_back(growth_json(one));
  return document;
}

Json bench_list_document() {
  Json document{{"schema", "kith.bench-list/1"}, {"cases", Json::array()}, {"growth", Json::array()}};
  for (const auto& one : bench::all_cases()) {
    document["cases"].push_back(
        {{"name", one.name}, {"what", one.what}, {"rival", one.rival.empty() ? Json{} : Json(one.rival)}});
  }
  for (const auto& one : bench::all_growths())
    document["growth"].push_back({{"name", one.name}, {"what", one.what}, {"size", one.size}});
  return document;
}

}  // namespace kith::cli
