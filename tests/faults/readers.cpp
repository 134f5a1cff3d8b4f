#include "readers.hpp"

#include <algorithm>

#include "kith/files/atomic_file.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

bool any_of(const std::vector<const Expected*>& allowed, const std::function<bool(const Expected& one)>& is) {
  return std::any_of(allowed.begin(), allowed.end(), [&](const Expected* one) { return is(*one); });
}

// Why the folder is not what verify says it is.
std::string unsound(const Models& models, const Reading& reading) {
  const auto run = reading.root / "run";
  const auto tables = files_below(run / "tables");
  const auto inputs = files_below(run / "inputs");
  // Of a run that is not finished it says that the teams so far are right.
  if (tables.empty() && !fs::exists(run / "manifest.json") && !reading.was_finished) return {};
  if (!any_of(reading.allowed, [&](const Expected& one) { return one.tables == tables; })) return "tables are wrong";
  if (!any_of(reading.allowed, [&](const Expected& one) { return one.inputs == inputs; })) return "inputs are wrong";
  if (!fs::exists(run / "manifest.json")) return "there is no manifest";
  const auto manifest = comparable_manifest(read_file(run / "manifest.json"));
  const auto is_whole = [&](const Expected& one) {
    return one.tables == tables && one.inputs == inputs && one.manifest == manifest;
  };
  if (!any_of(reading.allowed, is_whole)) return "the manifest is wrong, or of another run";
  if (reading.is_worked_on) return {};
  const auto readable = readable_records(run, models.records_of("run"), reading.root.parent_path() / "journals");
  return readable.size() < models.records_of("run").forms.size() ? "the journal lacks records" : "";
}

}  // namespace

std::string wrong_ending(const std::string& command, const Ended& ended) {
  if (ended.hung) return command + " hangs; ";
  if (ended.code == 1 || ended.code >= 128 || ended.code < 0) {
    return command + " crashes with " + std::to_string(ended.code) + " (" + ended.err.substr(0, 200) + "); ";
  }
  if (ended.code != 0 && ended.err.empty() && ended.out.empty())
    return command + " exits with " + std::to_string(ended.code) + " unsaid; ";
  return {};
}

std::string wrong_readings(const Models& models, const Reading& reading) {
  const auto ask = [&](const Words& words) { return run_kith(models.tools(), reading.root, words); };
  const auto verify = ask({"verify", "run"});
  const auto analyze = ask({"analyze", "run", "--json"});
  const auto report = ask({"report", "run", "--json"});
  auto wrong = wrong_ending("status", ask({"status", "run", "--json"})) + wrong_ending("verify", verify) +
               wrong_ending("analyze", analyze) + wrong_ending("report", report);
  if (verify.code == 0) {
    const auto why = unsound(models, reading);
    if (!why.empty()) wrong += "verify exits with 0 though " + why + "; ";
  }
  if (analyze.code == 0 && !any_of(reading.allowed, [&](const auto& one) { return one.analysis == analyze.out; })) {
    wrong += "analyze exits with 0 and another result; ";
  }
  if (report.code == 0) {
    const auto document = comparable_report(report.out);
    if (!any_of(reading.allowed, [&](const auto& one) { return one.report == document; })) {
      wrong += "report exits with 0 and another result; ";
    }
  }
  return wrong;
}

}  // namespace kith::faults
