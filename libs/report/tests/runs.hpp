#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kith/files/atomic_file.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/study.hpp"
#include "scratch_folder.hpp"

namespace kith::testing {

using Json = nlohmann::json;

inline RunFacts facts() {
  RunFacts facts;
  facts.version = "1.2.3";
  facts.git = "abc";
  facts.command_line = {"kith", "study", "quick"};
  facts.domain = "item-delivery";
  facts.started = "2026-01-31T11:00:00Z";
  facts.stopped = "2026-01-31T12:00:00Z";
  facts.timings = {{"teach", 1.5}};
  return facts;
}

inline void publish(const std::filesystem::path& folder, const StudyReading& reading,
                    const std::vector<TeamRecord>& teams) {
  RunFolder{folder, freeze(reading)}.publish(reading.study.value(), teams, facts());
}

/// Two baseline teams and two taught with the common belief, of one novice and one proficient learner each.
inline StudyReading tiny_study(std::vector<std::string> overrides = {}) {
  overrides.insert(overrides.begin(),
                   {"replicates=2", "learner.N.particles=60", "learner.P.particles=60", "teacher.particles=60"});
  return load_study("quick", {overrides});
}

/// A finished run of that study.
inline void run_tiny_study(const std::filesystem::path& folder, const std::vector<std::string>& overrides = {}) {
  const auto reading = tiny_study(overrides);
  const Atlas atlas{*reading.domain};
  publish(folder, reading,
          run_teams(atlas, *reading.study, team_addresses(*reading.study), {.threads = 1, .on_progress = {}}).teams);
}

/// The same with teams made up so that every figure can be computed by hand.
inline std::vector<TeamRecord> invented_teams() {
  const auto addresses = team_addresses(tiny_study().study.value());
  std::vector<TeamRecord> teams(4);
  const std::vector<std::size_t> periods{3, 5, 4, 6};
  const std::vector<double> knowledge{0.2, 0.4, 0.5, 0.7};
  for (std::size_t i = 0; i < teams.size(); ++i) {
    teams[i].address = addresses[i];
    teams[i].seed_address = "1/NP/" + std::to_string(addresses[i].replicate);
    teams[i].status = i != 1 ? SessionStatus::kComplete : SessionStatus::kMaxPeriods;
    teams[i].periods = periods[i];
    teams[i].knowledge = knowledge[i];
    teams[i].area_sr = 1.0 + static_cast<double>(i);
  }
  const auto teach = [](TeamRecord& team, std::size_t member, std::size_t component, double area) {
    const auto& known = team.period_records;
    const bool goes_on = !known.empty() && known.back().member == member;
    const auto period = goes_on ? known.back().period + 1 : 1;
    team.period_records.push_back({.period = period,
                                   .member = member,
                                   .component = component,
                                   .source = "common",
                                   .area_sr = area,
                                   .p_bec = {0.5, 0.5}});
  };
  // The baseline: member 1 has two periods of component 1, member 2 one of it.
  teach(teams[0], 1, 1, 9.0);
  teach(teams[0], 1, 1, std::exp(0.5));
  teach(teams[0], 2, 1, 9.0);
  for (const double area : {9.0, std::exp(1.0)}) teach(teams[2], 0, 1, area);
  for (const double area : {9.0, std::exp(2.0)}) teach(teams[2], 0, 2, area);
  for (const double area : {9.0, std::exp(2.0), std::exp(2.0), std::exp(2.0)}) teach(teams[3], 0, 1, area);
  for (const double area : {9.0, std::exp(4.0)}) teach(teams[3], 0, 2, area);
  teams[2].progress = {{.period = 1, .component = 1, .member = 1, .type = 'N', .ability = 0.7, .p_bec = 0.1},
                       {.period = 1, .component = 1, .member = 2, .type = 'P', .ability = 0.8, .p_bec = 0.2},
                       {.period = 2, .component = 1, .member = 1, .type = 'N', .ability = 0.75, .p_bec = 0.25},
                       {.period = 3, .component = 2, .member = 1, .type = 'N', .ability = 0.7, .p_bec = 0.5}};
  teams[3].progress = {{.period = 1, .component = 1, .member = 1, .type = 'N', .ability = 0.8, .p_bec = 0.3}};
  const auto answer = [](std::size_t member, std::size_t test, bool correct) {
    ResponseRecord response;
    response.period = 1;
    response.component = 1;
    response.test = test;
    response.member = member;
    response.correct = correct;
    return response;
  };
  teams[2].responses = {answer(1, 1, true), answer(1, 2, false), answer(2, 1, true)};
  teams[3].responses = {answer(1, 1, true), answer(1, 2, true)};
  return teams;
}

/// The rows of a table of the document whose first cells are these.
inline std::vector<Json> rows_of(const Json& document, const std::string& table, const std::vector<Json>& keys) {
  std::vector<Json> rows;
  for (const auto& row : document.at("tables").at(table).at("rows")) {
    bool same = true;
    for (std::size_t i = 0; i < keys.size(); ++i) same = same && row.at(i) == keys[i];
    if (same) rows.push_back(row);
  }
  return rows;
}

/// Replaces the first `from` in a file.
inline void edit(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  auto text = read_file(file);
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument{"edit: " + file.string() + " has no " + from};
  std::ofstream{file, std::ios::binary} << text.replace(at, from.size(), to);
}

}  // namespace kith::testing
