#include "scenario.hpp"

namespace kith::faults {
namespace {

using Placed = std::vector<Preparation::Placed>;

Words shard_into(const std::string& folder, const std::string& shard) { return study_into(folder, {"--shard", shard}); }

const Words& merge() {
  static const Words kMerge{"merge", "s1", "s2", "s3", "-o", "run"};
  return kMerge;
}

Placed and_shards(Placed placed) {
  for (const std::string name : {"s1", "s2", "s3"}) placed.push_back({name, name});
  return placed;
}

std::vector<Scenario> while_it_runs() {
  const Words yes{"--yes"};
  std::vector<Scenario> all;
  all.push_back({"plain", Where::kProcess, {{}}, {study_into("run")}});
  all.push_back({"resume",
                 Where::kProcess,
                 {{{{"unfinished-1", "run"}}},
                  {{{"unfinished-3", "run"}}},
                  {{{"unfinished-6", "run"}}},
                  {{{"untabled", "run"}}},
                  {{{"finished", "run"}}}},
                 {study_into("run")}});
  all.push_back({"replace",
                 Where::kProcess,
                 {{{{"seed.finished", "run"}}, "", yes},
                  {{{"order.finished", "run"}}, "", yes},
                  {{{"key.finished", "run"}}, "", yes},
                  {{{"seed.unfinished", "run"}}, "", yes}},
                 {study_into("run", yes)}});
  all.push_back({"anew",
                 Where::kProcess,
                 {{{{"finished", "run"}}}, {{{"unfinished-3", "run"}}}, {{{"order.finished", "run"}}}},
                 {study_into("run", {"--resume", "never", "--yes"})}});
  all.push_back({"shard",
                 Where::kProcess,
                 {{{{"s2", "s2"}, {"s3", "s3"}}},
                  {{{"order.s1", "s1"}, {"s2", "s2"}, {"s3", "s3"}}},
                  {{{"seed.s1", "s1"}, {"s2", "s2"}, {"s3", "s3"}}},
                  {{{"s1-unfinished", "s1"}, {"s2", "s2"}, {"s3", "s3"}}}},
                 {study_into("s1", {"--shard", "1/3", "--yes"}), merge()}});
  all.push_back({"merge",
                 Where::kProcess,
                 {{and_shards({})}, {and_shards({{"order.finished", "run"}})}, {and_shards({{"finished", "run"}})}},
                 {{"merge", "s1", "s2", "s3", "-o", "run", "--yes"}}});
  all.push_back({"salvage",
                 Where::kProcess,
                 {{{{"untabled", "run"}}, "run/study.sqlite"}, {{{"finished", "run"}}, "run/study.sqlite"}},
                 {study_into("run")}});
  all.push_back({"mend", Where::kProcess, {{and_shards({}), "s1/study.sqlite"}}, {shard_into("s1", "1/3"), merge()}});
  all.push_back({"report", Where::kOutput, {{{{"finished", "run"}}}}, {{"report", "run", "-o", "run/report.html"}}});
  all.push_back({"analyze", Where::kOutput, {{{{"finished", "run"}}}}, {{"analyze", "run", "--json"}}});
  return all;
}

std::vector<Scenario> at_rest() {
  const std::vector<Words> shards{shard_into("s1", "1/3"), shard_into("s2", "2/3"), shard_into("s3", "3/3"), merge()};
  std::vector<Scenario> all;
  all.push_back({"finished", Where::kFolder, {{{{"finished", "run"}}}, {{{"replaced", "run"}}}}, {study_into("run")}});
  all.push_back({"unfinished",
                 Where::kFolder,
                 {{{{"unfinished-3", "run"}}}, {{{"unfinished-6", "run"}}}, {{{"untabled", "run"}}}},
                 {study_into("run")}});
  all.push_back(
      {"shards", Where::kFolder, {{and_shards({})}, {{{"s1-unfinished", "s1"}, {"s2", "s2"}, {"s3", "s3"}}}}, shards});
  all.push_back({"merged", Where::kFolder, {{and_shards({{"merged", "run"}})}}, {merge()}, "run"});
  return all;
}

}  // namespace

Words study_into(const std::string& folder, const Words& options) {
  Words words{"study", "quick", "--set", "domain=\"two-goals\"", "--set", "replicates=4", "--progress",
              "none",  "-o",    folder};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

std::vector<Scenario> all_scenarios(bool with_mpi) {
  auto all = while_it_runs();
  for (auto& scenario : at_rest()) all.push_back(std::move(scenario));
  if (with_mpi) {
    all.push_back({"ranks", Where::kProcess, {{}, {{{"unfinished-3", "run"}}}}, {study_into("run")}, "", 2});
  }
  return all;
}

}  // namespace kith::faults
